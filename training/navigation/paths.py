"""Paths that keep their distance from walls, and drives along them with deviations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gloam.navigation.grid import Grid
from gloam.navigation.paths import smoothed

from .labels import Path

Array = NDArray[np.float64]

VIEW_SPACING = 0.2  # between views along a path [m]
_COMFORT = 0.6  # clearance beyond the robot's radius from which walls have no cost [m]
_WALL_COST = 4.0  # of a metre at the edge of the free space, in metres


@dataclass(frozen=True)
class Deviation:
    """Standard deviations of a drive from its path: sideways [m] and in heading [rad]; correlation length [m]; largest
    heading error at the start, where the robot turns in place [rad]."""

    sideways: float = 0.15
    heading: float = 0.2
    correlation: float = 0.8
    start_turn: float = 2.0


def plan(space: Grid, start: Array, goal: Array) -> Path | None:
    """The path of the least length and cost of walls between two points (x, y) [m]; None if there is none."""
    cells = space.path(start, goal, space.wall_cost(_COMFORT, _WALL_COST))
    if len(cells) < 3:
        return None
    fine = smoothed(_resampled(Path(np.array(cells))), 80, space)
    return Path(_resampled(Path(np.array(fine))))


def _resampled(path: Path) -> Array:
    """Points of the path at equal distances of about 0.05 m."""
    return path.at(np.linspace(0.0, path.length, max(round(path.length / 0.05), 1) + 1))


def nominal_drive(path: Path) -> tuple[Array, Array]:
    """Poses (n, 3) on the path, VIEW_SPACING apart, and their lengths along it (n,) [m]."""
    along = np.asarray(np.arange(int(path.length / VIEW_SPACING) + 1) * VIEW_SPACING, np.float64)
    return np.column_stack([path.at(along), path.heading(along)]), along


def deviating_drive(
    path: Path, space: Grid, rng: np.random.Generator, deviation: Deviation
) -> tuple[Array, Array]:
    """Poses (n, 3) of a drive that strays from the path, and their progress on it (n,) [m].

    It begins with a turn in place towards the path. Offsets are smooth random functions of the progress; those that
    would leave the free space are halved until they do not. Each pose is a place to recover from.
    """
    poses, along = nominal_drive(path)
    turn = rng.uniform(-deviation.start_turn, deviation.start_turn)
    count = int(abs(turn) / 0.35)
    turning = turn * np.arange(count, 0, -1) / max(count, 1)
    along = np.concatenate([np.zeros(count), along])
    poses = np.concatenate([np.repeat(poses[:1], count, axis=0), poses])
    poses[:count, 2] += turning
    smooth = max(deviation.correlation / VIEW_SPACING, 1.0)
    sideways = deviation.sideways * _smooth_noise(rng, len(poses), smooth)
    sideways[:count] = 0.0
    heading = deviation.heading * _smooth_noise(rng, len(poses), smooth)
    normal = np.column_stack([-np.sin(path.heading(along)), np.cos(path.heading(along))])
    for index in range(len(poses)):
        for share in (1.0, 0.5, 0.25, 0.0):
            point = poses[index, :2] + share * sideways[index] * normal[index]
            if share == 0.0 or space.is_free(point):
                poses[index, :2] = point
                break
    poses[:, 2] += np.clip(heading, -0.7, 0.7)
    return poses, along


def _smooth_noise(rng: np.random.Generator, count: int, scale: float) -> Array:
    """Normal numbers of variance 1 whose correlation falls over `scale` samples, (count,)."""
    half = int(np.ceil(3 * scale))
    kernel = np.exp(-0.5 * (np.arange(-half, half + 1) / scale) ** 2)
    white = rng.standard_normal(count + 2 * half)
    return np.asarray(np.convolve(white, kernel / np.linalg.norm(kernel), mode="valid"))
