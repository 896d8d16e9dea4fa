"""gloam.ik, and the controllers "ik" and "osc" in scenes: goals, errors, logs that replay."""

from __future__ import annotations

import shutil
from pathlib import Path

import gloam
import ik_models
import numpy as np
import pytest
from gloam import ik

SCENE = """
[[robot]]
name = "arm"
file = "arm.xml"
keyframe = "home"

[robot.controller]
type = "ik"
rate = 250
frame = "site tool"
velocity_limit = 1.5
collision_distance = 0.01
"""
GOAL = ([0.4, 0.2, 0.35], [0, 0, 1, 0])


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    shutil.copy(ik_models.ROOT / "assets" / "robots" / "arm" / "arm.xml", tmp_path)
    path = tmp_path / "reach.toml"
    path.write_text(SCENE)
    return path


def tool(sim: gloam.Simulation) -> np.ndarray:
    return np.asarray(sim.bodies["arm/tool"].pose.p)


def test_the_arm_reaches_its_goal(scene: Path) -> None:
    sim = gloam.load(scene)
    sim.robots["arm"].set_pose_goal(GOAL)
    sim.run_until(time=4)
    # Its servos yield by up to 17 mrad under the arm's weight.
    assert np.linalg.norm(tool(sim) - GOAL[0]) < 0.02
    assert abs(sim.bodies["arm/tool"].pose.q @ GOAL[1]) > 0.999
    sim.robots["arm"].set_pose_goal(gloam.Pose(np.array([0.3, -0.3, 0.4]), np.array([0, 0, 1.0, 0])))
    sim.run_until(time=8)
    assert np.linalg.norm(tool(sim) - [0.3, -0.3, 0.4]) < 0.02


def test_goals_repeat_and_survive_a_checkpoint(scene: Path) -> None:
    hashes = []
    for _ in range(2):
        sim = gloam.load(scene)
        sim.robots["arm"].set_pose_goal(GOAL)
        sim.run_until(time=0.5)
        saved = sim.checkpoint()
        sim.run_until(time=1)
        hashes.append(sim.hash)
        sim.restore(saved)
        sim.run_until(time=1)
        hashes.append(sim.hash)
    assert len(set(hashes)) == 1


def test_a_goal_out_of_reach_is_reported_once(scene: Path, run_python) -> None:  # type: ignore[no-untyped-def]
    code = f"""
import gloam, numpy as np
sim = gloam.load({str(scene)!r})
sim.robots["arm"].set_pose_goal(([3, 0, 0.5], [1, 0, 0, 0]))
sim.run_until(time=8)
assert np.isfinite(sim.robots["arm"].qpos).all()
"""
    result = run_python(code)
    assert result.stderr.count("out of reach") == 1, result.stderr


def test_wrong_goals_and_options_are_refused(scene: Path, tmp_path: Path) -> None:
    sim = gloam.load(scene)
    with pytest.raises(gloam.UsageError, match="quaternion"):
        sim.robots["arm"].set_pose_goal(([0, 0, 0], [0, 0, 0, 0]))
    with pytest.raises(gloam.UsageError, match="finite"):
        sim.robots["arm"].set_pose_goal(([np.nan, 0, 0], [1, 0, 0, 0]))
    for line, message in {
        'frame = "site tol"': "'arm/tool'",
        'frame = "tool"': "site NAME",
        "": "frame",
        'frame = "body pedestal"': "no motor or position servo",
    }.items():
        path = tmp_path / "wrong.toml"
        path.write_text(SCENE.replace('frame = "site tool"', line))
        with pytest.raises(gloam.InputError, match=message):
            gloam.load(path)


def test_operational_space_control_needs_motors(scene: Path) -> None:
    scene.write_text(SCENE.replace('"ik"', '"osc"').split("velocity_limit")[0])
    with pytest.raises(gloam.InputError, match="position servo"):
        gloam.load(scene)


def test_a_log_of_the_arm_verifies(scene: Path, tmp_path: Path) -> None:
    sim = gloam.load(scene)
    log = tmp_path / "reach.mcap"
    with sim.record(log):
        sim.robots["arm"].set_pose_goal(GOAL)
        sim.run_until(time=1)
        sim.robots["arm"].set_pose_goal(([0.3, -0.3, 0.4], [0, 0, 1, 0]))
        sim.run_until(time=2)
    assert gloam.Log(log).verify().is_equal


def test_solver_reports_what_it_cannot_solve(tmp_path: Path) -> None:
    world = gloam.load(ik_models.arm(tmp_path)).world
    posture = ik.PostureTask(1.0, target=np.zeros(7))
    limits = [ik.ConfigurationLimit(), ik.VelocityLimit({"j0": 1.0})]
    solver = ik.Solver(world, [posture], limits)
    outside = np.zeros(7)
    outside[0] = 4
    assert not solver.solve(outside, 0.01).any()
    assert solver.status == "infeasible"
    assert solver.solve(np.full(7, 0.001), 0.01) == pytest.approx(-0.1)
    assert solver.status == "solved"
    frame = ik.FrameTask("site tool", orientation_cost=0, target=([0.3, 0, 0.5], [1, 0, 0, 0]))
    loose = ik.Solver(world, [frame], damping=0)
    assert not loose.solve(np.zeros(7), 0.01).any()
    assert loose.status == "singular"


def test_wrong_problems_name_the_remedy(tmp_path: Path) -> None:
    sim = gloam.load(ik_models.arm(tmp_path))
    with pytest.raises(gloam.InputError, match="tol") as error:
        ik.Solver(sim, [ik.FrameTask("site tol")])
    assert "tool" in str(error.value)
    with pytest.raises(gloam.InputError, match="site NAME"):
        ik.Solver(sim, [ik.FrameTask("tool")])
    solver = ik.Solver(sim, [ik.PostureTask()])
    with pytest.raises(gloam.UsageError, match="target"):
        solver.solve(np.zeros(7), 0.01)
    solver.tasks[0].target = np.zeros(3)  # type: ignore[union-attr]
    with pytest.raises(gloam.InputError, match="7 coordinates"):
        solver.solve(np.zeros(7), 0.01)
    solver.tasks[0].target = np.zeros(7)  # type: ignore[union-attr]
    with pytest.raises(gloam.InputError, match="7 coordinates"):
        solver.solve(np.zeros(6), 0.01)
    with pytest.raises(gloam.InputError, match="time step"):
        solver.solve(np.zeros(7), 0.0)
