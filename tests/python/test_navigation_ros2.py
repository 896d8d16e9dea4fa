"""A planner as a ROS 2 node, in lockstep through examples/ros2/planner_relay.py, with the real rclpy."""

from __future__ import annotations

import math
import os
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import gloam
import pytest
from e2e.ros2_env import ros2_env
from gloam.navigation import Driver, Rig, Task
from navigation_scene import arena

zmq = pytest.importorskip("zmq")
from gloam.navigation.planners.external import ExternalPlanner  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
RELAY = ROOT / "examples" / "ros2" / "planner_relay.py"
NODE = ROOT / "tests" / "e2e" / "ros2_planner_node.py"
GOAL = (0.2, -0.4)

pytestmark = pytest.mark.slow  # makes the environment of rclpy, once


@pytest.fixture(scope="module")
def ros(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """The interpreter and the variables of ROS 2, with the pyzmq of this interpreter."""
    env = ros2_env()
    packages = tmp_path_factory.mktemp("packages")
    site = Path(zmq.__file__).parents[1]
    for name in ("zmq", "pyzmq.libs"):
        if (site / name).exists():
            (packages / name).symlink_to(site / name)
    variables = env.variables(domain=1 + os.getpid() % 80)
    variables["PYTHONPATH"] += f":{packages}"
    return env.python, variables


@pytest.fixture
def processes(ros: tuple[Path, dict[str, str]], tmp_path: Path) -> Iterator[Any]:
    """start(script, …): a process of ROS 2, which ends with the test."""
    with ExitStack() as stack:

        def start(*arguments: object) -> subprocess.Popen[bytes]:
            process = subprocess.Popen([str(ros[0]), *map(str, arguments)], env=ros[1], cwd=tmp_path)
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        yield start


@pytest.mark.parametrize("mode", ["velocity", "path", "clock"])
def test_a_node_drives_to_the_goal_and_the_run_repeats(processes: Any, tmp_path: Path, mode: str) -> None:
    address, world, hashes = f"ipc://{tmp_path}/relay", arena().compile(), set()
    relay = processes(RELAY, "--address", address, "--namespace", "go", "--needs", "image,scan", "--rate", "5")
    processes(NODE, "go", mode)
    for _ in range(2):
        with gloam.Simulation(world) as sim:
            driver = Driver(sim, Rig("go", "go/front", "lidar"), ExternalPlanner(address, timeout=60))
            assert driver.planner.needs == {"image", "scan"} and driver.planner.rate == 5
            driver.run(Task("go", goal=GOAL, radius=0.4), 15.0, lambda s: driver.has_arrived)  # noqa: B023
            assert driver.stats.invalid == 0, driver.stats.error
            assert driver.has_arrived and math.dist(sim.robots["go"].pose.p[:2], GOAL) < 0.5
            hashes.add(sim.hash)
            driver.close()
    assert len(hashes) == 1
    relay.terminate()
    assert relay.wait(10) == 0


def test_answers_with_another_stamp_are_given_up(processes: Any, tmp_path: Path) -> None:
    address = f"ipc://{tmp_path}/relay"
    processes(RELAY, "--address", address, "--namespace", "go", "--needs", "")
    processes(NODE, "go", "stale")
    with gloam.Simulation(arena().compile()) as sim:
        planner = ExternalPlanner(address, timeout=60)
        driver = Driver(sim, Rig("go"), planner)
        planner.reset(Task("go", goal=GOAL))  # waits for the node
        planner._timeout = 3.0
        driver.run(Task("go", goal=GOAL), 1.0)
        assert driver.stats.plans == driver.stats.invalid == 4
        assert "has not answered within 3 s" in driver.stats.error
        driver.close()


def test_a_missing_node_is_an_error_before_the_first_step(processes: Any, tmp_path: Path) -> None:
    address = f"ipc://{tmp_path}/relay"
    processes(RELAY, "--address", address, "--namespace", "go", "--needs", "")
    planner = ExternalPlanner(address, timeout=60)
    with pytest.raises(gloam.UsageError, match="no node publishes any of /go/cmd_vel_stamped, /go/path, /go/arrived"):
        planner.reset(Task("go", goal=GOAL))
    planner.close()
