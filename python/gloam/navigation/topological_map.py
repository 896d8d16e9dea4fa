"""Topological maps: images along a demonstrated path, with the goal as the last node.

    map = build_map(frames, MapSource("house", "", "front"), Spacing("time", 1.0))
    map.save("maps/house")
    map = TopologicalMap.load("maps/house")

A map is a single path, as in the authors' release of GNM, ViNT and NoMaD (robodhruv/visualnav-transformer,
deployment/src/create_topomap.py: one image per second by default; the robot's settings propose one per three seconds).
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

import gloam

from .networks.preprocessing import Image, check_image

if TYPE_CHECKING:
    from os import PathLike

Rule = Literal["time", "distance", "change"]
Pose = tuple[float, float, float]

MOST_NODES = 10_000
MOST_SIDE = 4096  # [px]
_GREY_SIZE = (32, 24)  # (width, height) [px] of the images that the rule "change" compares
# Tables that alter no building. A map that was recorded in clear air serves in smoke.
_NOT_SEEN = (
    *("scene", "sim", "robot", "camera", "lidar", "sensor", "goal", "metric", "record", "planner"),
    *("adversity", "weather"),
)


@dataclass(frozen=True)
class Node:
    """An image of the demonstration: (H, W, 3) uint8 sRGB, the robot's pose (x, y, yaw) in the world [m, rad], which only
    evaluations read, and the simulation time [s]."""

    image: Image
    pose: Pose
    time: float


@dataclass(frozen=True)
class Spacing:
    """When the next node follows: after `value` seconds ("time") or metres ("distance"), or when the grey images of
    32 x 24 pixels differ by a mean above `value` ("change"; of 255). Errors: ValueError."""

    rule: Rule = "time"
    value: float = 1.0

    def __post_init__(self) -> None:
        if self.rule not in ("time", "distance", "change"):
            raise ValueError(f"the rule of spacing must be time, distance or change, got {self.rule!r}")
        if not 0 < _number(self.value, "the value of spacing") <= 1e6:
            raise ValueError(f"the value of spacing must be above 0 and at most 1e6, got {self.value}")


@dataclass(frozen=True)
class MapSource:
    """Where a map was recorded: name and hash of the scene ("" = unknown, matches every scene), name of the camera."""

    scene: str = ""
    scene_hash: str = ""
    camera: str = ""

    @classmethod
    def of(cls, world: gloam.World, camera: str = "") -> MapSource:
        """The source for a compiled scene."""
        return cls(world.scene.name, scene_hash(world), camera)


class TopologicalMap:
    """Nodes in the order of the demonstration; the last one is the goal."""

    def __init__(self, nodes: Iterable[Node], source: MapSource | None = None, spacing: Spacing | None = None) -> None:
        """nodes: 1 … 10000, with images of one size. Errors: ValueError."""
        self.nodes: tuple[Node, ...] = tuple(nodes)
        self.source = source or MapSource()
        self.spacing = spacing or Spacing()
        if not 1 <= len(self.nodes) <= MOST_NODES:
            raise ValueError(f"a map must have 1 … {MOST_NODES} nodes, got {len(self.nodes)}")
        shape = check_image(self.nodes[0].image, "the image of node 0").shape
        if max(shape) > MOST_SIDE:
            raise ValueError(f"images of a map must have sides of at most {MOST_SIDE} pixels, got {shape[1]} x {shape[0]}")
        for i, node in enumerate(self.nodes):
            _check_node(node, i, shape)

    def __len__(self) -> int:
        return len(self.nodes)

    def __repr__(self) -> str:
        return f"<TopologicalMap of {len(self)} nodes, scene '{self.source.scene}', camera '{self.source.camera}'>"

    @property
    def image_size(self) -> tuple[int, int]:
        """(width, height) [px]."""
        height, width = self.nodes[0].image.shape[:2]
        return width, height

    def check_scene(self, world: gloam.World) -> None:
        """Errors: gloam.UsageError if the map was recorded in a scene of another name or other contents."""
        here = MapSource.of(world)
        if self.source.scene and self.source.scene != here.scene:
            raise gloam.UsageError(f"the map was recorded in scene '{self.source.scene}', but the task is in '{here.scene}'")
        if self.source.scene_hash and self.source.scene_hash != here.scene_hash:
            raise gloam.UsageError(
                f"scene '{here.scene}' has changed since the map was recorded", hint="record the demonstration again"
            )

    def save(self, folder: str | PathLike[str]) -> None:
        """Writes 000000.png … and map.json into a folder, which must be new or empty. Errors: gloam.IoError."""
        from .topological_map_files import save

        save(self, Path(folder))

    @classmethod
    def load(cls, folder: str | PathLike[str]) -> TopologicalMap:
        """Reads a folder that save() wrote. Errors: gloam.IoError if it cannot be read; gloam.InputError for contents that
        are not a map: unknown keys, sizes or counts out of range, numbers that are not finite, links."""
        from .topological_map_files import load

        return load(Path(folder))


def build_map(frames: Iterable[Node], source: MapSource | None = None, spacing: Spacing | None = None) -> TopologicalMap:
    """A map from the images of a demonstration in the order of time.

    It keeps the first frame, each frame at which the rule of `spacing` holds relative to the last node, and the last
    frame as the goal. Errors: ValueError if there is no frame, or time decreases.
    """
    spacing = spacing or Spacing()
    nodes: list[Node] = []
    last: Node | None = None
    for frame in frames:
        if last is not None and frame.time < last.time:
            raise ValueError(f"time must not decrease, got {frame.time} after {last.time}")
        last = frame
        if not nodes or _is_due(spacing, nodes[-1], frame):
            nodes.append(frame)
    if last is not None and nodes[-1] is not last:
        nodes.append(last)
    return TopologicalMap(nodes, source, spacing)


def visual_change(first: Image, second: Image) -> float:
    """Mean absolute difference of two images as grey images of 32 x 24 pixels, 0 … 255."""
    return float(np.abs(_grey(first) - _grey(second)).mean())


def scene_hash(world: gloam.World) -> str:
    """Hash of the tables of a scene that alter what a camera sees of its surroundings: 64 hexadecimal digits."""
    import tomllib

    tables: dict[str, Any] = {k: v for k, v in tomllib.loads(world.scene.to_toml()).items() if k not in _NOT_SEEN}
    return hashlib.sha256(json.dumps(tables, sort_keys=True, default=str).encode()).hexdigest()


def _is_due(spacing: Spacing, node: Node, frame: Node) -> bool:
    if spacing.rule == "time":
        return frame.time - node.time >= spacing.value - 1e-9
    if spacing.rule == "distance":
        return math.hypot(frame.pose[0] - node.pose[0], frame.pose[1] - node.pose[1]) >= spacing.value - 1e-9
    return visual_change(node.image, frame.image) > spacing.value


def _grey(image: Image) -> NDArray[np.float64]:
    """(24, 32) means over cells, with the luma weights of ITU-R BT.601."""
    luma: NDArray[np.float64] = check_image(image).astype(np.float64) @ np.array([0.299, 0.587, 0.114])
    for axis, count in ((0, _GREY_SIZE[1]), (1, _GREY_SIZE[0])):
        size = luma.shape[axis]
        starts = np.arange(count) * size // count
        ends = np.maximum((np.arange(count) + 1) * size // count, starts + 1)
        sums = np.concatenate([np.zeros_like(luma.take([0], axis)), luma.cumsum(axis)], axis)
        luma = (sums.take(ends, axis) - sums.take(starts, axis)) / np.expand_dims(ends - starts, 1 - axis)
    return luma


def _check_node(node: Node, index: int, shape: tuple[int, ...]) -> None:
    if check_image(node.image, f"the image of node {index}").shape != shape:
        raise ValueError(f"images of a map must have one size, but node {index} differs from node 0")
    if len(node.pose) != 3:
        raise ValueError(f"the pose of node {index} must be (x, y, yaw), got {node.pose}")
    for value in (*node.pose, node.time):
        _number(value, f"a number of node {index}")


def _number(value: object, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.floating)) or not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, got {value!r}")
    return float(value)
