"""Videos of chosen runs: which ones are missing or out of date, and how each is written."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import gloam

from .movie import write_movie
from .words import Remaining

VIDEO, POSTER = "video.mp4", "poster.jpg"
_WORK = ".video-"  # begins the names of folders of videos that are being written
Run = TypeVar("Run")


@dataclass(frozen=True)
class Film:
    """A video to be written. home: folder of its run; name: in messages; rate: images per second; images: composes them (PIL,
    RGB, of one size of even numbers), with a new folder for its files."""

    home: Path
    name: str
    rate: float
    images: Callable[[Path], Iterable[Any]]


def median_and_worst(runs: Sequence[Run], goodness: Callable[[Run], Any]) -> tuple[Run, Run] | None:
    """The median and the worst of runs by a key that sorts them from bad to good; None without any. Of an even number, the
    median is the better one of the two in the middle, so that it is not the worst of two."""
    ranked = sorted(runs, key=goodness)
    return (ranked[len(ranked) // 2], ranked[0]) if ranked else None


def write_films(homes: Iterable[Path], films: Sequence[Film], progress: Callable[[str], None]) -> list[str]:
    """Writes the films whose runs have no video, each with a poster, its last image. Removes videos of other runs, and remains
    of interrupted calls. The caller holds the lock of the results.

    homes: folders of all runs; progress: gets a line per video. Returns a sentence for each video that could not be written, such as
    on a full disk; another call tries again.
    """
    _remove_others(homes, {film.home for film in films})
    waiting = [film for film in films if not (film.home / VIDEO).is_file()]
    problems, remaining = [], Remaining(len(waiting))
    for done, film in enumerate(waiting):
        progress(f"video {done + 1} of {len(waiting)}: {film.name}{remaining.after(done)}")
        try:
            _write(film)
        except gloam.Error as error:
            problems.append(f"no video of {film.name}: {error}")
    return problems


def _remove_others(homes: Iterable[Path], kept: set[Path]) -> None:
    for home in homes:
        for file in () if home in kept else (VIDEO, POSTER):
            (home / file).unlink(missing_ok=True)
        for work in home.glob(f"{_WORK}*"):
            shutil.rmtree(work, ignore_errors=True)


def _write(film: Film) -> None:
    try:
        with tempfile.TemporaryDirectory(dir=film.home, prefix=_WORK) as name:
            work = Path(name)
            last: list[Any] = []
            write_movie(work / VIDEO, _noted(film.images(work), last), film.rate)
            last[0].save(work / POSTER, "JPEG", quality=80)
            # The video comes last: where it exists, the poster does too.
            (work / POSTER).replace(film.home / POSTER)
            (work / VIDEO).replace(film.home / VIDEO)
    except OSError as error:
        raise gloam.IoError(f"cannot write the video: {error.strerror or error}", str(film.home / VIDEO)) from error


def _noted(images: Iterable[Any], last: list[Any]) -> Iterator[Any]:
    """The same images; `last` keeps the last one."""
    for image in images:
        last[:] = [image]
        yield image
