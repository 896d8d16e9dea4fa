"""Charts of the page, as SVG."""

from __future__ import annotations

from typing import Any

import numpy as np

from gloam.experiments.charts import INK, PALETTE, Chart

from .appearance import GRADIENT_BINS, LIGHTNESS_BINS
from .compare import REAL, Comparison, features_file
from .network import Floats, Network

_MOST_POINTS = 1000  # of a set
_MARKERS = "osD^vPX*"


def _color(name: str, k: int) -> str:
    return INK if name == REAL else PALETTE[(k - 1) % len(PALETTE)]


def histogram_chart(found: Comparison) -> str:
    """Lightness and gradients of all sets."""
    with Chart(11, 3.2, "real histograms") as chart:
        left, right = chart.figure.subplots(1, 2)
        for k, (name, one) in enumerate(found.sets.items()):
            style = {"color": _color(name, k), "label": name, "linewidth": 2.4 if k < 2 else 1.1}
            left.plot((LIGHTNESS_BINS[1:] + LIGHTNESS_BINS[:-1]) / 2, 100 * one.histograms["lightness"], **style)
            right.plot(GRADIENT_BINS[1:], 100 * one.histograms["gradient"], **style)
        left.set_xlabel("lightness L*")
        left.set_ylabel("share of pixels [%]")
        right.set_xlabel("gradient [grey levels/px]")
        right.set_xscale("log")
        right.set_xticks([0.3, 1, 3, 10, 30, 100], ["0.3", "1", "3", "10", "30", "100"])
        right.minorticks_off()
        left.legend(frameon=False)
    return chart.svg


def feature_chart(found: Comparison, network: Network) -> str:
    """Images of all sets on the first two principal components of their features."""
    rows = {name: _some(np.load(features_file(found, network, name, "features"), mmap_mode="r")) for name in found.sets}
    everything = np.vstack(list(rows.values()))
    mean = everything.mean(axis=0)
    _, s, axes = np.linalg.svd(everything - mean, full_matrices=False)
    shares = np.pad(s**2 / max(float((s**2).sum()), 1e-300), (0, 2))
    with Chart(7.2, 4.6, f"real features {network.settings.name}") as chart:
        axis = chart.figure.subplots()
        for k, (name, values) in enumerate(rows.items()):
            places = (values - mean) @ axes[:2].T
            places = np.pad(places, ((0, 0), (0, 2 - places.shape[1])))
            axis.scatter(*places.T, s=18, alpha=0.75, color=_color(name, k), marker=_MARKERS[k % len(_MARKERS)], label=name, linewidths=0)
        axis.set_xlabel(f"component 1 ({100 * shares[0]:.0f} % of the variance)")
        axis.set_ylabel(f"component 2 ({100 * shares[1]:.0f} % of the variance)")
        chart.figure.legend(loc="outside right upper", frameon=False)
    return chart.svg


def _some(rows: Any) -> Floats:
    """Evenly spaced rows of a mapped file."""
    return np.asarray(rows[:: max(1, -(-len(rows) // _MOST_POINTS))], np.float64)
