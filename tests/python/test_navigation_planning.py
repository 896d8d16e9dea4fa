"""Grids, paths and the local planners of navigation, without a simulation."""

from __future__ import annotations

import math
from collections.abc import Callable

import gloam
import numpy as np
import pytest
from gloam.navigation.free_space import shared_space
from gloam.navigation.grid import Grid
from gloam.navigation.local import LocalOptions, LocalPlanner, Obstacles
from gloam.navigation.mppi import Mppi
from gloam.navigation.paths import Point, length_of, point_ahead, smoothed
from gloam.navigation.window import DynamicWindow

Make = Callable[[LocalOptions], LocalPlanner]
NOTHING = np.empty((0, 2))
PERIOD = 0.25  # [s]


def open_floor(rows: int = 11, columns: int = 11) -> Grid:
    return Grid((0.0, 0.0), 0.1, np.zeros((rows, columns), bool))


def trap() -> Grid:
    """A floor of 6 x 6 m about (2, 0) with a wall at x = 2.5 m and walls at y = ± 1.5 m up to it, open to the left."""
    grid = Grid((-1.0, -3.0), 0.1, np.zeros((61, 61), bool))
    grid.blocked[15:46, 35] = True
    grid.blocked[(15, 45), 15:36] = True
    return grid


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


def test_distances_to_obstacles_are_exact() -> None:
    points = np.array([[0.3, 0.4], [5.0, 0.0]])
    near = Obstacles(points, LocalOptions(radius=0.6, margin=0.2))
    assert near.distances(np.zeros((2, 3, 2))).tolist() == [[0.5] * 3] * 2, "and the far point is left out"
    assert near.nearness(np.array([0.5, 0.7, 0.8, np.inf])).tolist() == pytest.approx([1, 0.5, 0, 0])
    assert near.hits(np.array([0.47, 0.49])).tolist() == [True, False], "a robot that is too close may leave"
    assert Obstacles(NOTHING, LocalOptions()).distances(np.zeros((4, 2))).tolist() == [math.inf] * 4


def drive(local: LocalPlanner, obstacles: np.ndarray, goal: Point, path: list[Point] | None = None) -> tuple[float, float]:
    """A unicycle that reaches velocities at once, for at most 40 s: the distance to the goal that is left, and the least
    one to an obstacle [m]."""
    place, yaw, least = np.zeros(2), 0.0, math.inf
    for _ in range(round(40 / PERIOD)):
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        target = point_ahead(path, (place[0], place[1]), 0.8) if path else goal
        x, y = (np.array(target) - place) @ turn
        command = local.choose((x, y), (obstacles - place) @ turn)
        for _ in range(10):
            yaw += 0.1 * PERIOD * command.yaw_rate
            place = place + 0.1 * PERIOD * command.vx * np.array([np.cos(yaw), np.sin(yaw)])
            least = min(least, np.hypot(*(obstacles - place).T).min(initial=math.inf))
        if math.dist(place, goal) < 0.3:
            break
    return math.dist(place, goal), least


def mppi(options: LocalOptions) -> LocalPlanner:
    return Mppi(options, PERIOD, 1)


@pytest.fixture(params=[DynamicWindow, mppi])
def make(request: pytest.FixtureRequest) -> Make:
    made: Make = request.param
    return made


def test_free_space_is_crossed_straight_at_top_speed(make: Make) -> None:
    local = make(LocalOptions(top_speed=0.4))
    commands = [local.choose((1.5, 0.0), NOTHING) for _ in range(12)]
    assert np.mean([c.vx for c in commands[2:]]) > 0.38 and max(c.vx for c in commands) <= 0.4
    assert np.abs([c.yaw_rate for c in commands]).mean() < 0.15 and all(c.vy == 0 for c in commands)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_robots_turn_to_targets_behind(make: Make, side: float) -> None:
    local = make(LocalOptions(top_yaw_rate=0.8))
    rates = [side * local.choose((-1.0, 0.4 * side), NOTHING).yaw_rate for _ in range(6)]
    assert np.mean(rates[2:]) > 0.5 and max(rates) <= 0.8
    left, _ = drive(make(LocalOptions()), NOTHING, (-2.0, 0.3 * side))
    assert left < 0.3


def test_robots_stop_before_a_wall(make: Make) -> None:
    wall = np.stack([np.full(61, 1.0), np.linspace(-1.5, 1.5, 61)], axis=-1)
    left, least = drive(make(LocalOptions()), wall, (2.0, 0.0))
    assert left > 0.9 and least > 0.25, "radius 0.28 m, less 2 cm for those who are too close already"


def test_robots_pass_a_gap(make: Make) -> None:
    half = np.linspace(0.4, 3.0, 53)
    wall = np.concatenate([np.stack([np.full(53, 1.5), side * half], axis=-1) for side in (1, -1)])
    left, least = drive(make(LocalOptions(radius=0.2)), wall, (3.0, 0.0))
    assert left < 0.3 and least > 0.18


def test_robots_leave_a_trap_along_the_path_only(make: Make) -> None:
    grid, options = trap(), LocalOptions(radius=0.12)
    walls, goal = grid.middles(grid.blocked), (4.0, 0.0)
    left, least = drive(make(options), walls, goal)
    assert left > 1.5 and least > 0.1
    left, least = drive(make(options), walls, goal, grid.path((0.0, 0.0), goal, grid.wall_cost(0.4, 4.0)))
    assert left < 0.3 and least > 0.1


def test_the_samples_of_mppi_follow_the_seed_and_go_on() -> None:
    wall = np.array([[0.8, 0.1], [0.9, -0.5]])

    def commands(seed: int) -> list[tuple[float, float]]:
        local = Mppi(LocalOptions(), PERIOD, seed)
        return [(c.vx, c.yaw_rate) for c in (local.choose((1.5, 0.2), wall) for _ in range(4))]

    assert commands(3) == commands(3) != commands(4)
    assert commands(-1) == commands((1 << 64) - 1)
    first, *_, last = commands(3)
    assert last[0] > first[0], "each call begins with the mean of the one before"
