"""PD control of the robots of assets/robots that have torque motors."""

from __future__ import annotations

from typing import Any

import numpy as np
from robots import Bench, mujoco


def bench(name: str, add: Any = None) -> Bench:
    """The robot at its keyframe "home"."""
    return Bench(f"{name}/{name}.xml", "home", add=add)


class Servo:
    """Torques kp (target - q) - kd v of all motors, within their limits. Targets are the start's positions at first."""

    def __init__(self, robot: Bench, kp: float, kd: float) -> None:
        self.model, self.data, self.kp, self.kd = robot.model, robot.data, kp, kd
        joints = self.model.actuator_trnid[:, 0]
        self.q_at, self.v_at = self.model.jnt_qposadr[joints], self.model.jnt_dofadr[joints]
        self.target = self.data.qpos[self.q_at].copy()

    def actuator(self, name: str) -> int:
        return int(self.model.actuator(name).id)

    def run(self, seconds: float) -> None:
        low, high = self.model.actuator_ctrlrange.T
        for _ in range(round(seconds / self.model.opt.timestep)):
            torque = self.kp * (self.target - self.data.qpos[self.q_at]) - self.kd * self.data.qvel[self.v_at]
            self.data.ctrl[:] = np.clip(torque, low, high)
            mujoco.mj_step(self.model, self.data)
