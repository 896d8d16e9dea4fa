"""Uneven ground: the height field of a generated terrain."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import gloam

from .planner import Array

STEEPEST = math.radians(20)  # slopes that a quadruped is expected to climb
DEEPEST = 0.1  # water that it is expected to wade through [m]
_BASE = 0.4  # length over which slopes are measured [m], of a quadruped: ruts and bumps are shorter
_HFIELD = 1  # mjtGeom
_WATER = re.compile(r"(^|/)water_\d+/")  # of generated places


@dataclass(frozen=True)
class Ground:
    """low, high: corners (x, y) [m]; heights: (rows along y, columns along x) of samples from low to high [m]; water: boxes
    (low x, y, high x, y, z of the surface) of ponds, (n, 5) [m]."""

    low: Array
    high: Array
    heights: Array
    water: Array

    @classmethod
    def of(cls, world: gloam.World) -> Ground | None:
        """The first height field of a World, or None. Errors: UsageError if it is turned."""
        with gloam.Simulation(world) as sim:
            sim.step()  # which computes places
            geoms = np.flatnonzero(np.asarray(sim.memory.array("geom_type")) == _HFIELD)
            return cls._of_geom(sim, int(geoms[0])) if len(geoms) > 0 else None

    @classmethod
    def _of_geom(cls, sim: gloam.Simulation, geom: int) -> Ground:
        places, turns, boxes = (np.array(sim.memory.array(f"geom_{name}")) for name in ("xpos", "xmat", "aabb"))
        if not np.allclose(turns[geom].reshape(3, 3), np.eye(3), atol=1e-6):
            raise gloam.UsageError("planners need ground that is not turned")
        field = int(sim.memory.array("geom_dataid")[geom])
        rows, columns, first = (int(sim.memory.array(f"hfield_{name}")[field]) for name in ("nrow", "ncol", "adr"))
        x, y, top = (float(v) for v in sim.memory.array("hfield_size")[field][:3])
        shares = np.array(sim.memory.array("hfield_data")[first : first + rows * columns], dtype=np.float64)
        middle = places[geom]
        wet = [i for i, name in enumerate(sim.world.info.geoms) if _WATER.search(name)]
        reach = np.abs(np.einsum("nij,nj->ni", turns[wet].reshape(-1, 3, 3), boxes[wet, 3:]))
        center = places[wet] + np.einsum("nij,nj->ni", turns[wet].reshape(-1, 3, 3), boxes[wet, :3])
        water = np.concatenate([(center - reach)[:, :2], center + reach], axis=1)
        return cls(middle[:2] - (x, y), middle[:2] + (x, y), middle[2] + top * shares.reshape(rows, columns), water)

    @property
    def corners(self) -> Array:
        """low and high, (2, 2) [m]."""
        return np.stack([self.low, self.high])

    def height(self, points: Array) -> Array:
        """z of the ground at points (…, 2), bilinear between samples; points beyond the edge have the height of the edge [m]."""
        last = np.array(self.heights.shape[::-1]) - 1
        place = np.clip((np.asarray(points) - self.low) / (self.high - self.low) * last, 0, last)
        cell = np.minimum(place.astype(int), last - 1)
        column, row = cell[..., 0], cell[..., 1]
        u, v = (place - cell)[..., 0], (place - cell)[..., 1]
        h = self.heights
        lower = (1 - u) * h[row, column] + u * h[row, column + 1]
        upper = (1 - u) * h[row + 1, column] + u * h[row + 1, column + 1]
        return np.asarray((1 - v) * lower + v * upper)

    def is_hard(self, points: Array) -> NDArray[np.bool_]:
        """Whether the ground at points (…, 2) is steeper than STEEPEST, or under more than DEEPEST of water."""
        points = np.asarray(points, dtype=np.float64)
        steps = np.eye(2) * _BASE / 2
        inner = np.clip(points, self.low + _BASE / 2, self.high - _BASE / 2)  # the slope at the edge is that beside it
        rise = [self.height(inner + step) - self.height(inner - step) for step in steps]
        hard = np.hypot(*rise) / _BASE > math.tan(STEEPEST)
        for box in self.water:
            inside = ((points >= box[:2]) & (points <= box[2:4])).all(axis=-1)
            hard |= inside & (self.height(points) < box[4] - DEEPEST)
        return np.asarray(hard)


def height_at(ground: Ground | None, x: float, y: float) -> float:
    """z of the ground at a place; 0 on a floor [m]."""
    return 0.0 if ground is None else float(ground.height(np.array([x, y])))
