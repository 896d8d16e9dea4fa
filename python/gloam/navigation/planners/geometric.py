"""Baselines that know or measure geometry: A* and a local planner, on the scene's geometry or on a map from a LiDAR."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

import gloam

from ..free_space import free_space, robot_bodies
from ..grid import Grid
from ..local import LocalOptions, LocalPlanner
from ..mppi import Mppi
from ..paths import Point, point_ahead
from ..planner import Answer, Arrived, Array, Need, Observation, Planner, Task, register_planner
from ..window import DynamicWindow

_LOOKAHEAD = 0.8  # of the point on the path that the local planner aims at [m]
_CARE = 4.0  # cost of a metre at an obstacle, in metres


def _near(points: Array, observation: Observation, reach: float = 2.0) -> Array:
    """The points (n, 2) of the world within `reach` of the robot, in its frame [m]."""
    x, y, yaw = observation.pose
    near = points[np.hypot(points[:, 0] - x, points[:, 1] - y) < reach] - (x, y)
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    local: Array = near @ turn
    return local


class _OnGrid(Planner):
    """Follows the cheapest path on a grid. radius: of the robot for the local planner [m]."""

    uses_map: ClassVar[bool] = False
    radius = 0.2

    def reset(self, task: Task) -> None:
        if task.goal is None:
            raise gloam.UsageError("a planner with A* needs the position of the goal")
        self._goal, self._task = task.goal, task
        self._local = self._local_planner(LocalOptions(task.top_speed, radius=self.radius))

    def _local_planner(self, options: LocalOptions) -> LocalPlanner:
        return DynamicWindow(options)

    def _drive(self, observation: Observation, path: list[Point], obstacles: Array) -> Answer:
        here = observation.pose[:2]
        target = point_ahead(path, here, _LOOKAHEAD) if path else self._goal
        return self._local.choose(observation.in_robot_frame(target), obstacles)

    def _has_arrived(self, observation: Observation) -> bool:
        return math.dist(observation.pose[:2], self._goal) < 0.8 * self._task.radius


class Route(_OnGrid):
    """Knows the scene's static geometry and its own pose: an upper bound for planners with sensors. People and other
    moving bodies are unknown to it."""

    radius = 0.12  # obstacles on its grid are wider by as much

    def reset(self, task: Task) -> None:
        super().reset(task)
        if task.world is None:
            raise gloam.UsageError("a planner with the scene's geometry needs the World")
        self._grid = free_space(task.world, robot_bodies(task.world, task.robot), self.radius)
        self._blocked = self._grid.middles(self._grid.blocked)
        self._cost = self._grid.wall_cost(0.4, _CARE)
        self._path: list[Point] = []

    def plan(self, observation: Observation) -> Answer:
        if self._has_arrived(observation):
            return Arrived()
        here = observation.pose[:2]
        if not self._path or min(math.dist(p, here) for p in self._path) > 0.5:
            self._path = self._grid.path(here, self._goal, self._cost)
        return self._drive(observation, self._path, _near(self._blocked, observation))


class RouteMppi(Route):
    """The same with MPPI in place of the dynamic window."""

    def _local_planner(self, options: LocalOptions) -> LocalPlanner:
        return Mppi(options, 1.0 / self.rate, self._task.seed)


class LidarFollower(_OnGrid):
    """Knows its pose and the direction of the goal, and maps obstacles with its LiDAR on the way: unknown cells count
    as free. Cells are cleared again when beams pass them, so that people who walk on leave no wall behind."""

    needs: ClassVar[frozenset[Need]] = frozenset({"scan"})
    heights = (-0.22, 0.3)  # of obstacles over the robot's origin [m]
    cell = 0.1
    reach = 6.0  # of the map around start and goal [m]

    def reset(self, task: Task) -> None:
        super().reset(task)
        self._seen: Array | None = None
        self._plans = 0
        self._path: list[Point] = []

    def plan(self, observation: Observation) -> Answer:
        if self._has_arrived(observation):
            return Arrived()
        if self._seen is None:
            self._begin(observation.pose[:2])
        assert observation.scan is not None
        points = self._solid(observation.scan)
        self._remember(points, observation)
        if self._plans % 8 == 0 or not self._path:
            self._path = self._route(observation.pose[:2])
        self._plans += 1
        return self._drive(observation, self._path, points.astype(np.float64))

    def _begin(self, start: Point) -> None:
        low = np.minimum(start, self._goal) - self.reach
        size = np.ceil((np.maximum(start, self._goal) + self.reach - low) / self.cell).astype(int)
        self._low = (float(low[0]), float(low[1]))
        self._seen = np.zeros((int(size[1]), int(size[0])))

    def _solid(self, scan: NDArray[np.float32]) -> NDArray[np.float32]:
        """Points (n, 2) of obstacles in the robot's frame [m]; nearer ones are its own body."""
        near, far = 0.35, 5.0
        distance = np.hypot(scan[:, 0], scan[:, 1])
        keep = (scan[:, 2] > self.heights[0]) & (scan[:, 2] < self.heights[1]) & (distance > near) & (distance < far)
        cells = np.unique(np.rint(scan[keep][:, :2] / 0.05), axis=0)
        return (0.05 * cells).astype(np.float32)

    def _remember(self, points: NDArray[np.float32], observation: Observation) -> None:
        assert self._seen is not None
        x, y, yaw = observation.pose
        turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
        world = points @ turn.T + (x, y)
        self._seen *= 0.96  # at 4 Hz a trace that is not seen any more fades in five seconds
        column, row = np.rint((world - self._low) / self.cell).astype(int).T
        inside = (row >= 0) & (row < self._seen.shape[0]) & (column >= 0) & (column < self._seen.shape[1])
        self._seen[row[inside], column[inside]] = 1.0

    def _route(self, here: Point) -> list[Point]:
        assert self._seen is not None
        grid = Grid(self._low, self.cell, self._seen > 0.4)
        wide = Grid(self._low, self.cell, grid.clearance(0.5) < 0.25)
        return wide.path(here, self._goal, grid.wall_cost(0.5, _CARE)) or [self._goal]


register_planner("route", Route)
register_planner("route_mppi", RouteMppi)
register_planner("lidar", LidarFollower)
