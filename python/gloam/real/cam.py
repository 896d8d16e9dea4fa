"""Maps of the places in an image that a network's answer depends on: Grad-CAM and EigenCAM, and their overlap."""

from __future__ import annotations

import numpy as np

from .network import Floats


def grad_cam(layer: Floats, gradient: Floats) -> Floats:
    """Grad-CAM (Selvaraju et al. 2017), (h, w): the positive part of the layer's channels weighted by the mean gradient of a class's
    score. layer, gradient: (c, h, w)."""
    weights = gradient.mean(axis=(1, 2))
    return np.maximum(np.tensordot(weights, layer, 1), 0)


def eigen_cam(layer: Floats) -> Floats:
    """EigenCAM (Muhammad and Yeasin 2020), (h, w): the positive part of the projection of the centred layer on its first principal
    component over the places.

    The sign of a principal component is arbitrary; here the map rises where the mean over channels rises. layer: (c, h, w).
    """
    places = layer.reshape(len(layer), -1).T
    centred = places - places.mean(axis=0)
    u, s, _ = np.linalg.svd(centred, full_matrices=False)
    projection = u[:, 0] * s[0]
    if projection @ centred.mean(axis=1) < 0:
        projection = -projection
    return np.asarray(np.maximum(projection, 0).reshape(layer.shape[1:]))


def normalised(map_: Floats) -> Floats:
    """A map scaled to 0 … 1; zeros if it is constant."""
    span = map_.max() - map_.min()
    return (map_ - map_.min()) / span if span > 1e-12 * max(1.0, abs(float(map_.max()))) else np.zeros_like(map_)


def enlarged(map_: Floats, size: tuple[int, int]) -> Floats:
    """A map at (width, height) by bilinear interpolation between the middles of its cells."""

    def weights(new: int, old: int) -> tuple[np.ndarray, np.ndarray, Floats]:
        at = np.clip((np.arange(new) + 0.5) * old / new - 0.5, 0, old - 1)
        low = np.minimum(at.astype(int), max(old - 2, 0))
        return low, np.minimum(low + 1, old - 1), at - low

    low, high, share = weights(size[1], map_.shape[0])
    rows = map_[low] * (1 - share[:, None]) + map_[high] * share[:, None]
    low, high, share = weights(size[0], map_.shape[1])
    return np.asarray(rows[:, low] * (1 - share) + rows[:, high] * share)


def overlap(a: Floats, b: Floats) -> float | None:
    """Shared share of two maps of one network, each scaled to a sum of 1: 1 = equal, 0 = disjoint; None if one is zero or their
    shapes differ."""
    if a.shape != b.shape or a.sum() <= 0 or b.sum() <= 0:
        return None
    return float(np.minimum(a / a.sum(), b / b.sum()).sum())


def intersection_over_union(a: Floats, b: Floats) -> float | None:
    """Of the areas in which two maps exceed half of their maxima; None if one is zero or their shapes differ."""
    if a.shape != b.shape or a.max() <= 0 or b.max() <= 0:
        return None
    bright_a, bright_b = a > a.max() / 2, b > b.max() / 2
    return float((bright_a & bright_b).sum() / (bright_a | bright_b).sum())
