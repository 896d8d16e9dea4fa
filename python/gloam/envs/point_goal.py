"""PointGoal: a cart with a camera or a LiDAR drives to a point, around obstacles.

The task and its measure, SPL, follow Anderson et al., "On Evaluation of Embodied Navigation Agents"
(arXiv:1807.06757); the goal is given in polar coordinates and the reward is the progress towards it, as in Savva et
al. ("Habitat", arXiv:1904.01201).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import spaces

import gloam
from gloam.envs.assets import asset_folder
from gloam.envs.noise import Array
from gloam.envs.sources import CameraSource, LidarSource
from gloam.envs.task import Outcome, SceneSource, Task, TaskWorld
from gloam.envs.terms import Term
from gloam.navigation.free_space import free_space, robot_bodies
from gloam.navigation.grid import Grid

Place = Literal["arena", "house"]
Sight = Literal["image", "depth", "lidar"]

WHEEL_RADIUS, TRACK = 0.07, 0.24  # assets/robots/cart [m]
TOP_SPEED, TOP_YAW_RATE = 0.6, 1.5  # of actions of 1 [m/s], [rad/s]
FOOTPRINT = 0.2  # radius of the cart, with a margin [m]


class PointGoal(Task):
    """observation: its sensor. place: a room of 4 x 4 m, or a generated house (house_seed, rooms).

    size: (width, height) of images [px]; beams: LiDAR beams per turn. reach: minimum and maximum path length to the
    goal [m]. radius: distance at which a goal is reached [m]. max_range: of depth and LiDAR [m]. tier, spp, denoise:
    of images. Errors: ValueError.
    """

    control_interval = 0.1

    def __init__(
        self,
        observation: Sight = "depth",
        place: Place = "arena",
        size: tuple[int, int] = (32, 24),
        beams: int = 36,
        reach: tuple[float, float] = (0.8, 4.0),
        radius: float = 0.25,
        max_range: float = 5.0,
        house_seed: int = 3,
        rooms: int = 4,
        tier: str = "direct",
        spp: int = 1,
        denoise: bool = False,
    ) -> None:
        if observation not in ("image", "depth", "lidar"):
            raise ValueError(f"observation must be 'image', 'depth' or 'lidar', got {observation!r}")
        if place not in ("arena", "house"):
            raise ValueError(f"place must be 'arena' or 'house', got {place!r}")
        if not 0 < radius < reach[0] <= reach[1]:
            raise ValueError(f"expected 0 < radius < least reach <= most reach, got radius {radius} and reach {reach}")
        if beams < 1 or min(size) < 1 or max_range <= 0:
            raise ValueError("beams, size and max_range must be above 0")
        self.observation: Sight = observation
        self.place: Place = place
        self.size, self.beams, self.reach, self.radius, self.max_range = size, beams, reach, radius, max_range
        self.house = {"seed": house_seed, "rooms": rooms}
        self.look = {"tier": tier, "spp": spp, "denoise": denoise}
        # The first scan begins where the cart was before it was placed.
        self.settle = 2 * self.control_interval if observation == "lidar" else 0.0
        self._lock = threading.Lock()
        self._space: Grid | None = None

    def scene(self) -> SceneSource:
        is_house = self.place == "house"
        environment = {"house": self.house} if is_house else {"file": "environments/arena/arena.xml"}
        lamp = {"name": "lamp", "type": "rect", "position": [0, 0, 3], "size": [0.5, 0.5], "flux": 4000}
        tables: dict[str, Any] = {
            "scene": {"name": "point_goal"},
            "sim": {"timestep": 0.005},
            "environment": environment,
            "robot": [{"name": "cart", "file": "robots/cart/cart.xml"}],
            "override": {"environment": {"option": {"integrator": "implicitfast"}}},
            "camera": [
                {
                    "name": "front",
                    "body": "cart/chassis",
                    "position": [0.16, 0, 0.16],
                    "look_at": [1.16, 0, 0.1],
                    "fovy": 75,
                    "width": self.size[0],
                    "height": self.size[1],
                    "rate": 10,
                }
            ],
            "render": self.look,
        }
        if not is_house:
            tables["light"] = [lamp]
        if self.observation == "lidar":
            tables["lidar"] = [self._lidar()]
        return gloam.Scene.from_dict(tables, folder=asset_folder())

    def _lidar(self) -> dict[str, Any]:
        """One ring at 0.23 m above the floor, a turn in each control interval."""
        return {
            "name": "top",
            "body": "cart/chassis",
            "position": [0, 0, 0.23],
            "preset": "VLP-16",
            "elevations": [0],
            "columns": self.beams,
            "rate": round(1 / self.control_interval),
            "returns": "first",
            "range_at_10_percent": 0,
            "min_range": 0.05,
            "max_range": self.max_range,
            "motion_keys": 1,
        }

    def action_space(self, world: gloam.World) -> spaces.Box:
        """Forward speed and yaw rate, 1 = TOP_SPEED, TOP_YAW_RATE."""
        return spaces.Box(-1.0, 1.0, (2,), np.float32)

    def terms(self, world: gloam.World) -> Sequence[Term]:
        """Sensor data, and "goal": its distance [m] and the cosine and sine of its bearing (left is positive)."""
        width, height = self.size
        limit = (0.0, self.max_range)
        sight = {
            "image": Term("image", (height, width, 3), 0, 255, dtype=np.uint8),
            "depth": Term("depth", (height, width), 0, clip=limit, scale=1 / self.max_range),
            "lidar": Term("lidar", (self.beams,), 0, clip=limit, scale=1 / self.max_range),
        }[self.observation]
        return [sight, Term("goal", (3,), clip=(-100.0, 100.0))]

    def bind(self, sim: gloam.Simulation) -> TaskWorld:
        return _PointGoalWorld(sim, self, self.free_space(sim.world))

    def free_space(self, world: gloam.World) -> Grid:
        """Free space of the cart; computed once."""
        with self._lock:
            if self._space is None:
                self._space = free_space(world, robot_bodies(world, "cart"), FOOTPRINT)
            return self._space


class _PointGoalWorld(TaskWorld):
    def __init__(self, sim: gloam.Simulation, task: PointGoal, space: Grid) -> None:
        super().__init__(sim)
        self._task, self._space = task, space
        self._cart = sim.robots["cart"]
        self._source: CameraSource | LidarSource
        if task.observation == "lidar":
            self._source = LidarSource(sim, "top", 1, task.beams, task.max_range)
        else:
            output = "rgb" if task.observation == "image" else "depth"
            self._source = CameraSource(sim, "front", output, task.size, task.max_range, task.look)
        self._goal = np.zeros(2)
        self._field = np.zeros((1, 1))
        self._left = self._shortest = self._driven = 0.0
        self._last = self._position = np.zeros(2)

    def begin(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        """options: "goal" (x, y) and "start" (x, y, yaw) [m, rad] in place of drawn ones."""
        self._goal = _point(options["goal"], 2, self._space) if "goal" in options else self._space.sample(rng)
        self._field = self._space.distances(self._goal)
        if "start" in options:
            x, y, yaw = _point(options["start"], 3, self._space)
        else:
            x, y = self._space.sample(rng, self._field, self._task.reach)
            yaw = rng.uniform(-math.pi, math.pi)
        self._source.begin()
        self._cart.place(position=(float(x), float(y), 0.001), yaw=float(yaw))
        self._last = np.array([x, y])
        self._left = self._shortest = self._space.distance(self._field, self._last)
        self._driven = 0.0

    def apply(self, action: Array) -> None:
        speed, turn = float(action[0]) * TOP_SPEED, float(action[1]) * TOP_YAW_RATE * TRACK / 2
        self._cart.controls = np.array([speed - turn, speed + turn]) / WHEEL_RADIUS

    def observe(self) -> dict[str, Array]:
        pose = self._cart.pose
        self._position = pose.p[:2]
        dx, dy = self._goal - pose.p[:2]
        bearing = math.atan2(dy, dx) - pose.yaw
        goal = np.array([math.hypot(dx, dy), math.cos(bearing), math.sin(bearing)])
        return {self._task.observation: self._source.read(), "goal": goal}

    def judge(self, action: Array) -> Outcome:
        """Reward: progress towards the goal [m], minus 0.01, and 5 for the goal."""
        position = self._position
        self._driven += float(np.linalg.norm(position - self._last))
        self._last = position.copy()
        left = self._space.distance(self._field, position)
        left = left if math.isfinite(left) else self._left
        gained, self._left = self._left - left, left
        distance = float(np.linalg.norm(self._goal - position))
        is_there = distance < self._task.radius
        spl = self._shortest / max(self._shortest, self._driven) if is_there else 0.0
        info = {"distance": distance, "success": is_there, "spl": spl}
        return Outcome(gained - 0.01 + (5.0 if is_there else 0.0), is_there, info)

    def start_info(self) -> dict[str, Any]:
        return {"distance": float(np.linalg.norm(self._goal - self._last)), "success": False, "spl": 0.0}

    def close(self) -> None:
        self._source.close()


def _point(value: object, size: int, space: Grid) -> Array:
    """Numbers from an option of reset. Errors: ValueError for another count, NaN, or a place that is not free."""
    point = np.asarray(value, dtype=np.float64)
    if point.shape != (size,) or not np.isfinite(point).all():
        raise ValueError(f"expected {size} finite numbers, got {value!r}")
    if not space.is_free(point):
        raise ValueError(f"there is no room for the cart at ({point[0]:g}, {point[1]:g})")
    return point
