"""Distances between sets of features and class distributions, with intervals by a jackknife over groups of images."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import TypeVar

import numpy as np

from gloam.experiments.statistics import Estimate

from .network import Floats

GROUPS = 10  # of the jackknife, at most
_BLOCK = 1024  # rows at a time
_Z95 = 1.959963984540054
Group = TypeVar("Group")


def group_of(order: np.ndarray) -> np.ndarray:
    """Group of each image, (n,), by its place in an order that does not depend on names (content hashes)."""
    groups = np.empty(len(order), int)
    groups[order] = np.arange(len(order)) % GROUPS
    return groups


def jackknife(
    measure: Callable[[list[Group], list[Group]], float | None],
    a: list[Group],
    b: list[Group],
    limits: tuple[float, float] = (-np.inf, np.inf),
) -> Estimate:
    """A measure of two samples with its 95 % interval by leaving out one group at a time (Efron and Tibshirani 1993, chapter 11).

    A bootstrap would repeat images, which biases distances between sets. No interval if a sample has a single group. The
    count is of groups. limits: of the measure's values, which clip the interval.
    """
    value = measure(a, b)
    count = len(a) + len(b)
    if value is None:
        return Estimate(None, None, None, count)
    variance = 0.0
    for mine, swap in ((a, False), (b, True)):
        if len(mine) < 2:
            return Estimate(value, None, None, count)
        rest = [mine[:i] + mine[i + 1 :] for i in range(len(mine))]
        found = [measure(a, part) if swap else measure(part, b) for part in rest]
        kept = [one for one in found if one is not None]
        if len(kept) < len(found):
            return Estimate(value, None, None, count)
        variance += (len(kept) - 1) * float(np.var(kept))
    half = _Z95 * float(np.sqrt(variance))
    return Estimate(value, max(limits[0], value - half), min(limits[1], value + half), count)


@dataclass(frozen=True)
class Moments:
    """Mean and scatter of vectors. factor: (r, d), whose product with itself is the sum of outer products of deviations."""

    count: int
    mean: Floats
    factor: Floats


def moments(rows: np.ndarray) -> Moments:
    """Of (n, d), in blocks, so that `rows` may be a mapped file."""
    return reduce(_united, (_moments(np.asarray(rows[i : i + _BLOCK], np.float64)) for i in range(0, len(rows), _BLOCK)))


def _moments(rows: Floats) -> Moments:
    mean = rows.mean(axis=0)
    return Moments(len(rows), mean, _short(rows - mean))


def _short(factor: Floats) -> Floats:
    """A factor of the same scatter with at most d rows."""
    return np.asarray(np.linalg.qr(factor, mode="r")) if factor.shape[0] > factor.shape[1] else factor


def _united(a: Moments, b: Moments) -> Moments:
    count = a.count + b.count
    apart = np.sqrt(a.count * b.count / count) * (a.mean - b.mean)
    return Moments(count, (a.count * a.mean + b.count * b.mean) / count, _short(np.vstack([a.factor, b.factor, apart])))


def frechet(a: Sequence[Moments], b: Sequence[Moments]) -> float | None:
    """Fréchet distance between the normal distributions of two samples in groups (FID of Heusel et al. 2017, with the features at
    hand): |μ - ν|² + Tr(Σ + Τ - 2 (Σ Τ)^½). None if a sample has fewer than two vectors.

    With Σ = FᵀF and Τ = GᵀG the trace of the root is the sum of the singular values of F Gᵀ, which stays exact where the
    covariances have no full rank.
    """
    x, y = reduce(_united, a), reduce(_united, b)
    if x.count < 2 or y.count < 2:
        return None
    f, g = x.factor / np.sqrt(x.count - 1), y.factor / np.sqrt(y.count - 1)
    cross = np.linalg.svd(f @ g.T, compute_uv=False).sum()
    return float(max(0.0, ((x.mean - y.mean) ** 2).sum() + (f**2).sum() + (g**2).sum() - 2 * cross))


class KernelSums:
    """Sums of a cubic kernel between the groups of two samples, for KID."""

    def __init__(self, a: Floats, a_groups: np.ndarray, b: Floats, b_groups: np.ndarray) -> None:
        """a, b: (n, d), (m, d); a_groups, b_groups: their groups from 0."""
        self.counts = [np.bincount(groups) for groups in (a_groups, b_groups)]
        ones = [np.eye(groups.max() + 1)[groups] for groups in (a_groups, b_groups)]

        def kernel(x: Floats, y: Floats) -> Floats:
            return np.asarray((x @ y.T / x.shape[1] + 1) ** 3)

        own = []
        for x, one in zip((a, b), ones, strict=True):
            matrix = kernel(x, x)
            np.fill_diagonal(matrix, 0.0)
            own.append(one.T @ matrix @ one)
        self.own = own
        self.cross = ones[0].T @ kernel(a, b) @ ones[1]

    def kid(self, a: list[int], b: list[int]) -> float | None:
        """Kernel inception distance (Bińkowski et al. 2018) of these groups: the unbiased estimate of the squared maximum mean
        discrepancy with the kernel (xᵀy / d + 1)³. None if a sample has fewer than two vectors."""
        n, m = self.counts[0][a].sum(), self.counts[1][b].sum()
        if n < 2 or m < 2:
            return None
        own = [float(matrix[np.ix_(groups, groups)].sum()) for matrix, groups in zip(self.own, (a, b), strict=True)]
        return float(own[0] / (n * (n - 1)) + own[1] / (m * (m - 1)) - 2 * self.cross[np.ix_(a, b)].sum() / (n * m))


def cosine(a: Floats, b: Floats) -> float | None:
    """Cosine of the angle between two vectors; None if one is zero."""
    product = np.linalg.norm(a) * np.linalg.norm(b)
    return float(np.clip(a @ b / product, -1, 1)) if product > 0 else None


def class_distribution(scores: Floats, temperature: float = 1.0) -> Floats:
    """Softmax of scores over a temperature, (classes,)."""
    scaled = (scores - scores.max()) / temperature
    weights = np.exp(scaled)
    return np.asarray(weights / weights.sum())


def kl_divergence(p: Floats, q: Floats, smoothing: float = 1e-6) -> float:
    """Kullback-Leibler divergence D(P || Q) = Σ p ln(p / q) [nat] of distributions over K classes, both smoothed:
    (p + s) / (1 + K s), so that it is finite."""
    k = len(p)
    p, q = ((x + smoothing) / (1 + k * smoothing) for x in (p, q))
    return float((p * np.log(p / q)).sum())


def cliff_delta(a: Floats, b: Floats) -> float | None:
    """Cliff's δ: probability that a value of b exceeds one of a, less the probability of the opposite; -1 … 1."""
    if not len(a) or not len(b):
        return None
    ordered = np.sort(a)
    below, not_above = np.searchsorted(ordered, b, "left"), np.searchsorted(ordered, b, "right")
    return float((below - (len(a) - not_above)).sum() / (len(a) * len(b)))
