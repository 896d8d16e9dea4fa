"""The request of a benchmark, and its file `request.json` in the folder of the results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, TypeVar

import gloam
from gloam.experiments.checks import Fields, read_object
from gloam.experiments.request import REQUEST_FILE, STAMP, check_known, check_once, is_folder_name, keep_request

from ..planner import planner_names
from .episode import EpisodeSpec
from .options import File, Option, arguments, read_files, read_options, type_of
from .places import ALL_LEVELS, LEVELS, PLACES

T = TypeVar("T")
_MAY_DIFFER = STAMP | {"episodes"}  # between the calls that continue a benchmark


@dataclass(frozen=True)
class Request:
    """Episodes of a results folder: all planners x scenes x levels x numbers 0 … episodes - 1.

    levels: in order of increasing adversity; tier: of images; log: whether episodes have a run.mcap; options, plugins: of
    planners; machine, version, started: text for the page, which keep() fills in.
    """

    planners: tuple[str, ...]
    scenes: tuple[str, ...] = ("house", "warehouse")
    levels: tuple[str, ...] = LEVELS
    episodes: int = 100
    seed: int = 1
    tier: str = "interactive"
    log: bool = True
    options: tuple[Option, ...] = ()
    plugins: tuple[File, ...] = ()
    machine: str = ""
    version: str = ""
    started: str = ""

    def check(self) -> None:
        """Errors: NotFoundError for an unknown planner, scene or level; UsageError for numbers out of range."""
        check_known("planner", self._types(), planner_names())
        check_known("scene", self.scenes, PLACES)
        check_known("level", self.levels, ALL_LEVELS)
        for kind, asked in (("planner", self.planners), ("scene", self.scenes), ("level", self.levels)):
            check_once(kind, asked)
        if unfit := [name for name in self.planners if not is_folder_name(name)]:
            raise gloam.UsageError(f"a planner's name is also a folder's, which '{unfit[0]}' cannot be")
        if not 1 <= self.episodes <= 100_000 or not 0 <= self.seed < 2**32:
            raise gloam.UsageError("expected 1 to 100000 episodes, and a seed from 0 to 2^32 - 1")

    def _types(self) -> tuple[str, ...]:
        return tuple(type_of(planner, self.options) for planner in self.planners)

    def specs(self) -> Iterator[EpisodeSpec]:
        """All episodes, one of each cell before the second of any: an interrupted run has something of everything."""
        options = {planner: arguments(planner, self.options) for planner in self.planners}
        for number in range(self.episodes):
            for planner, scene, level in self.cells():
                yield EpisodeSpec(planner, scene, level, number, self.seed, self.tier, options[planner], self.log)

    def cells(self) -> Iterator[tuple[str, str, str]]:
        """(planner, scene, level) of all cells, scenes first, in the order of the request."""
        return ((p, s, v) for s in self.scenes for v in self.levels for p in self.planners)

    def keep(self, folder: Path) -> None:
        """Writes request.json, or continues the benchmark that the folder holds: with the larger number of episodes, and
        the day of the first call. Errors: UsageError if it holds another one; InputError if its file is not valid."""
        file = folder / REQUEST_FILE
        kept = Request.read(file) if file.is_file() else self
        written = replace(self, episodes=max(self.episodes, kept.episodes))
        keep_request(folder, asdict(written), _differences(self, kept), kept.started)

    @classmethod
    def read(cls, file: Path) -> Request:
        """The request in a file, whose names need not exist here. Errors: IoError; InputError with file and cause."""
        if not file.parent.is_dir():
            raise gloam.IoError("the folder does not exist", str(file.parent))
        values = Fields(read_object(file), file)
        return cls(
            values.names("planners"),
            values.names("scenes"),
            values.names("levels"),
            values.integer("episodes", least=1),
            values.integer("seed"),
            values.text("tier"),
            values.boolean("log"),
            _parts(values, "options", read_options),
            _parts(values, "plugins", read_files),
            values.description("machine"),
            values.text("version"),
            values.text("started"),
        )


def _differences(first: Request, second: Request) -> list[str]:
    """Names of the fields and options that differ; files differ by their content."""
    names = [f.name for f in fields(first) if f.name not in _MAY_DIFFER | {"options"}]
    options = {str(o) for o in set(first.options) ^ set(second.options)}
    return [name for name in names if getattr(first, name) != getattr(second, name)] + sorted(options)


def _parts(values: Fields, name: str, read: Callable[[Any], tuple[T, ...]]) -> tuple[T, ...]:
    """A list of a request, which has none if it was written before there were options."""
    try:
        return read(values.value(name)) if values.has(name) else ()
    except (KeyError, TypeError, ValueError) as error:
        raise values.error(name, f"cannot be read: {type(error).__name__}: {error}") from None
