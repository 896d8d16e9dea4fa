"""Environments of Gymnasium (docs/python_envs.md). Needs the package `gymnasium`, 1.4 or newer."""

from gloam.envs.declared import DeclaredTask, make_env, make_vec_env
from gloam.envs.noise import Gaussian, Noise, Uniform
from gloam.envs.pipeline import Pipeline
from gloam.envs.point_goal import PointGoal
from gloam.envs.quadruped_velocity import QuadrupedVelocity
from gloam.envs.reach import Reach
from gloam.envs.registration import register_envs
from gloam.envs.settings import EnvSettings
from gloam.envs.single import Env
from gloam.envs.task import Outcome, Task, TaskWorld
from gloam.envs.terms import Term
from gloam.envs.vector import VectorEnv
from gloam.envs.worlds import Worlds

__all__ = [
    "DeclaredTask",
    "Env",
    "EnvSettings",
    "Gaussian",
    "Noise",
    "Outcome",
    "Pipeline",
    "PointGoal",
    "QuadrupedVelocity",
    "Reach",
    "Task",
    "TaskWorld",
    "Term",
    "Uniform",
    "VectorEnv",
    "Worlds",
    "make_env",
    "make_vec_env",
    "register_envs",
]

register_envs()
