"""What a policy is handed: frames, order, clip, scale, history, gait."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402

from policy_fixtures import HELD, Seen, held_policy, write_scene  # noqa: E402


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[gloam.Simulation]:
    with gloam.load(write_scene(tmp_path)) as made:
        yield made


def test_observation_of_a_turned_and_moving_robot(
    sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
    seen = Seen(policy, monkeypatch)
    policy.attach(sim, "bot").command(vx=0.1, vy=-0.2, yaw_rate=0.3)
    half = np.sqrt(0.5)  # a quarter turn about x: the base's y is the world's z, its z the world's -y
    sim.joints["bot/root"].set(qpos=[0, 0, 1, half, half, 0, 0], qvel=[1, 2, 3, 0.1, 0.2, 0.3])
    sim.joints["bot/knee"].set(qpos=[0.7], qvel=[0.5])
    sim.step(5)
    first, second = seen.observations
    np.testing.assert_allclose(first[0:3], [1, 3, -2], atol=1e-6)
    np.testing.assert_allclose(first[3:6], [0.1, 0.2, 0.3], atol=1e-6)
    np.testing.assert_allclose(first[6:9], [0, -1, 0], atol=1e-6)
    np.testing.assert_allclose(first[9:13], [0.7 - 0.3, 0.2, 0.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(first[13:18], [0, 0, 0.1, -0.2, 0.3], atol=1e-6)
    np.testing.assert_allclose(second[13:15], HELD, atol=1e-6)


def test_clip_then_scale_then_history_oldest_first(
    sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    terms = '[[observation]]\nterm = "command"\nclip = [-1, 0.5]\nscale = [1, 10, 100]\nhistory = 3\n'
    policy = held_policy(tmp_path, terms, 9)
    seen = Seen(policy, monkeypatch)
    drive = policy.attach(sim, "bot")
    for vx in (0.2, 0.4, 5.0):
        drive.command(vx, -0.3, 0.05)
        sim.step(4)
    rows = [o.reshape(3, 3) for o in seen.observations]
    np.testing.assert_allclose(rows[0], [[0.2, -3, 5]] * 3, rtol=1e-6)  # the first one stands for those before it
    np.testing.assert_allclose(rows[2][:, 0], [0.2, 0.4, 0.5], rtol=1e-6)
    sim.reset()
    sim.step()
    np.testing.assert_allclose(seen.observations[3].reshape(3, 3)[:, 0], [0.5] * 3)  # nothing of the run before


def test_history_that_starts_with_zeros(sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    policy = held_policy(
        tmp_path, '[[observation]]\nterm = "command_ang_vel"\nhistory = 3\n', 3, 'history_start = "zeros"\n'
    )
    seen = Seen(policy, monkeypatch)
    policy.attach(sim, "bot").command(yaw_rate=0.5)
    sim.step(5)
    assert [o.tolist() for o in seen.observations] == [[0, 0, 0.5], [0, 0.5, 0.5]]


def test_gait_phases(sim: gloam.Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    terms = "".join(f'[[observation]]\nterm = "{name}"\n' for name in ("sin_phase", "cos_phase", "phase"))
    policy = held_policy(tmp_path, terms, 6, "gait_period = 0.8\n")
    seen = Seen(policy, monkeypatch)
    drive = policy.attach(sim, "bot")
    sim.step()
    np.testing.assert_allclose(seen.observations[-1], [0, 0, -1, -1, 0, -1], atol=1e-6)  # it stands
    drive.command(vx=0.5)
    sim.step(3 + 4 * 10 + 1)  # the step that begins anew, then a quarter of the period: 10 of 40 control periods
    np.testing.assert_allclose(seen.observations[-1], [1, -1, 0, 0, 1, 0], atol=1e-6)
