"""Errors of measurements that an observation term adds: its own for each world, and the same for equal seeds."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class Noise(ABC):
    """An additive error. `bias` is drawn once an episode, `sample` at every observation."""

    bounded: bool = False
    """Whether the error has limits: of `low` and `high`."""
    low: float = -math.inf
    high: float = math.inf

    @abstractmethod
    def sample(self, rng: np.random.Generator, value: Array) -> Array:
        """The error of one observation, of the shape and in the unit of `value`."""

    def bias(self, rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
        """The error that stays for an episode, of `shape`; 0 unless a subclass overrides it."""
        return np.zeros(shape)


@dataclass(frozen=True)
class Gaussian(Noise):
    """Normal error: std + relative |value| is its standard deviation, bias_std that of an offset per episode.

    All three are >= 0; `std` and `bias_std` have the unit of the term, `relative` has none.
    """

    std: float = 0.0
    relative: float = 0.0
    bias_std: float = 0.0

    def __post_init__(self) -> None:
        for name in ("std", "relative", "bias_std"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise ValueError(f"noise: {name} must be finite and not negative, got {value}")

    def sample(self, rng: np.random.Generator, value: Array) -> Array:
        return rng.standard_normal(value.shape) * (self.std + self.relative * np.abs(value))

    def bias(self, rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
        return rng.standard_normal(shape) * self.bias_std


@dataclass(frozen=True)
class Uniform(Noise):
    """Error evenly between `low` and `high`, in the unit of the term."""

    low: float = 0.0
    high: float = 0.0
    bounded = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low <= self.high):
            raise ValueError(f"noise: uniform from {self.low} to {self.high} is not a range")

    def sample(self, rng: np.random.Generator, value: Array) -> Array:
        return rng.uniform(self.low, self.high, value.shape)


def parse_noise(value: object) -> Noise | None:
    """A Noise of what a scene's author writes: a number (std of a Gaussian), {"std": …} or {"uniform": [low, high]}.

    Errors: ValueError for anything else.
    """
    if value is None or isinstance(value, Noise):
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return Gaussian(float(value))
    if isinstance(value, Mapping):
        keys = set(value)
        if keys == {"uniform"}:
            low, high = value["uniform"]
            return Uniform(float(low), float(high))
        if keys and keys <= {"std", "relative", "bias_std"}:
            return Gaussian(**{str(key): float(number) for key, number in value.items()})
    raise ValueError(
        f'noise must be a number, {{"std": …, "relative": …, "bias_std": …}} or {{"uniform": [low, high]}}, got {value!r}'
    )
