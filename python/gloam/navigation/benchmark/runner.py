"""`gloam bench nav`: all episodes of planners, scenes and levels, on several processes or machines.

Each episode is one folder, which gets its name when it is complete: a repeated call continues after any interruption,
and runs each episode once.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import gloam
from gloam.experiments.files import locked, remove_parts, whole
from gloam.experiments.words import Remaining

from ..plugins import load_plugin
from .episode import EpisodeSpec, run_episode
from .on_cluster import cluster_results
from .options import check_planners
from .places import Course
from .pool import Died, local_results
from .request import Request

_MOST_CRASHES = 3  # of worker processes with one episode, before the benchmark stops
_PARTS = ("episodes/*/*/*", "maps/*")  # parents of folders that appear when they are complete


@dataclass(frozen=True)
class Workers:
    """Where episodes run. count: processes of this machine, 0 = one for two processors; cluster: address of a Ray cluster
    that runs them instead, "" = none."""

    count: int = 0
    cluster: str = ""

    def single(self, planner: str) -> Workers:
        """One process, for a planner that serves one robot. Errors: gloam.UsageError if more were asked for."""
        if self.cluster or self.count > 1:
            raise gloam.UsageError(f"planner '{planner}' serves one robot at a time, so episodes run in one process", hint="--workers 1")
        return Workers(1)

    def results(
        self, do: Callable[[EpisodeSpec], Result], specs: deque[EpisodeSpec]
    ) -> Generator[tuple[EpisodeSpec, Result | Died], None, None]:
        """Results as they come; specs may grow meanwhile."""
        if self.cluster:
            return cluster_results(do, specs, self.cluster)
        return local_results(do, specs, min(self.count or max(1, (os.cpu_count() or 1) // 2), len(specs)))


Result = dict[str, Any]


def run(
    request: Request, out: Path, workers: Workers | None = None, tell: Callable[[str], None] | None = None
) -> list[Result]:
    """Runs the missing episodes of a folder. Returns all results.

    Errors: UsageError if the request is wrong, or the folder holds another one or is in use; gloam.Error if an episode
    cannot be written, or its process has ended several times.
    """
    request.check()
    workers = workers or Workers()
    planners = check_planners(request.planners, request.options)  # before the folder knows the request
    if single := [name for name, planner in planners.items() if planner.serves_one]:
        workers = workers.single(single[0])
    with locked(out):
        request.keep(out)
        missing = [spec for spec in request.specs() if not _file(out, spec).is_file()]
        if missing:
            remove_parts(out, *_PARTS)
            job = Job(str(out.resolve()), tuple(file.name for file in request.plugins))
            try:
                _run_all(missing, job, workers, tell or (lambda _: None))
            finally:
                remove_parts(out, *_PARTS)
    return [json.loads(_file(out, spec).read_text(encoding="utf-8")) for spec in request.specs()]


def _file(out: Path, spec: EpisodeSpec) -> Path:
    return out / "episodes" / spec.path / "episode.json"


@lru_cache
def _course(place: str) -> Course:
    return Course(place)


@dataclass(frozen=True)
class Job:
    """The work of one episode in a worker. out: folder of the benchmark; plugins: names for load_plugin()."""

    out: str
    plugins: tuple[str, ...] = ()

    def __call__(self, spec: EpisodeSpec) -> Result:
        """Its folder appears when it is complete; if two workers run it, the first one's counts."""
        for plugin in self.plugins:
            load_plugin(plugin)
        out = Path(self.out)
        with whole(out / "episodes" / spec.path) as part:
            return run_episode(spec, _course(spec.place).pair(spec.pair_seed), part, out / "maps")


def _run_all(specs: list[EpisodeSpec], job: Job, workers: Workers, tell: Callable[[str], None]) -> None:
    done, total, remaining = 0, len(specs), Remaining(len(specs))
    crashes: dict[EpisodeSpec, int] = {}
    waiting = deque(_ordered(specs))
    with closing(workers.results(job, waiting)) as results:
        for spec, result in results:
            if isinstance(result, Died):
                crashes[spec] = crashes.get(spec, 0) + 1
                if crashes[spec] >= _MOST_CRASHES:
                    raise gloam.Error(f"the process of {spec.path} ended {_MOST_CRASHES} times: killed, out of memory, or a crash")
                tell(f"the process of {spec.path} ended; it runs again")
                waiting.append(spec)
                continue
            done += 1
            tell(f"{done} of {total}: {spec.path} {result['outcome']}{remaining.after(done)}")


def _ordered(specs: list[EpisodeSpec]) -> list[EpisodeSpec]:
    """Scene by scene within each number, so that workers keep their compiled Worlds."""
    return sorted(specs, key=lambda spec: (spec.number, spec.place, spec.level, spec.planner))

