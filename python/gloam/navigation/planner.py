"""Planners: from observations of a robot to velocities or waypoints.

A planner is called at a declared rate with the observations that it needs, and its answer applies after a declared
latency in simulation time (`gloam.navigation.driver`). It is the same interface for Python code, networks and other
processes.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import gloam

    from .topological_map import TopologicalMap

Need = Literal["image", "depth", "scan"]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Observation:
    """Data of one instant. Fields that the planner does not need are None.

    time: simulation time [s]; image: (H, W, 3) uint8 sRGB; depth: (H, W) [m], inf = nothing; scan: (n, 3) points of a
    LiDAR from the robot's origin, x in its heading, z up: levelled as by an IMU [m]; pose: (x, y, yaw) in the world [m, rad]; velocity: (vx, vy, yaw rate)
    in the robot's frame [m/s, rad/s].
    """

    time: float
    pose: tuple[float, float, float]
    velocity: tuple[float, float, float]
    image: NDArray[np.uint8] | None = None
    depth: NDArray[np.float32] | None = None
    scan: NDArray[np.float32] | None = None

    def in_robot_frame(self, point: tuple[float, float]) -> tuple[float, float]:
        """(x, y) of a point of the world, in the robot's frame [m]."""
        x, y, yaw = self.pose
        dx, dy = point[0] - x, point[1] - y
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return cosine * dx + sine * dy, cosine * dy - sine * dx


@dataclass(frozen=True)
class Velocity:
    """Velocity of the robot in its own frame [m/s, rad/s]."""

    vx: float = 0.0
    vy: float = 0.0
    yaw_rate: float = 0.0


@dataclass(frozen=True)
class Waypoints:
    """Places to pass, in the robot's frame at the time of the observation: (n, 2) as (x, y) [m], or (n, 4) with the
    cosine and sine of the heading. `chosen`: the one to drive to (WaypointFollower)."""

    points: Array
    chosen: int = 2


@dataclass(frozen=True)
class Arrived:
    """The planner considers the goal reached: the robot stops."""


Answer = Velocity | Waypoints | Arrived


@dataclass(frozen=True)
class Task:
    """Work that a planner gets before the first observation.

    goal: (x, y) in the world [m], or None if only the map leads there; map: images of a demonstration, with the goal
    as its last node; world: the compiled scene, for planners that know its geometry; robot: its name; seed: of all
    random numbers of the planner; top_speed: [m/s]; radius: distance at which the goal counts as reached [m].
    """

    robot: str
    seed: int = 0
    goal: tuple[float, float] | None = None
    map: TopologicalMap | None = None
    world: gloam.World | None = None
    top_speed: float = 0.4
    radius: float = 0.5


class Planner(ABC):
    """Base class of planners. Override the class variables or set them on the instance.

    rate: calls per second of simulation time; latency: simulation time between an observation and the application of
    its answer [s]; needs: observations other than pose and velocity; uses_map: whether it
    reads Task.map, which the benchmark then renders; serves_one: whether all its instances share a resource that serves
    one robot at a time, such as a process at an address; image_size: (width, height) [px].
    """

    rate: float = 4.0
    latency: float = 0.1
    needs: ClassVar[frozenset[Need]] = frozenset()
    uses_map: ClassVar[bool] = True
    serves_one: ClassVar[bool] = False
    image_size: tuple[int, int] = (85, 64)

    @abstractmethod
    def reset(self, task: Task) -> None:
        """Begins an episode. Errors: gloam.UsageError if the task lacks something that this planner needs."""

    @abstractmethod
    def plan(self, observation: Observation) -> Answer:
        """The answer to an observation. NaN and exceptions stop the robot and are counted."""

    def close(self) -> None:
        """Releases resources, such as another process."""


_planners: dict[str, Any] = {}


def register_planner(name: str, make: Any) -> None:
    """Makes a planner available to `[planner] type` and `gloam bench nav`. `make(**options)` returns a Planner."""
    if name in _planners:
        raise ValueError(f"there is already a planner '{name}'")
    _planners[name] = make


def planner_names() -> list[str]:
    """Names of all planners."""
    return sorted(_planners)


def make_planner(name: str, **options: Any) -> Planner:
    """Creates a planner. Errors: gloam.NotFoundError with the nearest name; TypeError for an unknown option."""
    import difflib

    import gloam

    if name not in _planners:
        near = difflib.get_close_matches(name, _planners, 1)
        hint = f"did you mean '{near[0]}'?" if near else ""
        raise gloam.NotFoundError(f"there is no planner '{name}'; there are: {', '.join(planner_names())}", hint=hint)
    planner: Planner = _planners[name](**options)
    return planner
