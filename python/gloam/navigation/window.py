"""The dynamic window approach: of the velocities that a robot can have, the one whose arc serves best.

Fox, Burgard and Thrun, "The Dynamic Window Approach to Collision Avoidance", IEEE RAM 1997. The window here is that of a
robot that reaches a velocity within a control period, so it holds all velocities up to the limits.
"""

from __future__ import annotations

import math

import numpy as np

from .local import LocalOptions, Obstacles
from .planner import Array, Velocity


class DynamicWindow:
    """Chooses velocities. Arcs are computed once: (n velocities, m instants, 2) [m] in the robot's frame."""

    def __init__(self, options: LocalOptions) -> None:
        self._options = options
        speeds = np.concatenate([[-0.3 * options.top_speed], np.linspace(0.0, options.top_speed, 6)])
        turns = np.linspace(-options.top_yaw_rate, options.top_yaw_rate, 15)
        self._velocities = np.array([(v, w) for v in speeds for w in turns])
        times = np.linspace(0.2, options.horizon, 8)
        v, w = self._velocities[:, :1], self._velocities[:, 1:]
        angle = w * times
        safe = np.where(np.abs(w) < 1e-6, 1.0, w)
        x = np.where(np.abs(w) < 1e-6, v * times, v / safe * np.sin(angle))
        y = np.where(np.abs(w) < 1e-6, 0.0, v / safe * (1 - np.cos(angle)))
        self._arcs: Array = np.stack([x, y], axis=-1)
        self._headings: Array = angle[:, -1]

    def choose(self, target: tuple[float, float], obstacles: Array) -> Velocity:
        """The velocity towards a target (x, y) around obstacles (n, 2), both in the robot's frame [m].

        If every arc meets an obstacle, the robot turns in place towards the target. It drives backwards only to get free.
        """
        options = self._options
        ends = self._arcs[:, -1]
        left = np.hypot(target[0] - ends[:, 0], target[1] - ends[:, 1])
        bearing = np.arctan2(target[1] - ends[:, 1], target[0] - ends[:, 0]) - self._headings
        off = np.abs((bearing + math.pi) % (2 * math.pi) - math.pi)
        cost = left + 0.25 * off + np.where(self._velocities[:, 0] < 0, 0.3, 0.0)
        near = Obstacles(obstacles, options)
        distances = near.distances(self._arcs).min(axis=1)
        turns_only = self._velocities[:, 0] == 0
        cost = cost + 0.6 * near.nearness(distances) ** 2 + np.where(near.hits(distances) & ~turns_only, 1e3, 0.0)
        v, w = self._velocities[int(np.argmin(cost))]
        return Velocity(vx=float(v), yaw_rate=float(w))
