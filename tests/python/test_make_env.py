"""Environments made of tables: names of cameras, topics and metrics, in Python and TOML."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import gloam
from gloam.envs import EnvSettings, make_env, make_vec_env

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "envs"
SCENE, WALK = EXAMPLES / "walk_scene.toml", EXAMPLES / "walk.toml"
TILT = {"tilt": {"metric": "go.tilt_deg"}}
COMMAND = {"command": "go", "low": [-0.2, -0.2, -0.8], "high": [0.5, 0.2, 0.8]}


@pytest.fixture(scope="module")
def world():
    return gloam.Scene(SCENE).compile(progress=False)


def test_the_example_is_checked_and_its_goal_reached():
    env = make_env(WALK)
    check_env(env, skip_render_check=True)
    observation, _ = env.reset(seed=0)
    assert observation["picture"].shape == (12, 16) and observation["bearing"].shape == (3, 1)
    total, steps = 0.0, 0
    terminated = truncated = False
    while not (terminated or truncated):
        turn = np.clip(3 * observation["bearing"][-1, 0], -0.8, 0.8)
        observation, reward, terminated, truncated, info = env.step(np.array([0.4, 0, turn]))
        total, steps = total + reward, steps + 1
    assert terminated and info["success"] and steps < 60
    assert 5 < total < 7  # 5 for the goal, 1.6 m - 0.3 m, less the rest
    env.reset(seed=0)
    for k in range(100):
        _, _, terminated, truncated, info = env.step(np.zeros(3))
        assert truncated == (k == 99) and not terminated and not info["success"]


def test_the_file_of_the_page_works(tmp_path):
    page = EXAMPLES.parents[1] / "docs" / "python_envs.md"
    (text,) = re.findall(r"``` toml\n(.*?)```", page.read_text(), re.DOTALL)
    file = tmp_path / "env.toml"
    file.write_text(text.replace("walk_scene.toml", str(SCENE)))
    env = make_env(file)
    env.reset(seed=0)
    assert env.step(np.array([0.3, 0, 0]))[0]["bearing"].shape == (3, 1)


def test_one_and_many_worlds_are_the_same():
    many, one = make_vec_env(WALK, 3), make_env(WALK)
    seen, _ = many.reset(seed=4)
    alone, _ = one.reset(seed=6)
    for k in range(4):
        assert all(np.array_equal(seen[name][2], alone[name]) for name in alone)
        action = np.tile([0.1 * k, 0.0, 0.3], (3, 1))
        seen, alone = many.step(action)[0], one.step(action[2])[0]
    assert many.hashes[2] == one.hash


@pytest.mark.parametrize("seed", [1, 7])
def test_a_seed_is_the_run_of_that_seed(world, tmp_path, seed):
    scene = gloam.Scene(SCENE)
    scene["sim.seed"] = seed
    report = gloam.run(scene, tmp_path / "run", outputs=["metrics"], duration=0.5, seed=seed)
    env = make_env(world, TILT)  # without actions: the robot does what its scene says
    env.reset(seed=seed)
    for _ in range(5):
        env.step(np.zeros(0))
    assert env.sim.step_count == report.steps
    assert env.hash == report.hash
    sim = gloam.Simulation(world, seed=seed)
    sim.step(report.steps)
    assert sim.hash == report.hash


def test_all_kinds_of_sources(world):
    observations = {
        "metric": "go.goal_distance_m",
        "topic": {"topic": "/go/odom", "field": "pose.pose.position"},
        "camera": {"camera": "go/front", "output": "rgb", "size": [8, 6]},
        "scaled": {"camera": "go/front", "output": "rgb", "size": [8, 6], "scale": 1 / 255},
        "ids": {"camera": "go/front", "output": "semantic", "size": [8, 6]},
        "sensor": {"sensor": "go/imu_accelerometer"},
        "joints": {"joints": "go"},
        "speeds": {"joint_velocities": "go", "clip": [-1, 1]},
        "function": lambda sim: sim.robots["go"].pose.p,
    }
    env = make_env(world, observations, COMMAND)
    seen, _ = env.reset(seed=0)
    for _ in range(5):
        seen, *_ = env.step(np.array([0.5, 0, 0]))
    assert env.observation_space.contains(seen)
    assert seen["camera"].dtype == np.uint8 and seen["scaled"].dtype == np.float32
    np.testing.assert_allclose(seen["topic"], seen["function"], atol=0.02)
    np.testing.assert_allclose(seen["metric"], np.hypot(*(np.array([1.5, 0.5]) - seen["function"][:2])), atol=1e-4)
    assert 5 < np.linalg.norm(seen["sensor"]) < 20
    assert env.sim.robots["go"].pose.p[0] > 0.05  # it was told to walk


def test_nothing_of_the_episode_before_is_seen_after_a_reset(world):
    observations = {"topic": {"topic": "/go/odom", "field": "pose.pose.position.x"}, "metric": "go.path_length_m"}
    env = make_env(world, observations, COMMAND)
    first, _ = env.reset(seed=0)
    for _ in range(8):
        last, *_ = env.step(np.array([0.5, 0, 0]))
    again, _ = env.reset(seed=0)
    assert last["topic"] > first["topic"] + 0.05 and last["metric"] > first["metric"] + 0.05
    assert all(np.array_equal(first[name], again[name]) for name in first)


def test_joint_goals_and_controls_move_the_robot():
    scene = gloam.Scene(SCENE)
    scene["robot.go.controller.type"] = "joint_position"
    scene["robot.go.controller.kp"] = 60.0
    scene["robot.go.controller.kd"] = 2.0
    env = make_env(scene, {"joints": {"joints": "go"}}, {"joint_goals": "go"})
    assert env.action_space.shape == (12,)
    first, _ = env.reset(seed=0)
    goal = first["joints"] + np.tile([0.0, 0.2, 0.0], 4)
    for _ in range(4):
        seen, *_ = env.step(goal)
    assert np.abs(seen["joints"] - goal).max() < 0.1
    scene["robot.go.controller.type"] = "none"
    env = make_env(scene, {"joints": {"joints": "go"}}, [{"controls": "go"}])
    np.testing.assert_allclose(env.action_space.high[:3], [23.7, 23.7, 35.55], rtol=1e-5)
    env.reset(seed=0)
    env.step(np.full(12, 3.0))
    np.testing.assert_allclose(env.sim.robots["go"].controls, 3.0)


def test_functions_reward_and_end(world):
    moved = {"function": lambda sim, action: sim.robots["go"].command(vx=float(action[0])), "low": [0], "high": [1]}
    env = make_env(
        world,
        TILT,
        moved,
        reward=lambda sim: 2.0,
        termination=[{"function": lambda sim: sim.time > 0.25, "success": True}],
    )
    env.reset(seed=0)
    results = [env.step(np.array([0.2]))[1:] for _ in range(3)]
    assert [result[0] for result in results] == [2.0] * 3
    assert [result[1] for result in results] == [False, False, True]
    assert results[-1][3] == {"success": True}


def test_settings_reach_the_terms(world):
    env = make_env(world, TILT, COMMAND, noise={"tilt": 5.0}, history={"tilt": 4}, sensor_latency={"tilt": 0.1})
    seen, _ = env.reset(seed=0)
    assert seen["tilt"].shape == (4, 1) and abs(seen["tilt"][0, 0]) > 0.1
    assert isinstance(env._worlds.settings, EnvSettings)


@pytest.mark.parametrize(
    "bad",
    [
        {"observations": {}},
        {"observations": {"x": {"metric": "go.tilt_deg", "smell": 1}}},
        {"observations": {"x": {"metric": "go.tilt_deg", "camera": "go/front"}}},
        {"observations": {"x": {}}},
        {"observations": {"x": 3}},
        {"observations": {"x": {"metric": "go.tilt_deg", "clip": [2, 1]}}},
        {"observations": {"x": {"lidar": "none"}}},
        {"actions": {"command": "go"}},
        {"actions": {"command": "go", "low": [0, 0], "high": [1, 1]}},
        {"actions": {"wish": "go"}},
        {"actions": {**COMMAND, "gain": 2}},
        {"actions": "go"},
        {"reward": [{"weight": 2}]},
        {"reward": [{"metric": "go.tilt_deg", "weight": float("nan")}]},
        {"reward": [{"metric": "go.tilt_deg", "scale": 2}]},
        {"reward": "go.tilt_deg"},
        {"termination": [{"metric": "go.tilt_deg"}]},
        {"termination": [{"above": 1}]},
        {"control_interval": 0},
        {"control_interval": float("nan")},
        {"layout": "heap"},
        {"max_episode_steps": 0},
    ],
)
def test_tables_that_make_no_sense_are_errors(world, bad):
    with pytest.raises(ValueError):
        make_env(world, **{"observations": TILT, **bad})


@pytest.mark.parametrize(
    ("bad", "name"),
    [
        ({"observations": {"x": "go.tild_deg"}}, "go.tild_deg"),
        ({"observations": {"x": {"camera": "go/fromt"}}}, "go/fromt"),
        ({"observations": {"x": {"sensor": "go/imu_giro"}}}, "go/imu_giro"),
        ({"observations": {"x": {"topic": "/go/odom", "field": "pose.smell"}}}, "pose.smell"),
        ({"observations": {"x": {"joints": "gone"}}}, "gone"),
        ({"actions": {**COMMAND, "command": "gone"}}, "gone"),
        ({"reward": {"metric": "go.tild_deg"}}, "go.tild_deg"),
        ({"termination": {"metric": "go.tild_deg", "above": 1}}, "go.tild_deg"),
    ],
)
def test_names_that_there_are_not_are_told_when_it_is_made(world, bad, name):
    with pytest.raises(gloam.NotFoundError, match=name):
        make_env(world, **{"observations": TILT, **bad})


@pytest.mark.parametrize(
    "text",
    [
        "scene = 3 4",
        "[observations.x]\nmetric = 'go.tilt_deg'",
        f"scene = '{SCENE}'",
        f"scene = '{SCENE}'\nsmell = 1\n[observations.x]\nmetric = 'go.tilt_deg'",
        f"scene = '{SCENE}'\n[observations.x]\nmetric = 'go.tilt_deg'\n[settings]\nthreads = 0",
    ],
)
def test_files_that_make_no_sense_are_errors(tmp_path, text):
    file = tmp_path / "env.toml"
    file.write_text(text)
    with pytest.raises(ValueError):
        make_env(file)


def test_a_world_without_a_file_needs_observations(world):
    with pytest.raises(ValueError, match="observations"):
        make_env(world)


def test_resets_take_no_memory():
    """A stream of metrics that each reset opened anew took 0.13 MB."""
    program = f"""
import ctypes, gc
from pathlib import Path
from gloam.envs import make_env

def resident():
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

env = make_env({str(SCENE)!r}, {TILT!r}, {COMMAND!r})
for k in range(350):
    env.reset()
    if k == 50:
        before = resident()
grown = resident() - before
assert grown < 15e6, grown  # 39 MB, if each took that
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=180)
