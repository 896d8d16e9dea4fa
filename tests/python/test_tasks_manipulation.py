"""examples/tasks: the arm that clears a table and the mobile manipulator that opens a door succeed, and their logs verify."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gloam

TASKS = Path(__file__).resolve().parents[2] / "examples" / "tasks"


def program(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, TASKS / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(name: str, *arguments: str | Path) -> str:
    """The output of a task's program."""
    return subprocess.run([sys.executable, TASKS / f"{name}.py", *map(str, arguments)], text=True, capture_output=True, check=True, timeout=1500).stdout


def hashes(output: str) -> list[str]:
    return re.findall(r"hash (\w{16})", output)


def test_the_arm_finds_grasps_and_carries_an_object() -> None:
    pick = program("pick")
    sim = gloam.Simulation(gloam.Scene(TASKS / "pick.toml").compile(), seed=4)
    pick.scatter(sim, np.random.default_rng(4))
    arm = pick.Arm(sim)
    arm.go(np.array([0.3, 0.55, 1.25]))
    seen = pick.look(sim)
    assert sorted(seen) == sorted(pick.OBJECTS)
    for name, points in seen.items():
        place, _ = pick.grasp(points, again=False)
        assert place[:2] == pytest.approx(sim.bodies[name].pose.p[:2], abs=0.015), name
    first = max(seen, key=lambda name: np.arctan2(*seen[name].mean(axis=0)[1::-1]))
    assert pick.pick(arm, seen[first], again=False) == "in the bin"
    assert np.all(np.abs(sim.bodies[first].pose.p[:2] - pick.BIN) < [0.2, 0.3])
    assert sim.bodies[first].pose.p[2] < 0.7


def test_rotations_of_the_hand() -> None:
    door = program("door")
    np.testing.assert_allclose(door.turn([0, 0, 1], np.pi / 2) @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    q = door.quaternion(door.turn([0.6, 0, 0.8], 0.7))
    np.testing.assert_allclose(q * np.sign(q[0]), [np.cos(0.35), *(np.sin(0.35) * np.array([0.6, 0, 0.8]))], atol=1e-12)
    np.testing.assert_allclose(door.facing(0.3) @ [0, 1, 0], [0, 0, 1], atol=1e-12)


@pytest.mark.slow
def test_the_arm_clears_tables(tmp_path: Path) -> None:
    log = tmp_path / "pick.mcap"
    output = run("pick", "--seeds", "2", "--log", log)
    done = re.search(r"(\d+) of 20 objects are in the bin", output)
    assert done is not None and int(done[1]) >= 18, output
    assert gloam.replay(log).verify().differing_steps == 0
    assert hashes(run("pick", "--seeds", "1")) == hashes(output)[:1], "recording has no influence"


@pytest.mark.slow
def test_the_arm_clears_a_table_in_dust() -> None:
    done = re.search(r"(\d+) of 10 objects", run("pick", "--overlay", "pick_dust.toml"))
    assert done is not None and int(done[1]) >= 5


@pytest.mark.slow
def test_the_mobile_manipulator_opens_doors(tmp_path: Path) -> None:
    log = tmp_path / "door.mcap"
    output = run("door", "--seeds", "3", "--first", "1", "--log", log)
    done = re.search(r"(\d+) of 3 doors are open", output)
    assert done is not None and int(done[1]) >= 2, output
    assert "fallen" not in output
    assert gloam.replay(log).verify().differing_steps == 0
    assert hashes(run("door", "--first", "1")) == hashes(output)[:1]
