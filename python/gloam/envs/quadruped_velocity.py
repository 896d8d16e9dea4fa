"""QuadrupedVelocity: a quadruped follows velocity goals; actions are targets of its joints.

Observations, rewards and their weights follow the velocity task for flat ground of Rudin et al., "Learning to Walk in
Minutes" (arXiv:2109.11978), with our own figures where the robot differs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces

import gloam
from gloam.envs.assets import asset_folder
from gloam.envs.noise import Array, Uniform
from gloam.envs.task import Outcome, SceneSource, Task, TaskWorld
from gloam.envs.terms import Term

JOINTS = 12
ACTION_SCALE = 0.7  # [rad] of an action of 1, about the stance of the keyframe "home"
FALLEN = math.cos(math.radians(60))  # of the angle between the trunk's z and the vertical
LOWEST = 0.15  # height of the trunk [m]
SPREAD = 0.25  # of the kernels of the tracking rewards, (m/s)^2 and (rad/s)^2


class QuadrupedVelocity(Task):
    """vx, vy, yaw_rate: ranges (least, most) of velocity goals in the heading frame [m/s, m/s, rad/s].

    hold: time that a goal stays [s]. noisy: whether observations have the noise of the paper. kp, kd: of the joints'
    servos [N m/rad, N m s/rad]. Errors: ValueError.
    """

    control_interval = 0.02
    layout = "vector"

    def __init__(
        self,
        vx: tuple[float, float] = (-0.5, 1.0),
        vy: tuple[float, float] = (-0.4, 0.4),
        yaw_rate: tuple[float, float] = (-1.0, 1.0),
        hold: float = 5.0,
        noisy: bool = True,
        kp: float = 30.0,
        kd: float = 0.8,
    ) -> None:
        self.goals = np.array([vx, vy, yaw_rate], dtype=np.float64)
        if (
            self.goals.shape != (3, 2)
            or not np.isfinite(self.goals).all()
            or (self.goals[:, 0] > self.goals[:, 1]).any()
        ):
            raise ValueError("vx, vy and yaw_rate must be ranges (least, most)")
        if not hold > 0:
            raise ValueError(f"hold must be a time above 0 s, got {hold}")
        self.hold, self.noisy, self.kp, self.kd = hold, noisy, kp, kd

    def scene(self) -> SceneSource:
        tables: dict[str, Any] = {
            "scene": {"name": "quadruped_velocity"},
            "sim": {"timestep": 0.004},
            "environment": {"file": "environments/plane/plane.xml"},
            "robot": [
                {
                    "name": "go",
                    "file": "robots/quadruped/quadruped.xml",
                    "keyframe": "home",
                    "controller": {"type": "joint_position", "kp": self.kp, "kd": self.kd, "rate": 250},
                }
            ],
            "camera": [
                {
                    "name": "chase",
                    "track": "go/trunk",
                    "position": [-1.4, -0.7, 0.8],
                    "look_at": [0.3, 0, 0],
                    "fovy": 55,
                }
            ],
            "render": {"tier": "direct", "spp": 1},
        }
        return gloam.Scene.from_dict(tables, folder=asset_folder())

    def action_space(self, world: gloam.World) -> spaces.Box:
        """Targets of the joints, about the stance, in units of ACTION_SCALE."""
        return spaces.Box(-1.0, 1.0, (JOINTS,), np.float32)

    def terms(self, world: gloam.World) -> Sequence[Term]:
        """In this order, all in the trunk's frame: velocities, gravity's direction, goal, joints, the last action."""

        def noise(size: float) -> Uniform | None:
            return Uniform(-size, size) if self.noisy else None

        return [
            Term("velocity", (3,), noise=noise(0.1), clip=(-10, 10), scale=2.0),
            Term("angular_velocity", (3,), noise=noise(0.2), clip=(-40, 40), scale=0.25),
            Term("gravity", (3,), noise=noise(0.05), clip=(-1, 1)),
            Term("goal", (3,), clip=(-10, 10), scale=(2.0, 2.0, 0.25)),
            Term("joint_position", (JOINTS,), noise=noise(0.01), clip=(-6, 6)),
            Term("joint_velocity", (JOINTS,), noise=noise(1.5), clip=(-100, 100), scale=0.05),
            Term("action", (JOINTS,), clip=(-1, 1)),
        ]

    def bind(self, sim: gloam.Simulation) -> TaskWorld:
        return _QuadrupedWorld(sim, self)


class _QuadrupedWorld(TaskWorld):
    def __init__(self, sim: gloam.Simulation, task: QuadrupedVelocity) -> None:
        super().__init__(sim)
        self._task = task
        self._robot = sim.robots["go"]
        self._joints = [sim.joints[name] for name in self._robot.joint_names]
        self._stance = np.array(self._robot.qpos)
        self._rng = np.random.default_rng(0)
        self._goal = np.zeros(3)
        self._fixed: Array | None = None
        self._renew = 0.0
        self._motion = (np.zeros(3), np.zeros(3), np.zeros(3), 0.0)
        self._action, self._before = np.zeros(JOINTS), np.zeros(JOINTS)

    def begin(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        """options: "goal" (vx, vy, yaw_rate), that stays, in place of drawn ones."""
        self._rng = rng
        self._fixed = None
        if "goal" in options:
            self._fixed = np.asarray(options["goal"], dtype=np.float64)
            if self._fixed.shape != (3,) or not np.isfinite(self._fixed).all():
                raise ValueError(f"goal must be (vx, vy, yaw_rate), got {options['goal']!r}")
        self._draw_goal(0.0)
        self._action, self._before = np.zeros(JOINTS), np.zeros(JOINTS)
        self._robot.place(position=(0, 0, 0.3), yaw=float(rng.uniform(-math.pi, math.pi)))
        self._robot.set_joints(qpos=self._stance + rng.uniform(-0.05, 0.05, JOINTS))

    def _draw_goal(self, now: float) -> None:
        low, high = self._task.goals.T
        self._goal = self._rng.uniform(low, high) if self._fixed is None else self._fixed
        self._renew = now + self._task.hold

    def decide(self, action: Array) -> None:
        self._before, self._action = self._action, np.array(action)

    def apply(self, action: Array) -> None:
        for joint, target in zip(self._joints, self._stance + ACTION_SCALE * np.asarray(action), strict=True):
            joint.set_goal(float(target))

    def _measured(self) -> tuple[Array, Array, Array, float]:
        """Velocity, angular velocity, direction of gravity, all in the trunk's frame, and its height [m]."""
        pose = self._robot.pose
        inverse = pose.R.T
        down = inverse @ np.array([0.0, 0.0, -1.0])
        return inverse @ self._robot.velocity, inverse @ self._robot.angular_velocity, down, float(pose.p[2])

    def observe(self) -> dict[str, Array]:
        velocity, turning, down, _ = self._motion = self._measured()
        return {
            "velocity": velocity,
            "angular_velocity": turning,
            "gravity": down,
            "goal": self._goal,
            "joint_position": self._robot.qpos - self._stance,
            "joint_velocity": np.array(self._robot.qvel),
            "action": self._action,
        }

    def judge(self, action: Array) -> Outcome:
        """Tracking of the goal, less what is jerky, tilted or bounces; all per second, times the control interval."""
        velocity, turning, down, height = self._motion
        wrong = float(np.sum((self._goal[:2] - velocity[:2]) ** 2))
        turned_wrong = float((self._goal[2] - turning[2]) ** 2)
        has_fallen = -down[2] < FALLEN or height < LOWEST
        reward = (
            math.exp(-wrong / SPREAD)
            + 0.5 * math.exp(-turned_wrong / SPREAD)
            - 2.0 * float(velocity[2]) ** 2
            - 0.05 * float(np.sum(turning[:2] ** 2))
            - 0.05 * float(np.sum((self._action - self._before) ** 2))
            - float(np.sum(down[:2] ** 2))
        )
        info = {
            "velocity_error": math.sqrt(wrong),
            "yaw_rate_error": math.sqrt(turned_wrong),
            "fallen": bool(has_fallen),
        }
        if self.sim.time >= self._renew:
            self._draw_goal(self.sim.time)
        return Outcome(reward * self._task.control_interval - (2.0 if has_fallen else 0.0), bool(has_fallen), info)
