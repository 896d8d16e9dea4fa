"""Videos of the median and the worst episode of each cell, rendered from their logs.

A video shows the image of the robot's camera beside its route on the floor plan, at twice the speed of the simulation. A
finished one is kept until another episode is the median or the worst.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gloam
from gloam.experiments.files import locked
from gloam.experiments.optional import require
from gloam.experiments.videos import Film, write_films

from ..grid import Grid
from .floor_plan import plan_of
from .places import CAMERA
from .results import Episode, Results, load_results
from .route_view import RouteView
from .summary import median_and_worst_of

_RATE, _SPEED = 4.0, 2.0  # images per second of simulation time [Hz]; speed of the video relative to it
_CAMERA_SIZE = (160, 120)  # as for networks: four times as many pixels would cost four times as much [px]
_VIEW, _TITLE = (320, 240), 24  # the camera's image and the map, and the height of the title [px]


def render_videos(folder: Path, progress: Callable[[str], None]) -> list[str]:
    """Renders the missing videos, and removes videos of other episodes. progress: gets a line per video.

    Returns a sentence for each video that could not be rendered, such as on a full disk; another call tries again. Errors:
    gloam.UsageError if another process uses the folder; as load_results; gloam.UnsupportedError without matplotlib.
    """
    require("matplotlib")
    results = load_results(folder)
    with locked(folder):
        homes = [folder / e.key.folder for e in results.episodes]
        return write_films(homes, [_film(folder, e) for e in chosen_episodes(results)], progress)


def chosen_episodes(results: Results) -> list[Episode]:
    """The median and the worst episode of each cell that have a log, without repetitions."""
    pairs = (median_and_worst_of(results.cell(*cell)) for cell in results.request.cells())
    chosen = {e.key: e for pair in pairs for e in pair if e is not None}
    return [e for e in chosen.values() if e.log and (results.folder / e.key.folder / e.log).is_file()]


def _film(folder: Path, episode: Episode) -> Film:
    home = folder / episode.key.folder

    def images(work: Path) -> Iterator[Any]:
        plan = plan_of(folder, episode.key.scene, episode.key.level)
        return _composed(_replayed(home / str(episode.log), work / "replay"), RouteView(episode, plan, _VIEW), episode)

    return Film(home, episode.key.name, _RATE * _SPEED, images)


def _replayed(log: Path, out: Path) -> list[Path]:
    """Images of the robot's camera, `_RATE` per second."""
    gloam.replay(log).replay(
        out, outputs=["png"], cameras=[CAMERA], width=_CAMERA_SIZE[0], height=_CAMERA_SIZE[1], rate=_RATE,
        settings={"render.tier": "interactive"}, progress=False,
    )  # fmt: skip
    images = sorted(out.rglob("*.png"))
    if not images:
        raise gloam.InputError("the replay has no images", str(log))
    return images


def _composed(images: list[Path], route: RouteView, episode: Episode) -> Iterator[Any]:
    """Images of the video."""
    pillow = require("PIL.Image")
    times = [t for t, *_ in episode.touches]
    for k, path in enumerate(images):
        now = k / _RATE
        canvas = pillow.new("RGB", (2 * _VIEW[0], _TITLE + _VIEW[1]), "white")
        with pillow.open(path) as own:
            canvas.paste(own.convert("RGB").resize(_VIEW), (0, _TITLE))
        canvas.paste(route.at(now), (_VIEW[0], _TITLE))
        canvas.paste(route.title(now, bisect_right(times, now), (canvas.width, _TITLE)), (0, 0))
        yield canvas
