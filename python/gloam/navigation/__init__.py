"""Visual navigation: planners, topological maps, and a benchmark (docs/navigation.md)."""

from __future__ import annotations

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
    "Observation",
    "Planner",
    "Task",
    "Velocity",
    "Waypoints",
    "make_planner",
    "planner_names",
    "register_planner",
]
