"""The request of a benchmark, and its file `request.json` in the folder of the results."""

from __future__ import annotations

import json
import os
import platform
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import gloam

from ..planner import planner_names
from .checks import Fields, read_object
from .episode import EpisodeSpec
from .places import LEVELS, PLACES

REQUEST_FILE = "request.json"
_MAY_DIFFER = {"episodes", "machine", "version", "started"}  # between the calls that continue a benchmark


@dataclass(frozen=True)
class Request:
    """Episodes of a results folder: all planners x scenes x levels x numbers 0 … episodes - 1.

    levels: in order of increasing adversity; tier: of images; log: whether episodes have a run.mcap; machine, version,
    started: text for the page, which keep() fills in.
    """

    planners: tuple[str, ...]
    scenes: tuple[str, ...] = ("house", "warehouse")
    levels: tuple[str, ...] = LEVELS
    episodes: int = 100
    seed: int = 1
    tier: str = "interactive"
    log: bool = True
    machine: str = ""
    version: str = ""
    started: str = ""

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

    def cells(self) -> Iterator[tuple[str, str, str]]:
        """(planner, scene, level) of all cells, scenes first, in the order of the request."""
        return ((p, s, v) for s in self.scenes for v in self.levels for p in self.planners)

    def keep(self, folder: Path) -> None:
        """Writes request.json, or continues the benchmark that the folder holds: with the larger number of episodes, and
        the day of the first call. Errors: UsageError if it holds another one; InputError if its file is not valid."""
        file = folder / REQUEST_FILE
        kept = Request.read(file) if file.is_file() else self
        different = [f.name for f in fields(self) if f.name not in _MAY_DIFFER and getattr(self, f.name) != getattr(kept, f.name)]
        if different:
            raise gloam.UsageError(f"{folder} holds another benchmark ({', '.join(different)} differ)", hint="choose another folder")
        written = replace(
            self,
            episodes=max(self.episodes, kept.episodes),
            machine=_machine(),
            version=gloam.__version__,
            started=kept.started or time.strftime("%Y-%m-%d"),
        )
        part = file.with_suffix(".part")
        part.write_text(json.dumps(asdict(written), indent=1) + "\n", encoding="utf-8")
        part.rename(file)

    @classmethod
    def read(cls, file: Path) -> Request:
        """The request in a file, whose names need not exist here. Errors: IoError; InputError with file and cause."""
        if not file.parent.is_dir():
            raise gloam.IoError("there is no such folder", str(file.parent))
        values = Fields(read_object(file), file)
        return cls(
            values.names("planners"),
            values.names("scenes"),
            values.names("levels"),
            values.integer("episodes", least=1),
            values.integer("seed"),
            values.text("tier"),
            values.boolean("log"),
            values.description("machine"),
            values.text("version"),
            values.text("started"),
        )


def _machine() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        name = next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} processors"
