"""Topological maps from logs: the run is replayed, and its camera gives the images."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import gloam

from .driver import Rig
from .free_space import robot_bodies
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
        rig = Rig.of(world, *who)
    if not rig.camera:
        raise gloam.NotFoundError(f"robot '{rig.robot}' has no camera", hint=f"name another one: {', '.join(world.cameras) or 'none'}")
    recorded.replay(
        work / "replay", outputs=["png"], cameras=[rig.camera], width=size[0], height=size[1], rate=_RATE,
        settings={"render.tier": "interactive"},
    )  # fmt: skip
    images = sorted((work / "replay").rglob("*.png"))
    times, poses = recorded.trajectory(f"/tf:{world.bodies[robot_bodies(world, rig.robot)[0]]}")
    nodes = [_node(image, size, k / _RATE, times, poses) for k, image in enumerate(images)]
    if len(nodes) < 2:
        raise gloam.UsageError(f"{log} is too short for a map", hint=f"record at least {2 / _RATE} s")
    return build_map(nodes, MapSource.of(world, rig.camera), spacing)


def _node(image: Path, size: tuple[int, int], time: float, times: Any, poses: Any) -> Node:
    from .topological_map_files import decode_png

    index = int(np.argmin(np.abs(np.asarray(times) - time)))
    pose = gloam.Pose(poses[index][:3], poses[index][3:])
    return Node(decode_png(image.read_bytes(), size), (float(pose.p[0]), float(pose.p[1]), float(pose.yaw)), time)
