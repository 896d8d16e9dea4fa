"""`gloam bench nav`: all episodes of planners, scenes and levels, on several processes, and their report.

Each episode is one folder, which gets its name when it is complete: a repeated call continues after any interruption,
and runs each episode once.
"""

from __future__ import annotations

import fcntl
import json
import multiprocessing
import os
import shutil
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import gloam

from .episode import EpisodeSpec, run_episode
from .places import Course
from .request import Request

_MOST_CRASHES = 3  # of worker processes with one episode, before the benchmark stops


def run(request: Request, out: Path, workers: int = 0, tell: Callable[[str], None] | None = None) -> list[dict[str, Any]]:
    """Runs the missing episodes of a folder. workers: processes; 0 = one for two processors. Returns all results.

    Errors: UsageError if the folder holds another request or is in use.
    """
    request.check()
    with _folder(request, out):
        waiting = [spec for spec in request.specs() if not (out / "episodes" / spec.path / "episode.json").is_file()]
        _run_all(waiting, out, workers or max(1, (os.cpu_count() or 1) // 2), tell or (lambda _: None))
    files = [out / "episodes" / spec.path / "episode.json" for spec in request.specs()]
    return [json.loads(file.read_text(encoding="utf-8")) for file in files]


@contextmanager
def _folder(request: Request, out: Path) -> Iterator[None]:
    """Locks the folder, and keeps its request."""
    out.mkdir(parents=True, exist_ok=True)
    with (out / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise gloam.UsageError(f"{out} is in use by another benchmark") from None
        request.keep(out)
        yield


@lru_cache(maxsize=1)
def _course(place: str) -> Course:
    return Course(place)


def work(spec: EpisodeSpec, out: Path) -> dict[str, Any]:
    """One episode, in a worker: its folder appears when it is complete. The last one wins if two workers run it."""
    folder = out / "episodes" / spec.path
    part = folder.with_name(f".{folder.name}.{os.getpid()}")
    shutil.rmtree(part, ignore_errors=True)
    pair = _course(spec.place).pair(spec.pair_seed)
    result = run_episode(spec, pair, part, out / "maps")
    try:
        part.rename(folder)
    except OSError:
        shutil.rmtree(part, ignore_errors=True)
    return result


def _run_all(specs: list[EpisodeSpec], out: Path, workers: int, tell: Callable[[str], None]) -> None:
    begin, done, total = time.monotonic(), 0, len(specs)
    crashes: dict[EpisodeSpec, int] = {}
    while specs:
        with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
            running = {pool.submit(work, spec, out): spec for spec in _ordered(specs)}
            specs = []
            for spec, future in _as_they_finish(running):
                try:
                    result = future.result()
                except BrokenProcessPool:  # a worker was killed: its episodes are tried again, one crash each at most
                    crashes[spec] = crashes.get(spec, 0) + 1
                    if crashes[spec] > _MOST_CRASHES:
                        raise gloam.Error(f"the process of {spec.path} ended {_MOST_CRASHES} times") from None
                    specs.append(spec)
                    continue
                done += 1
                left = (time.monotonic() - begin) / done * (total - done)
                tell(f"{done} of {total}: {spec.path} {result['outcome']}, {_duration(left)} left")


def _ordered(specs: Iterable[EpisodeSpec]) -> list[EpisodeSpec]:
    """Scene by scene within each number, so that workers keep their compiled Worlds."""
    return sorted(specs, key=lambda spec: (spec.number, spec.place, spec.level, spec.planner))


def _as_they_finish(running: dict[Future[Any], EpisodeSpec]) -> Iterator[tuple[EpisodeSpec, Future[Any]]]:
    while running:
        finished, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in finished:
            yield running.pop(future), future


def _duration(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
