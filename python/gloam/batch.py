"""Batch jobs: recorded runs, stills, meshes, trajectories, reports."""
from __future__ import annotations

import os
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from gloam import _core

from .elements import Pose
from .errors import PartialError, UsageError
from .frames import Frame
from .logs import Log, RunReport
from .progress import ProgressLike, watch
from .scene import Scene, as_scene
from .world import World

PathLike = str | os.PathLike[str]


def run(source: Any, out: PathLike, *, settings: Mapping[str, Any] | None = None, outputs: Sequence[str] | None = None,
        overwrite: bool = False, progress: ProgressLike = None, **request: Any) -> RunReport:
    """Runs a scene for its duration and records its outputs into the folder `out`, like `gloam run`.

    `request`: cameras, width, height, rate [Hz], duration [s], seed, timestep [s], mcap (a log's path), topics.
    """
    world = _compiled(source, settings, outputs, progress)
    options = {"out": Path(out), "overwrite": overwrite, **request}
    if "mcap" in options:
        options["mcap"] = Path(options["mcap"])
    with watch(progress, "running") as told:
        report = RunReport.of(_core.run_and_record(world._world, options, told))
    if report.error:
        raise PartialError(report.error)
    return report


def render(source: Any, time: float = 0.0, camera: str = "free", *, outputs: Sequence[str] = ("rgb",), settings: Mapping[str, Any] | None = None,
           width: int = 0, height: int = 0, pose: Pose | None = None, progress: ProgressLike = None, **options: Any) -> Frame:
    """A still of one camera at a time [s], like `gloam render`. `options`: tier, spp, denoise, device …"""
    world = _compiled(source, settings, None, progress)
    request = {"camera": camera, "outputs": list(outputs), "width": width, "height": height, "pose": pose, **options}
    with watch(progress, "rendering") as told:
        return Frame(_core.render_stills(world._world, float(time), [request], told)[0])


def _compiled(source: Any, settings: Mapping[str, Any] | None, outputs: Sequence[str] | None, progress: ProgressLike) -> World:
    if isinstance(source, World):
        return source
    scene: Scene = as_scene(source).copy()
    if settings:
        scene.update(settings)
    if outputs is not None:
        _core.set_record_outputs(scene._scene, list(outputs))
    return scene.compile(progress)


def generate(kind: str, folder: PathLike = ".", **parameters: Any) -> Scene:
    """A Scene of a generated place: generate("house", seed=3, rooms=4), "warehouse", "office", "hallway" … (docs/environments.md)."""
    return Scene.from_dict({"environment": {kind: parameters}}, folder)


def convert(mesh: PathLike, progress: ProgressLike = None, root: PathLike = "", strict: bool = False) -> dict[str, Any]:
    """Colliders, volume and mass of a mesh as an [[object]], and the accuracy of the colliders. `root`, `strict`: as
    for Scene."""
    with watch(progress, f"converting {Path(mesh).name}") as told:
        return dict(_core.convert_object(Path(mesh), told, os.fspath(root), strict))


def check(model: PathLike, root: PathLike = "", strict: bool = False) -> dict[str, Any]:
    """Compares a model or scene with the result of stock MuJoCo, and its export with itself: "passed", and the fields
    that differ."""
    with tempfile.TemporaryDirectory() as folder:
        return dict(_core.check_model(Path(model), Path(folder), os.fspath(root), strict))


def _trajectory(source: Any) -> Any:
    if isinstance(source, tuple) and isinstance(source[0], Log):
        log, topic = source
        times, poses = log.trajectory(topic)
        return _core.Trajectory.make(times, poses, f"{log.file}:{topic}")
    if isinstance(source, tuple):
        return _core.Trajectory.make(source[0], source[1])
    file, _, topic = str(source.file if isinstance(source, Log) else os.fspath(source)).partition(":/")
    if Path(file).suffix != ".mcap":
        read = _core.Trajectory.read(Path(source))
        for note in read.notes:
            warnings.warn(note, stacklevel=3)
        return read
    log = source if isinstance(source, Log) else Log(file)
    return _trajectory((log, f"/{topic}" if topic else _only_pose_topic(log)))


def _only_pose_topic(log: Log) -> str:
    topics = list(_core.trajectory_topics(log.file))
    if len(topics) != 1:
        raise UsageError(f"the log has several pose topics: {', '.join(topics)}" if topics else "the log has no pose topics",
                         hint="choose one as in 'run.mcap:/odom'; a frame of /tf is written as 'run.mcap:/tf:robot/base'")
    return str(topics[0])


def evaluate(estimate: Any, reference: Any, *, align: str = "se3", rpe_delta: float | None = None, rpe_unit: str = "m", all_pairs: bool = False,
             rpe_tolerance: float = 0.1, max_difference: float = 0.01, offset: float = 0.0) -> dict[str, Any]:
    """ATE and RPE of an estimated trajectory against a reference, with the names, defaults and results of `gloam evaluate --json`.

    Each side is a file (TUM, KITTI, EuRoC), a topic of a log ("run.mcap:/odom", or (log, "/odom")), or (times (n,)
    [s], poses (n, 7): x, y, z, qw, qx, qy, qz). `align`: se3, sim3, scale, origin or none. `rpe_delta` (None = 1) in
    `rpe_unit`: m along the path, f frames, s, deg or rad. Returns "ate" and "rpe", each with "translation_m",
    "angle_rad" and "full": rmse, mean, median, std, min, max, sse, count and "values"; "align", "pairs", lengths.
    "rpe" is None if the trajectory is shorter than the default delta of 1.
    """
    options = {"align": align, "rpe_delta": rpe_delta, "rpe_unit": rpe_unit, "all_pairs": all_pairs, "rpe_tolerance": rpe_tolerance,
               "max_difference": max_difference, "offset": offset}
    return dict(_core.evaluate(_trajectory(estimate), _trajectory(reference), options))


def report(runs: Sequence[PathLike], out: PathLike, *, title: str = "", overwrite: bool = False) -> list[str]:
    """Writes one HTML page that compares results folders. Returns the errors of files that could not be read."""
    _, _, left_out = _core.write_report([Path(r) for r in runs], Path(out), overwrite, title)
    return list(left_out)
