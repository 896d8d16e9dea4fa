"""Planners that follow a topological map with a network of images: `gnm`, `vint` and `gloam`.

The search of nodes and the choice of the waypoint follow the authors' code of GNM (Shah et al. 2022, arXiv:2210.03370) and
ViNT (Shah et al. 2023, arXiv:2306.14846): robodhruv/visualnav-transformer, deployment/src/navigate.py.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

import gloam

from ..networks.onnx_network import Backend, OnnxNetwork, Port
from ..networks.preprocessing import ContextStack, Floats, prepare
from ..planner import Answer, Arrived, Need, Observation, Planner, Task, Waypoints, register_planner
from ..topological_map import TopologicalMap


@dataclass(frozen=True)
class MapOptions:
    """How a planner searches the map.

    radius: nodes before and behind the closest one that are compared (the publication's default is 4, and one more ahead);
    close_threshold: distance [steps of the demonstration] below which the next node becomes the goal (3);
    goal_threshold: distance to the last node at which it may count as reached (infinite = the published rule, by which
    the robot arrives as soon as the last node is the closest); waypoint: index of the chosen waypoint (2);
    rate [Hz] and latency [s] of the planner; crop: images to 4:3; image_size: (width, height) of the robot's images [px],
    None = as the network needs them; backend: package that evaluates networks. Errors: gloam.UsageError.
    """

    radius: int = 4
    close_threshold: float = 3.0
    goal_threshold: float = math.inf
    waypoint: int = 2
    rate: float = 4.0
    latency: float = 0.1
    crop: bool = True
    image_size: tuple[int, int] | None = None
    backend: Backend = "auto"

    def __post_init__(self) -> None:
        ranges = {"radius": (0, 1000), "waypoint": (0, 63), "rate": (0.01, 1000), "latency": (0, 60)}
        for name, (least, most) in ranges.items():
            if not least <= getattr(self, name) <= most:
                raise gloam.UsageError(f"{name} must be {least} … {most}, got {getattr(self, name)}")
        for name in ("close_threshold", "goal_threshold"):
            if not getattr(self, name) >= 0:
                raise gloam.UsageError(f"{name} must be 0 or more, got {getattr(self, name)}")


class MapPlanner(Planner):
    """Base of planners that follow `Task.map`: the window of nodes, prepared images, and the scale of waypoints.

    A subclass sets `context` and `size` (width, height of the network's images) and overrides `answer_in_window`.
    """

    needs: ClassVar[frozenset[Need]] = frozenset({"image"})

    def __init__(self, options: MapOptions, context_size: int, size: tuple[int, int]) -> None:
        self.options = options
        self.rate = options.rate
        self.latency = options.latency
        self.image_size = options.image_size or size
        self.closest = 0
        self._size = size
        self._context = ContextStack(context_size, size, options.crop)
        self._goals: dict[int, Floats] = {}
        self._map: TopologicalMap | None = None
        self._scale = 0.0

    def reset(self, task: Task) -> None:
        """Begins at the first node. Errors: gloam.UsageError without a map, or with a map of another scene."""
        if task.map is None:
            raise gloam.UsageError("this planner follows a map", hint="record a demonstration and set the task's map")
        if task.world is not None:
            task.map.check_scene(task.world)
        self._map = task.map
        self._goals = {}
        self._context.clear()
        self.closest = 0
        self._scale = task.top_speed / float(self.rate)

    def plan(self, observation: Observation) -> Answer:
        """Waypoints to the next node, or Arrived when the last node is the closest. Errors: ValueError for a wrong image
        or outputs of the network that are not finite."""
        if self._map is None:
            raise gloam.UsageError("plan() was called before reset()")
        if observation.image is None:
            raise ValueError("the observation has no image")
        seen = self._context.push(observation.image)
        last = len(self._map) - 1
        start = max(self.closest - self.options.radius, 0)
        end = min(self.closest + self.options.radius + 1, last)
        self.closest, distance, points = self.answer_in_window(seen, range(start, end + 1))
        if self.closest == last and distance <= self.options.goal_threshold:
            return Arrived()
        scaled = np.array(points, np.float64)
        scaled[:, :2] *= self._scale
        return Waypoints(scaled, self.options.waypoint)

    @abstractmethod
    def answer_in_window(self, seen: Floats, window: range) -> tuple[int, float, NDArray[Any]]:
        """The closest node, the least distance of the window [steps], and waypoints (n, 2) or (n, 4) in units of
        top speed / rate. seen: the stack of images; window: indices of the nodes to compare."""

    def goal(self, index: int) -> Floats:
        """(1, 3, height, width): the prepared image of a node."""
        if index not in self._goals:
            assert self._map is not None
            self._goals[index] = prepare(self._map.nodes[index].image, self._size, self.options.crop)[None]
        return self._goals[index]

    @property
    def last(self) -> int:
        """Index of the goal."""
        assert self._map is not None
        return len(self._map) - 1


class GoalImagePlanner(MapPlanner):
    """A network that estimates distance and waypoints from a stack of images and a goal image (GNM, ViNT)."""

    def __init__(self, weights: str | Path, **options: Any) -> None:
        """weights: an ONNX file with the signature of networks/preprocessing.py, whose shapes give the context size, the
        image size and the number of waypoints; options: MapOptions. Errors: as OnnxNetwork and MapOptions; TypeError for an
        unknown option."""
        chosen = MapOptions(**options)
        inputs = [Port("obs_img", (1, None, None, None)), Port("goal_img", (1, 3, None, None))]
        outputs = [Port("dist", (1, 1)), Port("action", (1, None, 4))]
        self._network = OnnxNetwork(weights, inputs, outputs, chosen.backend)
        context_size, size = _sizes(self._network)
        count = self._network.outputs["action"].shape[1]
        if count is None or not chosen.waypoint < count:
            raise gloam.InputError(f"there must be a waypoint {chosen.waypoint}, got {count} waypoints", str(weights))
        super().__init__(chosen, context_size, size)

    def answer_in_window(self, seen: Floats, window: range) -> tuple[int, float, NDArray[Any]]:
        """Drives to the closest node while it is beyond close_threshold, else to the one after it."""
        results = [self._network.run(obs_img=seen, goal_img=self.goal(i)) for i in window]
        distances = [float(result["dist"][0, 0]) for result in results]
        best = int(np.argmin(distances))
        if distances[best] > self.options.close_threshold:
            return window[best], distances[best], results[best]["action"][0]
        following = min(best + 1, len(results) - 1)
        return min(window[best] + 1, self.last), distances[following], results[following]["action"][0]


def _sizes(network: OnnxNetwork) -> tuple[int, tuple[int, int]]:
    """Context size, and (width, height) of the images. Errors: gloam.InputError if the file leaves them open."""
    seen, goal = network.inputs["obs_img"].shape, network.inputs["goal_img"].shape
    channels, height, width = seen[1:]
    if channels is None or height is None or width is None or channels % 3 or channels < 3 or goal[2:] != seen[2:]:
        ports = f"{network.inputs['obs_img']}; {network.inputs['goal_img']}"
        raise gloam.InputError(f"images must be [1, 3 n, h, w] and [1, 3, h, w] of one fixed size, got {ports}", str(network.path))
    return channels // 3 - 1, (width, height)


def _published(name: str, weights: str | Path | None = None, **options: Any) -> GoalImagePlanner:
    if weights is None:
        raise gloam.UsageError(
            f"planner '{name}' needs weights, an ONNX file", hint="convert the published weights: docs/navigation_networks.md"
        )
    return GoalImagePlanner(weights, **options)


def own_weights() -> Path:
    """The file of Gloam's own policy, which need not exist."""
    return Path(gloam.home()) / "assets/policies/navigation/policy.onnx"


def _own(weights: str | Path | None = None, **options: Any) -> GoalImagePlanner:
    return GoalImagePlanner(weights or own_weights(), **options)


register_planner("gnm", partial(_published, "gnm"))
register_planner("vint", partial(_published, "vint"))
register_planner("gloam", _own)
