"""Distances of sets and maps against closed forms and independent formulas."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from gloam.real.cam import eigen_cam, enlarged, grad_cam, intersection_over_union, normalised, overlap
from gloam.real.distances import (
    KernelSums, class_distribution, cliff_delta, cosine, frechet, group_of, jackknife, kl_divergence, moments,
)  # fmt: skip

RANDOM = np.random.default_rng(7)


def formula(a: np.ndarray, b: np.ndarray) -> float:
    """Fréchet distance as it is printed, by the matrix root."""
    root = scipy.linalg.sqrtm(np.cov(a.T) @ np.cov(b.T))
    return float(((a.mean(0) - b.mean(0)) ** 2).sum() + np.trace(np.cov(a.T) + np.cov(b.T) - 2 * np.real(root)))


@pytest.mark.parametrize(("n", "m"), [(200, 300), (40, 25)])
def test_frechet_equals_the_printed_formula(n: int, m: int) -> None:
    a = RANDOM.standard_normal((n, 12)) @ RANDOM.standard_normal((12, 12))
    b = RANDOM.standard_normal((m, 12)) * RANDOM.uniform(0.3, 2, 12) + 0.4
    assert frechet([moments(a)], [moments(b)]) == pytest.approx(formula(a, b), rel=1e-6)
    parts = [moments(a[k::4]) for k in range(4)]
    assert frechet(parts, [moments(b[: m // 2]), moments(b[m // 2 :])]) == pytest.approx(formula(a, b), rel=1e-6), "groups unite exactly"


def test_frechet_of_normal_distributions_in_closed_form() -> None:
    deviation, shift = np.array([1.0, 2, 0.5, 3]), np.array([0.5, -1, 0, 2])
    a = RANDOM.standard_normal((200_000, 4))
    exact = (shift**2).sum() + ((deviation - 1) ** 2).sum()
    assert frechet([moments(a)], [moments(RANDOM.standard_normal((200_000, 4)) * deviation + shift)]) == pytest.approx(exact, rel=0.02)


def test_frechet_without_full_rank() -> None:
    a = RANDOM.standard_normal((5, 300))
    assert frechet([moments(a)], [moments(a)]) == pytest.approx(0, abs=1e-9)
    b = a + 1
    assert frechet([moments(a)], [moments(b)]) == pytest.approx(300, rel=1e-9), "a shift keeps the covariance"
    assert frechet([moments(a[:1])], [moments(b)]) is None


def kid_formula(a: np.ndarray, b: np.ndarray) -> float:
    total, n, m = 0.0, len(a), len(b)
    for x in range(n):
        total += sum((a[x] @ a[y] / a.shape[1] + 1) ** 3 for y in range(n) if x != y) / (n * (n - 1))
        total -= 2 * sum((a[x] @ b[y] / a.shape[1] + 1) ** 3 for y in range(m)) / (n * m)
    return float(total + sum((b[x] @ b[y] / a.shape[1] + 1) ** 3 for x in range(m) for y in range(m) if x != y) / (m * (m - 1)))


def test_kid_equals_its_double_sum() -> None:
    a, b = RANDOM.standard_normal((13, 6)), RANDOM.standard_normal((9, 6)) + 0.5
    sums = KernelSums(a, np.arange(13) % 4, b, np.arange(9) % 3)
    assert sums.kid([0, 1, 2, 3], [0, 1, 2]) == pytest.approx(kid_formula(a, b), rel=1e-9)
    kept, others = np.arange(13) % 4 != 1, np.arange(9) % 3 == 2
    assert sums.kid([0, 2, 3], [2]) == pytest.approx(kid_formula(a[kept], b[others]), rel=1e-9), "without some groups"
    assert KernelSums(a[:1], np.zeros(1, int), b, np.zeros(9, int)).kid([0], [0]) is None


def test_intervals_of_equal_distributions_contain_zero() -> None:
    hits = 0
    for _ in range(60):
        a, b = RANDOM.standard_normal((60, 5)), RANDOM.standard_normal((50, 5))
        groups = np.arange(60) % 10, np.arange(50) % 10
        sums = KernelSums(a, groups[0], b, groups[1])
        found = jackknife(sums.kid, list(range(10)), list(range(10)))
        assert found.low is not None and found.high is not None
        hits += found.low <= 0 <= found.high
    assert hits >= 51, "95 % are expected, 85 % tolerated"


def test_jackknife_of_means_is_the_standard_error() -> None:
    a, b = list(RANDOM.standard_normal(10)), list(RANDOM.standard_normal(8) + 3)
    found = jackknife(lambda x, y: float(np.mean(y) - np.mean(x)), a, b)
    error = np.sqrt(np.var(a, ddof=1) / 10 + np.var(b, ddof=1) / 8)
    assert found.value == pytest.approx(np.mean(b) - np.mean(a))
    assert found.high == pytest.approx(np.mean(b) - np.mean(a) + 1.959964 * error, rel=1e-6)
    assert jackknife(lambda x, y: 1.0, [1], b).low is None, "one group admits no interval"
    limited = jackknife(lambda x, y: float(np.mean(y) - np.mean(x)), a, b, (0, 3.1))
    assert limited.high is not None and limited.high <= 3.1


def test_groups_are_balanced() -> None:
    groups = group_of(RANDOM.permutation(23))
    assert sorted(np.bincount(groups)) == [2] * 7 + [3] * 3


def test_divergence() -> None:
    p, q = class_distribution(np.log([0.5, 0.25, 0.25])), class_distribution(np.log([0.25, 0.25, 0.5]))
    assert kl_divergence(p, q, 1e-12) == pytest.approx(0.25 * np.log(2), rel=1e-6)
    assert kl_divergence(p, p) == 0
    sure, other = class_distribution(np.array([900.0, 0, 0])), class_distribution(np.array([0, 900.0, 0]))
    assert kl_divergence(sure, other) == pytest.approx(np.log((1 + 1e-6) / 1e-6), rel=1e-4), "finite by smoothing"
    warm = class_distribution(np.array([2.0, 0.0]), 2.0)
    assert warm[0] == pytest.approx(np.e / (np.e + 1))


def test_cosine_and_delta() -> None:
    assert cosine(np.array([1.0, 1]), np.array([1.0, 0])) == pytest.approx(np.sqrt(0.5))
    assert cosine(np.zeros(3), np.ones(3)) is None
    a, b = RANDOM.integers(0, 6, 30).astype(float), RANDOM.integers(2, 9, 20).astype(float)
    assert cliff_delta(a, b) == pytest.approx(np.sign(b[None] - a[:, None]).mean())
    assert cliff_delta(np.array([]), b) is None and cliff_delta(a, a + 10) == 1


def test_maps() -> None:
    layer, gradient = RANDOM.random((6, 5, 7)), RANDOM.standard_normal((6, 5, 7))
    weights = gradient.mean((1, 2))
    assert np.allclose(grad_cam(layer, gradient), np.maximum((weights[:, None, None] * layer).sum(0), 0))
    eigen = eigen_cam(layer)
    covariance = np.cov(layer.reshape(6, -1))
    values, vectors = np.linalg.eigh(covariance)
    along = vectors[:, -1] @ (layer.reshape(6, -1) - layer.reshape(6, -1).mean(1, keepdims=True))
    assert min(np.abs(np.maximum(sign * along, 0).reshape(5, 7) - eigen).max() for sign in (1, -1)) < 1e-9
    assert (layer.mean(0).ravel() - layer.mean()) @ eigen.ravel() > 0 and eigen_cam(np.ones((3, 4, 4))).max() == 0
    assert normalised(np.full((2, 2), 3.0)).max() == 0 and normalised(eigen).max() == 1


def test_overlap_of_maps() -> None:
    left, right = np.zeros((4, 4)), np.zeros((4, 4))
    left[:, :2], right[:, 1:3] = 1, 2
    assert overlap(left, right) == pytest.approx(0.5) and intersection_over_union(left, right) == pytest.approx(1 / 3)
    assert overlap(left, left) == 1 and overlap(left, 7 * left) == 1 and overlap(left, np.zeros((4, 4))) is None
    assert intersection_over_union(left, np.zeros((2, 2))) is None


def test_enlarged_maps() -> None:
    ramp = np.add.outer(10 * np.arange(4.0), np.arange(5.0))
    large = enlarged(ramp, (10, 8))
    assert large.shape == (8, 10) and large[0, 0] == 0 and large[-1, -1] == 34, "edges are held"
    assert large[3, 5] == pytest.approx(10 * (3.5 / 2 - 0.5) + (5.5 / 2 - 0.5)), "linear between the middles of cells"
    assert np.array_equal(enlarged(np.full((1, 1), 2.0), (3, 2)), np.full((2, 3), 2.0))
