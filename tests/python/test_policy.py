"""Policies at work: joints, torques, histories, resets, recompiles, and robots that walk."""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402
from gloam.policy import Policy, PolicyDriver  # noqa: E402

from policy_fixtures import HELD, MOTORS, OBSERVATION, POLICY, held_policy, write_network, write_scene, write_settings  # noqa: E402

KP, KD, DEFAULTS = np.array([10.0, 20.0]), 0.5, np.array([0.3, -0.2])  # of knee, hip


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[gloam.Simulation]:
    with gloam.load(write_scene(tmp_path)) as made:
        yield made


def joint_state(sim: gloam.Simulation) -> tuple[np.ndarray, np.ndarray]:
    """(knee, hip), the policy's order."""
    joints = [sim.joints["bot/knee"], sim.joints["bot/hip"]]
    return np.array([j.position for j in joints]), np.array([j.velocity for j in joints])


def test_torques_are_the_policys_at_every_step_whatever_the_gear(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path).attach(sim, "bot")
    targets = DEFAULTS + 0.5 * HELD
    assert not drive.is_active and drive.action.tolist() == [0, 0] and drive.targets.tolist() == DEFAULTS.tolist()
    for _ in range(20):
        q, v = joint_state(sim)
        sim.step()
        np.testing.assert_allclose(
            sim.memory.array("actuator_force") * [1, 2], (KP * (targets - q) - KD * v)[::-1], atol=1e-12
        )
    assert drive.is_active and not drive.is_servo and drive.action.tolist() == HELD.tolist()
    np.testing.assert_allclose(drive.targets, targets, atol=1e-7)
    assert abs(joint_state(sim)[0]).min() > 0.01  # it moved


@pytest.mark.parametrize(
    "actuators",
    [
        '<position name="a" joint="hip" kp="55" kv="3"/><position name="b" joint="knee" kp="5" gear="2"/>',
        '<general name="a" joint="hip" gainprm="2" biastype="affine" biasprm="0.5 -1 -0.1"/>'
        '<motor name="b" joint="knee"/>',
        '<motor name="b" joint="knee"/><motor name="a" joint="hip" gear="-3"/>',
    ],
)
def test_servos_of_other_gains_give_the_policys_torques(tmp_path: Path, actuators: str) -> None:
    hashes = []
    for name, kind in (("a", actuators), ("b", '<motor name="b" joint="knee"/><motor name="a" joint="hip"/>')):
        folder = tmp_path / name
        folder.mkdir()
        with gloam.load(write_scene(folder, kind)) as sim:
            held_policy(folder).attach(sim, "bot")
            sim.step(200)
            hashes.append(np.concatenate(joint_state(sim)))
    np.testing.assert_allclose(hashes[0], hashes[1], atol=1e-9)


def test_servos_of_the_same_gains_get_targets(tmp_path: Path) -> None:
    servos = '<position name="a" joint="hip" kp="20" kv="0.5"/><position name="b" joint="knee" kp="10" kv="0.5"/>'
    with gloam.load(write_scene(tmp_path, servos)) as sim:
        drive = held_policy(tmp_path).attach(sim, "bot")
        sim.step()
        assert drive.is_servo
        np.testing.assert_allclose(sim.robots["bot"].controls, (DEFAULTS + 0.5 * HELD)[::-1], atol=1e-7)


def test_torque_limit(sim: gloam.Simulation, tmp_path: Path) -> None:
    held_policy(tmp_path, extra="torque_limit = [0.25, 100.0]\n").attach(sim, "bot")
    sim.step()
    assert sim.memory.array("actuator_force")[1] * 2 == pytest.approx(0.25)


def test_reset_gives_the_same_run_and_leaves_others_alone(tmp_path: Path) -> None:
    weights = np.random.default_rng(0).normal(size=(2, 13)) / 100
    terms = OBSERVATION.replace('term = "joint_vel"', 'term = "joint_vel"\nhistory = 4')
    policy = Policy(write_network(tmp_path / "p.onnx", weights), write_settings(tmp_path, POLICY + terms))
    world = gloam.Scene(write_scene(tmp_path)).compile()
    with gloam.Simulation(world) as a, gloam.Simulation(world) as b, gloam.Simulation(world) as alone:
        for sim in (a, b, alone):
            policy.attach(sim, "bot").command(vx=0.3)
        alone.step(250)
        for _ in range(5):
            a.step(30)
            b.step(50)
            a.reset()  # which is none of b's business
        a.step(250)
        assert a.hash == alone.hash and b.hash == alone.hash


def test_restore_continues_the_history_of_the_checkpoint(sim: gloam.Simulation, tmp_path: Path) -> None:
    weights = np.random.default_rng(1).normal(size=(2, 6)) / 3
    terms = '[[observation]]\nterm = "joint_pos"\nhistory = 3\n'
    policy = Policy(write_network(tmp_path / "p.onnx", weights, HELD), write_settings(tmp_path, POLICY + terms))
    drive = policy.attach(sim, "bot")
    sim.step(10)
    there = sim.checkpoint()
    sim.step(10)
    first = sim.hash, drive.observation.tolist()
    sim.restore(there)
    assert drive.is_active
    sim.step(10)
    assert (sim.hash, drive.observation.tolist()) == first


def test_reset_starts_from_the_beginning_with_the_same_command(sim: gloam.Simulation, tmp_path: Path) -> None:
    policy = held_policy(tmp_path, '[[observation]]\nterm = "last_action"\n[[observation]]\nterm = "command_lin_vel"\n', 4)
    drive = policy.attach(sim, "bot")
    drive.command(vx=0.5)
    for again in (sim.reset, drive.reset):
        sim.step(8)
        assert drive.observation.tolist() == [*HELD, 0.5, 0]
        again()
        sim.step()
        assert drive.observation.tolist() == [0, 0, 0.5, 0]


def test_recompile_goes_on_with_the_new_world(sim: gloam.Simulation, tmp_path: Path) -> None:
    policy = held_policy(tmp_path, '[[observation]]\nterm = "time_step"\n', 1)
    drive = policy.attach(sim, "bot")
    sim.step(10)
    scene = sim.scene
    scene.add("robot", name="another", file="leg.xml", position=[2, 0, 0])  # indices of all joints may move
    sim.recompile(scene)
    q, v = joint_state(sim)
    sim.step()
    torque = KP * (drive.targets - q) - KD * v
    names = sim.world.actuators
    force = sim.memory.array("actuator_force")
    assert force[names.index("bot/m_knee")] * 2 == pytest.approx(torque[0])
    assert force[names.index("another/m_knee")] == 0
    assert drive.observation.tolist() == [2]  # steps 0, 4 and 8: the rhythm goes on
    sim.step(2)
    assert drive.observation.tolist() == [3]


def test_two_robots_by_one_policy_and_detach(tmp_path: Path) -> None:
    scene = gloam.Scene(write_scene(tmp_path))
    scene.add("robot", name="two", file="leg.xml", position=[2, 0, 0])
    policy = held_policy(tmp_path)
    with gloam.load(scene) as sim:
        one = policy.attach(sim, "bot")
        with policy.attach(sim, sim.robots["two"]) as two:
            with pytest.raises(gloam.UsageError, match="already driven by a policy"):
                policy.attach(sim, "two")
            sim.step()
            assert np.abs(sim.robots["two"].controls).min() > 0 and np.abs(sim.robots["bot"].controls).min() > 0
            left = sim.robots["two"].controls.copy()
            assert isinstance(two, PolicyDriver)
        sim.step(10)
        np.testing.assert_array_equal(sim.robots["two"].controls, left)
        assert one.is_active and not two.is_active
        one.detach()
        one.detach()
        policy.attach(sim, "bot")


def test_detach_returns_to_the_controller_of_the_scene(tmp_path: Path) -> None:
    path = write_scene(tmp_path)
    path.write_text(path.read_text() + '[robot.controller]\ntype = "torque"\nrate = 200\ntarget = [0.25, 0.5]\n')
    with gloam.load(path) as sim:
        drive = held_policy(tmp_path).attach(sim, "bot")
        sim.step(8)
        assert drive.is_active
        drive.detach()
        sim.step()
        assert not drive.is_active
        np.testing.assert_allclose(sim.robots["bot"].controls, [0.25, 0.25])  # the knee has a gear of 2


def test_another_controller_replaces_the_policy(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path).attach(sim, "bot")
    sim.step()
    sim.robots["bot"].set_controller("torque", rate=200)
    sim.step()
    assert not drive.is_active and sim.robots["bot"].controls.tolist() == [0, 0]


def test_the_step_hook_is_free_and_sees_the_policy(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path).attach(sim, "bot")
    seen: list[np.ndarray] = []
    sim.on_step(lambda _memory: seen.append(drive.action))
    sim.step(5)
    assert np.array(seen).tolist() == [HELD.tolist()] * 5


def test_terms_and_networks_of_scenes_work_from_python(sim: gloam.Simulation, tmp_path: Path) -> None:
    """A chain of two networks, a gait clock, a height scan and a recurrent state."""
    write_network(tmp_path / "scan.onnx", np.full((1, 6), 1 / 6))
    write_network(tmp_path / "body.onnx", np.array([[0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 0.5]]), np.array([0, 1]))
    text = POLICY + "[policy.gait]\nfrequency = 2.0\n"
    text += '[[network]]\nname = "scan"\nfile = "scan.onnx"\n[[network.observation]]\nterm = "height_scan"\n'
    text += 'size = [0.2, 0.1]\nresolution = 0.1\noffset = 0.0\n[[network]]\nname = "body"\nfile = "body.onnx"\n'
    text += '[[network.observation]]\nterm = "gait_clock"\n[[network.observation]]\nfrom = "scan"\n'
    text += '[[network.observation]]\nfrom = "body"\nfirst = 1\n'
    policy = Policy(None, write_settings(tmp_path, text))
    assert [network.name for network in policy.spec.networks] == ["scan", "body"]
    assert policy.spec.networks[0].inputs == {"obs": 6} and policy.spec.networks[1].outputs == {"actions": 2}
    assert [(term.name, term.size, term.source) for term in policy.spec.terms] == [
        ("gait_clock", 4, ""), ("network_output", 1, "scan"), ("network_output", 1, "body"),
    ]
    drive = policy.attach(sim, "bot")
    sim.step(4)
    height = sim.robots["bot"].pose.p[2]  # above the plane z = 0
    sim.step()
    clock = np.sin(2 * np.pi * 2 * 2.0 / 50 + np.pi * np.array([1, 0, 0, 1]))
    np.testing.assert_allclose(drive.observation, [*clock, height, 1], atol=1e-5)
    np.testing.assert_allclose(drive.inputs["scan"]["obs"], np.full(6, height), atol=1e-5)
    np.testing.assert_allclose(drive.action, [height, 1.5], atol=1e-5)
    with pytest.raises(gloam.UsageError, match="several networks"):
        policy.infer(np.zeros(6))


def test_other_names_in_the_model(sim: gloam.Simulation, tmp_path: Path) -> None:
    text = (POLICY + OBSERVATION).replace('["knee", "hip"]', '["robot/knee_dof", "robot/hip"]')
    settings = write_settings(
        tmp_path, text.replace("[[obs", '[policy.model_joints]\n"robot/knee_dof" = "knee"\n\n[[obs', 1)
    )
    Policy(write_network(tmp_path / "p.onnx", np.zeros((2, 7)), HELD), settings).attach(sim, "bot")
    sim.step()
    assert sim.memory.array("actuator_force")[1] * 2 == pytest.approx(KP[0] * (DEFAULTS[0] + 0.5 * HELD[0]))


def test_commands(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path, extra="command_ranges = { vx = [-0.5, 1.0], yaw_rate = 2 }\n").attach(sim, "bot")
    assert drive.command(vx=3, vy=-7, yaw_rate=-3) == (1.0, -7.0, -2.0)
    assert drive.command() == (0.0, 0.0, 0.0)
    for wrong in (float("nan"), float("inf"), None):
        with pytest.raises(gloam.UsageError, match="a commanded vx must be a finite number"):
            drive.command(vx=wrong)  # type: ignore[arg-type]


def test_place(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path).attach(sim, "bot")
    sim.step(20)
    drive.place((1, 2, 3), yaw=np.pi / 2)
    sim.step()
    np.testing.assert_allclose(sim.robots["bot"].pose.p, [1, 2, 3], atol=0.01)
    np.testing.assert_allclose(joint_state(sim)[0], DEFAULTS, atol=0.05)


def test_cameras_beside_a_policy(tmp_path: Path) -> None:
    scene = gloam.Scene(write_scene(tmp_path))
    scene.add("camera", name="cam", position=[2, 0, 1], look_at=[0, 0, 1], width=16, height=12, rate=50)
    scene.update({"render.tier": "direct", "render.spp": 1})
    with gloam.load(scene) as sim:
        held_policy(tmp_path).attach(sim, "bot")
        cam = sim.cameras["cam"].open()
        stamps = [cam.next().stamp for _ in range(5)]
    assert np.diff(stamps) == pytest.approx(0.02)


BACKGROUND = """
import sys, time, gloam
with gloam.load(sys.argv[1]) as sim:
    drive = gloam.Policy(sys.argv[2], sys.argv[3]).attach(sim, "bot")
    with sim.view():
        sim.run()
        while sim.step_count < 400:
            drive.command(vx=0.1 + sim.time)
            time.sleep(0.001)
        sim.pause()
    print(abs(sim.robots["bot"].controls).min() > 0)
"""


@pytest.mark.slow
def test_background_runs_and_views_beside_a_policy(tmp_path: Path) -> None:
    """In a process of its own: calls that wait for the thread that steps must not hold the interpreter."""
    policy = held_policy(tmp_path)
    command = [sys.executable, "-c", BACKGROUND, str(write_scene(tmp_path)), str(policy.path), str(policy.settings)]
    assert subprocess.run(command, capture_output=True, text=True, timeout=120).stdout.strip() == "True"


def test_log_verifies_without_the_network(sim: gloam.Simulation, tmp_path: Path) -> None:
    drive = held_policy(tmp_path).attach(sim, "bot")
    with sim.record(tmp_path / "run.mcap", ["/clock"]):
        sim.step(50)
        drive.command(vx=1)
        sim.step(50)
    assert gloam.replay(tmp_path / "run.mcap").verify().differing_steps == 0


def test_policies_can_be_sent(tmp_path: Path) -> None:
    policy = held_policy(tmp_path)
    again = pickle.loads(pickle.dumps(policy))
    np.testing.assert_array_equal(again.infer(np.ones(7)), policy.infer(np.ones(7)))


def elsewhere(tmp_path: Path) -> tuple[Path, Path]:
    """A folder of policies, and a folder of scenes whose root does not contain it: a root is at most four levels up."""
    policies, scenes = tmp_path / "policies", tmp_path / "1/2/3/4/5"
    for folder in (policies, scenes):
        folder.mkdir(parents=True)
    return policies, scenes


def test_policies_may_be_outside_of_the_root_of_the_scene(tmp_path: Path) -> None:
    policies, scenes = elsewhere(tmp_path)
    held_policy(policies).path.rename(policies / "other.onnx")
    policy = held_policy(policies)
    with gloam.load(write_scene(scenes)) as sim:
        with pytest.raises(gloam.InputError, match="other.onnx' lies outside"):
            settings = str(policies / "policy.toml")
            sim.robots["bot"].set_controller("policy", network=str(policies / "other.onnx"), settings=settings)
        drive = policy.attach(sim, "bot")
        sim.step()
        scene = sim.scene
        scene.add("robot", name="another", file="leg.xml", position=[2, 0, 0])
        sim.recompile(scene)
        sim.step()
        assert drive.is_active


def test_a_run_is_repeated_with_a_policy_that_was_released(tmp_path: Path) -> None:
    """Gas cannot be copied: the checkpoint is restored by stepping the run again, which makes its controllers again."""
    policies, scenes = elsewhere(tmp_path)
    scene = gloam.Scene(write_scene(scenes))
    scene.add("gas", name="lab", position=[0, 0, 1], size=[1, 1, 1], voxel=0.25, medium="smoke")
    with gloam.load(scene) as sim:
        with held_policy(policies).attach(sim, "bot"):
            sim.step(10)
        sim.step(10)
        there = sim.checkpoint()
        assert not there._checkpoint.is_copied
        sim.step(10)
        expected = sim.hash
        sim.restore(there)
        sim.step(10)
        assert sim.hash == expected


def test_a_robot_with_a_gripper_of_its_own_controller(tmp_path: Path) -> None:
    path = write_scene(tmp_path, MOTORS + '<motor name="m_grip" joint="grip"/>')
    model = tmp_path / "leg.xml"
    finger = '<body pos=".15 0 0"><joint name="grip" type="slide" axis="0 1 0" damping="1"/><geom size=".02" mass=".1"/></body>'
    model.write_text(model.read_text().replace('<site name="imu"/>', '<site name="imu"/>' + finger))
    path.write_text(path.read_text() + '[robot.controller]\nrate = 200\n[[robot.part]]\nname = "gripper"\njoints = ["grip"]\n'
                    '[robot.part.controller]\ntype = "joint_position"\nrate = 100\nkp = 50\nkd = 5\n')
    with gloam.load(path) as sim:
        drive = held_policy(tmp_path).attach(sim, "bot")
        sim.robots["bot"].command_joints(position=[0.03], joints=["grip"])
        sim.run_until(time=3)
        assert drive.is_active and drive.action.tolist() == HELD.tolist()
        assert sim.joints["bot/grip"].position == pytest.approx(0.03, abs=1e-3)
        np.testing.assert_allclose(joint_state(sim)[0], DEFAULTS + 0.5 * HELD, atol=1e-3)


def test_the_robot_of_a_bare_model(tmp_path: Path) -> None:
    write_scene(tmp_path)
    with gloam.load(tmp_path / "leg.xml") as sim:
        (name,) = sim.robots
        drive = held_policy(tmp_path).attach(sim, name)
        sim.step(200)
        np.testing.assert_allclose(drive.targets, DEFAULTS + 0.5 * HELD, atol=1e-7)
        assert abs(sim.joints["hip"].position - drive.targets[1]) < 0.05
