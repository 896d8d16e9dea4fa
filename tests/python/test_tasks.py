"""The tasks of examples/tasks (docs/tasks.md): planning and avoidance alone, then each task as a whole, with its log."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from gloam.navigation.grid import Grid

import gloam

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples" / "tasks"))
import cross_warehouse  # noqa: E402
import route  # noqa: E402


def two_rooms() -> Grid:
    """4 x 2 m in cells of 0.1 m; a wall at x = 2 m with an opening above y = 1.5 m."""
    blocked = np.zeros((20, 40), dtype=bool)
    blocked[:15, 20] = True
    return Grid((0.0, 0.0), 0.1, blocked)


def test_the_shortest_way_leads_through_the_opening() -> None:
    way = route.shortest(two_rooms(), (0.5, 0.5), (3.5, 0.5))
    assert way[0] == pytest.approx([0.5, 0.5]) and way[-1] == pytest.approx([3.5, 0.5])
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    assert steps.max() < 0.1415
    # Over the grid: from each side 10 diagonal steps to the row of the opening, and 10 level ones in all.
    assert steps.sum() == pytest.approx(20 * 0.1 * np.sqrt(2) + 1.0, abs=1e-6)
    assert way[np.abs(way[:, 0] - 2.0) < 0.05][0, 1] > 1.45


def test_pursuit_goes_on_along_the_route_and_ends_at_its_end() -> None:
    straight = np.column_stack([np.linspace(0, 3, 61), np.zeros(61)])
    pursuit = route.Pursuit(straight, 0.5)
    assert pursuit.target((0.0, 0.1)) == pytest.approx([0.5, 0.0], abs=0.06)
    assert pursuit.target((1.0, -0.2)) == pytest.approx([1.0 + np.sqrt(0.21), 0.0], abs=0.06)
    assert pursuit.target((2.9, 0.0)) == pytest.approx([3.0, 0.0])


def drive(obstacles: np.ndarray, velocity: tuple[float, float], seconds: float) -> tuple[np.ndarray, float]:
    """A base without inertia at (0, 0) that heads for (4, 0) among moving points: its last place, the least gap."""
    window, place, yaw, least = cross_warehouse.DynamicWindow(0.2), np.zeros(2), 0.0, np.inf
    for _ in range(round(seconds / 0.2)):
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        moving = window.velocities(obstacles) @ turn
        v, w = window.choose((obstacles - place) @ turn, moving, (np.array([4.0, 0.0]) - place) @ turn)
        for _ in range(20):
            place = place + 0.01 * v * np.array([np.cos(yaw), np.sin(yaw)])
            yaw += 0.01 * w
            obstacles = obstacles + 0.01 * np.array(velocity)
            least = min(least, float(np.linalg.norm(obstacles - place, axis=1).min()) - cross_warehouse.RADIUS)
    return place, least


def test_the_window_leads_around_a_pillar() -> None:
    angle = np.linspace(0, 2 * np.pi, 40)
    place, gap = drive(np.array([2.0, 0.05]) + 0.15 * np.column_stack([np.cos(angle), np.sin(angle)]), (0, 0), 9)
    assert place[0] > 3.0 and gap > 0.05


def test_the_window_stops_before_a_wall() -> None:
    wall = np.column_stack([np.full(201, 1.5), np.linspace(-5, 5, 201)])
    place, gap = drive(wall, (0, 0), 6)
    assert gap > 0.05 and place[0] < 1.5


def test_the_window_yields_to_a_leg_that_crosses() -> None:
    angle = np.linspace(0, 2 * np.pi, 24)
    leg = np.array([1.5, -2.5]) + 0.06 * np.column_stack([np.cos(angle), np.sin(angle)])
    _, gap = drive(leg, (0.0, 1.0), 5)
    assert gap > 0.05


TOUCH = """
[environment]
file = "assets/environments/arena/arena.xml"
[[agent]]
name = "worker0"
behavior = "stand"
position = [1, 0, 0]
[[robot]]
name = "base"
model = "diff_drive"
"""


def test_a_base_without_avoidance_touches_a_person() -> None:
    """The measures of success notice it: contacts, and the gap to the legs."""
    with gloam.load(gloam.Scene.parse(TOUCH, ROOT)) as sim:
        people, metrics = cross_warehouse.People(sim), sim.open_metrics()
        assert metrics.latest().get("base.collisions", 0) == 0
        assert people.nearest(sim.robots["base"].pose.p) == pytest.approx(0.75, abs=0.1)
        sim.robots["base"].command(vx=0.5)
        sim.run_until(time=2.5)
        assert metrics.latest()["base.collisions"] > 0
        assert people.nearest(sim.robots["base"].pose.p) < 0.02


@pytest.mark.slow
def test_the_base_crosses_the_warehouse(tmp_path: Path) -> None:
    result = cross_warehouse.cross(1, "none", tmp_path)
    assert result["there"] and result["contacts"] == 0 and result["nearest"] > 0
    assert gloam.replay(tmp_path / "none_1.mcap").verify().differing_steps == 0


@pytest.mark.slow
def test_the_quadruped_walks_out_of_the_burning_house(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    import walk_out

    result = walk_out.walk(3, tmp_path)
    assert result["out"] and result["go.fallen"] == 0
    assert gloam.replay(tmp_path / "3.mcap").verify().differing_steps == 0
