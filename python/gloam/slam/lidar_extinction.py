"""Extinction along a tour from its LiDAR alone: how much weaker the same beams return from the same surfaces than in clear air."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SAME = 0.1  # difference of ranges of one surface [m]
_NEAREST, _FARTHEST = 1.0, 20.0  # of surfaces: nearer ones hardly dim, farther ones have few returns [m]
_FEWEST = 20  # beams of a scan


def extinction_of_scans(case: Path, clear: Path) -> Array:
    """(n, 2): time [s] and extinction [1/m] at the wavelength of the LiDAR, the mean between LiDAR and surfaces, NaN with too few beams.

    case, clear: folders of one tour under a level and in clear air, so that both have the same beams. A surface at range r
    returns exp(-2 extinction r) of its intensity in clear air; the answer is the median over beams that hit the same surface in
    both. It has no rows if one of them lacks scans.
    """
    scans, references = _index(case), _index(clear)
    rows = [(time, _extinction(_beams(scans[time]), _beams(references[time]))) for time in sorted(scans.keys() & references.keys())]
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def _index(case: Path) -> dict[float, Path]:
    file = case / "sequence" / "scans.txt"
    if not file.is_file():
        return {}
    lines = [line.split() for line in file.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {float(time): case / "sequence" / name for time, name in lines}


def _beams(file: Path) -> tuple[NDArray[np.int64], Array, Array]:
    """Key of each beam, which its firing time and elevation give; range [m]; intensity."""
    x, y, z, intensity, time = np.fromfile(file, np.float32).reshape(-1, 5).astype(np.float64).T
    distance = np.sqrt(x**2 + y**2 + z**2)
    elevation = np.degrees(np.arcsin(z / np.maximum(distance, 1e-9)))
    key = np.round(time * 1e6).astype(np.int64) * 1024 + np.round(elevation * 2).astype(np.int64)
    key, first = np.unique(key, return_index=True)
    return key, distance[first], intensity[first]


def _extinction(scan: tuple[NDArray[np.int64], Array, Array], clear: tuple[NDArray[np.int64], Array, Array]) -> float:
    _, here, there = np.intersect1d(scan[0], clear[0], assume_unique=True, return_indices=True)
    distance, reference = scan[1][here], clear[1][there]
    weak, full = scan[2][here], clear[2][there]
    good = (np.abs(distance - reference) < _SAME) & (reference > _NEAREST) & (reference < _FARTHEST) & (weak > 0) & (full > 0)
    if good.sum() < _FEWEST:
        return float("nan")
    return float(np.median(-np.log(weak[good] / full[good]) / (2 * reference[good])))
