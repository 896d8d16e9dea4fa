"""Videos of the median and the worst run of each method, scene and level (run_view.py), at twice the speed of the sequence."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gloam.experiments.checks import read_object
from gloam.experiments.files import locked
from gloam.experiments.optional import require
from gloam.experiments.request import REQUEST_FILE
from gloam.experiments.videos import Film, write_films

from .adapters import contract
from .charts import aligned, plan_of_tour, visibility
from .estimate import NO_POSES, read_features, read_run, read_tum
from .methods import Method, load_method
from .results import Key, Row, case_of, load_rows
from .run_view import RunView, Shown
from .sequence import TRUTH, TRUTH_LIDAR
from .summary import summarize

_RATE, _SPEED = 10.0, 2.0  # images per second of the sequence at most [Hz]; speed of the video relative to it


def render_videos(out: Path, progress: Callable[[str], None]) -> list[str]:
    """Renders the missing videos, and removes videos of other runs. progress: gets a line per video.

    Returns a sentence for each video that could not be rendered, such as on a full disk; another call tries again. Errors:
    gloam.UsageError if another process uses the folder; gloam.UnsupportedError without matplotlib or Pillow.
    """
    require("matplotlib")
    require("PIL.Image")
    request = read_object(out / REQUEST_FILE)
    with locked(out):
        rows = load_rows(out, request)
        methods = {method.name: method for method in map(load_method, request["methods"])}
        films = [_film(out, methods[cell.method], row) for cell in summarize(rows, request["seed"]) for row in cell.examples]
        return write_films([out / "runs" / Key.of(row).path for row in rows], films, progress)


def _film(out: Path, method: Method, row: Row) -> Film:
    key = Key.of(row)
    times = [stamp for stamp, _ in _frames(case_of(out, key.scene, key.level), method)]
    rate = 1 / float(np.median(np.diff(times))) if len(times) > 1 else _RATE
    step = max(1, round(rate / _RATE))

    def images(_: Path) -> Iterator[Any]:
        return RunView(_shown(out, method, row)).images(step)

    return Film(out / "runs" / key.path, str(key.path), rate / step * _SPEED, images)


def _frames(case: Path, method: Method) -> list[tuple[float, Path]]:
    return contract.Sequence(case / "sequence").files("scans" if method.has_lidar else "rgb")


def _shown(out: Path, method: Method, row: Row) -> Shown:
    key = Key.of(row)
    home, case = out / "runs" / key.path, case_of(out, key.scene, key.level)
    truth = read_tum(case / (TRUTH_LIDAR if method.has_lidar else TRUTH))
    found = read_run(home)
    poses = found.trajectory if row["state"] == "ok" else NO_POSES
    places = aligned(poses, truth, method.is_metric)
    if places is None:
        poses, places = NO_POSES, np.zeros((0, 3))
    end = "" if row["state"] == "ok" else f": {row['state'].replace('_', ' ')}"
    files = _frames(case, method)
    return Shown(
        f"{key.method} · {key.scene} · {key.level} · run {key.number}{end}",
        np.array([stamp for stamp, _ in files]), tuple(file for _, file in files), found.frames, read_features(home),
        truth, poses.times, places[:, :2], visibility(case)[:, [0, 2]], plan_of_tour(out, key.scene),
    )  # fmt: skip
