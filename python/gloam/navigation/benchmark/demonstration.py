"""Maps of the benchmark: images along the path from start to goal, in clear air."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.experiments.files import whole

from ..ground import height_at
from ..topological_map import MapSource, Node, TopologicalMap
from .places import CAMERA, ROBOT, TOP_SPEED, Pair, ground_of, image_options, world_of

SPACING = 0.5  # of nodes [m]
TURN = 0.35  # between nodes at most [rad]: a robot slows down in turns, and a recorder that keeps time gets more images
_SIZE = (160, 120)  # [px]


def poses_along(pair: Pair) -> list[tuple[float, float, float]]:
    """(x, y, yaw) from start to goal, after each SPACING and each TURN; the heading follows the path ahead [m, rad]."""
    points = np.array(pair.path)
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])

    def poses(at: NDArray[np.float64]) -> NDArray[np.float64]:
        ahead = np.minimum(at + 0.6, lengths[-1])
        behind = ahead - 0.6  # near the goal the heading follows the last part
        here, first, last = (
            np.column_stack([np.interp(along, lengths, points[:, axis]) for axis in (0, 1)]) for along in (at, behind, ahead)
        )
        side = last - first
        return np.column_stack([here, np.unwrap(np.arctan2(side[:, 1], side[:, 0]))])

    fine = np.linspace(0.0, float(lengths[-1]), max(2, math.ceil(float(lengths[-1]) / 0.02) + 1))
    share = np.maximum(np.diff(fine) / SPACING, np.abs(np.diff(poses(fine)[:, 2])) / TURN)
    progress = np.concatenate([[0.0], np.cumsum(share)])
    count = max(2, math.ceil(float(progress[-1])) + 1)
    at = np.interp(np.linspace(0.0, float(progress[-1]), count), progress, fine)
    return [(float(x), float(y), math.remainder(float(yaw), math.tau)) for x, y, yaw in poses(at)]


def demonstrate(place: str, pair: Pair, tier: str = "interactive") -> TopologicalMap:
    """The map of a pair: the robot stands at each node, at level none. Node times correspond to a walk
    at TOP_SPEED that slows down in turns. tier: of images."""
    world = world_of(place, "none")
    ground = ground_of(place)
    nodes: list[Node] = []
    with gloam.Simulation(world) as sim:
        first = int(sim.memory.array("jnt_qposadr")[_free_joint(sim)])
        rest = np.array(sim.memory.array("qpos"))
        for k, (x, y, yaw) in enumerate(poses_along(pair)):
            qpos = rest.copy()
            qpos[first : first + 3] = x, y, rest[first + 2] + height_at(ground, x, y)
            qpos[first + 3 : first + 7] = gloam.yaw_quaternion(yaw)
            frame = sim.cameras[CAMERA].render(("rgb",), width=_SIZE[0], height=_SIZE[1], qpos=qpos, **image_options(tier))
            nodes.append(Node(np.array(frame.rgb), (x, y, yaw), k * SPACING / TOP_SPEED))
    return TopologicalMap(nodes, MapSource.of(world, CAMERA))


def _free_joint(sim: gloam.Simulation) -> int:
    kinds, bodies = sim.memory.array("jnt_type"), sim.memory.array("jnt_bodyid")
    names = sim.world.bodies
    return next(i for i, kind in enumerate(kinds) if kind == 0 and names[int(bodies[i])].startswith(f"{ROBOT}/"))


def map_of(place: str, pair: Pair, folder: Path, tier: str = "interactive") -> TopologicalMap:
    """The map in `folder`, which is made if it is missing."""
    if not folder.is_dir():
        with whole(folder) as part:
            demonstrate(place, pair, tier).save(part)
    return TopologicalMap.load(folder)
