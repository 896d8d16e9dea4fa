"""Measures a walk in Gloam."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

TIMESTEP = 0.002  # of the scenes [s]
SETTLE = 1.5  # after a change of command [s]
GRAVITY = 9.81  # [m/s²]


@dataclass
class Measures:
    """Means over the time after Meter.start."""

    velocity_error: float  # of the mean velocity, heading frame [m/s]
    yaw_rate_error: float  # of the mean yaw rate [rad/s]
    distance: float  # of the whole run [m]
    energy: float  # positive mechanical work of the joints of the legs after `start` [J]
    walked: float  # distance after `start` [m]
    weight: float  # [N]
    fell: bool


class Meter:
    """Reads the state of the scene's only robot before each step; its first `joints` joints and motors are the legs'."""

    def __init__(self, memory: Any, joints: int = 12) -> None:
        arrays = (memory.array(name) for name in ("qpos", "qvel", "actuator_force"))
        self.qpos, self.qvel, self.force = arrays
        self.joints = joints
        self.weight = GRAVITY * float(memory.array("body_mass").sum())
        self.start: float | None = None  # time from which means count [s]
        self.sums = np.zeros(6)  # seconds, m, m, rad, J, m
        self.distance, self.fell = 0.0, False

    def read(self, time: float) -> None:
        w, x, y, z = self.qpos[3:7]
        heading = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z)])
        heading /= max(float(np.linalg.norm(heading)), 1e-9)
        self.fell = self.fell or bool(1 - 2 * (x * x + y * y) < 0.5)
        velocity, speed = self.qvel[:2], float(np.linalg.norm(self.qvel[:2]))
        self.distance += speed * TIMESTEP
        if self.start is not None and time >= self.start and not self.fell:
            power = self.force[: self.joints] * self.qvel[6 : 6 + self.joints]
            work = float(np.maximum(power, 0).sum())
            across = heading[0] * velocity[1] - heading[1] * velocity[0]
            self.sums += np.array([1, heading @ velocity, across, self.qvel[5], work, speed]) * TIMESTEP

    def measures(self, command: tuple[float, float, float]) -> Measures:
        time, ahead, across, turned, energy, walked = (float(number) for number in self.sums)
        time = max(time, TIMESTEP)
        error = math.hypot(ahead / time - command[0], across / time - command[1])
        return Measures(error, abs(turned / time - command[2]), self.distance, energy, walked, self.weight, self.fell)
