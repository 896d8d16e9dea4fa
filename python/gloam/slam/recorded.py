"""Runs of users as tours: the sensors of a log's robot, and whether the run can be replayed under several conditions."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam.navigation.benchmark.floor_plan import keep_plan
from gloam.navigation.driver import Rig

from .estimate import Array
from .tour import Sensors

SHORTEST, LEAST_PATH = 2.0, 0.1  # of a run [s], and of its camera's path [m]
_PROBE = "slam_visibility"
_RATE = 4.0  # of the poses by which the path is measured [Hz]


def scene_name(log: Path) -> str:
    """The name of the log's scene in the results, from its file."""
    return re.sub(r"[^\w.+-]", "_", log.stem).lstrip(".") or "log"


def examine(log: Path, camera: str, plan: Path) -> tuple[Sensors, float]:
    """The sensors of a run, and the length of its camera's path [m]. camera: "" = the left one of the robot's stereo pair, or its first one; plan: file for the floor plan.

    Errors: as gloam.Log and its at(), for a log of another program or of a scene whose files have changed; InputError for a damaged
    log, or one that is too short or without motion; NotFoundError for an unknown camera, with the names of all.
    """
    recorded = gloam.replay(log)
    file = str(log)
    if recorded.info.damage:
        raise gloam.InputError(f"the log is damaged: {recorded.info.damage}", file, hint=f"gloam recover {log} -o whole.mcap")
    if not recorded.info.has_run:
        raise gloam.InputError("the log has no run of Gloam that can be replayed", file)
    if recorded.duration < SHORTEST:
        raise gloam.InputError(f"the run lasts {recorded.duration:.2g} s; a tour needs {SHORTEST:g} s", file)
    with recorded.at(recorded.info.start) as sim:
        sensors = _sensors(sim, camera, recorded.info.start)
        keep_plan(sim.world, next(iter(sim.world.robots), ""), plan)
    length = _path(recorded, sensors.left)
    if length < LEAST_PATH:
        raise gloam.InputError(f"camera '{sensors.left}' moves {length:.2g} m; a tour needs {LEAST_PATH:g} m", file)
    return sensors, length


def _sensors(sim: gloam.Simulation, camera: str, begin: float) -> Sensors:
    world = sim.world
    options = {option.path: option.value for option in world.scene.options()}
    if any(path.startswith("adversity.") for path in options):
        raise gloam.UsageError("the scene of the log has [adversity], and levels would replace it", hint="record the run without it")
    pairs = {path.split(".")[1]: value for path, value in options.items() if re.fullmatch(r"stereo\.[^.]+\.body", path)}
    robot = next(iter(world.robots), "")
    own = next((f"{name}/left" for name, body in pairs.items() if str(body).startswith(f"{robot}/")), "")
    left = Rig.of(world, robot, camera or own).camera
    if not left:
        known = ", ".join(world.cameras) or "none"
        raise gloam.NotFoundError(f"robot '{robot}' has no camera; there are: {known}", hint="name one with --camera")
    pair, _, eye = left.rpartition("/")
    is_pair = pair in pairs and eye == "left"
    table = f"stereo.{pair}" if is_pair else f"camera.{left}"
    clutter = next((value for path, value in options.items() if re.fullmatch(r"environment\.[^.]+\.clutter", path)), None)
    return Sensors(
        left, f"{pair}/right" if is_pair else "", float(options[f"stereo.{pair}.baseline"]) if is_pair else 0.0,
        next(iter(world.lidars), ""), "", begin, _PROBE, _probe(sim, left), clutter,
        any(path.startswith(("agent.", "crowd.")) for path in options),
        any(path.startswith(f"{table}.stereo_depth.") for path in options),
    )  # fmt: skip


def _probe(sim: gloam.Simulation, camera: str) -> str:
    """The scene file that adds a probe of visibility at the camera."""
    number = sim.world.cameras.index(camera)
    body = sim.world.bodies[int(sim.memory.array("cam_bodyid")[number])]
    x, y, z = np.array(sim.memory.array("cam_pos")).reshape(-1, 3)[number].tolist()
    return (
        f'[[probe]]\nname = "{_PROBE}"\nquantity = "visibility"\nbody = "{body}"\nposition = [{x:.9g}, {y:.9g}, {z:.9g}]\nrate = 2.0\n'
    )


def _path(recorded: gloam.Log, camera: str) -> float:
    """Length of the camera's path [m], by a replay with tiny images."""
    with tempfile.TemporaryDirectory(prefix="gloam-slam-") as name:
        request: dict[str, Any] = {"cameras": [camera], "width": 16, "height": 16, "rate": _RATE, "outputs": ["png"]}
        recorded.replay(Path(name) / "replay", {"render.tier": "direct"}, motion="poses", progress=False, **request)
        file = Path(name) / "replay" / camera.replace("/", "_") / "poses.csv"
        table = np.genfromtxt(file, delimiter=",", names=True, ndmin=1)
        places: Array = np.column_stack([table[axis] for axis in ("x_m", "y_m", "z_m")])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
