"""`gloam bench nav`: all episodes of planners, scenes and levels, on several processes, and their report.

Each episode is one folder, which gets its name when it is complete: a repeated call continues after any interruption,
and runs each episode once.
"""

from __future__ import annotations

import fcntl
import json
import multiprocessing
import os
import platform
import shutil
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import gloam

from ..planner import planner_names
from .episode import EpisodeSpec, run_episode
from .places import LEVELS, PLACES, Course

_MOST_CRASHES = 3  # of worker processes with one episode, before the benchmark stops


@dataclass(frozen=True)
class Request:
    """Episodes of a results folder: all planners x scenes x levels x numbers 0 … episodes - 1."""

    planners: tuple[str, ...]
    scenes: tuple[str, ...] = ("house", "warehouse")
    levels: tuple[str, ...] = LEVELS
    episodes: int = 100
    seed: int = 1
    tier: str = "interactive"
    log: bool = True

    def check(self) -> None:
        """Errors: NotFoundError for an unknown planner, scene or level; UsageError for numbers out of range."""
        for kind, asked, known in (
            ("planner", self.planners, planner_names()), ("scene", self.scenes, PLACES), ("level", self.levels, LEVELS),
        ):  # fmt: skip
            for name in asked:
                if name not in known:
                    raise gloam.NotFoundError(f"there is no {kind} '{name}'; there are: {', '.join(known)}")
            if not asked or len(set(asked)) != len(asked):
                raise gloam.UsageError(f"name each {kind} once, got {', '.join(asked) or 'none'}")
        if not 1 <= self.episodes <= 100_000 or not 0 <= self.seed < 2**32:
            raise gloam.UsageError("expected 1 to 100000 episodes, and a seed from 0 to 2^32 - 1")

    def specs(self) -> Iterator[EpisodeSpec]:
        """All episodes, one of each cell before the second of any: an interrupted run has something of everything."""
        for number in range(self.episodes):
            for scene in self.scenes:
                for level in self.levels:
                    for planner in self.planners:
                        yield EpisodeSpec(planner, scene, level, number, self.seed, self.tier, log=self.log)


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
    """Locks the folder, and writes or compares its request."""
    out.mkdir(parents=True, exist_ok=True)
    with (out / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise gloam.UsageError(f"{out} is in use by another benchmark") from None
        file = out / "request.json"
        asked = json.loads(json.dumps(asdict(request)))
        if file.is_file():
            kept = json.loads(file.read_text(encoding="utf-8"))
            different = sorted(key for key in asked if key != "episodes" and kept.get(key) != asked[key])
            if different:
                raise gloam.UsageError(f"{out} holds another benchmark ({', '.join(different)} differ)", hint="choose another folder")
        asked |= {"machine": _machine(), "version": gloam.__version__, "started": time.strftime("%Y-%m-%d")}
        part = file.with_suffix(".part")
        part.write_text(json.dumps(asked, indent=1) + "\n", encoding="utf-8")
        part.rename(file)
        yield


def _machine() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        name = next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} processors"


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
