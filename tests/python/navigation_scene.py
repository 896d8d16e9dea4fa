"""A small scene for planners: a quadruped with the trot controller in a walled arena of 4 x 4 m."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gloam
from gloam.envs.assets import asset_folder


def arena(folder: Path | None = None, **tables: Any) -> gloam.Scene:
    """The scene, with further tables. folder: of its files; default: the assets."""
    robot = {
        "name": "go",
        "file": "robots/quadruped/quadruped.xml",
        "keyframe": "home",
        "position": [-1.4, 0.2, 0],
        "controller": {"type": "trot"},
    }
    lamp = {"name": "lamp", "type": "rect", "position": [0, 0, 3], "size": [0.5, 0.5], "flux": 4000}
    lidar = {"name": "lidar", "body": "go/lidar_mount", "preset": "VLP-16", "rate": 10, "columns": 360}
    base: dict[str, Any] = {
        "scene": {"name": "arena"},
        "environment": {"file": "environments/arena/arena.xml"},
        "robot": [robot],
        "light": [lamp],
        "lidar": [lidar],
    }
    return gloam.Scene.from_dict(base | tables, folder=folder or asset_folder())
