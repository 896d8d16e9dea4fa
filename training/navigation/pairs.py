"""Pairs of views of one place whose images overlap: goals off the path of a drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gloam.navigation.grid import Grid

from .labels import MAX_TURN, SPACING, Path, waypoints, wrap

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PairRule:
    """per_view: pairs of each view, at most; reach: distance of a goal [m]; turned: largest angle between the headings of
    both [rad], so that the images overlap: the camera's horizontal field of view is 91 degrees; aside: largest angle
    between the view's heading and the goal for which waypoints have a meaning [rad]: goals behind have a distance only."""

    per_view: int = 24
    reach: tuple[float, float] = (0.1, 2.2)
    turned: float = 1.2
    aside: float = 1.4


@dataclass(frozen=True)
class Pairs:
    """Rows of a table of n pairs. anchor, goal: rows of the views; dist: steps of a pursuit of the straight way, with those
    in which it turns in place; action: (n, 5, 4) waypoints towards the goal (labels.waypoints); ahead: whether they
    have a meaning."""

    anchor: NDArray[np.int32]
    goal: NDArray[np.int32]
    dist: NDArray[np.float32]
    action: NDArray[np.float32]
    ahead: NDArray[np.bool_]


def pairs_of(poses: Array, space: Grid, rng: np.random.Generator, rule: PairRule) -> Pairs:
    """Pairs of the views of one place, which have poses (n, 3) x, y, yaw [m, rad]. Straight ways lie in the free space."""
    first: list[int] = []
    second: list[int] = []
    for anchor in range(len(poses)):
        offset = poses[:, :2] - poses[anchor, :2]
        gap = np.hypot(offset[:, 0], offset[:, 1])
        seen = (gap >= rule.reach[0]) & (gap <= rule.reach[1])
        seen &= np.abs(wrap(poses[:, 2] - poses[anchor, 2])) <= rule.turned
        candidates = rng.permutation(np.flatnonzero(seen))
        found = [goal for goal in candidates[: 2 * rule.per_view] if _is_free(space, poses[anchor, :2], offset[goal])]
        second += found[: rule.per_view]
        first += [anchor] * len(found[: rule.per_view])
    anchors, goals = np.array(first, np.int32), np.array(second, np.int32)
    action = [waypoints(Path(poses[[a, g], :2]), poses[a], 0.0) for a, g in zip(anchors, goals, strict=True)]
    offset = poses[goals] - poses[anchors]
    bearing = np.abs(wrap(np.arctan2(offset[:, 1], offset[:, 0]) - poses[anchors, 2]))
    steps = np.hypot(offset[:, 0], offset[:, 1]) / SPACING + np.maximum(bearing - np.pi / 4, 0.0) / MAX_TURN
    return Pairs(
        anchors,
        goals,
        steps.astype(np.float32),
        np.array(action, np.float32).reshape(-1, 5, 4),
        bearing <= rule.aside,
    )


def _is_free(space: Grid, start: Array, offset: Array) -> bool:
    shares = np.linspace(0.0, 1.0, int(np.ceil(np.hypot(*offset) / space.cell)) + 1)
    return bool(space.are_free(start + shares[:, None] * offset).all())
