"""The catalogue's humanoid walks by networks that were trained for the G1: its joints, inertias and limits are the G1's."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("openvino")
import gloam  # noqa: E402
from gloam.policy import Policy  # noqa: E402

import policy_data  # noqa: E402
from robots import ROBOTS  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
GROUND = '<mujoco><option integrator="implicitfast"/><worldbody><geom type="plane" size="0 0 0.05"/></worldbody></mujoco>'
SCENE = f"""
[scene]
name = "walk"

[sim]
timestep = 0.004

[environment]
file = "ground.xml"

[[robot]]
name = "robot"
file = "{ROBOTS / "humanoid" / "humanoid.xml"}"
"""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def networks() -> Path:
    try:
        return policy_data.fetch().holosoma / "loco" / "g1_29dof"
    except RuntimeError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize(
    "network, command, least, most",
    [
        ("ppo_g1_29dof.onnx", (0.5, 0.0), 1.5, 3.0),
        ("fastsac_g1_29dof.onnx", (0.5, 0.0), 1.6, 3.0),
        ("fastsac_g1_29dof.onnx", (0.0, 0.3), 0.4, 1.8),
    ],
)
def test_humanoid_walks_by_a_network_of_the_g1(
    networks: Path, tmp_path: Path, network: str, command: tuple[float, float], least: float, most: float
) -> None:
    """Distance in the commanded direction after 5 s [m]. Measured: 1.71, 1.91 and 0.67 m."""
    policy = Policy(networks / network, ROOT / "examples" / "python" / "g1_policy.toml")
    (tmp_path / "ground.xml").write_text(GROUND)
    with gloam.load(gloam.Scene.parse(SCENE, tmp_path, root="/")) as sim:
        drive = policy.attach(sim, "robot")
        drive.place((0, 0, 0.76))
        drive.command(vx=command[0], vy=command[1])
        poses = []
        for i in range(1, 11):
            sim.run_until(time=0.5 * i)
            poses.append(sim.robots["robot"].pose)
    axis = 0 if command[0] else 1
    assert least < poses[-1].p[axis] < most and abs(poses[-1].p[1 - axis]) < 0.5
    assert min(pose.p[2] for pose in poses) > 0.74 and min(pose.R[2, 2] for pose in poses) > 0.97
