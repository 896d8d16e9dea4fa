"""Statistics of one image that explain why images differ: colour, contrast, noise and sharpness."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .flip import Array, lab, linear, luminance
from .images import Image

VERSION = 1  # of the definitions; cached numbers of others are computed again
LIGHTNESS_BINS = np.linspace(0, 100, 41)  # of L*
GRADIENT_BINS = np.concatenate([[0], np.geomspace(0.25, 256, 41)])  # of grey levels per pixel
LUMA = np.array([0.299, 0.587, 0.114])  # Rec. 601, as the authors of SSIM convert to grey
_MAD = 0.6744897501960817  # median of |x| of a normal distribution with a standard deviation of 1
_FLOOR = 1 / 255 / 12.92  # linear value of the lowest grey level, below which 8 bits hold no ratios
_BAND = (0.04, 0.4)  # of the power spectrum's slope [cycles/px]: above gradual shading, below the limit of sampling


def grey_of(image: Image) -> Array:
    """Grey levels, (height, width), 0 … 255."""
    return np.asarray(image.astype(np.float64) @ LUMA)


def describe(image: Image) -> tuple[dict[str, float], dict[str, NDArray[Any]]]:
    """Statistics by name (reasons.STATISTICS describes them), and histograms "lightness" and "gradient" that sum to 1."""
    rgb = linear(image / 255.0)
    colour, grey = lab(rgb), grey_of(image)
    lightness = colour[..., 0]
    light = luminance(rgb)
    low, high = (max(float(value), _FLOOR) for value in np.percentile(light, [1, 99]))
    gradient = _gradient(grey)
    numbers = {
        "lightness": lightness.mean(),
        "green_red": colour[..., 1].mean(),
        "blue_yellow": colour[..., 2].mean(),
        "chroma": np.hypot(colour[..., 1], colour[..., 2]).mean(),
        "clipped_dark": (image.max(axis=2) <= 2).mean(),
        "clipped_bright": (image.max(axis=2) >= 253).mean(),
        "lightness_spread": lightness.std(),
        "rms_contrast": grey.std() / 255,
        "michelson": (high - low) / (high + low),
        "dynamic_range": np.log2(high / low),
        "noise": _noise(grey),
        "laplacian": _laplacian_variance(grey),
        "gradient_mean": gradient.mean(),
        "spectral_slope": _spectral_slope(grey),
    }
    histograms = {
        "lightness": _histogram(lightness, LIGHTNESS_BINS),
        "gradient": _histogram(gradient, GRADIENT_BINS),
    }
    return {name: float(value) for name, value in numbers.items()}, histograms


def _histogram(values: Array, bins: NDArray[Any]) -> NDArray[Any]:
    counts, _ = np.histogram(np.clip(values, bins[0], bins[-1]), bins)
    return counts / values.size


def _noise(grey: Array) -> float:
    """Standard deviation of the noise [grey levels]: Immerkaer's mask (1996, "Fast noise variance estimation"), which removes
    constant, linear and quadratic shading, with the median of absolute values in place of the mean, because edges raise a mean."""
    rows = grey[:-2] - 2 * grey[1:-1] + grey[2:]
    filtered = rows[:, :-2] - 2 * rows[:, 1:-1] + rows[:, 2:]
    return float(np.median(np.abs(filtered)) / (_MAD * 6))  # 6 = root of the sum of squares of the mask


def _laplacian_variance(grey: Array) -> float:
    inner = grey[1:-1, 1:-1]
    return float((grey[:-2, 1:-1] + grey[2:, 1:-1] + grey[1:-1, :-2] + grey[1:-1, 2:] - 4 * inner).var())


def _gradient(grey: Array) -> Array:
    """Magnitude by central differences [grey levels per pixel]."""
    return np.hypot((grey[1:-1, 2:] - grey[1:-1, :-2]) / 2, (grey[2:, 1:-1] - grey[:-2, 1:-1]) / 2)


def _spectral_slope(grey: Array) -> float:
    """Slope of log power over log frequency, about -2 for photographs (Field 1987); more negative = softer. Hann window, 12 rings
    of equal width in log frequency; NaN for an image of one grey level."""
    window = np.outer(np.hanning(grey.shape[0] + 2)[1:-1], np.hanning(grey.shape[1] + 2)[1:-1])
    mean = (grey * window).sum() / window.sum()
    power = np.abs(np.fft.rfft2((grey - mean) * window)) ** 2
    radius = np.hypot(np.fft.fftfreq(grey.shape[0])[:, None], np.fft.rfftfreq(grey.shape[1])[None])
    edges = np.geomspace(*_BAND, 13)
    ring = np.digitize(radius.ravel(), edges)
    counts = np.bincount(ring, minlength=14)[1:13]
    sums = np.bincount(ring, power.ravel(), minlength=14)[1:13]
    filled = (counts > 0) & (sums > 1e-9 * counts)
    if filled.sum() < 3:
        return float("nan")
    middles = np.log(np.sqrt(edges[1:] * edges[:-1]))[filled]
    return float(np.polyfit(middles, np.log(sums[filled] / counts[filled]), 1)[0])
