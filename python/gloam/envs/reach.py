"""Reach: the tool of a 6-joint arm moves to a point. Actions move the targets of the joints' servos.

The task is that of "Reach" in Plappert et al., "Multi-Goal Reinforcement Learning" (arXiv:1802.09464), with a dense
reward.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces

import gloam
from gloam.envs.assets import asset_folder
from gloam.envs.noise import Array
from gloam.envs.task import Outcome, SceneSource, Task, TaskWorld
from gloam.envs.terms import Term

JOINTS = 6
STEP = 0.1  # change of a target by an action of 1 [rad]
SHOULDER = np.array([0.0, 0.0, 0.18])  # [m]
SHELL = (0.35, 0.65)  # distance of goals from the shoulder [m]


class Reach(Task):
    """radius: at which the goal is reached [m]. hold: control steps that the tool has to stay there.

    Errors: ValueError.
    """

    control_interval = 0.04
    layout = "vector"

    def __init__(self, radius: float = 0.05, hold: int = 1) -> None:
        if not radius > 0 or hold < 1:
            raise ValueError(f"radius and hold must be above 0, got {radius} and {hold}")
        self.radius, self.hold = radius, hold

    def scene(self) -> SceneSource:
        tables: dict[str, Any] = {
            "scene": {"name": "reach"},
            "sim": {"timestep": 0.004},
            "environment": {"file": "environments/plane/plane.xml"},
            "robot": [{"name": "arm", "file": "robots/arm/arm.xml", "keyframe": "home"}],
            "override": {"environment": {"option": {"integrator": "implicitfast"}}},
            "camera": [{"name": "view", "position": [1.3, -1.1, 0.9], "look_at": [0.2, 0, 0.35], "fovy": 45}],
            "render": {"tier": "direct", "spp": 1},
        }
        return gloam.Scene.from_dict(tables, folder=asset_folder())

    def action_space(self, world: gloam.World) -> spaces.Box:
        """Changes of the joints' targets, in units of STEP."""
        return spaces.Box(-1.0, 1.0, (JOINTS,), np.float32)

    def terms(self, world: gloam.World) -> Sequence[Term]:
        """In this order: joints [rad, rad/s], their targets, the tool in the world, the vector from it to the goal
        [m]."""
        return [
            Term("joint_position", (JOINTS,), clip=(-4, 4)),
            Term("joint_velocity", (JOINTS,), clip=(-20, 20), scale=0.1),
            Term("target", (JOINTS,), clip=(-4, 4)),
            Term("tool", (3,), clip=(-2, 2)),
            Term("goal", (3,), clip=(-2, 2)),
        ]

    def bind(self, sim: gloam.Simulation) -> TaskWorld:
        return _ReachWorld(sim, self)


class _ReachWorld(TaskWorld):
    def __init__(self, sim: gloam.Simulation, task: Reach) -> None:
        super().__init__(sim)
        self._task = task
        self._arm = sim.robots["arm"]
        self._tool = sim.bodies["arm/tool"]
        self._home = np.array(self._arm.qpos)
        self._limits = np.array([[-2.9, -1.6, -0.2, -2.9, -1.9, -2.9], [2.9, 1.9, 2.6, 2.9, 1.9, 2.9]])
        self._target = self._home.copy()
        self._goal = self._tool_position = np.zeros(3)
        self._held = 0

    def begin(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        """options: "goal" (x, y, z) [m] in place of a drawn one."""
        self._goal = _drawn_goal(rng)
        if "goal" in options:
            self._goal = np.asarray(options["goal"], dtype=np.float64)
            if self._goal.shape != (3,) or not np.isfinite(self._goal).all():
                raise ValueError(f"goal must be (x, y, z), got {options['goal']!r}")
        self._target = np.clip(self._home + rng.uniform(-0.2, 0.2, JOINTS), *self._limits)
        self._held = 0
        self._arm.set_joints(qpos=self._target, qvel=np.zeros(JOINTS))

    def apply(self, action: Array) -> None:
        self._target = np.clip(self._target + STEP * np.asarray(action), *self._limits)
        self._arm.controls = self._target

    def observe(self) -> dict[str, Array]:
        tool = self._tool_position = self._tool.pose.p
        return {
            "joint_position": np.array(self._arm.qpos),
            "joint_velocity": np.array(self._arm.qvel),
            "target": self._target,
            "tool": tool,
            "goal": self._goal - tool,
        }

    def judge(self, action: Array) -> Outcome:
        """Reward: minus the distance [m] and a small penalty of the action; 1 at the goal."""
        distance = float(np.linalg.norm(self._goal - self._tool_position))
        is_near = distance < self._task.radius
        self._held = self._held + 1 if is_near else 0
        is_done = self._held >= self._task.hold
        reward = -distance - 0.005 * float(np.sum(np.square(action))) + (1.0 if is_near else 0.0)
        return Outcome(reward, is_done, {"distance": distance, "success": is_done})


def _drawn_goal(rng: np.random.Generator) -> Array:
    """A point of the half shell in front of the arm, at least 0.15 m above the floor [m]."""
    while True:
        point = rng.uniform(-SHELL[1], SHELL[1], 3)
        if SHELL[0] <= np.linalg.norm(point) <= SHELL[1] and point[0] > 0.1 and (point + SHOULDER)[2] > 0.15:
            return np.asarray(point + SHOULDER)
