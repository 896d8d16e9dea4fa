"""Measures of SLAM: analytic trajectories, degenerate ones, and files of methods that are malformed."""

from __future__ import annotations

import math
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.slam.adapters.contract import FRAMES, INITIALIZING, LOST, POSES, TRACKED, Output, quaternion, rotation
from gloam.slam.estimate import NO_POSES, Estimate, Frame, Trajectory, read_estimate, read_tum
from gloam.slam.measures import measure

COUNT = 201


def circle(share: float = 1.0) -> Trajectory:
    """A share of a circle of radius 2 m in 20 s at 10 Hz, looking along it, rising by 0.5 m."""
    times = np.linspace(0, 20, COUNT)[: round((COUNT - 1) * share) + 1]
    angle = times / 20 * 2 * math.pi
    place = np.column_stack([2 * np.cos(angle), 2 * np.sin(angle), 0.025 * times])
    half = (angle + math.pi / 2) / 2
    return Trajectory(times, np.column_stack([place, np.cos(half), np.zeros((len(times), 2)), np.sin(half)]))


def moved(path: Trajectory, scale: float = 1.0) -> Trajectory:
    """The same path in another world, turned by 1 rad about z and moved."""
    turn = np.array([[math.cos(1), -math.sin(1), 0], [math.sin(1), math.cos(1), 0], [0, 0, 1]])
    poses = path.poses.copy()
    poses[:, :3] = scale * (path.poses[:, :3] @ turn.T) + (3, -1, 2)
    for pose in poses:
        pose[3:] = quaternion(turn @ rotation(pose[3:]))
    return Trajectory(path.times, poses)


def estimate(path: Trajectory, states: list[str] | None = None) -> Estimate:
    chosen = states or [TRACKED] * len(path)
    return Estimate(path, tuple(Frame(0.1 * k, state, 0.02) for k, state in enumerate(chosen)))


def test_a_perfect_estimate_has_no_error() -> None:
    for is_metric in (False, True):
        found = measure(estimate(moved(circle())), circle(), is_metric)
        assert found.ate_se3 == pytest.approx(0, abs=1e-9) and found.ate_sim3 == pytest.approx(0, abs=1e-9)
        assert found.rpe == pytest.approx(0, abs=1e-9) and found.rpe_angle == pytest.approx(0, abs=1e-6)
        assert found.coverage == pytest.approx(1) and found.coverage_printed == pytest.approx(1)
        assert found.completeness == 1 and found.tracked == 1 and found.first_track == 0 and found.relocalisations == 0
        assert found.seconds == pytest.approx(0.02) and found.frames == COUNT


def test_scale_counts_unless_it_is_aligned() -> None:
    half = estimate(moved(circle(), 0.5))
    mono, metric = measure(half, circle(), False), measure(half, circle(), True)
    assert mono.ate_sim3 == pytest.approx(0, abs=1e-9) and mono.scale == pytest.approx(2)
    assert mono.coverage == pytest.approx(1) and mono.scaled_ate == pytest.approx(0, abs=1e-9)
    # Half the circle of 2 m about its own centre: every point is 1 m off, apart from the small rise.
    assert metric.ate_se3 == pytest.approx(1.0, abs=0.02) and metric.coverage == pytest.approx(0.5)
    assert metric.scaled_ate == pytest.approx(2 * metric.ate_se3) and metric.scaled_ate_printed == pytest.approx(0.5 * metric.ate_se3)


def test_noise_has_its_size() -> None:
    path = moved(circle())
    path.poses[:, :3] += np.random.default_rng(1).normal(0, 0.05, (COUNT, 3))
    found = measure(estimate(path), circle(), True)
    assert found.ate_se3 == pytest.approx(0.05 * math.sqrt(3), rel=0.08)
    assert found.coverage > 1.1, "noise lengthens a path"


def test_half_a_trajectory_covers_half() -> None:
    states = [INITIALIZING] * 20 + [TRACKED] * 81 + [LOST] * 100
    part = Trajectory(circle().times[20:101], moved(circle()).poses[20:101])
    found = measure(estimate(part, states), circle(), True)
    assert found.coverage == pytest.approx(0.4, abs=1e-3) and found.coverage_printed == pytest.approx(2.5, abs=1e-2)
    assert found.completeness == pytest.approx(0.4, abs=1e-6) and found.tracked == pytest.approx(81 / COUNT)
    assert found.first_track == pytest.approx(2.0) and found.relocalisations == 0


def test_returns_are_relocalisations() -> None:
    states = [INITIALIZING, TRACKED, LOST, LOST, TRACKED, INITIALIZING, TRACKED, LOST]
    assert measure(estimate(circle(), states + [LOST] * (COUNT - 8)), circle(), True).relocalisations == 2
    assert measure(estimate(circle(), [LOST, INITIALIZING, TRACKED] + [TRACKED] * (COUNT - 3)), circle(), True).relocalisations == 0


@pytest.mark.parametrize("count", [0, 1, 2])
def test_few_poses_have_no_error(count: int) -> None:
    short = Trajectory(circle().times[:count], circle().poses[:count])
    found = measure(Estimate(short, ()), circle(), False)
    assert found.ate_se3 is None and found.ate_sim3 is None and found.rpe is None and found.scaled_ate is None
    assert found.coverage == 0 and found.coverage_printed is None and found.tracked == 0 and found.first_track is None


def test_an_estimate_that_stands_still_has_no_error() -> None:
    still = Trajectory(circle().times, np.tile(circle().poses[0], (COUNT, 1)))
    assert measure(estimate(still), circle(), True).ate_se3 is None


def test_a_truth_without_motion_is_measured() -> None:
    still = Trajectory(circle().times, np.tile(circle().poses[0], (COUNT, 1)))
    found = measure(estimate(circle()), still, True)
    assert found.coverage == 0 and found.completeness == 0


def test_other_times_are_an_error() -> None:
    late = Trajectory(circle().times + 100, circle().poses)
    with pytest.raises(gloam.InputError, match="at a time of the sequence"):
        measure(estimate(late), circle(), True)
    with pytest.raises(ValueError, match="at least two"):
        measure(estimate(circle()), NO_POSES, True)


def test_output_is_read_back(tmp_path: Path) -> None:
    with Output(tmp_path) as output:
        for k, state in enumerate((INITIALIZING, TRACKED, LOST, TRACKED)):
            output.begin()
            pose = np.eye(4)
            pose[:3, :3], pose[0, 3] = rotation(np.array([math.cos(k), 0, math.sin(k), 0])), k
            output.frame(0.1 * k, state, pose)
    found = read_estimate(tmp_path)
    assert [frame.state for frame in found.frames] == [INITIALIZING, TRACKED, LOST, TRACKED]
    assert found.trajectory.times.tolist() == pytest.approx([0.1, 0.3]) and found.trajectory.poses[:, 0].tolist() == [1, 3]
    assert abs(found.trajectory.poses[1, 3:] @ (math.cos(3), 0, math.sin(3), 0)) == pytest.approx(1, abs=1e-8)


def test_quaternions_of_all_rotations() -> None:
    random = np.random.default_rng(2)
    for q in [*random.normal(size=(50, 4)), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (1e-9, 1, 0, 0)]:
        unit = np.asarray(q) / np.linalg.norm(q)
        assert abs(quaternion(rotation(unit)) @ unit) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 1\n", "times must rise"),
        ("1 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 1\n", "times must rise"),
        ("0 0 0 0 0 0 1\n", "eight finite numbers"),
        ("0 0 nan 0 0 0 0 1\n", "eight finite numbers"),
        ("0 0 0 0 0 0 0 2\n", "length 1"),
        ("0 0 zero 0 0 0 0 1\n", "expected numbers"),
    ],
)
def test_malformed_poses_name_their_line(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / POSES
    file.write_text("# a comment\n" + text)
    with pytest.raises(gloam.InputError, match=words) as caught:
        read_tum(file)
    assert caught.value.line == text.count("\n") + 1


@pytest.mark.parametrize(
    "text", ["time,state\n0,gone\n", "time,state\n1,lost\n1,lost\n", "time,state,seconds\n0,lost,-1\n", "time,state\nx,lost\n"]
)
def test_malformed_frames_are_errors(tmp_path: Path, text: str) -> None:
    (tmp_path / POSES).write_text("")
    (tmp_path / FRAMES).write_text(text)
    with pytest.raises(gloam.InputError):
        read_estimate(tmp_path)


def test_a_method_without_poses_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(gloam.InputError, match="has not written its poses"):
        read_estimate(tmp_path)
