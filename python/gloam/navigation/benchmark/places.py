"""Places of the benchmark, and pairs of start and goal that are free and connected at every level."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

import gloam

from ..free_space import free_space, robot_bodies, shared_space
from ..ground import Ground
from ..paths import Point, length_of, smoothed
from ..planner import Array
from .visibility import visibility_probe

LEVELS = ("none", "minor", "major")
ALL_LEVELS = (*LEVELS, "dark")  # dark: as none, at night with all lamps out
ROBOT, CAMERA, LIDAR = "go", "go/front", "lidar"
EYE = (0.306, 0.0, 0.0165)  # of the camera in the trunk, as in quadruped.xml [m]
TOP_SPEED = 0.5  # [m/s]
RADIUS = 1.0  # at which a goal counts as reached [m]
# Poses per scan (docs/lidar.md). A scan with people costs 0.56 s of CPU time with the default 4, mostly for trees of their
# moving skins, and 0.18 s with 1; in its 0.1 s people and robot move almost linearly.
_MOTION_KEYS = 1
_CLEARANCE = 0.3  # of start, goal and the path between them [m]
_CELL = 0.1  # [m]

# Seeds of the training places of Gloam's own policy are 1000 and above (training/navigation).
PLACES: dict[str, dict[str, Any]] = {
    "house": {"house": {"seed": 3, "rooms": 6}},
    "warehouse": {"warehouse": {"seed": 2, "length": 30, "width": 20}},
    "office": {"office": {"seed": 2}},
    "tunnel": {"tunnel": {"seed": 1}},
    "mine": {"mine": {"seed": 1}},
    "terrain": {"terrain": {"seed": 1, "length": 50, "width": 40}},
}


def quadruped() -> dict[str, Any]:
    """The [[robot]] table of the quadruped with its walking policy."""
    assets = gloam.home() / "assets"
    return {
        "name": ROBOT,
        "file": str(assets / "robots/quadruped/quadruped.xml"),
        "keyframe": "home",
        "controller": {
            "type": "policy",
            "network": str(assets / "policies/quadruped/policy.onnx"),
            "settings": str(assets / "policies/quadruped/policy.toml"),
        },
    }


def scene_of(place: str, level: str) -> gloam.Scene:
    """The scene of a place at a level of adversity, with the quadruped and its walking policy. Errors: NotFoundError."""
    for name, names, kind in ((place, PLACES, "scene"), (level, ALL_LEVELS, "level")):
        if name not in names:
            raise gloam.NotFoundError(f"there is no {kind} '{name}'; there are: {', '.join(names)}")
    tables: dict[str, Any] = {
        "scene": {"name": place},
        "environment": PLACES[place],
        "robot": [quadruped()],
        "probe": [visibility_probe(f"{ROBOT}/trunk", EYE)],
        "lidar": [{"name": LIDAR, "body": f"{ROBOT}/lidar_mount", "preset": "VLP-16", "rate": 10, "motion_keys": _MOTION_KEYS}],
    }
    if level == "dark":
        tables |= {"blackout": {"at": 0}, "sky": {"luminance": 0}}
    elif level != "none":
        tables["adversity"] = {"level": level}
    return gloam.Scene.from_dict(tables)


@lru_cache(maxsize=2)
def world_of(place: str, level: str) -> gloam.World:
    """The compiled scene."""
    return scene_of(place, level).compile()


def image_options(tier: str) -> dict[str, Any]:
    """Options of images of a tier. The path tier takes 16 samples, because images in smoke flicker with its default of 4."""
    return {"tier": tier} | ({"spp": 16} if tier == "path" else {})


@lru_cache
def ground_of(place: str) -> Ground | None:
    """Its uneven ground, which is the same at all levels."""
    return Ground.of(world_of(place, "none"))


@dataclass(frozen=True)
class Pair:
    """start: (x, y, yaw) [m, rad]; goal: (x, y) [m]; path: from one to the other [m]; shortest: its length [m]."""

    start: tuple[float, float, float]
    goal: Point
    path: tuple[Point, ...]
    shortest: float


class Course:
    """Free space of a place that all levels share: clutter differs between levels."""

    def __init__(self, place: str, levels: tuple[str, ...] = LEVELS) -> None:
        worlds = [world_of(place, level) for level in levels]
        self.grid = shared_space([free_space(world, robot_bodies(world, ROBOT), _CLEARANCE, cell=_CELL) for world in worlds])
        self._cost: Array = 2.0 * (1 - self.grid.clearance(0.5) / 0.5)

    def pair(self, seed: int, reach: tuple[float, float] = (4.0, 12.0)) -> Pair:
        """The pair of a seed, with a path of `reach` [m]. Errors: UsageError if the place has no such paths."""
        rng = np.random.Generator(np.random.Philox(key=seed))
        for _ in range(100):
            goal = self.grid.sample(rng)
            field = self.grid.distances(goal)
            if ((field >= reach[0]) & (field <= reach[1])).any():
                break
        else:
            raise gloam.UsageError(f"the place has no paths of {reach[0]} to {reach[1]} m")
        start = self.grid.sample(rng, field, reach)
        begin, end = (float(start[0]), float(start[1])), (float(goal[0]), float(goal[1]))
        path = smoothed(self.grid.path(begin, end, self._cost))
        ahead = path[min(8, len(path) - 1)]
        yaw = math.atan2(ahead[1] - begin[1], ahead[0] - begin[0])
        return Pair((*begin, yaw), end, tuple(path), length_of(self.grid.path(begin, end)))
