"""Models of actuators in scenes: learned networks, topics, metrics, logs, threads."""
import json
import os
import shutil

import numpy as np
import pytest

import gloam

ARM = """<mujoco><compiler angle="radian"/><option timestep="0.001" gravity="0 0 0"/><worldbody>
<body><joint name="shoulder" axis="0 1 0" range="-2 2" limited="true" armature="0.01"/><inertial pos=".3 0 0" mass="1" diaginertia=".01 .01 .01"/>
<body pos=".3 0 0"><joint name="elbow" axis="0 1 0" armature="0.01"/><inertial pos=".2 0 0" mass=".5" diaginertia=".01 .01 .01"/></body></body>
</worldbody><actuator><position name="shoulder" joint="shoulder" kp="40" kv="2"/><position name="elbow" joint="elbow" kp="40" kv="2"/></actuator></mujoco>"""
ROBOT = '[sim]\nduration = 1\n[[robot]]\nname = "arm"\nfile = "arm.xml"\n'
EVERYTHING = """
[robot.controller]
type = "joint_position"
[robot.actuators.battery]
voltage = 24
internal_resistance = 0.2
capacity = 0.01
[[robot.actuator]]
joints = ".*"
gear_ratio = 6
stall_torque = 4
no_load_speed = 120
torque_constant = 0.1
winding_resistance = 0.2
delay = 0.004
backlash = 0.01
friction = { coulomb = 0.1, breakaway = 0.2, viscous = 0.01 }
thermal = { thermal_resistance = 2, heat_capacity = 0.5 }
"""


def write_scene(folder, text):
    folder.mkdir(exist_ok=True, parents=True)
    (folder / "arm.xml").write_text(ARM)
    (folder / "scene.toml").write_text(ROBOT + text)
    return folder / "scene.toml"


def drive(sim):
    """Commands of every kind that reaches joints."""
    robot = sim.robots["arm"]
    robot.command_joints(position=[0.4, -0.3])
    sim.step(200)
    robot.follow([[0.8, 0.2], [0.0, 0.5]], times=[0.2, 0.4])
    sim.step(300)
    robot.set_controller("joint_velocity", kp=20, kd=2)
    robot.command_joints(velocity=[0.5, -0.5])
    sim.step(200)
    robot.set_controller("joint_effort")
    robot.command_joints(effort=[0.5, -0.2], kp=[5, 5], kd=[0.5, 0.5])
    sim.step(200)


def test_any_number_of_threads_gives_the_same_run(tmp_path):
    scene, hashes = write_scene(tmp_path, EVERYTHING), []
    try:
        for threads in (1, 2, 4):
            gloam.set_thread_count(threads)
            with gloam.load(scene) as sim:
                drive(sim)
                hashes.append(sim.hash)
    finally:
        gloam.set_thread_count(0)
    assert len(set(hashes)) == 1


def test_a_recorded_run_is_the_same_and_verifies(tmp_path):
    scene = write_scene(tmp_path, EVERYTHING)
    with gloam.load(scene) as sim:
        drive(sim)
        unwatched = sim.hash
    with gloam.load(scene) as sim, sim.record(tmp_path / "run.mcap"):
        drive(sim)
        assert sim.hash == unwatched
    verified = gloam.replay(tmp_path / "run.mcap").verify()
    assert verified.is_equal and verified.steps == 900, verified


def test_a_checkpoint_keeps_the_memory_of_the_models(tmp_path):
    with gloam.load(write_scene(tmp_path, EVERYTHING)) as sim:
        drive(sim)
        there = sim.checkpoint()
        charge = sim.robots["arm"].battery["charge"]
        sim.step(100)
        after = sim.hash
        sim.restore(there)
        assert sim.robots["arm"].battery["charge"] == charge
        sim.step(100)
        assert sim.hash == after


def test_topics_publish_the_battery_and_the_motors(tmp_path):
    with gloam.load(write_scene(tmp_path, EVERYTHING)) as sim:
        inbox = sim.subscribe(["/arm/battery", "/arm/actuators"])
        sim.robots["arm"].command_joints(position=[1.0, -1.0])
        messages = {}
        for _ in range(21):
            sim.step(100)
            for message in inbox:
                messages.setdefault(message.topic, []).append(message.decode())
        assert len(messages["/arm/battery"]) == 3 and len(messages["/arm/actuators"]) == 106
        assert inbox.dropped == 0
        first, _, last = messages["/arm/battery"]
        assert first["percentage"] == 1 and 0 < last["percentage"] < 1
        assert last["percentage"] == pytest.approx(sim.robots["arm"].battery["charge"], abs=0.01)
        assert last["voltage"] <= 24
        states = messages["/arm/actuators"][-1]
        assert list(states["name"]) == ["shoulder", "elbow"]
        assert max(states["temperature"]) > 20


def test_metrics_contain_the_electrical_energy(tmp_path):
    scene = write_scene(tmp_path, EVERYTHING.replace('"joint_position"', '"joint_position"\ntarget = [0.5, -0.5]'))
    gloam.run(scene, tmp_path / "out", outputs=("metrics",))
    results = json.loads((tmp_path / "out" / "summary.json").read_text())["results"]
    energy = results["arm.electrical_energy_J"]
    drawn = (1 - results["arm.battery_charge"]) * 0.01 * 3600  # [C]
    assert drawn * results["arm.battery_voltage_min_V"] < energy < drawn * 24
    assert 5 < energy and results["arm.motor_temperature_max_degC"] > 20


# ---- networks ----
def network(path, weights):
    """An ONNX file whose torque is the product of the weights and the six inputs."""
    onnx = pytest.importorskip("onnx")
    pytest.importorskip("openvino")
    tensor = onnx.numpy_helper.from_array(np.array(weights, np.float32).reshape(6, 1), "w")
    ports = [onnx.helper.make_tensor_value_info(n, onnx.TensorProto.FLOAT, [1, s]) for n, s in (("in", 6), ("torque", 1))]
    graph = onnx.helper.make_graph([onnx.helper.make_node("MatMul", ["in", "w"], ["torque"])], "g", ports[:1], ports[1:], [tensor])
    model = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 17)])
    model.ir_version = 8
    onnx.save(model, path)


LEARNED = '[[robot.actuator]]\njoints = ".*"\nnetwork = { file = "law.onnx", period = 0.001 }\n'


@pytest.fixture
def learned(tmp_path):
    """A scene whose network is the law of its servos: 40 e(t) - 2 v(t)."""
    scene = write_scene(tmp_path / "scene", LEARNED)
    network(scene.parent / "law.onnx", [40, 0, 0, -2, 0, 0])
    return scene


def test_a_network_with_the_law_of_the_servos_moves_as_they_do(learned, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # its path is relative to the scene
    runs = []
    for scene in (learned, write_scene(tmp_path / "servos", "")):
        with gloam.load(scene) as sim:
            sim.robots["arm"].controls = [0.6, -0.4]
            sim.step(80)
            runs.append(sim.robots["arm"].qpos.copy())
    assert runs[0] == pytest.approx(runs[1], abs=1e-5)
    assert np.abs(runs[0]).min() > 0.05


def test_a_log_of_a_network_verifies_where_the_folder_has_moved(learned, tmp_path):
    with gloam.load(learned) as sim, sim.record(learned.parent / "run.mcap"):
        sim.robots["arm"].controls = [0.6, -0.4]
        sim.step(200)
    moved = tmp_path / "elsewhere"
    shutil.move(learned.parent, moved)
    assert gloam.replay(moved / "run.mcap").verify().is_equal
    (moved / "law.onnx").unlink()
    with pytest.raises(gloam.Error, match="law.onnx"):
        gloam.replay(moved / "run.mcap").verify()


def test_a_network_outside_of_the_root_is_rejected(learned, tmp_path):
    outside = tmp_path / "law.onnx"
    network(outside, [1, 0, 0, 0, 0, 0])
    link = learned.parent / "link.onnx"
    os.symlink(outside, link)
    for file in (str(outside), "../law.onnx", "link.onnx"):
        learned.write_text(ROBOT + LEARNED.replace("law.onnx", file))
        with pytest.raises(gloam.Error, match="scene.toml:6.*(outside|leads out)"):
            gloam.Scene(learned, strict=True)


@pytest.mark.parametrize("weights, message", [([float("nan")] * 6, "not finite"), ([1e38] * 6, "not finite")])
def test_a_network_that_is_not_finite_ends_the_run(learned, weights, message):
    network(learned.parent / "law.onnx", weights)
    with gloam.load(learned) as sim, pytest.raises(gloam.Error, match=f"joint 'arm/shoulder'.*{message}|{message}.*"):
        sim.robots["arm"].controls = [10, 10]
        sim.step(100)
