"""Free space on a floor, and lengths of paths around obstacles to a goal."""

from __future__ import annotations

import re
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.navigation.planner import Array

_PLANE, _HFIELD = 0, 1  # mjtGeom
_FLOOR = re.compile(r"/floor_\d+/")  # of generated places


class FreeSpace:
    """A grid of the floor: cells are free where a disc of `radius` fits.

    origin: (x, y) of the middle of cell [0, 0] [m]; cell: their side [m]; blocked: [row along y, column along x].
    Obstacles are approximated by their bounding boxes at the initial state.
    """

    def __init__(self, origin: tuple[float, float], cell: float, blocked: NDArray[np.bool_]) -> None:
        self.origin = np.asarray(origin, dtype=np.float64)
        self.cell = cell
        self.blocked = blocked

    @classmethod
    def of(
        cls,
        world: gloam.World,
        ignore: Collection[int],
        radius: float,
        heights: tuple[float, float] = (0.03, 0.4),
        cell: float = 0.1,
    ) -> FreeSpace:
        """The largest connected free region of a World.

        ignore: bodies that are not obstacles (MuJoCo ids); radius, cell: [m]; heights: geoms entirely below or above
        them are not obstacles [m]. In generated places only the floors are free space. Errors: UsageError if there
        are no walls, or no room between them.
        """
        boxes, floors = _boxes(world, ignore, heights)
        corners = (floors if len(floors) > 0 else boxes).reshape(-1, 2)
        if len(corners) == 0:
            raise gloam.UsageError("the scene has no walls, so the extent of its floor is unknown")
        low, high = corners.min(axis=0), corners.max(axis=0)
        columns, rows = (np.ceil((high - low) / cell).astype(int) + 1).tolist()
        x = low[0] + cell * np.arange(columns)
        y = low[1] + cell * np.arange(rows)
        points = np.stack(np.meshgrid(x, y), axis=-1)
        blocked = np.full((rows, columns), len(floors) > 0)
        for floor in floors:
            blocked &= _distance_to_box(points, floor) > 0.5 * cell
        for box in boxes:
            blocked |= _distance_to_box(points, box) < radius
        space = cls((float(low[0]), float(low[1])), cell, blocked)
        space.keep_largest_region()
        return space

    def keep_largest_region(self) -> None:
        """Blocks all cells outside the largest connected region. Errors: UsageError if no cell is free."""
        left = ~self.blocked
        best = np.zeros_like(left)
        while left.any():
            row, column = np.argwhere(left)[0]
            region = np.isfinite(self.distances(self.origin + self.cell * np.array([column, row])))
            left &= ~region
            if region.sum() > best.sum():
                best = region
        if not best.any():
            raise gloam.UsageError("the scene has no free space")
        self.blocked = ~best

    def index(self, point: Array) -> tuple[int, int]:
        """Row and column of the cell that holds (x, y) [m], moved into the grid."""
        column, row = np.rint((np.asarray(point)[:2] - self.origin) / self.cell).astype(int)
        rows, columns = self.blocked.shape
        return int(np.clip(row, 0, rows - 1)), int(np.clip(column, 0, columns - 1))

    def is_free(self, point: Array) -> bool:
        """Whether (x, y) [m] is inside and free."""
        offset = (np.asarray(point)[:2] - self.origin) / self.cell
        rows, columns = self.blocked.shape
        if (offset < -0.5).any() or offset[0] > columns - 0.5 or offset[1] > rows - 0.5:
            return False
        return not self.blocked[self.index(point)]

    def distances(self, goal: Array) -> Array:
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

    def distance(self, field: Array, point: Array) -> float:
        """Length of the path from (x, y) [m], from the `distances` of a goal over the nearest cells; inf: no path."""
        row, column = self.index(point)
        rows = slice(max(row - 2, 0), row + 3)
        columns = slice(max(column - 2, 0), column + 3)
        x = self.origin[0] + self.cell * np.arange(columns.start, min(columns.stop, field.shape[1]))
        y = self.origin[1] + self.cell * np.arange(rows.start, min(rows.stop, field.shape[0]))
        steps = np.hypot(y[:, None] - float(point[1]), x[None, :] - float(point[0]))
        near: Array = field[rows][:, columns]
        return float((near + steps).min())

    def sample(
        self, rng: np.random.Generator, field: Array | None = None, reach: tuple[float, float] = (0, 0)
    ) -> Array:
        """A free point (x, y) [m]; with `field`, a point whose path to the field's goal is within `reach` [m].

        Errors: UsageError if there is none.
        """
        usable = ~self.blocked
        if field is not None:
            usable = usable & (field >= reach[0]) & (field <= reach[1])
        cells = np.argwhere(usable)
        if len(cells) == 0:
            raise gloam.UsageError(f"there is no free place {reach[0]} to {reach[1]} m from the goal")
        row, column = cells[rng.integers(len(cells))]
        return self.origin + self.cell * np.array([column, row], dtype=np.float64)


def robot_bodies(world: gloam.World, robot: str) -> list[int]:
    """MuJoCo ids of a robot's bodies, whose names begin with its name."""
    return [i for i, name in enumerate(world.bodies) if name.startswith(f"{robot}/")]


def _boxes(world: gloam.World, ignore: Collection[int], heights: tuple[float, float]) -> tuple[Array, Array]:
    """Outlines of all obstacles and of all floors seen from above, (n, 4 corners in order, 2) each [m]."""
    with gloam.Simulation(world) as sim:
        sim.step()
        fields = ("geom_type", "geom_contype", "geom_conaffinity", "geom_bodyid", "geom_aabb", "geom_xpos", "geom_xmat")
        kind, contype, affinity, body, aabb, position, rotation = (np.array(sim.memory.array(name)) for name in fields)
    signs = np.array([[i, j, k] for k in (-1, 1) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    boxes, floors = [], []
    for geom, name in enumerate(world.info["geoms"]):
        if kind[geom] in (_PLANE, _HFIELD) or int(body[geom]) in ignore:
            continue
        local = aabb[geom, :3] + signs * aabb[geom, 3:]
        corners = position[geom] + local @ rotation[geom].reshape(3, 3).T
        if _FLOOR.search(name):
            floors.append(_outline(corners))
        is_solid = bool(contype[geom] or affinity[geom])
        if is_solid and corners[:, 2].max() > heights[0] and corners[:, 2].min() < heights[1]:
            boxes.append(_outline(corners))
    return np.array(boxes).reshape(-1, 4, 2), np.array(floors).reshape(-1, 4, 2)


def _outline(corners: Array) -> Array:
    """The four corners of a box seen from above: of its base if it is upright, else of its bounding box."""
    base, top = corners[:4, :2], corners[4:, :2]
    if np.allclose(base, top, atol=1e-6):
        return base
    (x0, y0), (x1, y1) = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def _distance_to_box(points: Array, box: Array) -> Array:
    """Distance of points (…, 2) from a rectangle with the corners (4, 2) in order; 0 inside [m]."""
    middle = box.mean(axis=0)
    sides = np.array([box[1] - box[0], box[3] - box[0]])
    lengths = np.linalg.norm(sides, axis=1)
    axes = np.where(lengths[:, None] > 1e-9, sides / np.maximum(lengths, 1e-9)[:, None], 0.0)
    beyond = np.maximum(np.abs((points - middle) @ axes.T) - lengths / 2, 0.0)
    return np.asarray(np.linalg.norm(beyond, axis=-1))
