"""Reads the folder of a navigation benchmark: `request.json` and one `episode.json` per finished episode.

Wrong input raises `gloam.InputError` with the file and the cause. Episodes that have no file yet are listed as pending.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from gloam.errors import InputError
from gloam.experiments.checks import Fields, read_object
from gloam.experiments.request import REQUEST_FILE

from .key import Key
from .request import Request

OUTCOMES = ("success", "collided", "fell", "stuck", "lost", "timed_out", "error")


@dataclass(frozen=True)
class Episode:
    """One finished episode. The attributes are the keys of `episode.json`, with `key` for the first four.

    start: (x, y, yaw) [m, rad]; goal: (x, y) [m]; shortest, path_length, final_distance, visibility_*: [m]; limit, time:
    simulation time [s]; wall_seconds, cpu_seconds: cost [s]; plans: answers of the planner, of which `late` came after
    their deadline and `invalid` were NaN or exceptions; visibility_*: None if unknown;
    track: (time [s], x, y [m]) of the robot twice per second and at the end; touches: (time [s], x, y [m], object) of each
    collision. The log begins a second before the episode, so these times are up to 1 s + limit.
    """

    key: Key
    seed: int
    start: tuple[float, ...]
    goal: tuple[float, ...]
    shortest: float
    limit: float
    outcome: str
    success: bool
    collisions: int
    collisions_by_object: dict[str, int]
    time: float
    path_length: float
    final_distance: float
    visibility_mean: float | None
    visibility_min: float | None
    plans: int
    late: int
    invalid: int
    wall_seconds: float
    cpu_seconds: float
    tier: str
    log: str | None
    hash: str
    message: str
    track: tuple[tuple[float, float, float], ...]
    touches: tuple[tuple[float, float, float, str], ...]

    @property
    def sc(self) -> float:
        """Success weighted by collisions S / (1 + c), in [0, 1] (Eftekhar et al. 2024, as in arXiv:2504.14135)."""
        return float(self.success) / (1 + self.collisions)

    @property
    def spl(self) -> float:
        """Success weighted by path length S · l / max(p, l), in [0, 1] (Anderson et al. 2018, arXiv:1807.06757).

        An episode that starts at its goal (l = 0) scores S: no path is shorter than its shortest path.
        """
        if not self.success:
            return 0.0
        return self.shortest / max(self.path_length, self.shortest) if self.shortest > 0 else 1.0


@dataclass(frozen=True)
class Results:
    """All episodes of a folder. episodes: finished ones in the order of the request; pending: positions without a file;
    warnings: sentences about input that is valid but weakens a comparison."""

    folder: Path
    request: Request
    episodes: tuple[Episode, ...]
    pending: tuple[Key, ...]
    warnings: tuple[str, ...]

    def cell(self, planner: str, scene: str, level: str) -> list[Episode]:
        """Finished episodes of a cell, by index."""
        wanted = (planner, scene, level)
        return [e for e in self.episodes if (e.key.planner, e.key.scene, e.key.level) == wanted]


def load_results(folder: str | Path) -> Results:
    """Reads a folder of `gloam bench nav`.

    Errors: gloam.InputError with the file for unreadable JSON, a missing or wrong value, NaN, an unknown outcome, or an
    episode outside of the request; gloam.IoError if a file cannot be read.
    """
    folder = Path(folder)
    request = Request.read(folder / REQUEST_FILE)
    wanted = [Key(p, s, v, n) for p, s, v in request.cells() for n in range(request.episodes)]
    expected = {key.folder: key for key in wanted}
    found: dict[Key, Episode] = {}
    for path in sorted((folder / "episodes").rglob("episode.json")):
        if path.parent.name.startswith("."):  # being written
            continue
        key = expected.get(path.parent.relative_to(folder).as_posix())
        if key is None:
            raise InputError("the request does not contain this episode", str(path), hint="see request.json")
        found[key] = _episode(path, key)
    return Results(
        folder,
        request,
        tuple(found[key] for key in wanted if key in found),
        tuple(key for key in wanted if key not in found),
        _warnings(found.values()),
    )


def _episode(path: Path, key: Key) -> Episode:
    values = Fields(read_object(path), path)
    for name in ("planner", "scene", "level", "episode"):
        if values.value(name) != getattr(key, name):
            raise values.error(name, f"is {values.value(name)!r}, but the folder belongs to {getattr(key, name)!r}")
    read: dict[str, Any] = {"key": key, "outcome": values.text("outcome"), "success": values.boolean("success")}
    if read["outcome"] not in OUTCOMES:
        raise values.error("outcome", f"is {read['outcome']!r}; outcomes are {', '.join(OUTCOMES)}")
    if read["success"] != (read["outcome"] == "success"):
        raise values.error("success", f"is {read['success']}, but the outcome is '{read['outcome']}'")
    read |= {"seed": values.integer("seed"), "start": values.numbers("start", 3), "goal": values.numbers("goal", 2)}
    read |= {name: values.integer(name, least=0) for name in ("collisions", "plans", "late", "invalid")}
    read |= {name: values.text(name) for name in ("tier", "hash", "message")}
    read |= {"log": values.relative_file("log"), "track": values.rows("track", 3), "touches": values.rows("touches", 3, 1)}
    read |= {name: values.optional_length(name) for name in ("visibility_mean", "visibility_min")}
    read["collisions_by_object"] = values.counts("collisions_by_object")
    read |= {field.name: values.length(field.name) for field in fields(Episode) if field.name not in read}
    for name in ("late", "invalid"):
        if read[name] > read["plans"]:
            raise values.error(name, f"is {read[name]}, but the planner gave {read['plans']} answers")
    if sum(read["collisions_by_object"].values()) > read["collisions"]:
        raise values.error("collisions_by_object", f"has more collisions than collisions = {read['collisions']}")
    return Episode(**read)


def _warnings(episodes: Any) -> tuple[str, ...]:
    """Paired tests assume that episodes of one scene and index have the same task at all levels."""
    tasks: dict[tuple[str, int], set[tuple[tuple[float, ...], tuple[float, ...]]]] = {}
    for episode in episodes:
        tasks.setdefault((episode.key.scene, episode.key.episode), set()).add((episode.start, episode.goal))
    different: dict[str, list[int]] = {}
    for (scene, number), places in sorted(tasks.items()):
        if len(places) > 1:
            different.setdefault(scene, []).append(number)
    return tuple(
        f"Scene {scene}: start or goal of episode {', '.join(map(str, numbers))} differs between cells. "
        "Paired tests there compare different tasks."
        for scene, numbers in different.items()
    )
