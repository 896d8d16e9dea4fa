"""Free space on the floor of a World."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

import numpy as np

import gloam

from .grid import Grid
from .ground import Ground
from .planner import Array

_PLANE, _HFIELD = 0, 1  # mjtGeom
_FLOOR = re.compile(r"/floor_\d+/")  # of generated places


def free_space(
    world: gloam.World,
    ignore: Collection[int],
    radius: float,
    heights: tuple[float, float] = (0.03, 0.4),
    cell: float = 0.1,
) -> Grid:
    """The largest connected free region of a World at its initial state: cells are free where a disc of `radius` fits.

    ignore: bodies that are not obstacles (MuJoCo ids); radius, cell: [m]; heights: geoms entirely below or above them
    are not obstacles [m]. Obstacles are approximated by their bounding boxes. In generated places only the floors are
    free space; on the ground of a terrain, heights are above it, and Ground.is_hard() blocks slopes and water.
    Errors: UsageError if there are no walls, or no room between them.
    """
    ground = None if any(_FLOOR.search(name) for name in world.info.geoms) else Ground.of(world)
    boxes, floors = _boxes(world, ignore, heights, ground)
    corners = ground.corners if ground else (floors if len(floors) > 0 else boxes).reshape(-1, 2)
    if len(corners) == 0:
        raise gloam.UsageError("the scene has no walls, so the extent of its floor is unknown")
    low, high = corners.min(axis=0), corners.max(axis=0)
    columns, rows = (np.ceil((high - low) / cell).astype(int) + 1).tolist()
    x = low[0] + cell * np.arange(columns)
    y = low[1] + cell * np.arange(rows)
    points = np.stack(np.meshgrid(x, y), axis=-1)
    blocked = np.full((rows, columns), len(floors) > 0)
    if ground is not None:
        blocked |= ground.is_hard(points)
    for floor in floors:
        blocked &= _distance_to_box(points, floor) > 0.5 * cell
    for box in boxes:
        blocked |= _distance_to_box(points, box) < radius
    grid = Grid(low, cell, blocked)
    grid.keep_largest_region()
    return grid


def shared_space(grids: Sequence[Grid]) -> Grid:
    """The largest region that is free in each of several grids of one floor, such as under all levels of adversity.

    Errors: UsageError if the grids differ in origin, cell or shape, or share no free cell.
    """
    first = grids[0]
    for grid in grids[1:]:
        if grid.cell != first.cell or grid.blocked.shape != first.blocked.shape or not np.allclose(grid.origin, first.origin):
            raise gloam.UsageError("the floors differ")
    shared = Grid(first.origin, first.cell, np.logical_or.reduce([grid.blocked for grid in grids]))
    shared.keep_largest_region()
    return shared


def robot_bodies(world: gloam.World, robot: str) -> list[int]:
    """MuJoCo ids of a robot's bodies, whose names begin with its name."""
    return [i for i, name in enumerate(world.bodies) if name.startswith(f"{robot}/")]


def _boxes(
    world: gloam.World, ignore: Collection[int], heights: tuple[float, float], ground: Ground | None
) -> tuple[Array, Array]:
    """Outlines of all obstacles and of all floors seen from above, (n, 4 corners in order, 2) each [m]."""
    with gloam.Simulation(world) as sim:
        sim.step()
        fields = ("geom_type", "geom_contype", "geom_conaffinity", "geom_bodyid", "geom_aabb", "geom_xpos", "geom_xmat")
        kind, contype, affinity, body, aabb, position, rotation = (np.array(sim.memory.array(name)) for name in fields)
    signs = np.array([[i, j, k] for k in (-1, 1) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    boxes, floors = [], []
    for geom, name in enumerate(world.info.geoms):
        if kind[geom] in (_PLANE, _HFIELD) or int(body[geom]) in ignore:
            continue
        local = aabb[geom, :3] + signs * aabb[geom, 3:]
        corners = position[geom] + local @ rotation[geom].reshape(3, 3).T
        if _FLOOR.search(name):
            floors.append(_outline(corners))
        is_solid = bool(contype[geom] or affinity[geom])
        base = float(ground.height(corners[:, :2].mean(axis=0))) if ground else 0.0
        if is_solid and corners[:, 2].max() > base + heights[0] and corners[:, 2].min() < base + heights[1]:
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
