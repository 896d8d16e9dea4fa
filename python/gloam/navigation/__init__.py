"""Visual navigation: planners, topological maps, and a benchmark (docs/navigation.md)."""

from __future__ import annotations

from . import planners
from .driver import Driver, PlannerStats, Rig
from .follower import WaypointFollower
from .planner import (
    Answer,
    Arrived,
    Observation,
    Planner,
    Task,
    Velocity,
    Waypoints,
    make_planner,
    planner_names,
    register_planner,
)

__all__ = [
    "Answer",
    "Arrived",
    "Driver",
    "Observation",
    "Planner",
    "PlannerStats",
    "Rig",
    "Task",
    "Velocity",
    "WaypointFollower",
    "Waypoints",
    "make_planner",
    "planner_names",
    "planners",
    "register_planner",
]
