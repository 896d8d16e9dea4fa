"""Baselines without perception: straight to the goal, and a demonstration repeated blindly."""

from __future__ import annotations

import math
from typing import ClassVar

import gloam

from ..planner import Answer, Arrived, Observation, Planner, Task, Velocity, register_planner


def towards(point: tuple[float, float], top_speed: float, turn_rate: float = 1.0) -> Velocity:
    """Velocity to a point (x, y) in the robot's frame [m]: it turns first, and slows down in turns."""
    bearing = math.atan2(point[1], point[0])
    yaw_rate = max(-turn_rate, min(turn_rate, 2.0 * bearing))
    return Velocity(vx=top_speed * max(0.0, math.cos(bearing)) ** 2 * (abs(bearing) < 1.2), yaw_rate=yaw_rate)


class StraightLine(Planner):
    """Drives straight to the goal's position, whatever is in the way: the least that any planner must beat."""

    uses_map: ClassVar[bool] = False

    def reset(self, task: Task) -> None:
        if task.goal is None:
            raise gloam.UsageError("planner 'straight' needs the position of the goal")
        self._goal, self._task = task.goal, task

    def plan(self, observation: Observation) -> Answer:
        point = observation.in_robot_frame(self._goal)
        if math.hypot(*point) < self._task.radius:
            return Arrived()
        return towards(point, self._task.top_speed)


class BlindReplay(Planner):
    """Repeats the velocities of the demonstration of its map, by time and without looking (open loop)."""

    def reset(self, task: Task) -> None:
        if task.map is None or len(task.map.nodes) < 2:
            raise gloam.UsageError("planner 'replay' needs a map of at least two nodes")
        self._nodes, self._begin = task.map.nodes, math.nan
        self._top_speed = task.top_speed

    def plan(self, observation: Observation) -> Answer:
        if math.isnan(self._begin):
            self._begin = observation.time
        now = self._nodes[0].time + observation.time - self._begin
        later = next((i for i, node in enumerate(self._nodes) if node.time > now), None)
        if later is None:
            return Arrived()
        return self._velocity(max(later - 1, 0), max(later, 1))

    def _velocity(self, first: int, second: int) -> Velocity:
        a, b = self._nodes[first], self._nodes[second]
        seconds = max(b.time - a.time, 1e-6)
        dx, dy = b.pose[0] - a.pose[0], b.pose[1] - a.pose[1]
        along = math.cos(a.pose[2]) * dx + math.sin(a.pose[2]) * dy
        across = math.cos(a.pose[2]) * dy - math.sin(a.pose[2]) * dx
        turn = math.remainder(b.pose[2] - a.pose[2], 2 * math.pi)
        return Velocity(along / seconds, across / seconds, turn / seconds)


register_planner("straight", StraightLine)
register_planner("replay", BlindReplay)
