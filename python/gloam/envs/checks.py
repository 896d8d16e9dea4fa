"""Checks of arguments."""

from __future__ import annotations

import numpy as np
from gymnasium import spaces

from gloam.envs.noise import Array


def checked_actions(actions: object, space: spaces.Box, num_worlds: int) -> Array:
    """Actions (num_worlds, *shape), as float64, clipped to the limits of the space of one world.

    Errors: ValueError for another shape, values that are not numbers, NaN or an infinity. Values beyond the limits
    are clipped, as in servos.
    """
    try:
        values = np.asarray(actions, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"actions must be numbers, got {actions!r}") from error
    expected = (num_worlds, *space.shape)
    if values.shape != expected:
        raise ValueError(f"actions have the shape {values.shape}, expected {expected}")
    if not np.isfinite(values).all():
        raise ValueError("an action is not finite")
    return np.clip(values, space.low.astype(np.float64), space.high.astype(np.float64))


def checked_mask(mask: object, num_worlds: int) -> Array:
    """`options["reset_mask"]` of a vector environment. Errors as gymnasium's: TypeError, ValueError."""
    if not isinstance(mask, np.ndarray):
        raise TypeError(f"options['reset_mask'] must be a NumPy array, got {type(mask).__name__}")
    if mask.dtype != np.bool_:
        raise TypeError(f"options['reset_mask'] must have the dtype bool, got {mask.dtype}")
    if mask.shape != (num_worlds,):
        raise ValueError(f"options['reset_mask'] must have the shape ({num_worlds},), got {mask.shape}")
    if not mask.any():
        raise ValueError("options['reset_mask'] selects no world")
    return mask


def checked_seeds(seed: object, num_worlds: int) -> list[int | None]:
    """Seeds of all worlds: of None, of one number s (s, s + 1, …), or of a list. Errors: ValueError, TypeError."""
    if seed is None:
        return [None] * num_worlds
    if isinstance(seed, (int, np.integer)) and not isinstance(seed, bool):
        seeds: list[object] = [int(seed) + world for world in range(num_worlds)]
    elif isinstance(seed, (list, tuple, np.ndarray)):
        seeds = list(seed)
    else:
        raise TypeError(f"seed must be a number or a list of numbers, got {seed!r}")
    if len(seeds) != num_worlds:
        raise ValueError(f"got {len(seeds)} seeds for {num_worlds} worlds")
    checked: list[int | None] = []
    for one in seeds:
        if one is not None and (isinstance(one, bool) or not isinstance(one, (int, np.integer)) or one < 0):
            raise ValueError(f"a seed must be a whole number of at least 0, got {one!r}")
        checked.append(None if one is None else int(one))
    return checked
