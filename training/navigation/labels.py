"""Labels of goal-image navigation: waypoints that lead back to a path, and distances along it.

Units: lengths in metres, angles in radians; waypoints in steps of SPACING, in the robot's frame (x ahead, y left).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SPACING = 0.1  # [m] one step: the planner's top speed 0.4 m/s over its rate of 4 Hz
WAYPOINTS = 5
MAX_STEPS = 20  # distances are clipped to it [steps]
LOOKAHEAD = 0.5  # of the pursuit [m]
MAX_TURN = 0.25  # per step [rad]: a yaw rate of 1 rad/s at 4 Hz
_SLOWEST = 0.05  # share of a step that is made while the robot turns towards a path behind it


@dataclass(frozen=True)
class Path:
    """A polyline (n, 2) [m] with at least two different points; it goes on straight beyond its last point."""

    points: Array

    def __post_init__(self) -> None:
        points = np.asarray(self.points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
            raise ValueError(f"a path needs (n, 2) points with n >= 2, not {points.shape}")
        if not np.isfinite(points).all() or (np.linalg.norm(np.diff(points, axis=0), axis=1) < 1e-9).any():
            raise ValueError("a path needs finite points, each different from the one before")
        object.__setattr__(self, "points", points)

    @cached_property
    def arc(self) -> Array:
        """Length of the path up to each of its points, (n,) [m]."""
        return np.asarray(np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(self.points, axis=0), axis=1))]))

    @property
    def length(self) -> float:
        """[m]"""
        return float(self.arc[-1])

    def at(self, along: Array | float) -> Array:
        """Points (…, 2) at lengths along the path [m]; straight on beyond its end, the first point before its start."""
        along, arc = np.asarray(along, dtype=np.float64), self.arc
        inside = np.stack([np.interp(along, arc, self.points[:, k]) for k in range(2)], axis=-1)
        end = self.points[-1] - self.points[-2]
        return np.asarray(inside + np.maximum(along - arc[-1], 0.0)[..., None] * end / np.linalg.norm(end))

    def heading(self, along: Array | float) -> Array:
        """Direction of the path over 0.1 m about a length along it [rad]."""
        along = np.maximum(np.asarray(along, dtype=np.float64), 0.05)
        ahead = self.at(along + 0.05) - self.at(along - 0.05)
        return np.arctan2(ahead[..., 1], ahead[..., 0])

    def nearest(self, point: Array, near: float | None = None, window: float = 1.0) -> float:
        """Length along the path of its point nearest to (x, y) [m].

        near: a length within `window` of which the answer lies, so that it does not jump where a path crosses itself.
        """
        start, ends, arc = self.points[:-1], self.points[1:], self.arc
        side = ends - start
        share = ((point - start) * side).sum(1) / (side * side).sum(1)
        share[:-1] = np.minimum(share[:-1], 1.0)  # the last piece has no end
        share = np.maximum(share, 0.0)
        gap = np.linalg.norm(start + share[:, None] * side - point, axis=1)
        along: Array = arc[:-1] + share * np.diff(arc)
        if near is not None:
            gap = np.where(np.abs(along - near) <= window, gap, np.inf)
        return float(along[np.argmin(gap)])


def wrap(angle: Array | float) -> Array:
    """The same angle in -pi … pi [rad]."""
    return np.asarray((np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi)


def waypoints(path: Path, pose: Array, along: float) -> Array:
    """The next WAYPOINTS places (x, y, cos, sin) of a robot that returns to the path, (5, 4).

    pose: (x, y, yaw) in the world; along: its progress on the path [m]. x and y are cumulative, in units of SPACING and
    in the frame of `pose`; cos and sin are of the heading relative to it. The motion is a pure pursuit (Coulter 1992)
    of the point LOOKAHEAD ahead: it follows straight lines and circles exactly. The robot turns by at most MAX_TURN
    per step and slows down while the point is aside.
    """
    x, y, yaw = (float(value) for value in pose)
    origin, start = np.array([x, y]), yaw
    place, answer = origin.copy(), np.empty((WAYPOINTS, 4))
    for row in range(WAYPOINTS):
        along = path.nearest(place, along)
        target = path.at(along + LOOKAHEAD) - place
        bearing = float(wrap(np.arctan2(target[1], target[0]) - yaw))
        if abs(bearing) > np.pi / 4:
            step, turn = SPACING * max(np.cos(bearing), _SLOWEST), float(np.sign(bearing)) * MAX_TURN
        else:
            curvature = 2.0 * np.sin(bearing) / max(float(np.linalg.norm(target)), 0.1)
            step, turn = SPACING, float(np.clip(curvature * SPACING, -MAX_TURN, MAX_TURN))
        # The chord of the arc; its direction is that of the heading in the middle of the step.
        chord = step * (np.sin(turn / 2) / (turn / 2) if abs(turn) > 1e-9 else 1.0)
        place = place + chord * np.array([np.cos(yaw + turn / 2), np.sin(yaw + turn / 2)])
        yaw += turn
        ahead = _rotated(place - origin, -start) / SPACING
        answer[row] = (*ahead, np.cos(yaw - start), np.sin(yaw - start))
    return answer


def distance_steps(along: Array | float, goal: Array | float) -> Array:
    """Steps from a progress to a goal on the same path, 0 … MAX_STEPS."""
    return np.asarray(np.clip((np.asarray(goal) - np.asarray(along)) / SPACING, 0.0, MAX_STEPS))


def _rotated(vector: Array, angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]])
