"""Likeness of two images of one view: SSIM and FLIP."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gloam.experiments.optional import require

from .appearance import grey_of
from .flip import Array, flip
from .images import Image

_ASPECT = 0.01  # relative difference of aspect ratios that counts as none
_SIDE = 768  # longer side for FLIP [px]: larger images are reduced, which bounds memory


@dataclass(frozen=True)
class Likeness:
    """flip: mean of LDR-FLIP; ssim: mean; None with the reason if the images have no common size."""

    flip: float | None
    ssim: float | None
    reason: str = ""


def common_size(a: Image, b: Image) -> tuple[Image, Image] | str:
    """Both images at the size of the smaller one, by Pillow's area-widened bicubic filter; a reason if their aspect ratios differ
    by more than 1 %."""
    if a.shape == b.shape:
        return a, b
    (ha, wa), (hb, wb) = a.shape[:2], b.shape[:2]
    if abs(wa * hb / (wb * ha) - 1) > _ASPECT:
        return f"{wa} x {ha} and {wb} x {hb} pixels have different aspect ratios"
    size = min((wa, ha), (wb, hb), key=lambda side: side[0] * side[1])
    return _resized(a, size), _resized(b, size)


def _resized(image: Image, size: tuple[int, int]) -> Image:
    pillow = require("PIL.Image")
    if (image.shape[1], image.shape[0]) == size:
        return image
    return np.asarray(pillow.fromarray(image).resize(size, pillow.Resampling.BICUBIC))


def compare(reference: Image, test: Image) -> tuple[Likeness, Array | None]:
    """SSIM and FLIP of a pair, and the map of FLIP, (h, w), or None."""
    both = common_size(reference, test)
    if isinstance(both, str):
        return Likeness(None, None, both), None
    structural = ssim(grey_of(both[0]), grey_of(both[1]))
    long = max(both[0].shape[:2])
    if long > _SIDE:
        size = tuple(max(1, round(side * _SIDE / long)) for side in both[0].shape[1::-1])
        both = _resized(both[0], (size[0], size[1])), _resized(both[1], (size[0], size[1]))
    difference = flip(both[0] / 255.0, both[1] / 255.0)
    return Likeness(float(difference.mean()), structural), difference


def ssim(a: Array, b: Array) -> float:
    """Mean structural similarity (Wang et al. 2004) of grey images 0 … 255: Gaussian window of 11 × 11 px with σ = 1.5 px,
    K1 = 0.01, K2 = 0.03, over the places where the window fits."""
    x = np.arange(-5, 6)
    window = np.exp(-(x**2) / (2 * 1.5**2))
    window /= window.sum()

    def blurred(plane: Array) -> Array:
        return _valid(_valid(plane, window, 0), window, 1)

    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    mean_a, mean_b = blurred(a), blurred(b)
    var_a, var_b = blurred(a * a) - mean_a**2, blurred(b * b) - mean_b**2
    covariance = blurred(a * b) - mean_a * mean_b
    index = (2 * mean_a * mean_b + c1) * (2 * covariance + c2) / ((mean_a**2 + mean_b**2 + c1) * (var_a + var_b + c2))
    return float(index.mean())


def _valid(plane: Array, window: Array, axis: int) -> Array:
    """Correlation with a symmetric window along an axis, without padding."""
    length = plane.shape[axis] - len(window) + 1
    total = np.zeros_like(np.take(plane, range(length), axis))
    for i, weight in enumerate(window):
        total += weight * np.take(plane, np.arange(i, i + length), axis)
    return total
