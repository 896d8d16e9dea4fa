"""The policy outside of the training: observations and targets in NumPy, as Gloam computes them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from functools import partial
from pathlib import Path

import numpy as np

from .. import export
from .robot import ACTION_CLIP, CONTROL_PERIOD, GaitChoice, Robot
from .terms import actor_terms

Network = Callable[[np.ndarray], np.ndarray]  # (n,) observation → (joints,) action


class Driver:
    """Joint targets at 50 Hz from the state of the robot."""

    def __init__(self, robot: Robot, network: Network, gait: GaitChoice | None = None) -> None:
        self.robot, self.network, self.gait = robot, network, gait or robot.gait
        self.terms = actor_terms(robot)
        self.command = np.zeros(3)  # vx, vy, yaw rate, heading frame [m/s, m/s, rad/s]
        self.reset()

    def reset(self) -> None:
        self._index = 0.0
        self._action = np.zeros(len(self.robot.joints))
        self._history: list[np.ndarray] | None = None

    def _values(self, qpos: np.ndarray, qvel: np.ndarray) -> list[np.ndarray]:
        (w, x, y, z), n = qpos[3:7], len(self.robot.joints)
        R_WB = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])  # fmt: skip
        values = {
            "base_lin_vel": R_WB.T @ qvel[:3],
            "base_ang_vel": qvel[3:6],
            "projected_gravity": -R_WB[2],
            "joint_pos": qpos[7 : 7 + n] - self.robot.default_positions,
            "joint_vel": qvel[6 : 6 + n],
            "last_action": self._action,
            "velocity_commands": self.command,
            "gait_parameters": np.array(astuple(self.gait)),
            "gait_clock": self.gait.clock(self._index),
        }
        return [values[term.name] * np.asarray(term.scale) for term in self.terms]

    def targets(self, qpos: np.ndarray, qvel: np.ndarray) -> np.ndarray:
        """(joints,) [rad] of a free joint's 7 positions and 6 velocities in MuJoCo's convention, and the joints' after
        them; further joints are ignored."""
        self._index = (self._index + self.gait.frequency * CONTROL_PERIOD) % 1.0
        values = self._values(qpos, qvel)
        if self._history is None:
            self._history = [np.tile(value, (term.history, 1)) for value, term in zip(values, self.terms, strict=True)]
        else:
            pairs = zip(self._history, values, strict=True)
            self._history = [np.concatenate([old[1:], new[None]]) for old, new in pairs]
        observation = np.concatenate([part.ravel() for part in self._history])
        self._action = np.clip(self.network(observation), -ACTION_CLIP, ACTION_CLIP)
        return self.robot.default_positions + self.robot.action_scale * self._action

    def torques(self, targets: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(joints,) [N m] of the PD control that policy.toml specifies."""
        wanted = self.robot.stiffness * (targets - q) - self.robot.damping * v
        return np.clip(wanted, -self.robot.torque_limit, self.robot.torque_limit)


def load_network(path: Path) -> Network:
    """The network of an ONNX file, which requires openvino, or of a checkpoint.npz."""
    if path.suffix == ".npz":
        return partial(export.evaluate, export.layers_of(path))
    import openvino

    core = openvino.Core()
    options = {"INFERENCE_NUM_THREADS": 1, "INFERENCE_PRECISION_HINT": "f32"}
    request = core.compile_model(core.read_model(path), "CPU", options).create_infer_request()

    def infer(observation: np.ndarray) -> np.ndarray:
        output: np.ndarray = request.infer({0: observation[None].astype(np.float32)})[0]
        return output[0].astype(np.float64)

    return infer
