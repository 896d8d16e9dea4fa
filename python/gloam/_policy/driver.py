"""The loop in which a policy controls a robot: observation, network, targets, torques, between the steps of a
simulation."""

from __future__ import annotations

import contextlib
import math
import weakref
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ClosedError, DivergedError, UsageError
from .observer import Observer
from .robot_io import RobotIo
from .spec import AXES
from .terms import Array

if TYPE_CHECKING:
    from ..policy import Policy

_drivers: weakref.WeakKeyDictionary[Any, list[PolicyDriver]] = weakref.WeakKeyDictionary()


def _update_all(sim_ref: weakref.ref[Any]) -> None:
    sim = sim_ref()
    for driver in list(_drivers.get(sim, ())) if sim is not None else ():
        driver._before_step()


def _steps_per_action(rate: float, timestep: float) -> int:
    steps = 1.0 / (rate * timestep)
    whole = max(1, round(steps))
    if abs(steps - whole) > 1e-6 * steps:
        raise UsageError(
            f"a policy of {rate:g} Hz would act every {steps:g} steps of {timestep:g} s, which is not a whole number",
            hint=f"use a timestep of {1.0 / (rate * whole):g} s",
        )
    return whole


class PolicyDriver:
    """A policy that controls one robot. It acts before each step of the simulation until detach().

    At the policy's rate it observes and runs the network. Position servos with the policy's gains receive the targets
    as controls; for all other motors and servos the torques kp (target - q) - kd v are computed at every step. They
    replace the output of the robot's own controller. When time goes back (reset, restore) the policy restarts.
    """

    def __init__(self, policy: Policy, sim: Any, robot: str) -> None:
        self.policy = policy
        self.robot = robot
        self._sim = weakref.ref(sim)
        self._every = _steps_per_action(policy.spec.rate, sim.timestep)
        self._timestep = float(sim.timestep)
        self._io = RobotIo(sim.memory, policy.spec, robot)
        self._observer = Observer(policy.spec)
        self._command = np.zeros(3)
        self._begin(math.nan)
        drivers = _drivers.setdefault(sim, [])
        if any(other.robot == robot for other in drivers):
            raise UsageError(f"robot '{robot}' is already driven by a policy", hint="detach() that policy first")
        drivers.append(self)
        sim_ref = self._sim
        sim.on_step(lambda _memory: _update_all(sim_ref))

    def _begin(self, time: float) -> None:
        self._time = time
        self._count = 0
        self._observer.reset()
        self.action: Array = np.zeros(len(self.policy.spec.joints))  # (n,) the network's output, after its clip
        self.targets: Array = self.policy.spec.default_positions.copy()  # (n,) [rad], order of policy.spec.joints

    def reset(self) -> None:
        """Clears history, last action and gait phase; the policy acts at the next step. The command stays."""
        self._begin(math.nan)

    @property
    def is_servo(self) -> bool:
        """Whether the actuators are position servos of the policy's gains, which take the targets themselves."""
        return self._io.is_servo

    def command(self, vx: float = 0.0, vy: float = 0.0, yaw_rate: float = 0.0) -> tuple[float, float, float]:
        """Sets the commanded velocity, heading frame [m/s, m/s, rad/s]; stays until changed.

        Returns the command clipped to the policy's command ranges. Raises UsageError: a number is not finite.
        """
        values = []
        for axis, value in zip(AXES, (vx, vy, yaw_rate), strict=True):
            if value is None or not math.isfinite(value):
                raise UsageError(f"a commanded {axis} must be a finite number, got {value}")
            low, high = self.policy.spec.command_ranges.get(axis, (-math.inf, math.inf))
            values.append(min(max(float(value), low), high))
        self._command = np.array(values)
        return values[0], values[1], values[2]

    def place(self, position: Sequence[float], yaw: float = 0.0) -> None:
        """Puts the robot at `position` (3,) [m], turned by `yaw` [rad], at rest, its joints at the policy's default
        positions."""
        sim = self._sim()
        if sim is None:
            raise UsageError("the simulation of this policy no longer exists")
        robot, spec = sim.robots[self.robot], self.policy.spec
        robot.place(position, yaw)
        for name, angle in zip(self._io.joint_names, spec.default_positions, strict=True):
            sim.joints[name].set(qpos=[float(angle)], qvel=[0.0])
        self.reset()

    def detach(self) -> None:
        """Releases the robot; its last controls stay."""
        sim = self._sim()
        drivers = _drivers.get(sim, []) if sim is not None else []
        if self in drivers:
            drivers.remove(self)
            if not drivers:
                with contextlib.suppress(ClosedError):
                    sim.on_step(None)  # type: ignore[union-attr]

    def __enter__(self) -> PolicyDriver:
        return self

    def __exit__(self, *_: object) -> None:
        self.detach()

    def _before_step(self) -> None:
        """Called before each step, on the thread that steps."""
        sim = self._sim()
        memory = sim.memory  # type: ignore[union-attr]
        if memory is not self._io.memory:  # a recompile
            self._io = RobotIo(memory, self.policy.spec, self.robot)
        time = float(memory.time)
        if not abs(time - self._time - self._timestep) < 0.5 * self._timestep:
            self._begin(time)
        self._time = time
        acts = self._count % self._every == 0
        self._count += 1
        if acts:
            self._act()
        if acts or not self._io.is_servo:
            self._io.drive(self.targets)

    def _act(self) -> None:
        observation = self._observer.observe(self._io.state(), self._command, self.action)
        spec = self.policy.spec
        action = self.policy.infer(observation)
        self.action = np.clip(action, *spec.action_clip)
        self.targets = spec.default_positions + spec.action_scale * self.action
        if not np.isfinite(self.targets).all():
            joint = spec.joints[int(np.flatnonzero(~np.isfinite(self.targets))[0])]
            raise DivergedError(f"the policy's target of '{joint}' is not finite", str(self.policy.path))
