"""Observation terms of policies: a closed list, the same names for Python and for controllers in C++.

Frames and signs follow legged_gym, Isaac Lab and mjlab: the base frame is the frame of the floating root body, x
forward, y left, z up.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TermInfo:
    """One term: numbers = fixed + per_joint * joints of the policy."""

    name: str
    fixed: int
    per_joint: int
    unit: str
    doc: str
    aliases: tuple[str, ...] = ()

    def size(self, joints: int) -> int:
        return self.fixed + self.per_joint * joints


TERMS: tuple[TermInfo, ...] = (
    TermInfo("base_lin_vel", 3, 0, "m/s", "velocity of the base's origin, base frame", ("base_linear_velocity",)),
    TermInfo("base_ang_vel", 3, 0, "rad/s", "angular velocity of the base, base frame", ("base_angular_velocity",)),
    TermInfo("projected_gravity", 3, 0, "1", "direction of gravity, base frame; upright: (0, 0, -1)"),
    TermInfo(
        "velocity_commands",
        3,
        0,
        "m/s, m/s, rad/s",
        "commanded vx, vy, yaw rate, heading frame",
        ("command", "commands", "velocity_command", "generated_commands", "twist"),
    ),
    TermInfo("command_lin_vel", 2, 0, "m/s", "commanded vx, vy"),
    TermInfo("command_ang_vel", 1, 0, "rad/s", "commanded yaw rate"),
    TermInfo(
        "joint_pos",
        0,
        1,
        "rad",
        "positions of the policy's joints less their default positions",
        ("joint_pos_rel", "dof_pos"),
    ),
    TermInfo("joint_vel", 0, 1, "rad/s", "velocities of the policy's joints", ("joint_vel_rel", "dof_vel")),
    TermInfo(
        "last_action",
        0,
        1,
        "1",
        "the network's previous output, after its clip; 0 at first",
        ("actions", "action", "last_actions"),
    ),
    TermInfo("phase", 2, 0, "1", "sine and cosine of the first leg's gait phase", ("gait_phase",)),
    TermInfo("sin_phase", 2, 0, "1", "sines of the two legs' gait phases, half a period apart"),
    TermInfo("cos_phase", 2, 0, "1", "cosines of the two legs' gait phases"),
)
_BY_NAME = {name: info for info in TERMS for name in (info.name, *info.aliases)}


def term_info(name: str, file: str = "") -> TermInfo:
    """The term of a name or alias. Raises InputError: no such term; the hint names the nearest and all terms."""
    found = _BY_NAME.get(name)
    if found is not None:
        return found
    near = difflib.get_close_matches(name, _BY_NAME, n=1)
    hint = (f"did you mean '{near[0]}'? " if near else "") + "one of: " + ", ".join(info.name for info in TERMS)
    raise InputError(f"there is no observation term '{name}'", file, hint=hint)


@dataclass
class RobotState:
    """A robot as its policy sees it at one instant; arrays are copies."""

    base_lin_vel: Array  # (3,) [m/s], base frame
    base_ang_vel: Array  # (3,) [rad/s], base frame
    projected_gravity: Array  # (3,) unit vector, base frame
    joint_pos: Array  # (n,) [rad, m], order of the policy
    joint_vel: Array  # (n,) [rad/s, m/s]
    sensors: dict[str, Array]  # of terms that name a sensor, by that name


class GaitClock:
    """Gait phases of two legs half a period apart, as holosoma's policies were trained with them.

    While no velocity is commanded both phases stay at pi; they restart at (0, pi) with the next command.
    """

    _STILL = 0.01  # [m/s, rad/s] below which a command means standing

    def __init__(self, period: float, rate: float) -> None:
        self._step = 2 * np.pi / (period * rate)
        self.reset()

    def reset(self) -> None:
        self.phase: Array = np.array([0.0, np.pi])  # [rad]
        self._is_standing = False

    def tick(self, command: Array) -> None:
        self.phase = np.fmod(self.phase + self._step + np.pi, 2 * np.pi) - np.pi
        if float(np.linalg.norm(command[:2])) < self._STILL and abs(float(command[2])) < self._STILL:
            self.phase = np.full(2, np.pi)
            self._is_standing = True
        elif self._is_standing:
            self.reset()


def term_values(name: str, state: RobotState, command: Array, action: Array, defaults: Array, phase: Array) -> Array:
    """Numbers of one term, before clip and scale; (size of the term,)."""
    if name == "velocity_commands":
        return command
    if name == "command_lin_vel":
        return command[:2]
    if name == "command_ang_vel":
        return command[2:3]
    if name == "joint_pos":
        return state.joint_pos - defaults
    if name == "last_action":
        return action
    if name == "phase":
        return np.array([np.sin(phase[0]), np.cos(phase[0])])
    if name == "sin_phase":
        return np.asarray(np.sin(phase), dtype=np.float64)
    if name == "cos_phase":
        return np.asarray(np.cos(phase), dtype=np.float64)
    values: Array = getattr(state, name)
    return values
