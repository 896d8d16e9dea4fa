"""Gait clock and gait parameters of Walk-These-Ways (Margolis and Agrawal 2022), as Gloam's observation terms
`gait_clock` and `gait_parameters` define them with pacing_offset = true."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax.scipy.stats import norm

from .settings import Gaits

TROT, PACE, BOUND = (0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.5)  # phase, offset, bound
TOUCH_SPREAD = 0.05  # standard deviation of the moments of touch-down and lift-off, in cycles
LEAST_CLEARANCE = 0.01  # of a swinging foot's lowest point at both ends of its swing [m]


class Gait(NamedTuple):
    """Gait of one world; in the order of terms.GAIT_PARAMETERS."""

    frequency: jax.Array  # [Hz]
    phase: jax.Array  # [cycles], as offset and bound: delays of the feet
    offset: jax.Array
    bound: jax.Array
    duration: jax.Array  # share of a cycle in which a foot stands
    swing_height: jax.Array  # of a foot's lowest point in the middle of its swing [m]
    body_height: jax.Array  # offset to the nominal height [m]


def advance(index: jax.Array, gait: Gait, period: float) -> jax.Array:
    return jnp.mod(index + gait.frequency * period, 1.0)


def foot_phases(index: jax.Array, gait: Gait) -> jax.Array:
    """(4,) phases of FL, FR, RL, RR in [0, 1): stance below 0.5, swing above."""
    delays = jnp.stack([gait.phase + gait.offset + gait.bound, gait.bound, gait.offset, gait.phase])
    f = jnp.mod(index + delays, 1.0)
    swing = 0.5 + 0.5 * (f - gait.duration) / (1 - gait.duration)
    return jnp.where(f < gait.duration, 0.5 * f / gait.duration, swing)


def clock(phases: jax.Array) -> jax.Array:
    return jnp.sin(2 * jnp.pi * phases)


def wanted_contacts(phases: jax.Array) -> jax.Array:
    """(4,) from 0 (swing) to 1 (stance); smooth around touch-down and lift-off, as in Walk-These-Ways."""

    def stance(w: jax.Array) -> jax.Array:
        return norm.cdf(w, scale=TOUCH_SPREAD) * (1 - norm.cdf(w - 0.5, scale=TOUCH_SPREAD))

    return stance(phases) + stance(phases - 1)


def wanted_clearances(phases: jax.Array, gait: Gait) -> jax.Array:
    """(4,) height of a swinging foot's lowest point above the ground [m]."""
    progress = jnp.clip(2 * phases - 1, 0, 1)
    return LEAST_CLEARANCE + gait.swing_height * (1 - jnp.abs(1 - 2 * progress))


def sample(key: jax.Array, ranges: Gaits) -> Gait:
    keys = jax.random.split(key, 5)
    kind = jax.random.choice(keys[0], 3, p=jnp.asarray(ranges.shares))
    delays = jnp.array([TROT, PACE, BOUND])[kind]

    def uniform(number: int, limits: tuple[float, float]) -> jax.Array:
        return jax.random.uniform(keys[number], (), minval=limits[0], maxval=limits[1])

    height = uniform(4, ranges.body_height)
    frequency, duration, swing = (uniform(n, r) for n, r in ((1, ranges.frequency), (2, ranges.duration), (3, ranges.swing_height)))
    return Gait(frequency, delays[0], delays[1], delays[2], duration, swing, height)
