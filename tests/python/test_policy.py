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

from policy_fixtures import HELD, OBSERVATION, POLICY, Seen, held_policy, write_network, write_scene, write_settings  # noqa: E402

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
    assert not drive.is_servo
    targets = DEFAULTS + 0.5 * HELD
    for _ in range(20):
        q, v = joint_state(sim)
        sim.step()
        np.testing.assert_allclose(
            sim.memory.array("actuator_force") * [1, 2], (KP * (targets - q) - KD * v)[::-1], atol=1e-12
        )
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
        assert drive.is_servo
        sim.step()
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


def test_restore_begins_anew(sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    policy = held_policy(tmp_path, '[[observation]]\nterm = "last_action"\n', 2)
    seen = Seen(policy, monkeypatch)
    policy.attach(sim, "bot")
    sim.step(10)
    there = sim.checkpoint()
    sim.step(10)
    sim.restore(there)
    sim.step()
    assert seen.observations[-1].tolist() == [0, 0]


def test_recompile_goes_on_with_the_new_world(
    sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    policy = held_policy(tmp_path)
    seen = Seen(policy, monkeypatch)
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
    assert len(seen.observations) == 3  # at steps 0, 4 and 8: the rhythm goes on


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
        one.detach()
        one.detach()
        policy.attach(sim, "bot")


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
    """The hook waits for Python on the thread that steps; those who wait for a picture must not hold Python."""
    scene = gloam.Scene(write_scene(tmp_path))
    scene.add("camera", name="cam", position=[2, 0, 1], look_at=[0, 0, 1], width=16, height=12, rate=50)
    scene.update({"render.tier": "direct", "render.spp": 1})
    with gloam.load(scene) as sim:
        held_policy(tmp_path).attach(sim, "bot")
        stamps = [sim.step_until(sim.cameras["cam"]).stamp for _ in range(5)]
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
    """In a process of its own: what waits for the thread that steps must not hold Python, which the hook waits for."""
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
