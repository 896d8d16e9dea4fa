"""Paths that keep their distance from walls, and drives along them with deviations."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gloam.navigation.free_space import FreeSpace

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


def clearance(space: FreeSpace, limit: float = _COMFORT) -> Array:
    """Distance of each cell from the nearest blocked cell or border, over 8 neighbours, up to `limit` [m]."""
    field: Array = np.where(space.blocked, 0.0, limit)
    for _ in range(int(np.ceil(limit / space.cell))):
        padded = np.pad(field, 1, constant_values=0.0)
        for dy in (0, 1, 2):
            for dx in (0, 1, 2):
                length = space.cell * float(np.hypot(dy - 1, dx - 1))
                field = np.minimum(field, padded[dy : dy + field.shape[0], dx : dx + field.shape[1]] + length)
    return field


def plan(space: FreeSpace, start: Array, goal: Array) -> Path | None:
    """The path of the least length and cost of walls between two points (x, y) [m]; None if there is none."""
    cost = 1.0 + _WALL_COST * (1.0 - clearance(space) / _COMFORT) ** 2
    cells = _search(cost, space.blocked, space.index(start), space.index(goal))
    if len(cells) < 3:
        return None
    points = space.origin + space.cell * np.array(cells, dtype=np.float64)[:, ::-1]
    return Path(_resampled(_smooth(space, _resampled(points, 0.05)), 0.05))


def _search(cost: Array, blocked: Array, start: tuple[int, int], goal: tuple[int, int]) -> list[tuple[int, int]]:
    """Cells (row, column) from start to goal by Dijkstra's algorithm; empty if there are none."""
    best, before = {start: 0.0}, {start: start}
    queue = [(0.0, start)]
    steps = [(dy, dx, float(np.hypot(dy, dx))) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
    rows, columns = blocked.shape
    while queue:
        length, cell = heapq.heappop(queue)
        if cell == goal:
            cells = [cell]
            while cells[-1] != start:
                cells.append(before[cells[-1]])
            return cells[::-1]
        if length > best[cell]:
            continue
        for dy, dx, step in steps:
            row, column = cell[0] + dy, cell[1] + dx
            if not (0 <= row < rows and 0 <= column < columns) or blocked[row, column]:
                continue
            total = length + step * 0.5 * float(cost[cell] + cost[row, column])
            if total < best.get((row, column), np.inf):
                best[row, column], before[row, column] = total, cell
                heapq.heappush(queue, (total, (row, column)))
    return []


def _resampled(points: Array, spacing: float) -> Array:
    """Points at equal distances of about `spacing` along a polyline [m]."""
    points = points[np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9])]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    along = np.linspace(0.0, arc[-1], max(int(round(arc[-1] / spacing)), 1) + 1)
    return np.stack([np.interp(along, arc, points[:, k]) for k in range(2)], axis=-1)


def _smooth(space: FreeSpace, points: Array, rounds: int = 80) -> Array:
    """The polyline without the corners of the grid; points that would leave the free space stay."""
    points = points.copy()
    for _ in range(rounds):
        moved = 0.25 * points[:-2] + 0.5 * points[1:-1] + 0.25 * points[2:]
        for index, point in enumerate(moved, start=1):
            if space.is_free(point):
                points[index] = point
    return points


def nominal_drive(path: Path) -> tuple[Array, Array]:
    """Poses (n, 3) on the path, VIEW_SPACING apart, and their lengths along it (n,) [m]."""
    along = np.asarray(np.arange(int(path.length / VIEW_SPACING) + 1) * VIEW_SPACING, np.float64)
    return np.column_stack([path.at(along), path.heading(along)]), along


def deviating_drive(
    path: Path, space: FreeSpace, rng: np.random.Generator, deviation: Deviation
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
