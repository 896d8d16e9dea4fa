"""Routes on the plan of a generated place, and the point of a route that a robot drives towards."""

from __future__ import annotations

import numpy as np
from gloam.navigation.grid import Grid
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]


def nearest_free(space: Grid, point: ArrayLike) -> Points:
    """The middle of the free cell nearest to (x, y) [m]."""
    cells = space.middles(~space.blocked)
    return np.asarray(cells[np.argmin(np.linalg.norm(cells - np.asarray(point)[:2], axis=1))])


def shortest(space: Grid, start: ArrayLike, goal: ArrayLike) -> Points:
    """The shortest way over the grid from one (x, y) to another, (n, 2) [m]: downhill in the distance to the goal."""
    field = np.pad(space.distances(nearest_free(space, goal)), 1, constant_values=np.inf)
    row, column = space.index(nearest_free(space, start))
    way = [(row, column)]
    while field[row + 1, column + 1] > 0:
        around = field[row : row + 3, column : column + 3] + space.cell * np.hypot(*np.mgrid[-1:2, -1:2])
        around[1, 1] = np.inf
        step = np.unravel_index(np.argmin(around), (3, 3))
        row, column = row + int(step[0]) - 1, column + int(step[1]) - 1
        way.append((row, column))
    return np.asarray(space.origin + space.cell * np.array(way)[:, ::-1])


class Pursuit:
    """Pure pursuit (Coulter 1992): the point of a route that lies `ahead` [m] of the robot."""

    def __init__(self, route: Points, ahead: float) -> None:
        self._route, self._ahead, self._passed = route, ahead, 0

    def target(self, position: ArrayLike) -> Points:
        """(x, y) for a robot at `position` [m]; the end of the route when that is nearer than `ahead`."""
        left = np.linalg.norm(self._route[self._passed : self._passed + 60] - np.asarray(position)[:2], axis=1)
        self._passed += int(np.argmin(left))
        far = np.linalg.norm(self._route[self._passed :] - np.asarray(position)[:2], axis=1) > self._ahead
        return np.asarray(self._route[self._passed + int(np.argmax(far)) if far.any() else -1])


def bearing(pose: object, target: Points) -> float:
    """Angle from a robot's heading to a point, counterclockwise in (-pi, pi] [rad]."""
    dx, dy = target - pose.p[:2]  # type: ignore[attr-defined]
    turn = np.arctan2(dy, dx) - pose.yaw  # type: ignore[attr-defined]
    return float(np.arctan2(np.sin(turn), np.cos(turn)))
