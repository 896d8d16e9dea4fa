"""Many runs on many processors and machines, through Ray (docs/distribute.md).

    gloam.distribute.rollouts("house.toml", policy, 100, out="rollouts", robot="go2", command=(0.5, 0, 0), duration=5)
    gloam.distribute.variants("run.mcap", "skies.toml", 1000, out="skies")

One task is one folder OUT/0000, OUT/0001 …, made by a seed of its own. Repeating the call resumes it after any
interruption: each task is done exactly once. Results do not depend on the number of workers.
"""

from __future__ import annotations

import hashlib
import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._distribute.cluster import cluster, run_tasks
from ._distribute.jobs import Job, RolloutJob, SceneSource, VariantJob
from ._distribute.manifest import Manifest, read_task
from .errors import PartialError, UsageError
from .progress import ProgressLike, watch

if TYPE_CHECKING:
    from .policy import Policy
    from .simulation import Simulation

PathLike = str | os.PathLike[str]
Function = Callable[["Simulation", int, Path], Mapping[str, Any] | None]
TOPICS = (
    "/clock",
    "/tf*",
)  # that logs of rollouts have beside states and inputs: enough to step them again and see all else


@dataclass(frozen=True)
class Task:
    """A task of a folder. `error`: reason why it is missing, "" if it is present. `values`: its task.json, as steps,
    time [s], hash, result."""

    index: int
    seed: int
    folder: Path
    error: str
    values: dict[str, Any]


@dataclass(frozen=True)
class Report:
    """All tasks of a folder, in order."""

    out: Path
    tasks: tuple[Task, ...]

    @property
    def done(self) -> tuple[Task, ...]:
        return tuple(task for task in self.tasks if not task.error)

    @property
    def failed(self) -> tuple[Task, ...]:
        return tuple(task for task in self.tasks if task.error)


def _seeds(count: int, seeds: int | Sequence[int] | None) -> list[int]:
    if isinstance(count, bool) or not isinstance(count, int) or count < 1:
        raise UsageError(f"count must be a whole number of at least 1, got {count!r}")
    if seeds is None or isinstance(seeds, int):
        first = 1 if seeds is None else seeds
        made = list(range(first, first + count))
    else:
        made = [int(seed) for seed in seeds]
    if len(made) != count:
        raise UsageError(f"got {len(made)} seeds for {count} tasks")
    if len(set(made)) != count:
        raise UsageError("a seed is listed twice: its tasks would be the same")
    if min(made) < 0 or max(made) >= 2**64:
        raise UsageError("a seed must be an integer from 0 to 2^64 - 1")
    return made


def _content(path: Path) -> str:
    """Hash of a file, which identifies the source in a list. Raises UsageError: no such file."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None


def _scene_source(scene: Any) -> tuple[SceneSource, dict[str, str]]:
    """Data of a scene to send to workers, and its entry in a list."""
    from .scene import Scene

    if isinstance(scene, Mapping):
        scene = Scene.from_dict(scene)
    if isinstance(scene, Scene):
        folder = scene.file.parent if str(scene.file) not in ("", ".") else Path()
        text = scene.to_toml()
        return SceneSource(text=text, folder=str(folder.absolute())), {
            "scene": hashlib.sha256(text.encode()).hexdigest()
        }
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"a scene must be a path, a Scene or a dict, got a {type(scene).__name__}")
    path = Path(scene).absolute()
    return SceneSource(file=str(path)), {"scene": _content(path)}


def _drive_print(drive: Any) -> dict[str, str]:
    """Entry of a policy or function in a list, which distinguishes it from others."""
    from .policy import Policy

    if isinstance(drive, Policy):
        files = {"policy": drive.path, "policy_settings": drive.settings}
        return {key: _content(file) if file else "" for key, file in files.items()}
    if not callable(drive):
        raise TypeError(f"expected a gloam.Policy or a function (sim, seed, folder), got a {type(drive).__name__}")
    try:
        text = inspect.getsource(drive)
    except (OSError, TypeError):
        text = getattr(drive, "__qualname__", type(drive).__qualname__)
    return {"function": hashlib.sha256(text.encode()).hexdigest()}


def _do(
    job: Job,
    manifest: Manifest,
    address: str | None,
    workers: int | None,
    cpus: int,
    retries: int,
    required: bool,
    progress: ProgressLike,
) -> Report:
    try:
        if manifest.missing():
            with cluster(address, workers) as ray, watch(progress, manifest.kind) as tell:
                run_tasks(ray, manifest, job, cpus, retries, tell)
            manifest.remove_parts()
        tasks = []
        for index, seed in enumerate(manifest.seeds):
            values = read_task(manifest.folder(index))
            error = "" if values is not None else manifest.errors.get(index, "the task was not run")
            tasks.append(Task(index, seed, manifest.folder(index), error, values or {}))
    finally:
        manifest.close()
    report = Report(manifest.out, tuple(tasks))
    if required and report.failed:
        first = report.failed[0]
        raise PartialError(
            f"{len(report.failed)} of {len(tasks)} tasks failed; seed {first.seed}: {first.error}",
            str(manifest.out / "manifest.json"),
            hint="the other tasks are done; repeat the same call to retry the failed ones",
        )
    return report


def rollouts(
    scene: Any,
    drive: Policy | Function,
    count: int,
    seeds: int | Sequence[int] | None = None,
    *,
    out: PathLike,
    duration: float | None = None,
    robot: str = "",
    command: tuple[float, float, float] = (0.0, 0.0, 0.0),
    settings: Mapping[str, Any] | None = None,
    topics: Sequence[str] | None = TOPICS,
    address: str | None = None,
    workers: int | None = None,
    cpus: int = 1,
    retries: int = 2,
    required: bool = True,
    overwrite: bool = False,
    progress: ProgressLike = None,
) -> Report:
    """Simulates a scene `count` times, by one seed each, and writes OUT/0000 … with run.mcap and task.json.

    scene: path, Scene or dict; all workers see its files. drive: a Policy, which controls `robot` ("" = the first) at
    `command` (vx, vy [m/s], yaw rate [rad/s]) for `duration` [s]; or a function (sim, seed, folder) that steps the
    simulation, may write files into the folder, and returns a dict for task.json or None. seeds: None = 1, 2 …; a
    number = the first; or a list. settings: options of the scene. topics: of the log; None = no log. cpus: of one
    task. retries: of a task whose worker dies. address: of a Ray cluster; None = the one that Ray is connected to,
    else one of `workers` processes here (None = all CPUs) for the time of the call.

    Raises PartialError: tasks failed and `required` is true; the others are done. UsageError: OUT is of another
    request.
    """
    source, described = _scene_source(scene)
    described |= _drive_print(drive)
    if not callable(drive) and (duration is None or not 0 < duration < float("inf")):
        raise UsageError(f"a policy's rollout needs a duration above 0 s, got {duration}")
    job = RolloutJob(
        source,
        drive,
        dict(settings or {}),
        robot,
        command,
        float(duration or 0),
        None if topics is None else list(topics),
    )
    request = {
        **described,
        "settings": {k: repr(v) for k, v in job.settings.items()},
        "robot": robot,
        "command": list(command),
        "duration": job.duration,
        "topics": job.topics,
    }
    manifest = Manifest(Path(out).absolute(), "rollouts", request, _seeds(count, seeds), overwrite)
    return _do(job, manifest, address, workers, cpus, retries, required, progress)


def variants(
    log: PathLike,
    randomize: PathLike,
    count: int,
    out: PathLike,
    *,
    first_seed: int = 1,
    address: str | None = None,
    workers: int | None = None,
    cpus: int = 1,
    retries: int = 2,
    required: bool = True,
    overwrite: bool = False,
    progress: ProgressLike = None,
    **options: Any,
) -> Report:
    """Records a log again `count` times with values drawn by the [[randomize]] tables of a file: OUT/0000 … with
    seeds starting at `first_seed`.

    Each folder has the content of `gloam replay --variants`. options: as for Log.variants: settings, motion, outputs,
    cameras, width, height, rate [Hz], duration [s]. Other arguments as for rollouts().
    """
    file, drawn = Path(log).absolute(), Path(randomize).absolute()
    request = {
        "log": _content(file),
        "randomize": _content(drawn),
        "options": {k: repr(v) for k, v in sorted(options.items())},
    }
    manifest = Manifest(Path(out).absolute(), "variants", request, _seeds(count, first_seed), overwrite)
    return _do(
        VariantJob(str(file), str(drawn), options), manifest, address, workers, cpus, retries, required, progress
    )


__all__ = ["TOPICS", "Report", "Task", "rollouts", "variants"]
