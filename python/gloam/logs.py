"""Logs: verification, replay, rendering with another appearance, export."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

from gloam import _core

from ._toml import to_text
from .elements import Doubles
from .errors import PartialError, UsageError
from .info import LoggedTopic, LogInfo, LogRecovery, ReplayVariant, log_info_of, of
from .progress import ProgressLike, watch
from .simulation import Simulation
from .world import World

PathLike = str | os.PathLike[str]
Motion = Literal["stepped", "poses", "new_run"]


@dataclass(frozen=True)
class Verification:
    """Result of stepping a log again, with all states and hashes compared."""

    steps: int
    runs: int
    states: int
    differing_steps: int  #: from the first different state on
    run: int
    equal_step: int
    step: int
    where: str  #: "joint 'go1/FL_hip': position differs by 1e-12"
    notes: tuple[str, ...]  #: what could not be verified, and why

    @property
    def is_equal(self) -> bool:
        return self.differing_steps == 0


@dataclass(frozen=True)
class RunReport:
    """Report of a recorded run or replay. `error`: reason if it ended early, else ""."""

    out: Path
    steps: int
    sim_time: float  #: [s]
    wall_time: float  #: [s]
    hash: int
    frames: int
    written: tuple[str, ...]
    results: dict[str, float]
    notes: tuple[str, ...]
    error: str

    @classmethod
    def of(cls, report: Mapping[str, Any]) -> RunReport:
        made = dict(report)
        made["written"] = tuple(made["written"])
        made["notes"] = tuple(made["notes"])
        return cls(**made)


class Log:
    """A log (MCAP) of Gloam or any other writer. `folder`: present folder of the scene's files; None = the original
    one."""

    def __init__(self, file: PathLike, folder: PathLike | None = None) -> None:
        self.file = Path(file)
        self._folder = "" if folder is None else os.fspath(folder)
        self.info: LogInfo = log_info_of(_core.describe_log(self.file))

    @property
    def topics(self) -> list[LoggedTopic]:
        return list(self.info.topics)

    @property
    def duration(self) -> float:
        """[s]"""
        return self.info.duration

    def verify(self, progress: ProgressLike = None) -> Verification:
        """Steps its runs again from the scene and Commands. Raises InputError: a log of another program, changed
        files (named in the message)."""
        with watch(progress, f"verifying {self.file.name}") as told:
            result = dict(_core.verify_log(self.file, self._folder, told))
        result["notes"] = tuple(result["notes"])
        return Verification(**result)

    def replay(self, out: PathLike, settings: Mapping[str, Any] | None = None, *, motion: Motion = "stepped", run: int = 0,
               overlays: Sequence[PathLike] = (), outputs: Sequence[str] = (), overwrite: bool = False, progress: ProgressLike = None,
               **request: Any) -> RunReport:
        """Records a run again into the folder `out`, with another appearance: `settings` are options of the scene,
        `overlays` scene files that change it.

        `request`: cameras, width, height, rate [Hz], duration [s]. Raises InputError: a setting that would change how bodies move.
        """
        options = self._options(settings, motion, run, overlays, outputs)
        options["request"] = {"out": Path(out), "overwrite": overwrite, **request}
        with watch(progress, f"replaying {self.file.name}") as told:
            report = RunReport.of(_core.replay_log(self.file, options, told))
        if report.error:
            raise PartialError(report.error)
        return report

    def render(self, path: PathLike, settings: Mapping[str, Any] | None = None, *, camera: str | None = None, overwrite: bool = False,
               progress: ProgressLike = None, **request: Any) -> Path:
        """Renders a video (.mp4) of one camera of the run with other `settings`: log.render("night.mp4",
        {"light.lux": 5}).

        `camera`: None = the first one that the replay records.
        """
        import shutil
        import tempfile

        path = Path(path)
        if path.suffix != ".mp4":
            raise UsageError(f"{path.name}: the name of a video must end in .mp4", hint="to write other outputs to a folder, use replay()")
        if path.exists() and not overwrite:
            raise UsageError(f"{path} already exists", hint="replace it with overwrite=True")
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".gloam-") as folder:
            if camera is not None:
                request["cameras"] = [camera]
            report = self.replay(Path(folder) / "replay", settings, outputs=["video"], progress=progress, **request)
            videos = sorted(Path(report.out).rglob("*.mp4"))
            if not videos:
                raise UsageError(f"{self.file.name}: no camera is recorded", hint="choose one with camera=…")
            shutil.move(videos[0], path)
        return path

    def variants(self, randomize: PathLike, count: int, out: PathLike, *, first_seed: int = 1, settings: Mapping[str, Any] | None = None,
                 motion: Motion = "stepped", outputs: Sequence[str] = (), overwrite: bool = False, progress: ProgressLike = None,
                 **request: Any) -> list[ReplayVariant]:
        """Records replays that differ in the values drawn by the [[randomize]] tables of a file, in OUT/0000, 0001 …;
        another call resumes a cancelled one."""
        options = self._options(settings, motion, 0, (), outputs)
        options["request"] = {"out": Path(out), "overwrite": overwrite, **request}
        with watch(progress, f"variants of {self.file.name}") as told:
            return [of(ReplayVariant, row) for row in _core.replay_variants(self.file, options, Path(randomize), count, first_seed, told)]

    def at(self, time: float, run: int = 0, seed: int = 1) -> Simulation:
        """Returns a paused simulation at an instant of the run [s], which can be continued."""
        checkpoint = _core.log_checkpoint(self.file, self._folder, run, float(time))
        sim = Simulation(World(_core.checkpoint_world(checkpoint)), checkpoint.seed)
        from .simulation import Checkpoint

        sim.restore(Checkpoint(checkpoint))
        return sim

    def export(self, topic: str, path: PathLike, format: str | None = None) -> int:
        """Writes the messages of a topic as csv, parquet, png (a folder) or mp4; None = by the path's suffix. Returns
        the number of messages."""
        if format is None:
            format = Path(path).suffix.removeprefix(".") or "png"
        return int(_core.export_topic(self.file, topic, Path(path), format))

    def trajectory(self, topic: str) -> tuple[Doubles, Doubles]:
        """Times [s], (n,), and poses (n, 7) x, y, z, qw, qx, qy, qz of a topic of poses."""
        times, poses = _core.export_trajectory(self.file, topic)
        return cast(Doubles, times), cast(Doubles, poses)

    def recover(self, path: PathLike) -> LogRecovery:
        """Writes the intact messages of a damaged log to a new file."""
        whole, messages, lost, damage = _core.recover_log(self.file, Path(path))
        return LogRecovery(whole, messages, lost, tuple(damage))

    def _options(self, settings: Mapping[str, Any] | None, motion: str, run: int, overlays: Sequence[PathLike],
                 outputs: Sequence[str]) -> dict[str, Any]:
        return {"folder": self._folder, "run": run, "motion": motion, "overlays": [Path(o) for o in overlays], "outputs": list(outputs),
                "settings": [(path, to_text(value, path)) for path, value in (settings or {}).items()]}

    def __iter__(self) -> Iterator[str]:
        return (topic.name for topic in self.info.topics)

    def __repr__(self) -> str:
        return f"<gloam.Log '{self.file.name}', {self.duration:.3f} s, {len(self.topics)} topics>"


def replay(file: PathLike, folder: PathLike | None = None) -> Log:
    """Opens a log to verify, replay, render and export it."""
    return Log(file, folder)
