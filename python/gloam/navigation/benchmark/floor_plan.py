"""Floor plans of the benchmark's places, on which the page and its videos draw routes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import gloam
from gloam.errors import InputError
from gloam.experiments.files import replace_file

from ..free_space import free_space, robot_bodies
from ..grid import Grid
from .places import PLACES, ROBOT, world_of

_CELL = 0.05  # [m]
_ROBOT_RADIUS = 0.05  # small: the plan shows obstacles as wide as they are, not enlarged by the robot [m]


def plan_of(folder: Path, scene: str, level: str) -> Grid | None:
    """The plan of a scene at a level, kept in FOLDER/plans: its blocked cells have an obstacle or lie outside. None for scenes
    that the benchmark does not have, and without a kept plan.

    Errors: as World; gloam.IoError; gloam.InputError if the kept file is not a plan.
    """
    file = plan_file(folder, scene, level)
    if not file.is_file():
        if scene not in PLACES:
            return None
        keep_plan(world_of(scene, level), ROBOT, file)
    try:
        with np.load(file, allow_pickle=False) as kept:
            x, y = kept["origin"].tolist()
            return Grid((x, y), float(kept["cell"]), kept["blocked"].astype(bool))
    except (ValueError, KeyError, EOFError, OSError) as error:
        raise InputError(f"this is not a floor plan: {error}", str(file), hint="delete it") from error


def plan_file(folder: Path, scene: str, level: str) -> Path:
    """The file of the plan."""
    return folder / "plans" / scene / f"{level}.npz"


def keep_plan(world: gloam.World, robot: str, file: Path) -> None:
    """Makes the file of a plan. Errors: gloam.IoError."""
    space = free_space(world, robot_bodies(world, robot), _ROBOT_RADIUS, cell=_CELL)
    file.parent.mkdir(parents=True, exist_ok=True)
    replace_file(file, lambda path: _save(path, space))


def _save(path: Path, space: Grid) -> None:
    with path.open("wb") as file:
        np.savez_compressed(file, origin=space.origin, cell=space.cell, blocked=space.blocked)
