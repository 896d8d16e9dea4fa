"""Files between the benchmark and a SLAM method: the sequence that a method reads, the poses and states that it writes.

This module needs NumPy only and does not import Gloam, so that adapters run in any Python. docs/slam.md describes the files.
"""

from __future__ import annotations

import csv
import json
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INITIALIZING, TRACKED, LOST = "initializing", "tracked", "lost"
STATES = (INITIALIZING, TRACKED, LOST)
CALIBRATION, POSES, FRAMES, FEATURES = "calibration.json", "poses.tum", "frames.csv", "features.txt"


@dataclass(frozen=True)
class Camera:
    """A pinhole camera with Brown–Conrady distortion, in OpenCV's convention: pixel centres are at integers.

    width, height, fx, fy, cx, cy: [px]; distortion: k1 k2 p1 p2 [k3]; rate: [Hz]; baseline: to the right camera [m], 0 = none;
    depth_scale: numbers of the depth images per metre.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    rate: float
    distortion: tuple[float, ...] = ()
    baseline: float = 0.0
    depth_scale: float = 1000.0

    @property
    def matrix(self) -> Array:
        """K, (3, 3)."""
        return np.array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1.0]])


@dataclass(frozen=True)
class Imu:
    """noise densities and random walks: gyroscope [rad/s/√Hz, rad/s²/√Hz], accelerometer [m/s²/√Hz, m/s³/√Hz]; rate: [Hz];
    in_camera: (4, 4) pose of the IMU in the optical frame of the camera."""

    rate: float
    gyro_noise: float
    gyro_walk: float
    accel_noise: float
    accel_walk: float
    in_camera: tuple[tuple[float, ...], ...]


class Sequence:
    """A folder with images, depth, inertial measurements or scans of one run.

    rgb.txt, right.txt, depth.txt and scans.txt have lines "time file", as in TUM's RGB-D benchmark; sensors that
    the robot lacks have no file. imu.csv is EuRoC's: time [ns], angular velocity [rad/s], acceleration [m/s²]. Scans are files of float32
    x, y, z [m], intensity, and time within the scan [s] per point. Errors: OSError, ValueError for damaged files.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        values: dict[str, Any] = json.loads((self.folder / CALIBRATION).read_text(encoding="utf-8"))
        camera, imu = values.get("camera"), values.get("imu")
        self.camera = Camera(**{**camera, "distortion": tuple(camera["distortion"])}) if camera else None
        self.imu_model = Imu(**{**imu, "in_camera": tuple(map(tuple, imu["in_camera"]))}) if imu else None

    def files(self, kind: str) -> list[tuple[float, Path]]:
        """Times [s] and files of "rgb", "right", "depth" or "scans"; empty if the sequence has none."""
        index = self.folder / f"{kind}.txt"
        if not index.is_file():
            return []
        rows = [line.split() for line in index.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
        return [(float(stamp), self.folder / name) for stamp, name in rows]

    def imu(self) -> Array:
        """(n, 7): time [s], angular velocity [rad/s], acceleration [m/s²] in the IMU's frame."""
        with (self.folder / "imu.csv").open(encoding="utf-8") as file:
            rows = [[float(value) for value in row] for row in csv.reader(file) if row and not row[0].startswith("#")]
        values = np.array(rows, np.float64).reshape(-1, 7)
        values[:, 0] *= 1e-9
        return values

    def images(self, kinds: tuple[str, ...]) -> Iterator[tuple[float, tuple[Path, ...]]]:
        """Times at which all kinds have a file, with the files."""
        tables = [{round(stamp, 6): file for stamp, file in self.files(kind)} for kind in kinds]
        for stamp, _ in self.files(kinds[0]):
            found = [table.get(round(stamp, 6)) for table in tables]
            if all(file is not None for file in found):
                yield stamp, tuple(file for file in found if file is not None)


class Output:
    """Writes frames.csv and features.txt while a method runs, and poses.tum at the end.

        with Output(folder) as output:
            for stamp, (image,) in sequence.images(("rgb",)):
                output.begin()
                … # track
                output.frame(stamp, TRACKED, pose, pixels)
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        self.poses: dict[float, Array] = {}
        self._begun = time.perf_counter()

    def __enter__(self) -> Output:
        self._file = (self.folder / FRAMES).open("w", encoding="utf-8", newline="")
        self._rows = csv.writer(self._file, lineterminator="\n")
        self._rows.writerow(["time", "state", "seconds"])
        self._features: TextIO | None = None
        return self

    def begin(self) -> None:
        """The time of the next frame is counted from here, so that reading files does not count."""
        self._begun = time.perf_counter()

    def frame(self, stamp: float, state: str, pose: Array | None = None, features: Array | None = None) -> None:
        """One frame. pose: (4, 4), of the sensor in the world of the method; it counts if the state is TRACKED. features: (n, 2)
        pixels of the left image that the method used, for the video; None = it does not know them."""
        seconds = time.perf_counter() - self._begun
        self._rows.writerow([f"{stamp:.9f}", state, f"{seconds:.6f}"])
        self._file.flush()  # a method that crashes keeps its frames
        if features is not None:
            self._features = self._features or (self.folder / FEATURES).open("w", encoding="utf-8")
            self._features.write(" ".join([f"{stamp:.9f}", *(f"{value:.1f}" for value in features.ravel())]) + "\n")
        if state == TRACKED and pose is not None:
            self.poses[stamp] = np.asarray(pose, np.float64)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._file.close()
        if self._features is not None:
            self._features.close()
        with (self.folder / POSES).open("w", encoding="utf-8") as file:
            for stamp, pose in sorted(self.poses.items()):
                x, y, z = pose[:3, 3]
                qw, qx, qy, qz = quaternion(pose[:3, :3])
                file.write(f"{stamp:.9f} {x:.9g} {y:.9g} {z:.9g} {qx:.9g} {qy:.9g} {qz:.9g} {qw:.9g}\n")


def quaternion(rotation: Array) -> Array:
    """(w, x, y, z) of a rotation matrix, by its largest component (Shepperd 1978)."""
    r = np.asarray(rotation, np.float64)
    squares = np.array([1 + r[0, 0] + r[1, 1] + r[2, 2], *(1 + 2 * r[k, k] - np.trace(r) for k in range(3))])
    k = int(np.argmax(squares))
    largest = math.sqrt(max(float(squares[k]), 0.0))
    offsets = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    if k == 0:
        q = np.array([largest, *(offsets / largest)])
    else:
        i = k - 1
        sums = (r[i] + r[:, i]) / largest
        sums[i] = largest
        q = np.array([offsets[i] / largest, *sums])
    q = q / np.linalg.norm(q)
    return np.asarray(q if q[0] >= 0 else -q)


def rotation(quaternion_wxyz: Array) -> Array:
    """(3, 3) of a unit quaternion (w, x, y, z)."""
    w, x, y, z = (float(value) for value in quaternion_wxyz)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
