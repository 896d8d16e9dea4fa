"""Grids of free and blocked cells on a floor: clearance, distances to a goal, and A* with a cost near obstacles."""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

import gloam

from .paths import Point
from .planner import Array

_STEPS = [(dy, dx, math.hypot(dy, dx)) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
_Cell = tuple[int, int]


class Grid:
    """Cells of side `cell` [m]; origin: (x, y) of the middle of cell [0, 0] [m]; blocked: (rows along y, columns
    along x)."""

    def __init__(self, origin: ArrayLike, cell: float, blocked: NDArray[np.bool_]) -> None:
        self.origin: Array = np.asarray(origin, dtype=np.float64)
        self.cell = cell
        self.blocked = blocked

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top of the outer cells [m], as matplotlib's imshow() takes them."""
        (x, y), (rows, columns) = (self.origin - 0.5 * self.cell).tolist(), self.blocked.shape
        return x, x + columns * self.cell, y, y + rows * self.cell

    def index(self, point: ArrayLike) -> _Cell:
        """Row and column of the cell that holds (x, y) [m], moved into the grid."""
        column, row = np.rint(self._offsets(point)).astype(int)
        rows, columns = self.blocked.shape
        return int(np.clip(row, 0, rows - 1)), int(np.clip(column, 0, columns - 1))

    def middles(self, where: NDArray[np.bool_]) -> Array:
        """(x, y) of the middles of the cells where a mask of the grid's shape is true, row by row, (n, 2) [m]."""
        row, column = np.nonzero(where)
        return self.origin + self.cell * np.stack([column, row], axis=-1)

    def is_free(self, point: ArrayLike) -> bool:
        """Whether (x, y) [m] is inside and free."""
        return bool(self.are_free(np.asarray(point)[None]).all())

    def are_free(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether points (n, 2) [m] are inside and free, (n,)."""
        offsets = self._offsets(points)
        last = np.array(self.blocked.shape[::-1]) - 1
        inside = (offsets >= -0.5).all(axis=1) & (offsets <= last + 0.5).all(axis=1)
        column, row = np.clip(np.rint(offsets).astype(int), 0, last).T
        return np.asarray(inside & ~self.blocked[row, column])

    def _offsets(self, points: ArrayLike) -> Array:
        """Columns and rows of points, with fractions."""
        return np.asarray((np.asarray(points, dtype=np.float64)[..., :2] - self.origin) / self.cell)

    def keep_largest_region(self) -> None:
        """Blocks all cells outside the largest connected region. Errors: UsageError if no cell is free."""
        left = ~self.blocked
        best = np.zeros_like(left)
        while left.any():
            row, column = np.argwhere(left)[0].tolist()
            region = self._region(row, column)
            left &= ~region
            if region.sum() > best.sum():
                best = region
        if not best.any():
            raise gloam.UsageError("the scene has no free space")
        self.blocked = ~best

    def _region(self, row: int, column: int) -> NDArray[np.bool_]:
        """The free cells that are connected with a free cell."""
        rows, columns = self.blocked.shape
        region = np.zeros((rows, columns), bool)
        region[row, column] = True
        while True:
            padded = np.pad(region, 1)
            grown = np.logical_or.reduce([padded[1 + dy : 1 + dy + rows, 1 + dx : 1 + dx + columns] for dy, dx, _ in _STEPS])
            grown = (grown | region) & ~self.blocked
            if np.array_equal(grown, region):
                return region
            region = grown

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

    def wall_cost(self, reach: float, most: float) -> Array:
        """Cost of a metre for path(): `most` at obstacles, less with the square of the way to 0 at `reach` [m]."""
        return most * (1.0 - self.clearance(reach) / reach) ** 2

    def distances(self, goal: ArrayLike) -> Array:
        """Length of the path from the middle of each cell to (x, y) [m], over the grid's 8 neighbours; inf: no path.

        At most 8 % longer than the shortest path, as in all such grids.
        """
        field: Array = np.full(self.blocked.shape, np.inf)
        field[self.index(goal)] = 0.0
        free = ~self.blocked
        while True:
            padded: Array = np.pad(field, 1, constant_values=np.inf)
            best: Array = field
            for dy in (0, 1, 2):
                for dx in (0, 1, 2):
                    length = self.cell * np.hypot(dy - 1, dx - 1)
                    best = np.minimum(best, padded[dy : dy + field.shape[0], dx : dx + field.shape[1]] + length)
            best = np.where(free, best, field)
            if np.array_equal(best, field):
                return field
            field = best

    def distance(self, field: Array, point: ArrayLike) -> float:
        """Length of the path from (x, y) [m], from the `distances` of a goal over the nearest cells; inf: no path."""
        x, y = np.asarray(point, dtype=np.float64)[:2]
        row, column = self.index(point)
        rows = slice(max(row - 2, 0), row + 3)
        columns = slice(max(column - 2, 0), column + 3)
        across = self.origin[0] + self.cell * np.arange(columns.start, min(columns.stop, field.shape[1]))
        along = self.origin[1] + self.cell * np.arange(rows.start, min(rows.stop, field.shape[0]))
        steps = np.hypot(along[:, None] - y, across[None, :] - x)
        near: Array = field[rows][:, columns]
        return float((near + steps).min())

    def sample(self, rng: np.random.Generator, field: Array | None = None, reach: tuple[float, float] = (0, 0)) -> Array:
        """A free point (x, y) [m]; with `field`, a point whose path to the field's goal is within `reach` [m].

        Errors: UsageError if there is none.
        """
        usable = ~self.blocked
        if field is not None:
            usable = usable & (field >= reach[0]) & (field <= reach[1])
        points = self.middles(usable)
        if len(points) == 0:
            raise gloam.UsageError(f"no free place lies {reach[0]} to {reach[1]} m from the goal")
        point: Array = points[rng.integers(len(points))]
        return point

    def path(self, start: ArrayLike, goal: ArrayLike, cost: Array | None = None) -> list[Point]:
        """Middles of the cells of the cheapest path from start to goal [m], or [] if there is none.

        cost: (rows, columns), >= 0, added to each metre of the path. Blocked cells at the start are left, because a
        robot may touch an obstacle.
        """
        begin, end = self.index(start), self.index(goal)
        weights = 1.0 + (np.zeros(self.blocked.shape) if cost is None else cost)
        best = {begin: 0.0}
        before: dict[_Cell, _Cell] = {}
        heap = [(0.0, begin)]
        done: set[_Cell] = set()
        while heap:
            _, here = heapq.heappop(heap)
            if here == end:
                return self._walk_back(before, here)
            if here in done:
                continue
            done.add(here)
            for there, length in self._neighbours(here, weights):
                total = best[here] + length
                if total < best.get(there, math.inf):
                    best[there], before[there] = total, here
                    ahead = self.cell * math.hypot(there[0] - end[0], there[1] - end[1])
                    heapq.heappush(heap, (total + ahead, there))
        return []

    def _neighbours(self, here: _Cell, weights: Array) -> list[tuple[_Cell, float]]:
        """Cells that can be reached in a step, and the cost of each step. Only a blocked cell leads to blocked ones."""
        rows, columns = self.blocked.shape
        leaves = bool(self.blocked[here])
        found = []
        for dy, dx, length in _STEPS:
            row, column = here[0] + dy, here[1] + dx
            if not (0 <= row < rows and 0 <= column < columns) or (self.blocked[row, column] and not leaves):
                continue
            penalty = 5.0 if self.blocked[row, column] else 1.0
            found.append(((row, column), length * self.cell * float(weights[row, column]) * penalty))
        return found

    def _walk_back(self, before: dict[_Cell, _Cell], here: _Cell) -> list[Point]:
        cells = [here]
        while here in before:
            here = before[here]
            cells.append(here)
        x, y = (float(value) for value in self.origin)
        return [(x + self.cell * column, y + self.cell * row) for row, column in reversed(cells)]
