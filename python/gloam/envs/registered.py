"""The environments that gymnasium makes by name: one task each, all its settings as keyword arguments."""

from __future__ import annotations

import dataclasses
from typing import Any

from gymnasium.vector import AutoresetMode

from gloam.envs.point_goal import PointGoal
from gloam.envs.quadruped_velocity import QuadrupedVelocity
from gloam.envs.reach import Reach
from gloam.envs.settings import EnvSettings
from gloam.envs.single import Env
from gloam.envs.task import Task
from gloam.envs.vector import VectorEnv

_SETTINGS = {field.name for field in dataclasses.fields(EnvSettings)}


def _made(task: type[Task], options: dict[str, Any]) -> tuple[Task, EnvSettings]:
    """A task and settings out of keyword arguments. Errors: TypeError for one that neither has."""
    settings = {name: value for name, value in options.items() if name in _SETTINGS}
    return task(**{name: value for name, value in options.items() if name not in _SETTINGS}), EnvSettings(**settings)


class _NamedEnv(Env):
    _task: type[Task]

    def __init__(self, render_mode: str | None = None, max_episode_steps: int | None = None, **options: Any) -> None:
        task, settings = _made(self._task, options)
        super().__init__(task, settings, max_episode_steps, render_mode)


class _NamedVectorEnv(VectorEnv):
    _task: type[Task]

    def __init__(
        self,
        num_envs: int = 1,
        render_mode: str | None = None,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        **options: Any,
    ) -> None:
        task, settings = _made(self._task, options)
        super().__init__(task, num_envs, settings, max_episode_steps, autoreset_mode, render_mode)


class PointGoalEnv(_NamedEnv):
    """gloam/PointGoal-v0; options: as for PointGoal and EnvSettings."""

    _task = PointGoal


class PointGoalVectorEnv(_NamedVectorEnv):
    """gloam/PointGoal-v0, n worlds."""

    _task = PointGoal


class QuadrupedVelocityEnv(_NamedEnv):
    """gloam/QuadrupedVelocity-v0; options: as for QuadrupedVelocity and EnvSettings."""

    _task = QuadrupedVelocity


class QuadrupedVelocityVectorEnv(_NamedVectorEnv):
    """gloam/QuadrupedVelocity-v0, n worlds."""

    _task = QuadrupedVelocity


class ReachEnv(_NamedEnv):
    """gloam/Reach-v0; options: as for Reach and EnvSettings."""

    _task = Reach


class ReachVectorEnv(_NamedVectorEnv):
    """gloam/Reach-v0, n worlds."""

    _task = Reach
