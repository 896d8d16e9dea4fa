"""The output of a SLAM method: its poses, and the state of each frame."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gloam.errors import InputError

from .adapters.contract import FEATURES, FRAMES, POSES, STATES, TRACKED

Array = NDArray[np.float64]
_UNIT = 1e-3  # by which the length of a quaternion may differ from 1


@dataclass(frozen=True)
class Frame:
    """time [s]; state: initializing, tracked or lost; seconds: that the method took, NaN if it does not report them."""

    time: float
    state: str
    seconds: float


@dataclass(frozen=True)
class Trajectory:
    """times: (n,) [s], rising; poses: (n, 7) x, y, z [m], qw, qx, qy, qz."""

    times: Array
    poses: Array

    def __len__(self) -> int:
        return len(self.times)


NO_POSES = Trajectory(np.zeros(0), np.zeros((0, 7)))


@dataclass(frozen=True)
class Estimate:
    """trajectory: final poses of the sensor in the method's own world; frames: all that the method has processed."""

    trajectory: Trajectory
    frames: tuple[Frame, ...]


def read_tum(file: Path) -> Trajectory:
    """Poses "time x y z qx qy qz qw" of a file. Errors: InputError with the line for other content: wrong counts, numbers that
    are not finite, times that do not rise, quaternions whose length is not 1; OSError."""
    times: list[float] = []
    poses: list[list[float]] = []
    for number, line in enumerate(file.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            values = [float(word) for word in line.split()]
        except ValueError:
            raise InputError(f"expected numbers, got '{line[:60]}'", str(file), number) from None
        if len(values) != 8 or not all(math.isfinite(value) for value in values):
            raise InputError("expected eight finite numbers: time x y z qx qy qz qw", str(file), number)
        if times and values[0] <= times[-1]:
            raise InputError(f"times must rise, got {values[0]:.9g} after {times[-1]:.9g}", str(file), number)
        length = math.sqrt(sum(value * value for value in values[4:]))
        if abs(length - 1) > _UNIT:
            raise InputError(f"the quaternion must have length 1, got {length:.6g}", str(file), number)
        times.append(values[0])
        poses.append([*values[1:4], *(value / length for value in (values[7], *values[4:7]))])
    return Trajectory(np.array(times), np.array(poses).reshape(-1, 7))


def read_frames(file: Path) -> tuple[Frame, ...]:
    """Rows of frames.csv: time, state, seconds. Errors: InputError with the line; OSError."""
    frames: list[Frame] = []
    with file.open(encoding="utf-8", errors="replace", newline="") as stream:
        for number, row in enumerate(csv.reader(stream), 1):
            if number == 1 or not row:
                continue
            if len(row) not in (2, 3) or row[1] not in STATES:
                raise InputError(f"expected time, state and seconds with a state of {', '.join(STATES)}", str(file), number)
            try:
                stamp, seconds = float(row[0]), float(row[2]) if len(row) == 3 and row[2] else math.nan
            except ValueError:
                raise InputError(f"expected numbers, got '{','.join(row)[:60]}'", str(file), number) from None
            if not math.isfinite(stamp) or (frames and stamp <= frames[-1].time) or seconds < 0:
                raise InputError("times must be finite and rise, and seconds must not be negative", str(file), number)
            frames.append(Frame(stamp, row[1], seconds))
    return tuple(frames)


def read_estimate(folder: Path) -> Estimate:
    """The files of a method's output folder. Without frames.csv, frames with a pose count as tracked.

    Errors: InputError if poses.tum is missing or either file is malformed; OSError.
    """
    poses, frames = folder / POSES, folder / FRAMES
    if not poses.is_file():
        raise InputError("the method has not written its poses", str(poses))
    trajectory = read_tum(poses)
    if not frames.is_file():
        return Estimate(trajectory, tuple(Frame(float(time), TRACKED, math.nan) for time in trajectory.times))
    return Estimate(trajectory, read_frames(frames))


def read_run(folder: Path) -> Estimate:
    """As read_estimate, but without poses if either file is missing or malformed."""
    try:
        return read_estimate(folder)
    except (InputError, OSError):
        return Estimate(NO_POSES, frames_of_failure(folder))


def frames_of_failure(folder: Path) -> tuple[Frame, ...]:
    """The frames of a run that has failed; none if their file is missing or malformed."""
    try:
        return read_frames(folder / FRAMES)
    except (InputError, OSError):
        return ()


def read_features(folder: Path) -> dict[float, Array]:
    """Pixels (n, 2) by the time of their frame, from features.txt in a method's output folder; empty without that file. Errors:
    InputError with the line; OSError."""
    file = folder / FEATURES
    if not file.is_file():
        return {}
    features: dict[float, Array] = {}
    for number, line in enumerate(file.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        try:
            values = np.array([float(word) for word in line.split()])
        except ValueError:
            raise InputError(f"expected numbers, got '{line[:60]}'", str(file), number) from None
        if len(values) % 2 == 0 or not np.isfinite(values).all():
            raise InputError("expected a time and pairs of finite pixels", str(file), number)
        features[float(values[0])] = values[1:].reshape(-1, 2)
    return features
