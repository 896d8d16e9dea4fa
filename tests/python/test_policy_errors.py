"""Robots that a policy cannot drive, and numbers that stop it, in words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402
from gloam.policy import Policy  # noqa: E402

from policy_fixtures import (  # noqa: E402
    OBSERVATION,
    POLICY,
    held_policy,
    write_network,
    write_scene,
    write_settings,
)


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[gloam.Simulation]:
    with gloam.load(write_scene(tmp_path)) as made:
        yield made


def test_names_that_the_robot_has_not(tmp_path: Path) -> None:
    with gloam.load(write_scene(tmp_path)) as sim:
        for old, new, says in (
            ('"hip"', '"hop"', "has no joint bot/hop.*did you mean 'bot/hip'"),
            ('"hip"', '"root"', "neither a hinge"),
        ):
            folder = tmp_path / new.strip('"')
            folder.mkdir()
            settings = write_settings(folder, (POLICY + OBSERVATION).replace(old, new))
            with pytest.raises(gloam.Error, match=says):
                Policy(write_network(folder / "p.onnx", np.zeros((2, 7))), settings).attach(sim, "bot")
        with pytest.raises(gloam.NotFoundError, match="bot"):
            held_policy(tmp_path).attach(sim, "bt")
        with pytest.raises(TypeError, match="expected a robot or its name, got None"):
            held_policy(tmp_path).attach(sim, None)  # type: ignore[arg-type]
        with pytest.raises(gloam.InputError, match="has no sensor bot/giro.*did you mean 'bot/gyro'"):
            held_policy(tmp_path, '[[observation]]\nterm = "base_ang_vel"\nsensor = "giro"\n', 3).attach(sim, "bot")
        with pytest.raises(gloam.UnsupportedError, match="'gyro' has 3 numbers"):
            held_policy(tmp_path, '[[observation]]\nterm = "joint_pos"\nsensor = "gyro"\n', 2).attach(sim, "bot")
        assert sim.step() is None  # no driver was left behind


@pytest.mark.parametrize(
    "actuators, says",
    [
        ('<motor name="a" joint="hip"/>', "'bot/knee' has no actuator"),
        (
            '<motor name="a" joint="hip"/><motor name="b" joint="knee"/><motor name="c" joint="hip"/>',
            "'bot/hip' has several actuators",
        ),
        (
            '<motor name="a" joint="hip"/><muscle name="b" joint="knee" ctrlrange="0 1" lengthrange="0 1"/>',
            "neither a motor nor a position servo",
        ),
        (
            '<motor name="a" joint="hip"/><position name="b" joint="knee" kp="1" timeconst="0.1"/>',
            "neither a motor nor a position servo",
        ),
    ],
)
def test_actuators_that_policies_do_not_drive(tmp_path: Path, actuators: str, says: str) -> None:
    with gloam.load(write_scene(tmp_path, actuators)) as sim, pytest.raises(gloam.Error, match=says):
        held_policy(tmp_path).attach(sim, "bot")


def test_velocity_feedback_needs_a_floating_base(tmp_path: Path) -> None:
    scene = write_scene(tmp_path)
    model = tmp_path / "leg.xml"
    model.write_text(model.read_text().replace('<freejoint name="root"/>', ""))
    with gloam.load(scene) as sim, pytest.raises(gloam.Error, match="a velocity_feedback, but robot 'bot' has no floating"):
        held_policy(tmp_path, extra="velocity_feedback = 0.5\n").attach(sim, "bot")


def test_a_rate_that_no_number_of_steps_gives(tmp_path: Path) -> None:
    with (
        gloam.load(write_scene(tmp_path), timestep=0.003) as sim,
        pytest.raises(gloam.UsageError, match="use a timestep of 0.0028"),
    ):
        held_policy(tmp_path).attach(sim, "bot")


def test_an_action_that_is_not_finite_damps_the_joints(sim: gloam.Simulation, tmp_path: Path) -> None:
    weights = np.zeros((2, 7))
    weights[1, 4] = 3e38  # of vx
    drive = Policy(write_network(tmp_path / "p.onnx", weights), write_settings(tmp_path)).attach(sim, "bot")
    sim.step(10)
    assert drive.fault == ""
    drive.command(vx=100)
    sim.step(3)
    assert "action for 'hip' is not finite, its observation is finite" in drive.fault
    velocity = sim.joints["bot/hip"].velocity
    sim.step()
    assert sim.memory.array("actuator_force")[0] == pytest.approx(-0.5 * velocity)
    drive.command()
    drive.reset()
    sim.step(4)
    assert drive.fault == ""


def test_closed_simulations(tmp_path: Path) -> None:
    policy = held_policy(tmp_path)
    with gloam.load(write_scene(tmp_path)) as sim:
        drive = policy.attach(sim, "bot")
    with pytest.raises(gloam.ClosedError):
        policy.attach(sim, "bot")
    with pytest.raises(gloam.ClosedError):
        drive.place((0, 0, 1))
    drive.detach()
    drive.detach()
