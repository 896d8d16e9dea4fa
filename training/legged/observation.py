"""Observations of the training's worlds: histories of the terms, and mirror images."""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp

from .robot import Robot
from .terms import Term, actor_terms, critic_terms, mirror_table

History = tuple[jax.Array, ...]  # one (history, size) array per term, oldest first, scaled
Values = dict[str, jax.Array]  # of each term
Terms = tuple[Term, ...]


def push(terms: Terms, history: History, values: Values) -> History:
    """Adds one observation."""
    scaled = (values[term.name] * jnp.asarray(term.scale) for term in terms)
    return tuple(jnp.concatenate([old[1:], new[None]]) for old, new in zip(history, scaled, strict=True))


def begin(terms: Terms, values: Values) -> History:
    """A history that repeats its first observation."""
    return tuple(jnp.tile(values[term.name] * jnp.asarray(term.scale), (term.history, 1)) for term in terms)


def flatten(history: History) -> jax.Array:
    return jnp.concatenate([part.ravel() for part in history])


def privileged(terms: Terms, values: Values) -> jax.Array:
    """Clipped, because contact forces of a fall are large and those of a diverged world are not finite."""
    parts = [values[term.name] * jnp.asarray(term.scale) for term in terms]
    return jnp.clip(jnp.nan_to_num(jnp.concatenate(parts)), -20, 20)


def mirror(robot: Robot) -> Callable[[jax.Array, jax.Array, jax.Array], tuple[jax.Array, jax.Array, jax.Array]]:
    """A function of observations, the critic's values and actions (…, n) that returns their images in the xz plane.

    Gait parameters stay: for trot, pace and bound the image of a gait is the same gait, half a cycle later or not.
    """
    actor, critic = mirror_table(actor_terms(robot)), mirror_table(critic_terms(robot))

    def image(observation: jax.Array, hidden: jax.Array, action: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        return (
            observation[..., actor[0]] * actor[1],
            hidden[..., critic[0]] * critic[1],
            action[..., robot.mirrored_joints] * robot.mirrored_signs,
        )

    return image
