"""LDR-FLIP: how different two images look when one flips between them.

After Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating
Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2). Images are (height, width, 3) floats in sRGB, 0 … 1; the result is (height,
width), 0 = equal, 1 = as different as possible. This file needs NumPy alone: the benchmarks of the renderer use it too.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PIXELS_PER_DEGREE = 67  # 0.7 m from a screen with 3840 pixels on 0.7 m

_RGB_TO_XYZ = np.array([[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]])
_WHITE = _RGB_TO_XYZ @ np.ones(3)
# Contrast sensitivity: weights a and widths b [degrees²] of two Gaussians per channel.
_SENSITIVITY = (((1.0, 0.0047), (0.0, 1e-5)), ((1.0, 0.0053), (0.0, 1e-5)), ((34.1, 0.04), (13.5, 0.025)))


def linear(srgb: Array) -> Array:
    """Linear Rec. 709 from sRGB, both 0 … 1."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def luminance(rgb: Array) -> Array:
    """Relative luminance, (…), of linear Rec. 709."""
    return np.asarray(rgb @ _RGB_TO_XYZ[1])


def lab(rgb: Array) -> Array:
    """CIE L*a*b* with the white of sRGB, D65, from linear Rec. 709."""
    t = rgb @ _RGB_TO_XYZ.T / _WHITE
    d = 6 / 29
    f = np.where(t > d**3, np.cbrt(t), t / (3 * d * d) + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def _to_opponent(rgb: Array) -> Array:
    """Linear RGB to YCxCz."""
    x, y, z = np.moveaxis(rgb @ _RGB_TO_XYZ.T / _WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def _from_opponent(c: Array) -> Array:
    y = (c[..., 0] + 16) / 116
    xyz = np.stack([c[..., 1] / 500 + y, y, y - c[..., 2] / 200], -1) * _WHITE
    return np.asarray(xyz @ np.linalg.inv(_RGB_TO_XYZ).T)


def _hunt(rgb: Array) -> Array:
    """L*a*b* with chroma scaled by lightness (Hunt effect)."""
    found = lab(rgb)
    return np.asarray(found * np.concatenate([np.ones_like(found[..., :1]), *[0.01 * found[..., :1]] * 2], -1))


def _hyab(a: Array, b: Array) -> Array:
    d = a - b
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])


def _filter(plane: Array, rows: Array, columns: Array) -> Array:
    """Convolves a plane with a separable kernel, edges repeated."""
    for axis, kernel in ((0, rows), (1, columns)):
        radius = len(kernel) // 2
        width = [(0, 0), (0, 0)]
        width[axis] = (radius, radius)
        padded = np.pad(plane, width, mode="edge")
        out = np.zeros_like(plane)
        for i, weight in enumerate(kernel[::-1]):
            out += weight * np.take(padded, np.arange(i, i + plane.shape[axis]), axis)
        plane = out
    return plane


def _seen(srgb: Array) -> Array:
    """Colours after the eye's filter, in L*a*b*."""
    opponent = _to_opponent(linear(srgb))
    widest = max(b for channel in _SENSITIVITY for _, b in channel)
    radius = int(np.ceil(3 * np.sqrt(widest / (2 * np.pi**2)) * PIXELS_PER_DEGREE))
    x = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
    out = np.empty_like(opponent)
    for channel, parts in enumerate(_SENSITIVITY):
        gaussians = [(a * np.sqrt(np.pi / b), np.exp(-(np.pi**2) * x * x / b)) for a, b in parts]
        total = sum(scale * g.sum() ** 2 for scale, g in gaussians)
        filtered = [scale / total * _filter(opponent[..., channel], g, g) for scale, g in gaussians if scale > 0]
        out[..., channel] = sum(filtered)
    return _hunt(np.clip(_from_opponent(out), 0, 1))


def _features(srgb: Array) -> list[Array]:
    """Strength of edges and of points."""
    grey = (_to_opponent(linear(srgb))[..., 0] + 16) / 116
    sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE
    radius = int(np.ceil(3 * sigma))
    x = np.arange(-radius, radius + 1)
    g = np.exp(-x * x / (2 * sigma * sigma))
    strengths = []
    for kernel in (-x * g, (x * x / sigma**2 - 1) * g):
        # The kernels are separable: their positive parts sum to one with the Gaussian across.
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        across = g / g.sum()
        strengths.append(np.hypot(_filter(grey, across, kernel), _filter(grey, kernel, across)))
    return strengths


def flip(reference: NDArray[Any], test: NDArray[Any]) -> Array:
    """Difference of every pixel."""
    exponent, low, at_low = 0.7, 0.4, 0.95
    most = _hyab(_hunt(np.array([0.0, 1, 0])), _hunt(np.array([0.0, 0, 1]))) ** exponent
    color = _hyab(_seen(reference), _seen(test)) ** exponent
    knee = low * most
    color = np.where(color < knee, at_low / knee * color, at_low + (color - knee) / (most - knee) * (1 - at_low))
    (edge_a, point_a), (edge_b, point_b) = _features(reference), _features(test)
    feature = np.maximum(np.abs(edge_a - edge_b), np.abs(point_a - point_b)) / np.sqrt(2)
    return np.asarray(np.clip(color, 0, 1) ** (1 - np.sqrt(np.clip(feature, 0, 1))))
