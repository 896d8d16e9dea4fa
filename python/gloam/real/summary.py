"""Numbers of a comparison: each set of images against the photographs, by each network, and each pair."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gloam.experiments.statistics import Estimate, bootstrap_mean, generator

from .cam import intersection_over_union, overlap
from .compare import REAL, Comparison, Pair, class_of, features_file, likeness, response
from .distances import (
    GROUPS, KernelSums, Moments, class_distribution, cosine, frechet, group_of, jackknife, kl_divergence, moments,
)  # fmt: skip
from .network import Floats, Network

HALVES = "halves of real"
SET_MEASURES = ("cosine_of_means", "kl_of_means", "fid", "kid")
PAIR_MEASURES = ("cosine", "kl", "grad_overlap", "grad_iou", "eigen_overlap", "eigen_iou")
LIKENESS = ("flip", "ssim")
_KID_IMAGES = 2000  # of a set at most: the estimate is unbiased for any number
_FEW = 4  # real images for halves
Row = dict[str, Any]


@dataclass(frozen=True)
class Line:
    """Of the table. network: its name; count: images; rank: dimensions that the features of a set may have, of `dimensions`;
    measures: SET_MEASURES, and the means of PAIR_MEASURES and LIKENESS over pairs."""

    network: str
    name: str
    count: int
    real_count: int
    dimensions: int
    measures: dict[str, Estimate]

    @property
    def is_deficient(self) -> bool:
        """Whether the covariance of a set has no full rank, so that FID depends on the number of images."""
        return min(self.count, self.real_count) <= self.dimensions


@dataclass
class _Sample:
    """Features and class distributions of a set in groups for the jackknife, and up to _KID_IMAGES rows of features."""

    moments: list[Moments]
    mean_classes: list[Floats]
    counts: list[int]
    rows: Floats
    row_groups: NDArray[np.int64]

    @property
    def size(self) -> int:
        """Number of features."""
        return len(self.moments[0].mean)

    def half(self, which: int) -> _Sample:
        """Every second group, from the first (0) or second (1)."""
        keep = list(range(which, len(self.moments), 2))
        mask = np.isin(self.row_groups, keep)
        renumbered = np.searchsorted(keep, self.row_groups[mask])
        return _Sample(
            [self.moments[k] for k in keep], [self.mean_classes[k] for k in keep], [self.counts[k] for k in keep],
            self.rows[mask], renumbered,
        )  # fmt: skip


def summarize(found: Comparison) -> tuple[list[Line], list[Row]]:
    """Lines of the table, and a row for each pair and network. Without a network, only the likeness of pairs, as network ""."""
    lines, rows = [], []
    networks: tuple[Network | None, ...] = found.networks or (None,)
    for network in networks:
        label = network.settings.name if network else ""
        real = _sample(found, network, REAL) if network else None
        for name in found.request.others:
            mine = [_pair_row(found, network, name, pair) for pair in found.pairs.get(name, ())]
            measures: dict[str, Estimate] = {}
            if network and real:
                measures |= _distances(real, _sample(found, network, name), found.request.smoothing)
            for key in (*(PAIR_MEASURES if network else ()), *LIKENESS) if mine else ():
                values = [row[key] for row in mine if row[key] is not None]
                measures[key] = bootstrap_mean(values, generator(0, f"{label}/{name}/{key}"))
            if measures:
                counts = len(found.sets[name].pictures), len(found.sets[REAL].pictures)
                lines.append(Line(label, name, *counts, real.size if real else 0, measures))
            rows += mine
        if real and len(real.moments) >= _FEW:
            halves = real.half(0), real.half(1)
            measures = _distances(*halves, found.request.smoothing)
            lines.append(Line(label, HALVES, sum(halves[1].counts), sum(halves[0].counts), real.size, measures))
    return lines, rows


def _sample(found: Comparison, network: Network, name: str) -> _Sample:
    features = np.load(features_file(found, network, name, "features"), mmap_mode="r")
    scores = np.load(features_file(found, network, name, "scores"), mmap_mode="r")
    order = np.argsort([picture.hash for picture in found.sets[name].pictures], kind="stable")
    groups = group_of(order)
    kept = [np.flatnonzero(groups == k) for k in range(GROUPS) if (groups == k).any()]
    source = scores if scores.shape[1] else features
    means = [_mean_distribution(source, rows, found.request.temperature) for rows in kept]
    few = order[:_KID_IMAGES]
    return _Sample(
        [_moments_of(features, rows) for rows in kept], means, [len(rows) for rows in kept],
        np.asarray(features[np.sort(few)], np.float64), groups[np.sort(few)],
    )  # fmt: skip


def _moments_of(features: NDArray[Any], rows: NDArray[Any]) -> Moments:
    return moments(features[rows])


def _mean_distribution(source: NDArray[Any], rows: NDArray[Any], temperature: float) -> Floats:
    total: Any = 0.0
    for row in rows:
        total = total + class_distribution(np.asarray(source[row], np.float64), temperature)
    return np.asarray(total / len(rows))


def _distances(a: _Sample, b: _Sample, smoothing: float) -> dict[str, Estimate]:
    """SET_MEASURES of b against a."""
    pairs = [list(zip(one.mean_classes, one.counts, strict=True)) for one in (a, b)]
    sums = KernelSums(a.rows, a.row_groups, b.rows, b.row_groups)

    def mean(parts: list[tuple[Floats, int]]) -> Floats:
        return np.average([part for part, _ in parts], axis=0, weights=[count for _, count in parts])

    def mean_features(parts: list[Moments]) -> Floats:
        return np.average([part.mean for part in parts], axis=0, weights=[part.count for part in parts])

    def kid(x: list[int], y: list[int]) -> float | None:
        return sums.kid(x, y)

    return {
        "cosine_of_means": jackknife(lambda x, y: cosine(mean_features(x), mean_features(y)), a.moments, b.moments, (-1.0, 1.0)),
        "kl_of_means": jackknife(lambda x, y: kl_divergence(mean(x), mean(y), smoothing), pairs[0], pairs[1], (0.0, np.inf)),
        "fid": jackknife(frechet, a.moments, b.moments, (0.0, np.inf)),
        "kid": jackknife(kid, list(range(len(a.moments))), list(range(len(b.moments)))),
    }


def _pair_row(found: Comparison, network: Network | None, name: str, pair: Pair) -> Row:
    """PAIR_MEASURES and LIKENESS of a pair with the names of its files."""
    row: Row = {
        "network": network.settings.name if network else "", "set": name,
        "real": found.sets[REAL].pictures[pair.real].name, "other": found.sets[name].pictures[pair.other].name,
        **(_network_row(found, network, name, pair) if network else {}),
    }  # fmt: skip
    same = likeness(found, name, pair)
    for kind in LIKENESS:
        row[kind] = float(same[kind]) if np.isfinite(same[kind]) else None
    return {**row, "reason": str(same["reason"])}


def _network_row(found: Comparison, network: Network, name: str, pair: Pair) -> Row:
    request = found.request
    real = response(found, network, REAL, pair.real, request.class_number if network.tail else None)
    number = class_of(found, real["scores"])
    other = response(found, network, name, pair.other, number)
    source = "scores" if len(real["scores"]) else "features"
    p, q = (class_distribution(one[source].astype(np.float64), request.temperature) for one in (real, other))
    row: Row = {
        "class": number,
        "cosine": cosine(real["features"].astype(np.float64), other["features"].astype(np.float64)),
        "kl": kl_divergence(p, q, request.smoothing),
    }
    for kind, key in (("grad", f"grad_{number}"), ("eigen", "eigen")):
        both = (real[key], other[key]) if key in real else None
        row[f"{kind}_overlap"] = overlap(*both) if both else None
        row[f"{kind}_iou"] = intersection_over_union(*both) if both else None
    return row
