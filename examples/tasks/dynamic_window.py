"""Avoidance of obstacles by choosing among the velocities that a drive can reach."""

from __future__ import annotations

import numpy as np
from route import Points

RADIUS, MARGIN = 0.18, 0.15  # of the base, and kept from everything [m]
SPEED, BACK, TURN = 0.6, 0.3, 1.8  # largest commands [m/s, m/s, rad/s]
NOISE, TREND = 0.07, 1.2  # m between scans that are errors; s for which motions continue
BRAKE, TURN_UP = 0.8, 5.0  # used of the drive's accelerations [m/s², rad/s²]
HORIZON = 2.0  # of prediction [s]


class DynamicWindow:
    """Fox, Burgard and Thrun, "The dynamic window approach to collision avoidance" (1997), among moving points.

    Of the velocities that the drive can reach before the next scan, and from which it can brake before an obstacle, it
    takes the one with the best sum of heading, clearance and speed.
    """

    def __init__(self, interval: float) -> None:
        self._interval = interval  # between scans [s]
        self._last = np.zeros(2)  # v, w
        self._seen: Points | None = None  # the previous scan, in the world

    def velocities(self, points: Points) -> Points:
        """Of points in the world [m/s]: each came from the nearest point of the previous scan, or stands still."""
        seen = self._seen if self._seen is not None else points
        self._seen = points
        moved = points[:, None] - seen[None]
        moved = moved[np.arange(len(points)), np.argmin(np.linalg.norm(moved, axis=2), axis=1)]
        length = np.linalg.norm(moved, axis=1, keepdims=True)
        return np.where((length > NOISE) & (length < 2.0 * self._interval), moved / self._interval, 0.0)

    def choose(self, obstacles: Points, moving: Points, target: Points) -> tuple[float, float]:
        """Speed [m/s] and yaw rate [rad/s] towards `target` among `obstacles` that move, in the base's frame."""
        reach = self._interval * np.array([BRAKE, TURN_UP])
        low = np.maximum(self._last - reach, [-BACK, -TURN])
        high = np.minimum(self._last + reach, [SPEED, TURN])
        v, w = (grid.ravel() for grid in np.meshgrid(np.linspace(low[0], high[0], 7), np.linspace(low[1], high[1], 15)))
        t = np.linspace(0.1, HORIZON, 14)[:, None]
        turned = w * t
        x = v * t * np.sinc(turned / (2 * np.pi)) * np.cos(turned / 2)  # chords of the arcs, (times, candidates)
        y = v * t * np.sinc(turned / (2 * np.pi)) * np.sin(turned / 2)
        there = obstacles + np.minimum(t, TREND)[..., None] * moving  # (times, points, 2)
        gap = np.hypot(x[..., None] - there[:, None, :, 0], y[..., None] - there[:, None, :, 1]).min(axis=2) - RADIUS
        now = np.linalg.norm(obstacles, axis=1).min() - RADIUS
        hits = gap < min(MARGIN, 0.8 * now)
        time_left = np.where(hits.any(axis=0), t[np.argmax(hits, axis=0), 0] - 0.1, np.inf)
        admissible = np.abs(v) <= 2 * BRAKE * np.maximum(time_left - self._interval, 0)
        heading = np.arctan2(target[1] - y[7], target[0] - x[7]) - turned[7]
        score = 0.8 * np.cos(heading) + 0.7 * np.minimum(gap.min(axis=0), 0.6) + 0.8 * v
        best = int(np.argmax(np.where(admissible | (v == 0), score, -np.inf)))
        self._last = np.array([v[best], w[best]])
        if not admissible.any():  # it brakes as hard as it can
            self._last = np.array([low[0], 0.0])
        return float(self._last[0]), float(self._last[1])
