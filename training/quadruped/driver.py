"""The policy outside of the training: observations and targets in NumPy, as Gloam computes them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from .. import export
from . import robot
from .terms import TERMS

Network = Callable[[np.ndarray], np.ndarray]  # (n,) observation → (12,) action


@dataclass(frozen=True)
class GaitChoice:
    """In the order of terms.GAIT_PARAMETERS; units as in gait.Gait. The default is the trot of policy.toml."""

    frequency: float = 2.0
    phase: float = 0.5
    offset: float = 0.0
    bound: float = 0.0
    duration: float = 0.5
    swing_height: float = 0.08
    body_height: float = 0.0

    def clock(self, index: float) -> np.ndarray:
        """(4,) of FL, FR, RL, RR."""
        delays = np.array([self.phase + self.offset + self.bound, self.bound, self.offset, self.phase])
        f = np.mod(index + delays, 1.0)
        swing = 0.5 + 0.5 * (f - self.duration) / (1 - self.duration)
        return np.sin(2 * np.pi * np.where(f < self.duration, 0.5 * f / self.duration, swing))


class Driver:
    """Joint targets at 50 Hz from the state of the robot."""

    def __init__(self, network: Network, gait: GaitChoice | None = None) -> None:
        self.network, self.gait = network, gait or GaitChoice()
        self.command = np.zeros(3)  # vx, vy, yaw rate, heading frame [m/s, m/s, rad/s]
        self.reset()

    def reset(self) -> None:
        self._index = 0.0
        self._action = np.zeros(12)
        self._history: list[np.ndarray] | None = None

    def _values(self, quaternion: np.ndarray, angular_B: np.ndarray, q: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
        w, x, y, z = quaternion
        gravity = -np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        values = {
            "base_ang_vel": angular_B,
            "projected_gravity": gravity,
            "joint_pos": q - robot.DEFAULT_POSITIONS,
            "joint_vel": v,
            "last_action": self._action,
            "velocity_commands": self.command,
            "gait_parameters": np.array(astuple(self.gait)),
            "gait_clock": self.gait.clock(self._index),
        }
        return [values[term.name] * np.asarray(term.scale) for term in TERMS]

    def targets(self, qpos: np.ndarray, qvel: np.ndarray) -> np.ndarray:
        """(12,) [rad] of a free joint's 7 + 12 positions and 6 + 12 velocities in MuJoCo's convention."""
        self._index = (self._index + self.gait.frequency * robot.CONTROL_PERIOD) % 1.0
        values = self._values(qpos[3:7], qvel[3:6], qpos[7:], qvel[6:])
        if self._history is None:
            self._history = [np.tile(value, (term.history, 1)) for value, term in zip(values, TERMS, strict=True)]
        else:
            pairs = zip(self._history, values, strict=True)
            self._history = [np.concatenate([old[1:], new[None]]) for old, new in pairs]
        observation = np.concatenate([part.ravel() for part in self._history])
        self._action = np.clip(self.network(observation), -robot.ACTION_CLIP, robot.ACTION_CLIP)
        return robot.DEFAULT_POSITIONS + robot.ACTION_SCALE * self._action


def torques(targets: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(12,) [N m] of the PD control that policy.toml specifies."""
    wanted = robot.STIFFNESS * (targets - q) - robot.DAMPING * v
    return np.clip(wanted, -robot.TORQUE_LIMIT, robot.TORQUE_LIMIT)


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
