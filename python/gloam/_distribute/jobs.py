"""Jobs for workers: one task is one call with a seed and a folder. Jobs are pickled and sent to workers."""

from __future__ import annotations

import json
import shutil
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from ..errors import Error, UsageError
from .manifest import PART, TASK_FILE, publish, read_task, write_json


class Job(Protocol):
    """Fills a new folder by a seed and returns the content of its task.json. The same seed gives the same results."""

    def __call__(self, folder: Path, seed: int) -> dict[str, Any]: ...


@dataclass(frozen=True)
class VariantJob:
    """One replay of a log with values drawn by the [[randomize]] tables of a file, as in `gloam replay
    --variants`."""

    log: str
    randomize: str
    options: Mapping[str, Any]

    def __call__(self, folder: Path, seed: int) -> dict[str, Any]:
        import gloam

        made = gloam.replay(self.log).variants(
            self.randomize, 1, folder.parent / f"{folder.name}-all", first_seed=seed, progress=False, **self.options
        )
        made[0].out.rename(folder)
        shutil.rmtree(folder.parent / f"{folder.name}-all")
        return {}


@dataclass(frozen=True)
class SceneSource:
    """A scene that can be sent: a file, or a text with the folder that its paths begin at."""

    file: str = ""
    text: str = ""
    folder: str = "."

    def load(self) -> Any:
        import gloam

        return gloam.Scene(self.file) if self.file else gloam.Scene.parse(self.text, self.folder)


@dataclass(frozen=True)
class RolloutJob:
    """One simulation by a seed: a function that steps it, or a policy that controls a robot for a time."""

    scene: SceneSource
    drive: Any  # function(sim, seed, folder) -> mapping or None; else a Policy
    settings: Mapping[str, Any] = field(default_factory=dict)
    robot: str = ""
    command: tuple[float, float, float] = (0.0, 0.0, 0.0)
    duration: float = 0.0
    topics: Sequence[str] | None = None

    def __call__(self, folder: Path, seed: int) -> dict[str, Any]:
        import gloam

        folder.mkdir()
        with gloam.load(self.scene.load(), seed=seed, settings=dict(self.settings), progress=False) as sim:
            if self.topics is None:
                result = self._drive(sim, seed, folder)
            else:
                with sim.record(folder / "run.mcap", list(self.topics)):
                    result = self._drive(sim, seed, folder)
            return {"steps": sim.step_count, "time": sim.time, "hash": f"{sim.hash:016x}", "result": result}

    def _drive(self, sim: Any, seed: int, folder: Path) -> dict[str, Any]:
        if callable(self.drive):
            result = self.drive(sim, seed, folder)
            if result is not None and not isinstance(result, Mapping):
                raise TypeError(f"the function must return a dict or None, got a {type(result).__name__}")
            return _plain(result or {})
        robot = self.robot or next(iter(sim.world.robots), "")
        with self.drive.attach(sim, robot) as driver:
            driver.command(*self.command)
            sim.run_until(time=self.duration)
        return {}


def _plain(result: Mapping[str, Any]) -> dict[str, Any]:
    """Results as JSON holds them: NumPy's numbers and arrays become numbers and lists. Raises UsageError: NaN, or a
    value that JSON cannot represent."""

    def convert(value: Any) -> Any:
        if hasattr(value, "tolist"):
            return value.tolist()
        raise TypeError(f"a {type(value).__name__} cannot be written as JSON")

    try:
        made: dict[str, Any] = json.loads(json.dumps(dict(result), default=convert, allow_nan=False))
    except (TypeError, ValueError) as error:
        raise UsageError(
            f"the function's result cannot be written: {error}", hint="write files to the folder that is passed to it"
        ) from None
    return made


@dataclass(frozen=True)
class Failure:
    """Exception of a task, in a form that can always be pickled."""

    error: str


def work(
    job: Job, out: str, name: str, seed: int, threads: int, set_threads: Callable[[int], None] | None = None
) -> Failure | None:
    """Does one task and moves it to OUT/NAME. Runs on a worker; exceptions of the job become a Failure."""
    target = Path(out) / name
    scratch = Path(out) / f"{PART}{name}-{uuid.uuid4().hex[:12]}"
    try:
        if read_task(target) is not None:
            return None
        if set_threads is not None:
            set_threads(threads)
        scratch.mkdir()
        made = job(scratch / name, seed)
        write_json(scratch / name / TASK_FILE, {"seed": seed, **made})
        publish(scratch / name, target)
        return None
    except Exception as error:  # of the user's function, too: the other tasks go on
        text = str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"
        return Failure(text)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
