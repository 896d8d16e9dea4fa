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
from .topological_map import MapSource, Node, Spacing, TopologicalMap, build_map

__all__ = [
    "Answer",
    "Arrived",
    "Driver",
    "MapSource",
    "Node",
    "Observation",
    "Planner",
    "PlannerStats",
    "Rig",
    "Spacing",
    "Task",
    "TopologicalMap",
    "Velocity",
    "WaypointFollower",
    "Waypoints",
    "build_map",
    "make_planner",
    "planner_names",
    "planners",
    "register_planner",
]
