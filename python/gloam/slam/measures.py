"""Measures of an estimated trajectory: ATE, RPE, coverage as described and as printed in the paper, tracking.

The paper (Unreal Robotics Lab, section IV, Experiment 2) describes coverage as the ratio of the estimated trajectory's length
to the true one, but its formula has the true length above the line. Both are measured.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import gloam

from .adapters.contract import LOST, TRACKED
from .estimate import Array, Estimate, Frame, Trajectory

TOO_SHORT = 1e-3  # of a path, to be aligned or divided by [m]


@dataclass(frozen=True)
class Measures:
    """Of one run; None: not defined, such as errors of a trajectory without poses.

    ate_se3, ate_sim3: root mean square of translations after alignment without and with scale [m]; scale: of the latter.
    The other lengths are of the estimate aligned with scale, or without if the method has metric sensors. rpe: root
    mean square of translations per metre of the path [m]; rpe_angle: of rotations [rad]; coverage: estimated / true
    length; coverage_printed: the inverse, as in the paper's formula; scaled_ate, scaled_ate_printed: ATE / each;
    completeness: share of the true path between frames that have poses; tracked: share of all frames; first_track: time
    from the first frame to the first tracked one [s]; relocalisations: returns from lost to tracked; seconds: mean per
    frame; frames: of the sequence.
    """

    ate_se3: float | None
    ate_sim3: float | None
    scale: float | None
    rpe: float | None
    rpe_angle: float | None
    coverage: float
    coverage_printed: float | None
    scaled_ate: float | None
    scaled_ate_printed: float | None
    completeness: float
    tracked: float
    first_track: float | None
    relocalisations: int
    seconds: float | None
    frames: int

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def measure(estimate: Estimate, truth: Trajectory, is_metric: bool) -> Measures:
    """Measures against the true poses of the sensor, one per frame of the sequence.

    is_metric: whether the method knows lengths: stereo, depth, LiDAR, inertial. Errors: ValueError unless truth has two poses;
    gloam.InputError if no pose of the estimate is at a time of the truth.
    """
    if len(truth) < 2:
        raise ValueError("the truth must have at least two poses")
    half = float(np.median(np.diff(truth.times))) / 2
    poses = estimate.trajectory
    if len(poses) and not _near(poses.times, truth.times, half).any():
        raise gloam.InputError(
            "no pose of the estimate is at a time of the sequence", hint="poses.tum needs the times of rgb.txt or scans.txt"
        )
    se3, sim3 = _errors(poses, truth, "se3", half), _errors(poses, truth, "sim3", half)
    aligned = se3 if is_metric else sim3
    ate = _ate(aligned)
    full = _length(truth.poses[:, :3])
    estimated = 0.0 if aligned is None else float(aligned["align"]["scale"]) * _length(poses.poses[:, :3])
    coverage = estimated / full if full > TOO_SHORT else 0.0
    printed = full / estimated if estimated > TOO_SHORT else None
    rpe = None if aligned is None else aligned["rpe"]
    return Measures(
        ate_se3=_ate(se3),
        ate_sim3=_ate(sim3),
        scale=None if sim3 is None else float(sim3["align"]["scale"]),
        rpe=None if rpe is None else float(rpe["translation_m"]["rmse"]),
        rpe_angle=None if rpe is None else float(rpe["angle_rad"]["rmse"]),
        coverage=coverage,
        coverage_printed=printed,
        scaled_ate=None if ate is None or coverage <= 0 else ate / coverage,
        scaled_ate_printed=None if ate is None or printed is None else ate / printed,
        completeness=_completeness(poses.times, truth, half),
        **_tracking(estimate.frames, truth.times),
    )


def _errors(estimate: Trajectory, truth: Trajectory, align: str, half: float) -> dict[str, Any] | None:
    """gloam.evaluate of both, or None if the estimate admits no alignment: fewer than three poses, or no motion."""
    if len(estimate) < 3 or _length(estimate.poses[:, :3]) < TOO_SHORT:
        return None
    try:
        sides = [(side.times, side.poses) for side in (estimate, truth)]
        return gloam.evaluate(*sides, align=align, max_difference=half)
    except gloam.InputError:
        return None  # the matched poses stay at one point


def _ate(found: dict[str, Any] | None) -> float | None:
    return None if found is None else float(found["ate"]["translation_m"]["rmse"])


def _near(times: Array, others: Array, half: float) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """(n,): whether a time has one of `others`, which rise, within `half` [s]."""
    after = np.searchsorted(others, times).clip(1, len(others) - 1)
    return np.asarray(np.minimum(np.abs(times - others[after - 1]), np.abs(times - others[after])) <= half + 1e-9)


def _length(points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) if len(points) > 1 else 0.0


def _completeness(times: Array, truth: Trajectory, half: float) -> float:
    """Share of the true path's length whose both ends have a pose of the estimate."""
    steps = np.linalg.norm(np.diff(truth.poses[:, :3], axis=0), axis=1)
    if steps.sum() < TOO_SHORT or len(times) < 2:
        return 0.0
    have = _near(truth.times, times, half)
    return float(steps[have[:-1] & have[1:]].sum() / steps.sum())


def _tracking(frames: Sequence[Frame], times: Array) -> dict[str, Any]:
    """tracked, first_track, relocalisations, seconds and frames. Frames of the sequence that the method left out are not
    tracked."""
    states = [frame.state for frame in frames]
    first = next((frame.time for frame in frames if frame.state == TRACKED), None)
    seconds = [frame.seconds for frame in frames if math.isfinite(frame.seconds)]
    return {
        "tracked": min(1.0, states.count(TRACKED) / len(times)),
        "first_track": None if first is None else first - float(times[0]),
        "relocalisations": len(returns(states)),
        "seconds": float(np.mean(seconds)) if seconds else None,
        "frames": len(times),
    }


def returns(states: Sequence[str]) -> list[int]:
    """Numbers of the frames at which a method tracks again: after it was lost, or begins again after the first track."""
    begun = states.index(TRACKED) if TRACKED in states else len(states)
    pairs = enumerate(zip(states, states[1:], strict=False), 1)
    return [k for k, (before, now) in pairs if now == TRACKED != before and (before == LOST or k > begun)]
