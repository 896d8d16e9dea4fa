"""Paths as lists of points: length, the point ahead of a robot, smoothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from .grid import Grid

Point = tuple[float, float]


def length_of(path: Sequence[Point]) -> float:
    """Length of a path [m]."""
    return sum(math.dist(a, b) for a, b in zip(path, path[1:], strict=False))


def point_ahead(path: Sequence[Point], position: Point, distance: float) -> Point:
    """The point of a path that lies `distance` [m] behind the point nearest to a position, or its end."""
    nearest = min(range(len(path)), key=lambda i: math.dist(path[i], position))
    left = distance
    for a, b in zip(path[nearest:], path[nearest + 1 :], strict=False):
        left -= math.dist(a, b)
        if left <= 0:
            return b
    return path[-1]


def smoothed(path: ArrayLike, passes: int = 12, within: Grid | None = None) -> list[Point]:
    """A path (n, 2) [m] without the corners of a grid: its ends stay, and so do points that would leave the free cells of
    `within`. Each pass replaces a point by 1/4, 1/2, 1/4 of its neighbours and itself."""
    points = np.array(path, dtype=np.float64)
    for _ in range(passes):
        moved = 0.25 * points[:-2] + 0.5 * points[1:-1] + 0.25 * points[2:]
        if within is not None:
            moved = np.where(within.are_free(moved)[:, None], moved, points[1:-1])
        points[1:-1] = moved
    return [(float(x), float(y)) for x, y in points]
