"""Policies: networks in ONNX files that control robots (docs/policies.md).

policy = gloam.Policy("walk.onnx", "walk.toml")     # the TOML only if the file's metadata is incomplete
drive = policy.attach(sim, "go2")
drive.command(vx=0.5)
sim.run_until(time=5)
"""

from __future__ import annotations

import contextlib
import math
import os
import tomllib
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gloam import _core

from .errors import ClosedError, UsageError

if TYPE_CHECKING:
    from .elements import Robot
    from .simulation import Simulation

PathLike = str | os.PathLike[str]
Array = NDArray[np.float64]
AXES = ("vx", "vy", "yaw_rate")


@dataclass(frozen=True)
class TermInfo:
    """An observation term: numbers = fixed + per_joint * joints of the policy; both 0 = its own keys determine them."""

    name: str
    fixed: int
    per_joint: int
    unit: str
    doc: str
    aliases: tuple[str, ...]


TERMS: tuple[TermInfo, ...] = tuple(TermInfo(**row) for row in _core.policy_terms())


@dataclass(frozen=True)
class Term:
    """One part of an observation. Order of work: value, clip, scale, history."""

    name: str
    size: int  # numbers, with its history
    scale: tuple[float, ...]  # one number, or one of each value
    clip: tuple[float, float]  # in the term's unit
    history: int  # observations that are concatenated
    sensor: str  # gives the values instead of the true state; "" = none
    input: str  # of the network
    source: str  # "NETWORK.OUTPUT" that the term reads; "" = none


@dataclass(frozen=True)
class PolicyNetwork:
    """One network of a policy and its observation."""

    name: str
    every: int  # it runs in each k-th control period
    history: int  # whole observations of its first input
    terms: tuple[Term, ...]
    inputs: dict[str, int]  # numbers of each input
    outputs: dict[str, int]


@dataclass(frozen=True)
class PolicySpec:
    """The settings with which a policy was trained. Arrays are (n,) in the order of `joints`."""

    joints: tuple[str, ...]
    kp: Array  # [N m/rad]
    kd: Array  # [N m s/rad]
    default_positions: Array  # [rad]
    action_scale: Array  # target = default + scale * action [rad]
    torque_limit: Array  # [N m], infinite where not given
    action_clip: tuple[float, float]
    rate: float  # [Hz]
    history_start: str  # initial history: "repeat" the first observation, or "zeros"
    gait_period: float  # [s], of the terms phase, sin_phase, cos_phase
    command_ranges: dict[str, tuple[float, float]]  # of vx, vy [m/s], yaw_rate [rad/s]; infinite = no limit
    velocity_feedback: float  # integral gain of the velocity's error that is added to commands [1/s]; 0 = none
    model_joints: dict[str, str]  # names in the model where they are others
    networks: tuple[PolicyNetwork, ...]  # in the order in which they run; the last one gives the actions

    @property
    def terms(self) -> tuple[Term, ...]:
        """Observation of the network that gives the actions."""
        return self.networks[-1].terms

    @property
    def observation_size(self) -> int:
        """Numbers of all inputs of that network."""
        return sum(self.networks[-1].inputs.values())


def _spec(info: dict[str, Any]) -> PolicySpec:
    networks = tuple(
        PolicyNetwork(**{**network, "terms": tuple(Term(**term) for term in network["terms"])})
        for network in info["networks"]
    )
    return PolicySpec(**{**info, "networks": networks})


def read_policy_metadata(path: PathLike) -> dict[str, Any]:
    """Reads the metadata of an ONNX file, as {"policy": {...}, "observation": [...]} in the form of a policy's TOML.

    Empty unless the metadata is from mjlab or holosoma. Raises the same errors as Policy.
    """
    return tomllib.loads(_core.policy_metadata(Path(path).absolute()))


class Policy:
    """Networks and the specification of their training, `spec`. One thread, f32, on the CPU: the same observation
    gives the same action.

    `path`: an ONNX file, None if `settings` lists all networks. `settings`: a TOML whose keys replace keys of the
    file's metadata. Raises IoError: no such file; InputError: not a network, a malformed TOML, terms that do not fill
    the network's inputs, missing metadata; UnsupportedError: OpenVINO is not installed, the network has loops.
    """

    def __init__(self, path: PathLike | None, settings: PathLike | None = None) -> None:
        self.path = None if path is None else Path(path).absolute()
        self.settings = None if settings is None else Path(settings).absolute()
        self._loaded = _core.LoadedPolicy.load(self.path or "", self.settings or "")
        self.spec = _spec(self._loaded.info)

    def infer(self, observation: ArrayLike) -> Array:
        """Actions (n,) of an observation (m,), or (k, n) of (k, m), as output by the network: not clipped, not
        scaled.

        Raises UsageError: another size, or the policy has several networks or inputs; DivergedError: an action is not
        finite.
        """
        array = np.asarray(observation, dtype=np.float32)
        if array.ndim not in (1, 2) or array.shape[-1] != self.spec.observation_size:
            raise UsageError(f"expected an observation of {self.spec.observation_size} numbers, got shape {array.shape}")
        rows = [cast(Array, self._loaded.infer(row)) for row in np.atleast_2d(array)]
        if array.ndim == 1:
            return rows[0]
        return np.stack(rows) if rows else np.zeros((0, len(self.spec.joints)))

    def attach(self, sim: Simulation, robot: Robot | str) -> PolicyDriver:
        """Makes the policy the controller of a robot from the next step on.

        Raises NotFoundError: no such robot; InputError: joints, actuators or sensors that the robot does not have;
        UnsupportedError: actuators that accept no torque; UsageError: a timestep that does not divide the policy's
        period, a robot that already has a policy.
        """
        name = robot if isinstance(robot, str) else getattr(robot, "name", None)
        if name is None:
            raise TypeError(f"expected a robot or its name, got {robot!r}")
        return PolicyDriver(self, sim, name)

    def __reduce__(self) -> tuple[type[Policy], tuple[Path | None, Path | None]]:
        return Policy, (self.path, self.settings)  # read again where it is sent to

    def __repr__(self) -> str:
        name = (self.path or self.settings or Path()).name
        return f"<gloam.Policy '{name}': {self.spec.observation_size} -> {len(self.spec.joints)}, {self.spec.rate:g} Hz>"


class PolicyDriver:
    """A policy that controls one robot, as its controller of the type "policy", until detach().

    After sim.reset() it starts from the beginning with the same command; sim.restore() returns to the controllers of
    the checkpoint.
    """

    def __init__(self, policy: Policy, sim: Simulation, robot: str) -> None:
        self.policy = policy
        self.robot = robot
        self._sim = weakref.ref(sim)
        self._command: tuple[float, float, float] | None = None
        if robot in sim._drives:
            raise UsageError(f"robot '{robot}' is already driven by a policy", hint="detach() that policy first")
        self.reset()
        sim._drives[robot] = self

    def _element(self) -> Robot:
        sim = self._sim()
        if sim is None:
            raise UsageError("the simulation of this policy no longer exists")
        return sim.robots[self.robot]

    def reset(self) -> None:
        """Starts the policy from the beginning at the next step: clears history, last action and gait phase. The
        command stays."""
        robot = self._element()
        self.policy._loaded.start(robot._sim._core, robot._now(), lease=robot._sim._leases.get(self.robot))

    def _after_reset(self) -> None:
        """The simulation has returned to the controllers and goals of its scene."""
        self.reset()
        if self._command is not None:
            self._element().command(*self._command)

    def _state(self) -> dict[str, Any] | None:
        robot = self._element()
        state = cast(dict[str, Any] | None, _core.policy_state(robot._sim._core, robot._now()))
        loaded = self.policy._loaded
        if state is None or (state["network"], state["settings"]) != (loaded.network, loaded.settings):
            return None
        return state

    @property
    def is_active(self) -> bool:
        """Whether the policy controls the robot. It does from the first step after attach() until detach() or another
        change of the robot's controller."""
        return self._state() is not None

    @property
    def action(self) -> Array:
        """The latest output of the network after its clip, (n,); 0 before the first."""
        state = self._state()
        return state["action"] if state else np.zeros(len(self.policy.spec.joints))

    @property
    def targets(self) -> Array:
        """The latest targets in the order of policy.spec.joints [rad], (n,)."""
        state = self._state()
        return state["targets"] if state else self.policy.spec.default_positions.copy()

    @property
    def inputs(self) -> dict[str, dict[str, NDArray[np.float32]]]:
        """The latest inputs, by the names of network and input; empty before the first step. A policy of one
        network names it "policy"."""
        state = self._state()
        if state is None:
            return {}
        pairs = zip(self.policy.spec.networks, state["observations"], strict=True)
        return {network.name: dict(zip(network.inputs, values, strict=True)) for network, values in pairs}

    @property
    def observation(self) -> NDArray[np.float32]:
        """The latest first input of the network that gives the actions, (m,); empty before the first step."""
        state = self._state()
        return state["observations"][-1][0] if state else np.zeros(0, np.float32)

    @property
    def is_servo(self) -> bool:
        """Whether the actuators are position servos of the policy's gains, which take the targets themselves. False
        before the first step."""
        state = self._state()
        return bool(state and state["is_servo"])

    @property
    def fault(self) -> str:
        """Reason why the robot's joints are damped: an observation or action that is not finite; "" = none."""
        state = self._state()
        return state["fault"] if state else ""

    def command(self, vx: float = 0.0, vy: float = 0.0, yaw_rate: float = 0.0) -> tuple[float, float, float]:
        """Sets the commanded velocity, heading frame [m/s, m/s, rad/s], from the next step; stays until changed.

        Returns the command clipped to the policy's command ranges. Raises UsageError: a number is not finite.
        """
        values = []
        for axis, value in zip(AXES, (vx, vy, yaw_rate), strict=True):
            if value is None or not math.isfinite(value):
                raise UsageError(f"a commanded {axis} must be a finite number, got {value}")
            low, high = self.policy.spec.command_ranges[axis]
            values.append(min(max(float(value), low), high))
        self._command = (values[0], values[1], values[2])
        self._element().command(*self._command)
        return self._command

    def place(self, position: Sequence[float], yaw: float = 0.0) -> None:
        """Puts the robot at `position` (3,) [m] at the next step, turned by `yaw` [rad], at rest, its joints at the
        policy's default positions. The policy starts from the beginning."""
        robot, spec = self._element(), self.policy.spec
        robot.place(position, yaw)
        joints = robot.joints
        for name, angle in zip(spec.joints, spec.default_positions, strict=True):
            own = spec.model_joints.get(name, name).rsplit("/", 1)[-1]
            joints[own].set(qpos=[float(angle)], qvel=[0.0])
        self.reset()

    def detach(self) -> None:
        """Returns the robot to the controller of its scene at the next step; without one, its last controls stay."""
        sim = self._sim()
        if sim is None or sim._drives.get(self.robot) is not self:
            return
        del sim._drives[self.robot]
        with contextlib.suppress(ClosedError):
            robot = sim.robots[self.robot]
            _core.restore_scene_controller(sim._core, robot._now(), lease=sim._leases.get(self.robot))

    def __enter__(self) -> PolicyDriver:
        return self

    def __exit__(self, *_: object) -> None:
        self.detach()


__all__ = ["TERMS", "Policy", "PolicyDriver", "PolicyNetwork", "PolicySpec", "Term", "TermInfo", "read_policy_metadata"]
