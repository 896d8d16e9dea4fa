"""Random velocity commands and their timing."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from . import terrain
from .robot import CONTROL_PERIOD
from .settings import Commands

_HAS_STEPS = np.isin(terrain.MAP_KINDS, (terrain.STAIRS, terrain.CURBS))


def sample(key: jax.Array, map_index: jax.Array, progress: jax.Array, c: Commands) -> jax.Array:
    """(3,) vx, vy, yaw rate; the ranges grow with progress from 0 to 1. Slow commands become zero: standing."""
    keys = jax.random.split(key, 5)
    has_steps = jnp.asarray(_HAS_STEPS)[map_index]
    low = jnp.array([c.vx[0], c.vy[0], c.yaw_rate[0]])
    high = jnp.array([c.vx[1], c.vy[1], c.yaw_rate[1]])
    low = low.at[0].set(jnp.where(has_steps, c.stairs_vx[0], low[0]))
    high = high.at[0].set(jnp.where(has_steps, c.stairs_vx[1], high[0]))
    command = jax.random.uniform(keys[0], (3,), minval=low, maxval=high) * (0.5 + 0.5 * progress)
    straight = jax.random.uniform(keys[1]) < c.straight
    command = jnp.where(straight, command * jnp.array([1.0, 0.0, 0.0]), command)
    turns_only = jax.random.uniform(keys[2]) < 0.1
    command = jnp.where(turns_only, command * jnp.array([0.0, 0.0, 1.0]), command)
    stands = (jax.random.uniform(keys[3]) < c.standing) | (jnp.linalg.norm(command) < 0.1)
    return jnp.where(stands, 0.0, command)


def steps_until(key: jax.Array, interval: tuple[float, float]) -> jax.Array:
    """Control steps of a uniformly drawn interval [s]."""
    return (jax.random.uniform(key, (), minval=interval[0], maxval=interval[1]) / CONTROL_PERIOD).astype(jnp.int32)
