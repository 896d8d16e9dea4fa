"""Observations of the training's worlds: histories of the terms, and mirror images."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from .terms import MIRRORED_JOINTS, MIRRORED_SIGNS, PRIVILEGED, PRIVILEGED_SIZE, SIZE, TERMS, mirror_table

__all__ = ["PRIVILEGED_SIZE", "SIZE", "begin", "flatten", "mirror", "privileged", "push"]

History = tuple[jax.Array, ...]  # one (history, size) array per term, oldest first, scaled


def push(history: History, values: dict[str, jax.Array]) -> History:
    """Adds one observation."""
    scaled = (values[term.name] * jnp.asarray(term.scale) for term in TERMS)
    return tuple(jnp.concatenate([old[1:], new[None]]) for old, new in zip(history, scaled, strict=True))


def begin(values: dict[str, jax.Array]) -> History:
    """A history that repeats its first observation."""
    return tuple(jnp.tile(values[term.name] * jnp.asarray(term.scale), (term.history, 1)) for term in TERMS)


def flatten(history: History) -> jax.Array:
    return jnp.concatenate([part.ravel() for part in history])


def privileged(values: dict[str, jax.Array]) -> jax.Array:
    """Clipped, because contact forces of a fall are large and those of a diverged world are not finite."""
    parts = [values[term.name] * jnp.asarray(term.scale) for term in PRIVILEGED]
    return jnp.clip(jnp.nan_to_num(jnp.concatenate(parts)), -20, 20)


_ACTOR = mirror_table(TERMS)
_CRITIC = mirror_table(PRIVILEGED)


def mirror(observation: jax.Array, hidden: jax.Array, action: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Images of (…, SIZE) observations, (…, PRIVILEGED_SIZE) values and (…, 12) actions in the xz plane.

    Gait parameters stay: for trot, pace and bound the image of a gait is the same gait, half a cycle later or not.
    """
    return (
        observation[..., _ACTOR[0]] * _ACTOR[1],
        hidden[..., _CRITIC[0]] * _CRITIC[1],
        action[..., MIRRORED_JOINTS] * MIRRORED_SIGNS,
    )
