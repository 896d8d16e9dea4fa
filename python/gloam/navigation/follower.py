"""The waypoint follower of the GNM family: from a waypoint to a velocity (robodhruv/visualnav-transformer,
deployment/src/pd_controller.py, and the limits of deployment/config/robot.yaml)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .planner import Velocity, Waypoints

_NEAR = 1e-8  # [m]; the publication's EPS


@dataclass(frozen=True)
class WaypointFollower:
    """Drives so that the robot reaches a waypoint within one period of the planner, up to its limits.

    rate: of the planner [Hz]; top_speed [m/s]; top_yaw_rate [rad/s]. Defaults are the publication's faster pair of
    limits (it proposes 0.2 m/s and 0.4 rad/s for a first try). Errors: ValueError unless all are above 0.

    The rules, for a waypoint (x, y) or (x, y, cos, sin) in the robot's frame, with T = 1 / rate:

    - x and y both below 1e-8 m, with a heading: turn on the spot by the heading within T;
    - x below 1e-8 m: turn on the spot at ± pi / (2 T), to the side of y; stand still if y is 0;
    - otherwise vx = x / T, yaw rate = atan(y / x) / T.

    vx is clipped to 0 … top_speed, the yaw rate to ± top_yaw_rate. The robot never drives backwards; for a waypoint behind
    it, atan(y / x) turns it to the side opposite to the waypoint. This is a property of the published rule, which is kept
    so that results compare.
    """

    rate: float = 4.0
    top_speed: float = 0.4
    top_yaw_rate: float = 0.8

    def __post_init__(self) -> None:
        for name in ("rate", "top_speed", "top_yaw_rate"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{name} must be finite and above 0, got {value}")

    def follow(self, waypoint: ArrayLike) -> Velocity:
        """The velocity for a waypoint of 2 or 4 finite numbers. Errors: ValueError."""
        numbers = np.asarray(waypoint, np.float64)
        if numbers.shape not in ((2,), (4,)) or not np.isfinite(numbers).all():
            raise ValueError(f"a waypoint must be 2 or 4 finite numbers, got {waypoint!r}")
        x, y = float(numbers[0]), float(numbers[1])
        speed = 0.0
        if len(numbers) == 4 and abs(x) < _NEAR and abs(y) < _NEAR:
            angle = _wrapped(math.atan2(numbers[3], numbers[2]))
        elif abs(x) < _NEAR:
            angle = math.copysign(math.pi / 2, y) if y != 0 else 0.0
        else:
            speed = x * self.rate
            angle = math.atan(y / x)
        return Velocity(
            vx=min(max(speed, 0.0), self.top_speed),
            yaw_rate=min(max(angle * self.rate, -self.top_yaw_rate), self.top_yaw_rate),
        )

    def drive(self, waypoints: Waypoints) -> Velocity:
        """The velocity for the chosen one of several waypoints. Errors: ValueError for a wrong shape or index."""
        points = np.asarray(waypoints.points, np.float64)
        if points.ndim != 2 or not 0 <= waypoints.chosen < len(points):
            raise ValueError(f"waypoint {waypoints.chosen} is not among waypoints of shape {points.shape}")
        return self.follow(points[waypoints.chosen])


def _wrapped(angle: float) -> float:
    """Within -pi … pi, where pi itself becomes -pi."""
    angle %= 2 * math.pi
    return angle if angle < math.pi else angle - 2 * math.pi
