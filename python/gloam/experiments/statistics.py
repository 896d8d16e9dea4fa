"""Intervals and paired tests in NumPy: Wilson, percentile bootstrap, exact McNemar, sign-flip permutation, Holm."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

RESAMPLES = 10_000
EXACT_PAIRS = 16  # up to 2^16 assignments of signs are enumerated
FLIPS = 100_000
_Z95 = 1.959963984540054  # 97.5 % quantile of the normal distribution
_BLOCK = 2_000_000  # random numbers per block: bounds the memory of large cells


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % confidence interval. count: values behind it; value: None if there are none; low, high: None
    if one value or none admits no interval."""

    value: float | None
    low: float | None
    high: float | None
    count: int

    @property
    def constant(self) -> bool:
        """Whether all values are equal, so that resampling cannot show their spread."""
        return self.count > 1 and self.low is not None and self.low == self.high


def wilson(successes: int, count: int) -> Estimate:
    """Rate of successes in [0, 1] with its Wilson score interval (Wilson 1927, doi:10.1080/01621459.1927.10502953).

    Unlike the normal approximation it stays in [0, 1] and has a width at 0 and 1. Errors: ValueError unless
    0 <= successes <= count.
    """
    if not 0 <= successes <= count:
        raise ValueError(f"{successes} successes of {count}")
    if count == 0:
        return Estimate(None, None, None, 0)
    rate, z2 = successes / count, _Z95**2
    center = (rate + z2 / (2 * count)) / (1 + z2 / count)
    half = _Z95 * math.sqrt(rate * (1 - rate) / count + z2 / (4 * count**2)) / (1 + z2 / count)
    low = 0.0 if successes == 0 else center - half
    high = 1.0 if successes == count else center + half
    return Estimate(rate, low, high, count)


def generator(seed: int, name: str) -> np.random.Generator:
    """Random numbers of one quantity: its interval stays the same when cells are added or removed."""
    return np.random.default_rng([seed & 0xFFFFFFFFFFFFFFFF, zlib.crc32(name.encode())])


def bootstrap_mean(values: Sequence[float], random: np.random.Generator, resamples: int = RESAMPLES) -> Estimate:
    """Mean with its percentile bootstrap interval (Efron and Tibshirani 1993, chapter 13).

    values: (n,). No value: no mean; one value: no interval, because resampling one value would give a width of zero.
    """
    data = np.asarray(values, dtype=np.float64)
    n = data.size
    if n == 0:
        return Estimate(None, None, None, 0)
    mean = float(data.mean())
    if n == 1:
        return Estimate(mean, None, None, 1)
    if np.all(data == data[0]):
        return Estimate(float(data[0]), float(data[0]), float(data[0]), n)
    means = np.empty(resamples)
    rows = max(1, _BLOCK // n)
    for first in range(0, resamples, rows):
        last = min(first + rows, resamples)
        means[first:last] = data[random.integers(0, n, (last - first, n))].mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return Estimate(mean, float(low), float(high), n)


def mcnemar(first_only: int, second_only: int) -> float:
    """Two-sided p-value of the exact McNemar test (McNemar 1947, doi:10.1007/BF02295996; binomial form).

    first_only, second_only: pairs in which only one of the two succeeded. Without such pairs p = 1.
    """
    count, least = first_only + second_only, min(first_only, second_only)
    if least < 0:
        raise ValueError(f"{first_only} and {second_only} pairs")
    tail = sum(math.comb(count, k) for k in range(least + 1))
    return min(1.0, 2 * tail / (1 << count))


def sign_flip(differences: Sequence[float], random: np.random.Generator, flips: int = FLIPS) -> float:
    """Two-sided p-value of the permutation test of paired differences (Fisher 1935, The Design of Experiments, §21).

    Under the hypothesis that both members of a pair have one distribution, each difference has either sign with equal
    probability. The statistic is the absolute sum. Up to 16 differences other than 0 are enumerated exactly; beyond,
    `flips` random assignments give p = (extreme + 1) / (flips + 1) (Phipson and Smyth 2010, doi:10.2202/1544-6115.1585).
    Without a difference p = 1.
    """
    data = np.asarray(differences, dtype=np.float64)
    data = data[data != 0]
    if data.size == 0:
        return 1.0
    # Sums of the same numbers in another order differ by rounding; ties must count as extreme.
    observed = abs(float(data.sum())) - 1e-9 * float(np.abs(data).sum())
    if data.size <= EXACT_PAIRS:
        sums = np.zeros(1)
        for value in data:
            sums = np.concatenate((sums + value, sums - value))
        return float(np.mean(np.abs(sums) >= observed))
    extreme, rows = 0, max(1, _BLOCK // data.size)
    for first in range(0, flips, rows):
        signs: NDArray[np.int8] = random.integers(0, 2, (min(rows, flips - first), data.size), dtype=np.int8) * 2 - 1
        extreme += int(np.count_nonzero(np.abs(signs @ data) >= observed))
    return (extreme + 1) / (flips + 1)


def holm(p_values: Sequence[float]) -> list[float]:
    """p-values adjusted for their number so that the family-wise error rate holds (Holm 1979, jstor:4615733)."""
    adjusted = [0.0] * len(p_values)
    largest = 0.0
    for rank, index in enumerate(sorted(range(len(p_values)), key=lambda i: p_values[i])):
        largest = max(largest, min(1.0, p_values[index] * (len(p_values) - rank)))
        adjusted[index] = largest
    return adjusted
