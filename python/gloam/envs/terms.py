"""One term of an observation: its settings, and the space of its output."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium import spaces
from numpy.typing import DTypeLike

from gloam.envs.noise import Array, Noise

LagRange = tuple[int, int]


@dataclass(frozen=True)
class Term:
    """A quantity in an observation: raw value -> noise -> clip -> scale -> delay -> history.

    shape: of the raw value. low, high: limits of the raw value, if it has them. noise: added first. clip: limits
    after the noise, in the raw unit. scale: factor, a number or an array of `shape`. delay: control steps that the
    term is late, or (least, most), drawn for each world at its reset. history: newest values that are given together,
    oldest first; 1 = only the newest. dtype: of the output; uint8 for images.
    """

    name: str
    shape: tuple[int, ...]
    low: float = -math.inf
    high: float = math.inf
    noise: Noise | None = None
    clip: tuple[float, float] | None = None
    scale: float | Sequence[float] = 1.0
    delay: int | LagRange = 0
    history: int = 1
    dtype: DTypeLike = np.float32

    def __post_init__(self) -> None:
        if not self.name:
            raise ValueError("an observation term needs a name")
        if any(size < 1 for size in self.shape):
            raise ValueError(f"term '{self.name}': the shape {self.shape} is empty")
        if self.history < 1:
            raise ValueError(f"term '{self.name}': history must be at least 1, got {self.history}")
        low, high = self.lags
        if not 0 <= low <= high:
            raise ValueError(f"term '{self.name}': delay must be a range of control steps of at least 0, got {self.delay}")
        if self.clip is not None and not self.clip[0] <= self.clip[1]:
            raise ValueError(f"term '{self.name}': clip from {self.clip[0]} to {self.clip[1]} is not a range")
        if not np.all(np.isfinite(self.scale)):
            raise ValueError(f"term '{self.name}': scale must be finite, got {self.scale}")
        if np.ndim(self.scale) > 0 and np.shape(self.scale) != self.shape:
            raise ValueError(f"term '{self.name}': scale has the shape {np.shape(self.scale)}, but the term has {self.shape}")

    @property
    def lags(self) -> LagRange:
        """Least and most delay [control steps]."""
        return (self.delay, self.delay) if isinstance(self.delay, int) else (int(self.delay[0]), int(self.delay[1]))

    @property
    def output_shape(self) -> tuple[int, ...]:
        """Shape of the output, with the history as the first axis if it is longer than 1."""
        return self.shape if self.history == 1 else (self.history, *self.shape)

    def space(self) -> spaces.Box:
        """Limits of the output."""
        low, high = self.low, self.high
        if self.noise is not None:
            low, high = low + self.noise.low, high + self.noise.high
        if self.clip is not None:
            low, high = max(low, self.clip[0]), min(high, self.clip[1])
        kind = np.dtype(self.dtype)
        if kind.kind in "ui":
            info = np.iinfo(kind)
            low, high = max(low, info.min), min(high, info.max)
        with np.errstate(invalid="ignore"):
            ends = np.stack([np.broadcast_to(np.multiply(end, self.scale), self.shape) for end in (low, high)])
        ends = np.nan_to_num(ends, nan=0.0, posinf=math.inf, neginf=-math.inf)
        shape = self.output_shape
        return spaces.Box(
            np.broadcast_to(ends.min(axis=0), shape).astype(kind),
            np.broadcast_to(ends.max(axis=0), shape).astype(kind),
            shape,
            kind.type,
        )

    def finish(self, value: Array) -> Array:
        """`value` (k, *shape), after the noise, clipped and scaled, in the output's type."""
        if self.clip is not None:
            value = np.clip(value, *self.clip)
        if not isinstance(self.scale, (int, float)) or self.scale != 1.0:
            value = value * np.asarray(self.scale)
        kind = np.dtype(self.dtype)
        if kind.kind in "ui" and value.dtype != kind:
            info = np.iinfo(kind)
            value = np.clip(np.rint(value), info.min, info.max)
        return value.astype(kind)
