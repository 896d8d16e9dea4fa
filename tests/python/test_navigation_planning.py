"""Grids, paths and the dynamic window of navigation, without a simulation."""

from __future__ import annotations

import math

import gloam
import numpy as np
import pytest
from gloam.navigation.free_space import shared_space
from gloam.navigation.grid import Grid
from gloam.navigation.paths import length_of, point_ahead, smoothed
from gloam.navigation.window import DynamicWindow, WindowOptions

def open_floor(rows: int = 11, columns: int = 11) -> Grid:
    return Grid((0.0, 0.0), 0.1, np.zeros((rows, columns), bool))


def test_cells_hold_the_points_around_their_middles() -> None:
    grid = Grid((1.0, -1.0), 0.5, np.zeros((3, 4), bool))
    grid.blocked[1, 2] = True
    assert grid.index((2.2, -0.6)) == (1, 2) and grid.index((-9.0, 9.0)) == (2, 0)
    assert grid.middles(grid.blocked).tolist() == [[2.0, -0.5]]
    points = [(2.2, -0.6), (2.3, -0.6), (0.76, -1.24), (0.74, -1.0), (2.74, 0.24), (2.76, 0.24), (1.0, 0.26)]
    free = [False, True, True, False, True, False, False]
    assert grid.are_free(points).tolist() == free and [grid.is_free(point) for point in points] == free
    assert grid.is_free((2.3, -0.6, 0.4)), "a third number, such as a height, is left out"


def test_paths_go_around_walls() -> None:
    grid = open_floor()
    grid.blocked[5, :8] = True
    path = grid.path((0.0, 0.0), (0.0, 1.0))
    assert path[0] == (0.0, 0.0) and path[-1] == (0.0, 1.0)
    assert max(x for x, _ in path) == pytest.approx(0.8)
    assert length_of(path) == pytest.approx(2 * (0.4 + 0.4 * math.sqrt(2) + 0.1), abs=0.2)
    assert grid.clearance(0.3)[3, 0] == pytest.approx(0.2)
    grid.blocked[5, :] = True
    assert grid.path((0.0, 0.0), (0.0, 1.0)) == []


@pytest.mark.parametrize("seed", range(5))
def test_the_cheapest_path_is_as_long_as_the_distance(seed: int) -> None:
    rng = np.random.default_rng(seed)
    grid = Grid((0.0, 0.0), 0.1, rng.random((30, 40)) < 0.3)
    grid.keep_largest_region()
    start, goal = grid.sample(rng), grid.sample(rng)
    length = grid.distances(goal)[grid.index(start)]
    assert length_of(grid.path(start, goal)) == pytest.approx(length) and np.isfinite(length)
    costly = grid.path(start, goal, grid.wall_cost(0.3, 4.0))
    assert all(grid.is_free(point) for point in costly) and length_of(costly) >= length - 1e-9


def test_costs_of_walls_fall_with_the_square_of_the_clearance() -> None:
    grid = open_floor(1, 8)
    grid.blocked[0, 0] = True
    assert grid.wall_cost(0.4, 4.0)[0].tolist() == pytest.approx([4.0, 2.25, 1.0, 0.25, 0, 0, 0, 0])


def test_a_robot_in_an_obstacle_leaves_it() -> None:
    grid = open_floor()
    grid.blocked[:4] = True
    path = grid.path((0.5, 0.1), (0.5, 1.0))
    assert path[0] == pytest.approx((0.5, 0.1)) and length_of(path) == pytest.approx(0.9)


def test_shared_space_is_free_in_all_grids() -> None:
    left, right = open_floor(), open_floor()
    left.blocked[:, 7], right.blocked[0] = True, True
    shared = shared_space([left, right])
    assert (~shared.blocked).sum() == 10 * 7 and not shared.is_free((0.9, 0.5)), "the smaller region is left out"
    with pytest.raises(gloam.UsageError, match="floors differ"):
        shared_space([left, open_floor(11, 12)])
    with pytest.raises(gloam.UsageError, match="floors differ"):
        shared_space([left, Grid((0.1, 0.0), 0.1, right.blocked)])
    right.blocked[:] = True
    with pytest.raises(gloam.UsageError, match="no free space"):
        shared_space([left, right])


def test_smoothing_keeps_the_ends_and_the_free_cells() -> None:
    corner = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
    assert smoothed(corner, 1) == [(0.0, 0.0), (0.75, 0.25), (1.0, 1.0)]
    grid = open_floor()
    grid.blocked[2:, :5] = True
    path = grid.path((0.0, 0.0), (0.6, 1.0))
    cut = [grid.is_free(point) for point in smoothed(path, 100)]
    kept = [grid.is_free(point) for point in smoothed(path, 100, grid)]
    assert not all(cut) and all(kept)


def test_the_point_ahead_is_on_the_rest_of_the_path() -> None:
    path = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
    assert point_ahead(path, (0.9, 0.3), 0.5) == (2.0, 0.0) and point_ahead(path, (0.0, 0.0), 9.0) == (2.0, 0.0)


def test_the_window_avoids_obstacles_and_turns_to_the_target() -> None:
    window = DynamicWindow(WindowOptions())
    free = window.choose((1.0, 0.0), np.empty((0, 2)))
    assert free.vx == pytest.approx(0.4) and abs(free.yaw_rate) < 0.1
    assert window.choose((-1.0, 0.3), np.empty((0, 2))).yaw_rate > 0.5
    wall = np.stack([np.full(60, 0.5), np.linspace(-1.5, 1.5, 60)], axis=-1)
    assert window.choose((2.0, 0.0), wall).vx < 0.2
