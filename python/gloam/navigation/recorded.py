"""Topological maps from logs: the run is replayed, and its camera gives the images."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

import gloam

from .topological_map import MapSource, Node, Spacing, TopologicalMap, build_map

_RATE = 4.0  # of images from which nodes are chosen [Hz]


def map_of_log(
    log: Path, work: Path, spacing: Spacing, size: tuple[int, int] = (160, 120), who: tuple[str, str] = ("", "")
) -> TopologicalMap:
    """The map of a demonstration. work: empty folder for the images; who: robot and camera, "" = the first ones.

    Errors: as for Log; NotFoundError for an unknown robot or camera; UsageError if the robot does not move.
    """
    recorded = gloam.replay(log)
    with recorded.at(0.0) as sim:
        world = sim.world
        robot, camera = _parts(world, *who)
    recorded.replay(
        work / "replay", outputs=["png"], cameras=[camera], width=size[0], height=size[1], rate=_RATE,
        settings={"render.tier": "interactive"},
    )  # fmt: skip
    images = sorted((work / "replay").rglob("*.png"))
    times, poses = recorded.trajectory(f"/tf:{_root(world, robot)}")
    nodes = [_node(image, size, k / _RATE, times, poses) for k, image in enumerate(images)]
    if len(nodes) < 2:
        raise gloam.UsageError(f"{log} is too short for a map", hint=f"record at least {2 / _RATE} s")
    return build_map(nodes, MapSource.of(world, camera), spacing)


def _parts(world: gloam.World, robot: str, camera: str) -> tuple[str, str]:
    robot = robot or (world.robots[0] if world.robots else "")
    if robot not in world.robots:
        raise gloam.NotFoundError(f"there is no robot '{robot}'; there are: {', '.join(world.robots) or 'none'}")
    cameras = [name for name in world.cameras if name.startswith(f"{robot}/")] or list(world.cameras)
    camera = camera or (cameras[0] if cameras else "")
    if camera not in world.cameras:
        raise gloam.NotFoundError(f"there is no camera '{camera}'; there are: {', '.join(world.cameras) or 'none'}")
    return robot, camera


def _root(world: gloam.World, robot: str) -> str:
    return next(name for name in world.bodies if name.startswith(f"{robot}/"))


def _node(image: Path, size: tuple[int, int], time: float, times: Any, poses: Any) -> Node:
    from .topological_map_files import decode_png

    index = int(np.argmin(np.abs(np.asarray(times) - time)))
    x, y, _, w, qx, qy, qz = (float(v) for v in poses[index])
    yaw = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    return Node(decode_png(image.read_bytes(), size), (x, y, yaw), time)
