"""Pairs of views of one place of which the first sees the place of the second: goals off the path of a drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gloam.navigation.grid import Grid

from .labels import SPACING, Path, waypoints, wrap

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PairRule:
    """per_view: pairs of each view, at most; reach: distance of a goal [m]; aside: largest angle between the view's heading
    and the goal, within the camera's horizontal field of view of 91 degrees [rad]; turned: largest angle between the
    straight way to the goal and the goal's heading [rad]."""

    per_view: int = 16
    reach: tuple[float, float] = (0.1, 2.5)
    aside: float = 0.7
    turned: float = 0.9


@dataclass(frozen=True)
class Pairs:
    """Rows of a table of n pairs. anchor, goal: rows of the views; dist: length of the straight way [steps]; action:
    (n, 5, 4) waypoints towards the goal (labels.waypoints)."""

    anchor: NDArray[np.int32]
    goal: NDArray[np.int32]
    dist: NDArray[np.float32]
    action: NDArray[np.float32]


def pairs_of(poses: Array, space: Grid, rng: np.random.Generator, rule: PairRule) -> Pairs:
    """Pairs of the views of one place, which have poses (n, 3) x, y, yaw [m, rad]. Straight ways lie in the free space."""
    anchors, goals = [], []
    for anchor in range(len(poses)):
        offset = poses[:, :2] - poses[anchor, :2]
        gap, bearing = np.hypot(offset[:, 0], offset[:, 1]), np.arctan2(offset[:, 1], offset[:, 0])
        seen = (gap >= rule.reach[0]) & (gap <= rule.reach[1])
        seen &= np.abs(wrap(bearing - poses[anchor, 2])) <= rule.aside
        seen &= np.abs(wrap(poses[:, 2] - bearing)) <= rule.turned
        candidates = rng.permutation(np.flatnonzero(seen))
        found = [goal for goal in candidates[: 2 * rule.per_view] if _is_free(space, poses[anchor, :2], offset[goal])]
        goals += found[: rule.per_view]
        anchors += [anchor] * len(found[: rule.per_view])
    action = [waypoints(Path(poses[[a, g], :2]), poses[a], 0.0) for a, g in zip(anchors, goals, strict=True)]
    offset = poses[goals, :2] - poses[anchors, :2] if anchors else np.zeros((0, 2))
    return Pairs(
        np.array(anchors, np.int32),
        np.array(goals, np.int32),
        (np.hypot(offset[:, 0], offset[:, 1]) / SPACING).astype(np.float32),
        np.array(action, np.float32).reshape(-1, 5, 4),
    )


def _is_free(space: Grid, start: Array, offset: Array) -> bool:
    count = int(np.ceil(np.hypot(*offset) / space.cell)) + 1
    return bool(space.are_free(start + np.linspace(0.0, 1.0, count)[:, None] * offset).all())
