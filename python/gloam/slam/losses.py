"""Where runs lose their track: along the path, with the extinction there."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from .adapters.contract import LOST, TRACKED
from .charts import visibility
from .estimate import read_run, read_tum
from .results import Key, Row, case_of
from .sequence import TRUTH


@dataclass(frozen=True)
class Loss:
    """The first lost frame after a tracked one. distance: of the camera along its true path [m]; extinction: at the camera [1/m]."""

    distance: float
    extinction: float


@dataclass(frozen=True)
class Losses:
    """Of one run. places: in order; tracks: whether any frame is tracked."""

    places: tuple[Loss, ...]
    tracks: bool


def find_losses(out: Path, row: Row) -> Losses:
    """The losses of a run (results.load_rows). A method that does not write the states of its frames has none."""
    key = Key.of(row)
    case = case_of(out, key.scene, key.level)
    frames = read_run(out / "runs" / key.path).frames
    lost = [now.time for before, now in pairwise(frames) if (before.state, now.state) == (TRACKED, LOST)]
    truth = read_tum(case / TRUTH)
    steps = np.linalg.norm(np.diff(truth.poses[:, :3], axis=0), axis=1)
    distances = np.interp(lost, truth.times, np.concatenate([[0.0], np.cumsum(steps)]))
    times, _, extinction = visibility(case).T
    places = tuple(Loss(float(d), float(e)) for d, e in zip(distances, np.interp(lost, times, extinction), strict=True))
    return Losses(places, any(frame.state == TRACKED for frame in frames))
