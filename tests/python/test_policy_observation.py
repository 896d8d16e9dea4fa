"""What a policy is handed: frames, order, clip, scale, history, gait."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402

from policy_fixtures import (  # noqa: E402
    HELD,
    POLICY,
    Seen,
    held_policy,
    write_network,
    write_scene,
    write_settings,
)


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[gloam.Simulation]:
    with gloam.load(write_scene(tmp_path)) as made:
        yield made


def test_observation_of_a_turned_and_moving_robot(sim: gloam.Simulation, tmp_path: Path) -> None:
    names = (
        "base_lin_vel",
        "base_ang_vel",
        "projected_gravity",
        "joint_pos",
        "joint_vel",
        "last_action",
        "command",
        "base_ang_vel",
    )
    terms = "".join(f'[[observation]]\nterm = "{name}"\n' for name in names) + 'sensor = "gyro"\n'
    policy = held_policy(tmp_path, terms, 3 * 3 + 3 * 2 + 3 + 3)
    drive = policy.attach(sim, "bot")
    seen = Seen(sim, drive)
    drive.command(vx=0.1, vy=-0.2, yaw_rate=0.3)
    half = np.sqrt(0.5)  # a quarter turn about x: the base's y is the world's z, its z the world's -y
    sim.joints["bot/root"].set(qpos=[0, 0, 1, half, half, 0, 0], qvel=[1, 2, 3, 0.1, 0.2, 0.3])
    sim.joints["bot/knee"].set(qpos=[0.7], qvel=[0.5])
    seen.step(5)
    first, second = seen.observations
    np.testing.assert_allclose(first[0:3], [1, 3, -2], atol=1e-6)
    np.testing.assert_allclose(first[3:6], [0.1, 0.2, 0.3], atol=1e-6)
    np.testing.assert_allclose(first[6:9], [0, -1, 0], atol=1e-6)
    np.testing.assert_allclose(first[9:13], [0.7 - 0.3, 0.2, 0.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(first[13:18], [0, 0, 0.1, -0.2, 0.3], atol=1e-6)
    np.testing.assert_allclose(second[13:15], HELD, atol=1e-6)


def test_clip_then_scale_then_history_oldest_first(sim: gloam.Simulation, tmp_path: Path) -> None:
    terms = '[[observation]]\nterm = "command"\nclip = [-1, 0.5]\nscale = [1, 10, 100]\nhistory = 3\n'
    policy = held_policy(tmp_path, terms, 9)
    drive = policy.attach(sim, "bot")
    seen = Seen(sim, drive)
    for vx in (0.2, 0.4, 5.0):
        drive.command(vx, -0.3, 0.05)
        seen.step(4)
    rows = [o.reshape(3, 3) for o in seen.observations]
    np.testing.assert_allclose(rows[0], [[0.2, -3, 5]] * 3, rtol=1e-6)  # the first one stands for those before it
    np.testing.assert_allclose(rows[2][:, 0], [0.2, 0.4, 0.5], rtol=1e-6)
    sim.reset()
    seen.step()
    np.testing.assert_allclose(seen.observations[3].reshape(3, 3)[:, 0], [0.5] * 3)  # nothing of the run before


def test_history_that_starts_with_zeros(sim: gloam.Simulation, tmp_path: Path) -> None:
    policy = held_policy(
        tmp_path, '[[observation]]\nterm = "command_ang_vel"\nhistory = 3\n', 3, 'history_start = "zeros"\n'
    )
    drive = policy.attach(sim, "bot")
    seen = Seen(sim, drive)
    drive.command(yaw_rate=0.5)
    seen.step(5)
    assert [o.tolist() for o in seen.observations] == [[0, 0, 0.5], [0, 0.5, 0.5]]


def test_gait_phases(sim: gloam.Simulation, tmp_path: Path) -> None:
    terms = "".join(f'[[observation]]\nterm = "{name}"\n' for name in ("sin_phase", "cos_phase", "phase"))
    policy = held_policy(tmp_path, terms, 6, "gait_period = 0.8\n")
    drive = policy.attach(sim, "bot")
    seen = Seen(sim, drive)
    seen.step()
    np.testing.assert_allclose(seen.observations[-1], [0, 0, -1, -1, 0, -1], atol=1e-6)  # it stands
    drive.command(vx=0.5)
    seen.step(3 + 4 * 10 + 1)  # the step that begins anew, then a quarter of the period: 10 of 40 control periods
    np.testing.assert_allclose(seen.observations[-1], [1, -1, 0, 0, 1, 0], atol=1e-6)


REFERENCE = (  # term, scale, clip, history
    ("base_lin_vel", 2.0, (-0.5, 0.5), 2),
    ("base_ang_vel", 0.25, (-100, 100), 3),
    ("projected_gravity", 1.0, (-1, 1), 1),
    ("joint_pos", 1.0, (-0.4, 0.4), 2),
    ("joint_vel", 0.05, (-100, 100), 1),
    ("last_action", 1.0, (-100, 100), 3),
    ("previous_action", 1.0, (-100, 100), 1),
    ("velocity_commands", 2.0, (-1, 1), 2),
    ("sin_phase", 1.0, (-1, 1), 1),
    ("cos_phase", 1.0, (-1, 1), 2),
)


def robot_by_numpy(qpos: np.ndarray, qvel: np.ndarray) -> dict[str, np.ndarray]:
    """Terms of the state of the leg, whose joints are in the order hip, knee in the model."""
    w, v = qpos[3], qpos[4:7]

    def to_base(x: np.ndarray) -> np.ndarray:  # the inverse rotation by a unit quaternion
        return x - 2 * w * np.cross(v, x) + 2 * np.cross(v, np.cross(v, x))

    return {
        "base_lin_vel": to_base(qvel[:3]),
        "base_ang_vel": qvel[3:6],  # of a free joint in its own axes
        "projected_gravity": to_base(np.array([0.0, 0.0, -1.0])),
        "joint_pos": qpos[[8, 7]] - [0.3, -0.2],
        "joint_vel": qvel[[7, 6]],
    }


@pytest.mark.parametrize("start", ["repeat", "zeros"])
def test_observations_are_those_of_an_implementation_in_numpy(tmp_path: Path, start: str) -> None:
    rng = np.random.default_rng(4)
    size = sum({"joint_pos": 2, "joint_vel": 2, "last_action": 2, "previous_action": 2, "sin_phase": 2, "cos_phase": 2}
               .get(name, 3) * history for name, _, _, history in REFERENCE)
    terms = "".join(
        f'[[observation]]\nterm = "{name}"\nscale = {scale}\nclip = [{low}, {high}]\nhistory = {history}\n'
        for name, scale, (low, high), history in REFERENCE
    )
    settings = POLICY + f'history_start = "{start}"\ngait_period = 0.7\naction_clip = 0.6\n' + terms
    network = write_network(tmp_path / "p.onnx", rng.normal(size=(2, size)) / 4)
    policy = gloam.Policy(network, write_settings(tmp_path, settings))
    past: dict[str, list[np.ndarray]] = {name: [] for name, *_ in REFERENCE}
    last, before, phase = np.zeros(2), np.zeros(2), np.array([0, np.pi])
    with gloam.load(write_scene(tmp_path)) as sim:
        drive = policy.attach(sim, "bot")
        sim.joints["bot/root"].set(qpos=[0, 0, 1, *(rng.normal(size=4) + [3, 0, 0, 0])], qvel=rng.normal(size=6))
        states: list[tuple[np.ndarray, np.ndarray]] = []
        qpos, qvel = sim.memory.array("qpos"), sim.memory.array("qvel")
        sim.on_step(lambda _memory: states.append((qpos.copy(), qvel.copy())))
        for period in range(30):
            command = np.array([0.3, -0.2, 0.8 - 0.05 * period])
            drive.command(*command)
            sim.step(4)
            q, v = states[4 * period]
            q[3:7] /= np.linalg.norm(q[3:7])
            phase = phase + 2 * np.pi / (0.7 * 50)
            now = {**robot_by_numpy(q, v), "last_action": last, "previous_action": before, "velocity_commands": command}
            now |= {"sin_phase": np.sin(phase), "cos_phase": np.cos(phase)}
            expected = []
            for name, scale, (low, high), history in REFERENCE:
                value = np.clip(now[name], low, high) * scale
                rows = past[name]
                if not rows:
                    rows += [value if start == "repeat" else 0 * value] * history
                rows.append(value)
                expected += rows[-history:]
            np.testing.assert_allclose(drive.observation, np.concatenate(expected), atol=2e-6)
            before, last = last, np.clip(policy.infer(drive.observation), -0.6, 0.6)
            np.testing.assert_array_equal(drive.action, last)
            np.testing.assert_allclose(drive.targets, [0.3, -0.2] + 0.5 * last, atol=1e-12)
