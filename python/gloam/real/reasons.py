"""Why two sets of images differ: statistics of their appearance, ordered by the size of their differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gloam.experiments.statistics import Estimate

from .distances import GROUPS, cliff_delta, group_of, jackknife
from .network import Floats
from .sets import ImageSet


@dataclass(frozen=True)
class Statistic:
    """key: of appearance.describe(); label, unit, digits: for tables; more, less: adjectives for images whose value is higher or
    lower; per_pixel: whether it depends on the resolution; more_hint, less_hint: causes in a simulation."""

    key: str
    label: str
    unit: str
    digits: int
    more: str
    less: str
    per_pixel: bool = False
    more_hint: str = ""
    less_hint: str = ""


_EXPOSURE = "exposure or the power of the lamps"
_HUE = "temperature of the lamps, white balance, or colours of materials"
_SHARP = "no defocus, no motion blur and no optical low-pass in the simulated lens"
_SOFT = "materials without fine detail, or a denoiser that smooths them"

STATISTICS = (
    Statistic(
        "lightness",
        "lightness",
        "L*",
        1,
        "brighter",
        "darker",
        more_hint=_EXPOSURE,
        less_hint=_EXPOSURE,
    ),
    Statistic(
        "green_red",
        "green to red",
        "a*",
        1,
        "redder",
        "greener",
        more_hint=_HUE,
        less_hint=_HUE,
    ),
    Statistic(
        "blue_yellow",
        "blue to yellow",
        "b*",
        1,
        "yellower",
        "bluer",
        more_hint=_HUE,
        less_hint=_HUE,
    ),
    Statistic(
        "chroma",
        "chroma",
        "C*",
        1,
        "more colourful",
        "less colourful",
        more_hint="saturated colours of materials",
        less_hint="few coloured objects, or grey materials",
    ),
    Statistic(
        "clipped_dark",
        "black pixels",
        "share",
        3,
        "darker in the shadows",
        "brighter in the shadows",
        more_hint="missing indirect light or ambient light",
        less_hint="ambient light that reaches every corner",
    ),
    Statistic(
        "clipped_bright",
        "white pixels",
        "share",
        3,
        "more overexposed",
        "less overexposed",
        more_hint="exposure, or lamps in view",
        less_hint="a tone curve that rolls off",
    ),
    Statistic(
        "lightness_spread",
        "spread of lightness",
        "L*",
        1,
        "higher in contrast",
        "lower in contrast",
        more_hint="hard light from few lamps",
        less_hint="even light, or a place with few objects",
    ),
    Statistic(
        "rms_contrast",
        "RMS contrast",
        "of white",
        3,
        "higher in RMS contrast",
        "lower in RMS contrast",
        more_hint="hard light from few lamps",
        less_hint="even light",
    ),
    Statistic(
        "michelson",
        "Michelson contrast",
        "1st and 99th percentile",
        3,
        "higher in extreme contrast",
        "lower in extreme contrast",
        more_hint="deep shadows",
        less_hint="haze, glare or ambient light",
    ),
    Statistic(
        "dynamic_range",
        "dynamic range",
        "stops",
        1,
        "wider in dynamic range",
        "narrower in dynamic range",
        more_hint="deep shadows",
        less_hint="haze, glare or ambient light",
    ),
    Statistic(
        "noise",
        "noise",
        "grey levels",
        2,
        "noisier",
        "less noisy",
        per_pixel=True,
        more_hint="too few samples per pixel, or more camera noise than the real camera has",
        less_hint="no camera noise: [camera.imager.pixel], docs/sensors.md",
    ),
    Statistic(
        "laplacian",
        "variance of the Laplacian",
        "grey levels²",
        0,
        "sharper in fine detail",
        "softer in fine detail",
        per_pixel=True,
        more_hint=_SHARP,
        less_hint=_SOFT,
    ),
    Statistic(
        "gradient_mean",
        "mean gradient",
        "grey levels/px",
        2,
        "richer in edges",
        "poorer in edges",
        per_pixel=True,
        more_hint=_SHARP,
        less_hint=_SOFT,
    ),
    Statistic(
        "spectral_slope",
        "slope of the power spectrum",
        "log/log",
        2,
        "richer in high frequencies",
        "poorer in high frequencies",
        per_pixel=True,
        more_hint="noise or aliasing",
        less_hint=_SOFT,
    ),
)
_CLEAR = 0.147  # |δ| below which a difference is called negligible (Romano et al. 2006)


@dataclass(frozen=True)
class Difference:
    """Of one statistic. real, other: means; delta: Cliff's δ; standardised: Cohen's d with the pooled deviation, None without a
    spread; is_comparable: False for a number per pixel of images of different sizes."""

    statistic: Statistic
    real: float
    other: float
    delta: Estimate
    standardised: float | None
    is_comparable: bool

    @property
    def sentence(self) -> str:
        """The difference in words, with a possible cause."""
        s, value = self.statistic, self.delta.value or 0.0
        if abs(value) < _CLEAR or (self.delta.low is not None and self.delta.high is not None and self.delta.low <= 0 <= self.delta.high):
            return f"No clear difference of {s.label}."
        higher = value > 0
        hint = s.more_hint if higher else s.less_hint
        size = "Because the images have different sizes, this may be due to the resolution." if not self.is_comparable else ""
        cause = f"Possible cause: {hint}." if hint and not size else size
        return f"The simulated images are {s.more if higher else s.less}. {cause}"


def differences(real: ImageSet, other: ImageSet) -> list[Difference]:
    """All statistics, the largest effect first."""
    sizes = [{(picture.width, picture.height) for picture in one.pictures} for one in (real, other)]
    same_size = sizes[0] == sizes[1] and len(sizes[0]) == 1
    groups = [_groups(one) for one in (real, other)]
    found = []
    for statistic in STATISTICS:
        a, b = (np.array([picture.numbers[statistic.key] for picture in one.pictures]) for one in (real, other))
        parts = [_split(values, of) for values, of in zip((a, b), groups, strict=True)]
        delta = jackknife(_delta, parts[0], parts[1], (-1.0, 1.0))
        a, b = a[np.isfinite(a)], b[np.isfinite(b)]
        means = [float(values.mean()) if len(values) else float("nan") for values in (a, b)]
        found.append(Difference(statistic, means[0], means[1], delta, _standardised(a, b), same_size or not statistic.per_pixel))
    return sorted(found, key=lambda one: (-abs(one.delta.value or 0.0), -abs(one.standardised or 0.0)))


def _groups(one: ImageSet) -> np.ndarray:
    return group_of(np.argsort([picture.hash for picture in one.pictures], kind="stable"))


def _split(values: Floats, groups: np.ndarray) -> list[Floats]:
    parts = [values[groups == k] for k in range(GROUPS)]
    return [part[np.isfinite(part)] for part in parts if len(part)]


def _delta(a: list[Floats], b: list[Floats]) -> float | None:
    return cliff_delta(np.concatenate(a), np.concatenate(b))


def _standardised(a: Floats, b: Floats) -> float | None:
    if len(a) < 2 or len(b) < 2:
        return None
    pooled = np.sqrt(((len(a) - 1) * a.var(ddof=1) + (len(b) - 1) * b.var(ddof=1)) / (len(a) + len(b) - 2))
    return float((b.mean() - a.mean()) / pooled) if pooled > 0 else None
