"""Ground of the training: columns on a periodic grid, some of them soft.

The ground replaces MJX's plane. A foot touches the column below its centre and the nearest of the higher columns
beside it, so edges and risers of stairs are exact and cost two contacts per foot. MJX's height fields test every prism
under a sphere's bounding box instead.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import mujoco.mjx
import numpy as np
from mujoco.mjx._src import collision_driver  # MJX has no public table of its collision functions
from mujoco.mjx._src import math as mjx_math

CELL = 0.1  # edge length of a column [m]; larger than a foot
CELLS = 128  # columns per period
ROUGH_HEIGHT = 0.08  # [m] at level 1
STEP_HEIGHT = 0.10  # [m] at level 1
DEEPEST = 0.03  # penetration that a contact answers to [m]: a foot that is caught inside a column is lifted gently

FLAT, ROUGH, STAIRS, WAVES, CURBS = range(5)
# One map per row; worlds draw maps uniformly. Rough ground with columns of 0.1, 0.2 and 0.3 m.
MAP_KINDS = (FLAT, FLAT, FLAT, ROUGH, ROUGH, ROUGH, STAIRS, STAIRS, STAIRS, WAVES, WAVES, CURBS, STAIRS)


class Ground(NamedTuple):
    """Ground of one world, as it is packed into mjData.userdata (Robot.userdata_size)."""

    map: jax.Array  # index into the maps
    offset: jax.Array  # (2,) of the map's origin [m]
    level: jax.Array  # scale of the heights, 0 … 1.2
    sinkage: jax.Array  # (spheres,) depth of the print under each sphere of the soles [m]


def pack(ground: Ground) -> jax.Array:
    return jnp.concatenate([ground.map[None].astype(jnp.float32), ground.offset, ground.level[None], ground.sinkage])


def unpack(userdata: jax.Array) -> Ground:
    return Ground(userdata[0].astype(jnp.int32), userdata[1:3], userdata[3], userdata[4:])


def _rough(rng: np.random.Generator, block: int) -> np.ndarray:
    count = -(-CELLS // block)
    coarse = rng.uniform(0, ROUGH_HEIGHT, (count, count))
    return np.kron(coarse, np.ones((block, block)))[:CELLS, :CELLS]


def _pyramids(tread: int, sign: int) -> np.ndarray:
    """Four pyramids per period, or pits, with stairs on all sides and level ground around them."""
    half = CELLS // 4
    ring = np.minimum(np.arange(2 * half), 2 * half - 1 - np.arange(2 * half))
    inwards = np.minimum(ring[:, None], ring[None, :])
    count = (half - 10) // tread
    steps = np.clip((inwards - 5) // tread, 0, count)
    return np.tile(sign * STEP_HEIGHT * steps, (2, 2))


def _waves(rng: np.random.Generator, noise: float) -> np.ndarray:
    """Sinusoids with slopes up to about 20 %, and noise."""
    x = np.arange(CELLS) * 2 * np.pi / CELLS
    heights = np.zeros((CELLS, CELLS))
    for wave in range(1, 5):
        phases = rng.uniform(0, 2 * np.pi, 2)
        heights += 0.16 / wave * np.sin(wave * x + phases[0])[:, None] * np.cos((5 - wave) * x + phases[1])[None, :]
    return heights + rng.uniform(0, noise, heights.shape)


def _curbs(rng: np.random.Generator) -> np.ndarray:
    """Blocks of one step's height in a tenth of the area."""
    heights = np.zeros((CELLS, CELLS))
    for _ in range(60):
        corner, size = rng.integers(0, CELLS, 2), rng.integers(3, 9, 2)
        rows, columns = ((corner[axis] + np.arange(size[axis])) % CELLS for axis in (0, 1))
        heights[np.ix_(rows, columns)] = STEP_HEIGHT * rng.uniform(0.5, 1)
    return heights


def make_maps(seed: int) -> jax.Array:
    """(len(MAP_KINDS), CELLS, CELLS) heights at level 1 [m]."""
    rng = np.random.default_rng(seed)
    maps = [np.zeros((CELLS, CELLS))] * 3
    maps += [_rough(rng, block) for block in (1, 2, 3)]
    maps += [_pyramids(3, 1), _pyramids(4, 1), _pyramids(3, -1)]
    maps += [_waves(rng, 0.02), _waves(rng, 0.05), _curbs(rng), _pyramids(4, -1)]
    return jnp.asarray(np.stack(maps), jnp.float32)


def heights(maps: jax.Array, ground: Ground, points: jax.Array) -> jax.Array:
    """(n,) heights of the undisturbed ground at (n, 2) points [m]."""
    cell = jnp.floor((points + ground.offset) / CELL).astype(jnp.int32) % CELLS
    return ground.level * maps[ground.map, cell[:, 0], cell[:, 1]]


def _side_contact(maps: jax.Array, ground: Ground, centre: jax.Array, own: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Distance of a sphere's `centre` (3,) from the nearest higher column beside it, and the normal."""
    local = (centre[:2] + ground.offset) / CELL
    corner = jnp.floor(local + 0.5)  # the corner of columns nearest to the foot
    towards = jnp.where(corner > local, 1.0, -1.0)
    edge = (corner - local) * CELL  # from the centre to that corner [m]
    moves = jnp.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    height = heights(maps, ground, centre[:2] + moves * towards * CELL)
    drop = jnp.maximum(centre[2] - height, 0.0)
    delta = jnp.concatenate([-moves * edge, drop[:, None]], axis=1)  # from the column to the centre
    length = jnp.linalg.norm(delta + 1e-9, axis=1)
    distance = jnp.where(height > own + 1e-3, length, 10.0)
    best = jnp.argmin(distance)
    return distance[best], delta[best] / length[best]


def sole_contacts(maps: jax.Array, ground: Ground, centres: jax.Array, radius: float) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Two contacts for each of n spheres, below and beside: distances (2n,), points (2n, 3), normals (2n, 3)."""

    def one(centre: jax.Array, sinkage: jax.Array) -> tuple[jax.Array, jax.Array]:
        own = heights(maps, ground, centre[None, :2])[0]
        below = jnp.maximum(centre[2] - radius - (own - sinkage), -DEEPEST)
        side, side_normal = _side_contact(maps, ground, centre, own)
        return jnp.stack([below, side - radius]), jnp.stack([jnp.array([0.0, 0.0, 1.0]), side_normal])

    distance, normal = jax.vmap(one)(centres, ground.sinkage)
    distance, normal = distance.ravel(), normal.reshape(-1, 3)
    points = jnp.repeat(centres, 2, axis=0) - normal * (radius + 0.5 * distance)[:, None]
    return distance, points, normal


def install(maps: jax.Array, radius: float) -> None:
    """Makes MJX collide planes and spheres by sole_contacts(); the ground's state is in mjData.userdata."""

    def collide(_model: Any, data: Any, _key: Any, geom: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        distance, points, normal = sole_contacts(maps, unpack(data.userdata), data.geom_xpos[geom[:, 1]], radius)
        return distance, points, jax.vmap(mjx_math.make_frame)(normal)

    collide.ncon = 2  # type: ignore[attr-defined]
    kinds = (mujoco.mjx.GeomType.PLANE, mujoco.mjx.GeomType.SPHERE)
    collision_driver._COLLISION_FUNC[kinds] = collide
