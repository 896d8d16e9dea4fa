"""The waypoint follower against results by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from gloam.navigation import Velocity, WaypointFollower, Waypoints

FOLLOWER = WaypointFollower(rate=4.0, top_speed=0.4, top_yaw_rate=0.8)
FREE = WaypointFollower(rate=4.0, top_speed=100.0, top_yaw_rate=100.0)


@pytest.mark.parametrize(
    ("waypoint", "vx", "yaw_rate"),
    [
        ((0.05, 0.0), 0.2, 0.0),
        ((0.1, 0.1), 0.4, math.pi),
        ((0.1, -0.05), 0.4, -4 * math.atan(0.5)),
        ((0.0, 0.2), 0.0, 2 * math.pi),  # a quarter of a turn in 0.25 s
        ((0.0, -0.2), 0.0, -2 * math.pi),
        ((0.0, 0.0), 0.0, 0.0),
        ((-0.1, 0.1), 0.0, -math.pi),  # behind: the published rule turns to the other side and never drives back
        ((0.0, 0.0, 0.0, 1.0), 0.0, 2 * math.pi),  # a heading counts only on the spot
        ((0.0, 0.0, 1.0, -1.0), 0.0, -math.pi),
        ((0.0, 0.0, -1.0, 0.0), 0.0, -4 * math.pi),
        ((0.05, 0.0, 0.0, 1.0), 0.2, 0.0),
        ((0.0, 1e-6, 1.0, 0.0), 0.0, 2 * math.pi),
        ((9e-9, -9e-9, 0.6, 0.8), 0.0, 4 * math.atan2(0.8, 0.6)),
    ],
)
def test_published_rules(waypoint: tuple[float, ...], vx: float, yaw_rate: float) -> None:
    velocity = FREE.follow(waypoint)
    assert velocity.vx == pytest.approx(vx, abs=1e-12) and velocity.yaw_rate == pytest.approx(yaw_rate, abs=1e-12)
    assert velocity.vy == 0


def test_limits() -> None:
    assert FOLLOWER.follow((1.0, 0.0)) == Velocity(0.4, 0.0, 0.0)
    assert FOLLOWER.follow((1.0, 1.0)) == Velocity(0.4, 0.0, 0.8)
    assert FOLLOWER.follow((1.0, -1.0)) == Velocity(0.4, 0.0, -0.8)
    assert FOLLOWER.follow((-1.0, 0.0)) == Velocity(0.0, 0.0, 0.0)


def test_drives_to_the_chosen_waypoint() -> None:
    points = np.array([[0.01, 0, 1, 0], [0.02, 0, 1, 0], [0.05, 0.01, 1, 0]])
    assert FOLLOWER.drive(Waypoints(points)) == FOLLOWER.follow(points[2])
    assert FOLLOWER.drive(Waypoints(points[:, :2], 0)) == Velocity(0.04, 0.0, 0.0)
    for wrong in (Waypoints(points, 3), Waypoints(points, -1), Waypoints(points[0])):
        with pytest.raises(ValueError, match="is not among"):
            FOLLOWER.drive(wrong)


@pytest.mark.parametrize("waypoint", [(), (1.0,), (1.0, 2.0, 3.0), (math.nan, 0.0), (0.0, math.inf), (1, 0, math.nan, 0)])
def test_refuses_other_waypoints(waypoint: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="2 or 4 finite numbers"):
        FOLLOWER.follow(waypoint)


@pytest.mark.parametrize("limits", [{"rate": 0.0}, {"top_speed": -1.0}, {"top_yaw_rate": math.nan}])
def test_refuses_limits(limits: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="above 0"):
        WaypointFollower(**limits)
