"""Tables of actions for make_env."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import gloam
from gloam.envs.noise import Array


@dataclass(frozen=True)
class Actuation(ABC):
    """A part of an action. low, high: its limits, in the units of the quantity it sets."""

    robot: str
    low: Sequence[float] | float | None
    high: Sequence[float] | float | None

    @abstractmethod
    def default_limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        """Limits of the model; infinite if it has none."""

    @abstractmethod
    def apply(self, sim: gloam.Simulation, action: Array) -> None:
        """Applies the action to the robot."""

    def limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        """Lowest and highest action. Errors: ValueError if they are unknown, or low exceeds high; NotFoundError."""
        low, high = self.default_limits(sim)
        try:
            if self.low is not None:
                low = np.broadcast_to(np.asarray(self.low, dtype=np.float64), low.shape)
            if self.high is not None:
                high = np.broadcast_to(np.asarray(self.high, dtype=np.float64), high.shape)
        except ValueError as error:
            raise ValueError(
                f"limits of the actions of '{self.robot}': expected {len(low)} numbers each"
            ) from error
        if not (np.isfinite(low).all() and np.isfinite(high).all() and (low <= high).all()):
            raise ValueError(f"limits of the actions of '{self.robot}' are unknown: give low and high")
        return low, high


class Controls(Actuation):
    """Controls of all actuators of a robot; limits: their control ranges."""

    def default_limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        names = sim.robots[self.robot].actuator_names
        places = [sim.world.actuators.index(name) for name in names]
        ranges = np.array(sim.memory.array("actuator_ctrlrange"))[places]
        limited = np.array(sim.memory.array("actuator_ctrllimited"))[places].astype(bool)
        return np.where(limited, ranges[:, 0], -np.inf), np.where(limited, ranges[:, 1], np.inf)

    def apply(self, sim: gloam.Simulation, action: Array) -> None:
        sim.robots[self.robot].controls = action


class VelocityCommand(Actuation):
    """Velocity goal (vx, vy, yaw_rate) of a robot's controller [m/s, m/s, rad/s]."""

    def default_limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        assert sim.robots[self.robot] is not None
        return np.full(3, -np.inf), np.full(3, np.inf)

    def apply(self, sim: gloam.Simulation, action: Array) -> None:
        sim.robots[self.robot].command(vx=float(action[0]), vy=float(action[1]), yaw_rate=float(action[2]))


class JointGoals(Actuation):
    """Goals of all hinges and slides of a robot with a joint_position controller [rad, m]; limits: their ranges."""

    def default_limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        places = [sim.world.joints.index(name) for name in sim.robots[self.robot].joint_names]
        ranges = np.array(sim.memory.array("jnt_range"))[places]
        limited = np.array(sim.memory.array("jnt_limited"))[places].astype(bool)
        return np.where(limited, ranges[:, 0], -np.inf), np.where(limited, ranges[:, 1], np.inf)

    def apply(self, sim: gloam.Simulation, action: Array) -> None:
        for name, goal in zip(sim.robots[self.robot].joint_names, action, strict=True):
            sim.joints[name].set_goal(float(goal))


@dataclass(frozen=True)
class FunctionActuation(Actuation):
    """A function of the simulation and the action."""

    function: Callable[[gloam.Simulation, Array], None]

    def default_limits(self, sim: gloam.Simulation) -> tuple[Array, Array]:
        size = max(np.size(limit) for limit in (self.low, self.high, 0.0) if limit is not None)
        return np.full(size, -np.inf), np.full(size, np.inf)

    def apply(self, sim: gloam.Simulation, action: Array) -> None:
        self.function(sim, action)


_KINDS: dict[str, type[Actuation]] = {"controls": Controls, "command": VelocityCommand, "joint_goals": JointGoals}


def parse_actions(tables: object) -> list[Actuation]:
    """Actuations out of a table or a list of tables. Errors: ValueError."""
    if tables is None:
        return []
    listed: Any = [tables] if isinstance(tables, Mapping) else tables
    if not isinstance(listed, Sequence) or isinstance(listed, str):
        raise ValueError(f"actions must be a table or a list of tables, got {tables!r}")
    return [_parsed(table) for table in listed]


def _parsed(table: object) -> Actuation:
    if not isinstance(table, Mapping):
        raise ValueError(f"an action must be a table, got {table!r}")
    kinds = [key for key in table if key in (*_KINDS, "function")]
    if len(kinds) != 1:
        raise ValueError(f"an action must have one of {', '.join(_KINDS)}, function; got {sorted(table)}")
    kind = kinds[0]
    for key in table:
        if key not in (kind, "low", "high"):
            raise ValueError(f"an action has no key '{key}'; it has low, high")
    low, high = table.get("low"), table.get("high")
    if kind == "function":
        return FunctionActuation("function", low, high, table[kind])
    return _KINDS[kind](str(table[kind]), low, high)
