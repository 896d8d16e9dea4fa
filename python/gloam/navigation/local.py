"""Parts of local planners, which choose velocities towards a point among obstacles: limits, obstacles near the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .planner import Array, Velocity


@dataclass(frozen=True)
class LocalOptions:
    """top_speed [m/s], top_yaw_rate [rad/s]: limits; horizon: time to look ahead [s]; radius: of the robot [m]; margin:
    distance beyond it at which obstacles cost nothing [m]."""

    top_speed: float = 0.4
    top_yaw_rate: float = 1.0
    horizon: float = 1.6
    radius: float = 0.28
    margin: float = 0.25


class LocalPlanner(Protocol):
    """Chooses velocities. Calls may depend on the calls before."""

    def choose(self, target: tuple[float, float], obstacles: Array) -> Velocity:
        """The velocity towards a target (x, y) around obstacles (n, 2), both in the robot's frame [m]."""
        ...


class Obstacles:
    """Points (n, 2) in the robot's frame [m]. Those beyond the horizon are left out."""

    def __init__(self, points: Array, options: LocalOptions) -> None:
        self._options = options
        away = np.hypot(points[:, 0], points[:, 1])
        reach = options.top_speed * options.horizon + options.radius + options.margin
        self._points = points[away < reach]
        self._least = min(options.radius, float(away.min(initial=np.inf)) - 0.02)  # a robot that is too close may leave

    def distances(self, places: Array) -> Array:
        """Distances of places (…, 2) to the nearest point, (…) [m]; inf if there is none."""
        # Not as a product of matrices, whose bits may depend on the number of threads.
        x = places[..., None, 0] - self._points[:, 0]
        y = places[..., None, 1] - self._points[:, 1]
        return np.asarray(np.sqrt((x * x + y * y).min(axis=-1, initial=np.inf)))

    def nearness(self, distances: Array) -> Array:
        """From 0 at the margin to 1 at the robot's radius."""
        options = self._options
        return np.clip((options.radius + options.margin - distances) / options.margin, 0.0, 1.0)

    def hits(self, distances: Array) -> NDArray[np.bool_]:
        """Whether a robot at such distances touches an obstacle."""
        return np.asarray(distances < self._least)
