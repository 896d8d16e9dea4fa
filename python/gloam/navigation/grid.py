"""Paths on a grid of free and blocked cells: A* with a cost near obstacles."""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from .planner import Array

Point = tuple[float, float]
_STEPS = [(dy, dx, math.hypot(dy, dx)) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]


class Grid:
    """Cells of side `cell` [m]; origin: (x, y) of the middle of cell [0, 0] [m]; blocked: (rows along y, columns
    along x)."""

    def __init__(self, origin: Point, cell: float, blocked: NDArray[np.bool_]) -> None:
        self.origin, self.cell, self.blocked = origin, cell, blocked

    def index(self, point: Point) -> tuple[int, int]:
        """Row and column of the cell that holds the point, moved into the grid."""
        rows, columns = self.blocked.shape
        column = round((point[0] - self.origin[0]) / self.cell)
        row = round((point[1] - self.origin[1]) / self.cell)
        return min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)

    def middle(self, row: int, column: int) -> Point:
        """(x, y) of the middle of a cell [m]."""
        return self.origin[0] + self.cell * column, self.origin[1] + self.cell * row

    def clearance(self, most: float) -> Array:
        """Distance of each cell to the nearest blocked one, at most `most` [m]; chessboard steps, so up to 30 % short."""
        distance = np.where(self.blocked, 0.0, most)
        near = self.blocked
        for k in range(1, math.ceil(most / self.cell)):
            padded = np.pad(near, 1)
            rows, columns = near.shape
            near = np.logical_or.reduce([padded[1 + dy : 1 + dy + rows, 1 + dx : 1 + dx + columns] for dy, dx, _ in _STEPS] + [near])
            distance = np.where(near & (distance > k * self.cell), k * self.cell, distance)
        return distance

    def path(self, start: Point, goal: Point, cost: Array | None = None) -> list[Point]:
        """Middles of the cells of the cheapest path from start to goal [m], or [] if there is none.

        cost: (rows, columns), >= 0, added to each metre of the path. Blocked cells at the start are left, because a
        robot may touch an obstacle.
        """
        begin, end = self.index(start), self.index(goal)
        weights = 1.0 + (np.zeros(self.blocked.shape) if cost is None else cost)
        best = {begin: 0.0}
        before: dict[tuple[int, int], tuple[int, int]] = {}
        heap = [(0.0, begin)]
        done: set[tuple[int, int]] = set()
        while heap:
            _, here = heapq.heappop(heap)
            if here == end:
                return self._walk_back(before, here)
            if here in done:
                continue
            done.add(here)
            self._expand(here, end, weights, best, before, heap)
        return []

    def _expand(
        self,
        here: tuple[int, int],
        end: tuple[int, int],
        weights: Array,
        best: dict[tuple[int, int], float],
        before: dict[tuple[int, int], tuple[int, int]],
        heap: list[tuple[float, tuple[int, int]]],
    ) -> None:
        rows, columns = self.blocked.shape
        leaves = bool(self.blocked[here])
        for dy, dx, length in _STEPS:
            row, column = here[0] + dy, here[1] + dx
            if not (0 <= row < rows and 0 <= column < columns) or (self.blocked[row, column] and not leaves):
                continue
            total = best[here] + length * self.cell * float(weights[row, column]) * (5.0 if self.blocked[row, column] else 1.0)
            if total < best.get((row, column), math.inf):
                best[row, column] = total
                before[row, column] = here
                ahead = self.cell * math.hypot(row - end[0], column - end[1])
                heapq.heappush(heap, (total + ahead, (row, column)))

    def _walk_back(self, before: dict[tuple[int, int], tuple[int, int]], here: tuple[int, int]) -> list[Point]:
        cells = [here]
        while here in before:
            here = before[here]
            cells.append(here)
        return [self.middle(*cell) for cell in reversed(cells)]


def length_of(path: list[Point]) -> float:
    """Length of a path [m]."""
    return sum(math.dist(a, b) for a, b in zip(path, path[1:], strict=False))


def point_ahead(path: list[Point], position: Point, distance: float) -> Point:
    """The point of a path that lies `distance` [m] behind the point nearest to a position, or its end."""
    nearest = min(range(len(path)), key=lambda i: math.dist(path[i], position))
    left = distance
    for a, b in zip(path[nearest:], path[nearest + 1 :], strict=False):
        left -= math.dist(a, b)
        if left <= 0:
            return b
    return path[-1]
