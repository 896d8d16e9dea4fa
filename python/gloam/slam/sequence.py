"""Sequences: what a SLAM method reads, made by replaying the log of a tour under a condition."""

from __future__ import annotations

import csv
import json
import os
import shutil
from collections.abc import Sequence as Rows
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam.navigation.benchmark.places import ROBOT
from gloam.navigation.benchmark.visibility import KOSCHMIEDER

from .adapters.contract import CALIBRATION, Camera, Imu
from .estimate import Array
from .tour import IMU_RATE, TOUR_SENSORS, Sensors

TRUTH, TRUTH_LIDAR, VISIBILITY = "truth.tum", "truth_lidar.tum", "visibility.csv"
PATH_SAMPLES = 64  # per pixel in the path tier; with fewer the denoiser leaves patterns that methods take for features
_DEPTH_SCALE = 1000.0  # of Gloam's depth images per metre
# Of a BMI088 [rad/s/√Hz, rad/s²/√Hz, m/s²/√Hz, m/s³/√Hz]; its data sheet gives no random walks, those are usual values.
_IMU_NOISE = (2.44e-4, 2e-5, 1.72e-3, 2e-4)


@dataclass(frozen=True)
class Condition:
    """level: of adversity, or dark; overlay: scene file that is applied instead, or None; tier, width, height, rate [Hz]: of the
    images; duration: of the replay [s], None = the whole tour; has_stereo, has_lidar: whether these are recorded."""

    level: str = "none"
    overlay: Path | None = None
    tier: str = "interactive"
    width: int = 640
    height: int = 480
    rate: float = 20.0
    duration: float | None = None
    has_stereo: bool = True
    has_lidar: bool = True


def make_sequence(log: Path, condition: Condition, folder: Path, sensors: Sensors = TOUR_SENSORS, progress: Any = None) -> None:
    """Writes the sequence of a tour into the new folder FOLDER/sequence, and the truth beside it: truth.tum has the poses of the
    left camera (optical frame), truth_lidar.tum the poses of the LiDAR at the end of each scan, visibility.csv the visibility
    at the camera.

    The robot moves as in the log under every condition. Errors: as gloam.Log.replay; OSError.
    """
    work = folder / "replay"
    depth = "sensor_depth_png" if sensors.has_depth_camera else "depth_png"
    outputs = ["png", depth, "sensors", *(["lidar"] if condition.has_lidar else [])]
    cameras = [sensors.left, *([sensors.right] if condition.has_stereo else [])]
    request: dict[str, Any] = {"width": condition.width, "height": condition.height, "rate": condition.rate, "cameras": cameras}
    if condition.duration is not None:
        request["duration"] = sensors.begin + condition.duration
    recorded = gloam.replay(log)
    settings = {"render.tier": condition.tier, **({} if condition.overlay else _settings(condition.level, sensors))}
    if condition.tier == "path":
        settings["render.spp"] = PATH_SAMPLES
    if condition.has_lidar:
        settings[f"lidar.{sensors.lidar}.outputs"] = ["npy"]
    overlays = [condition.overlay] if condition.overlay else []
    if sensors.overlay:
        overlays.append(folder / "probe.toml")
        overlays[-1].write_text(sensors.overlay, encoding="utf-8")
    recorded.replay(work, settings, motion="poses", overlays=overlays, outputs=outputs, progress=progress, **request)
    try:
        _write(recorded, work, condition, folder, sensors)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _settings(level: str, sensors: Sensors) -> dict[str, Any]:
    """Of a replay. The place keeps its clutter, which has bodies of its own, and a run with people keeps those it has."""
    if level == "none":
        return {}
    if level == "dark":
        return {"blackout.at": 0, "sky.luminance": 0}
    clutter = {} if sensors.clutter is None else {"adversity.clutter": sensors.clutter}
    return {"adversity.level": level, **clutter, **({"adversity.people": 0} if sensors.has_people else {})}


def _write(log: gloam.Log, work: Path, condition: Condition, folder: Path, sensors: Sensors) -> None:
    sequence = folder / "sequence"
    sequence.mkdir()
    # 1. Images, with the times and poses of the left camera.
    left = work / sensors.left.replace("/", "_")
    poses = _table(left / "poses.csv")
    kept = [row for row in poses if row["time_s"] >= sensors.begin - 1e-9]
    sources = {"rgb": left / "rgb", "depth": left / ("sensor_depth" if sensors.has_depth_camera else "depth")}
    if condition.has_stereo:
        sources["right"] = work / sensors.right.replace("/", "_") / "rgb"
    for kind, source in sources.items():
        (sequence / kind).mkdir()
        for row in kept:
            os.link(source / f"{row['frame']:06.0f}.png", sequence / kind / f"{row['frame']:06.0f}.png")
        _write_index(sequence / f"{kind}.txt", [(row["time_s"], f"{kind}/{row['frame']:06.0f}.png") for row in kept])
    _write_truth(folder / TRUTH, np.array([row["time_s"] for row in kept]), _poses(kept, ""))
    # 2. Scans: x, y, z, intensity and the time within the scan.
    if condition.has_lidar:
        lidar = sensors.lidar.replace("/", "_")
        scans = [row for row in _table(work / lidar / "scans.csv") if row["start_s"] >= sensors.begin - 1e-9]
        (sequence / "scans").mkdir()
        for row in scans:
            points = np.load(work / lidar / "npy" / f"{row['scan']:06.0f}.npy")
            packed = np.column_stack([points[name] for name in ("x", "y", "z", "intensity", "time")]).astype(np.float32)
            packed.tofile(sequence / "scans" / f"{row['scan']:06.0f}.bin")
        _write_index(sequence / "scans.txt", [(row["end_s"], f"scans/{row['scan']:06.0f}.bin") for row in scans])
        _write_truth(folder / TRUTH_LIDAR, np.array([row["end_s"] for row in scans]), _poses(scans, "end_"))
    _write_visibility(work / "sensors" / f"{sensors.probe}.csv", folder / VISIBILITY, sensors.begin)
    # 3. Inertial measurements, which the log has, and the calibration.
    if sensors.imu:
        _write_imu(log, sequence / "imu.csv", sensors)
    (sequence / CALIBRATION).write_text(json.dumps(_calibration(log, work, condition, sensors), indent=1) + "\n", encoding="utf-8")


def _calibration(log: gloam.Log, work: Path, condition: Condition, sensors: Sensors) -> dict[str, Any]:
    cameras = json.loads((work / "cameras.json").read_text(encoding="utf-8"))["cameras"]
    found = next(camera for camera in cameras if camera["name"] == sensors.left)
    k, d = found["camera_info"]["k"], found["camera_info"]["d"]
    camera = Camera(
        found["width_px"], found["height_px"], k[0], k[4], k[2], k[5], condition.rate, tuple(d) if any(d) else (),
        sensors.baseline if condition.has_stereo else 0.0, _DEPTH_SCALE,
    )  # fmt: skip
    if not sensors.imu:
        return {"camera": asdict(camera)}
    imu = Imu(IMU_RATE, *_IMU_NOISE, tuple(map(tuple, _imu_in_camera(log, sensors).tolist())))
    return {"camera": asdict(camera), "imu": asdict(imu)}


def _imu_in_camera(log: gloam.Log, sensors: Sensors) -> Array:
    """(4, 4): pose of the IMU in the optical frame of the left camera."""
    with log.at(sensors.begin) as sim:
        number = sim.world.info.sites.index(f"{ROBOT}/imu")
        imu = np.eye(4)
        imu[:3, :3] = np.array(sim.memory.array("site_xmat"))[number].reshape(3, 3)
        imu[:3, 3] = np.array(sim.memory.array("site_xpos"))[number]
        pose = sim.cameras[sensors.left].render(("depth",), width=8, height=8, tier="direct").pose
        camera = np.eye(4)
        camera[:3, :3] = np.asarray(pose.R) * (1, -1, -1)  # from MJCF's axes to the optical ones
        camera[:3, 3] = np.asarray(pose.p)
    answer: Array = np.linalg.inv(camera) @ imu
    return answer


def _table(file: Path) -> list[dict[str, float]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]


def _poses(rows: Rows[dict[str, float]], prefix: str) -> Array:
    names = [f"{prefix}{name}" for name in ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")]
    return np.array([[row[name] for name in names] for row in rows]).reshape(-1, 7)


def _write_truth(file: Path, times: Array, poses: Array) -> None:
    lines = [" ".join(f"{value:.9f}" for value in (time, *pose[:3], *pose[4:], pose[3])) for time, pose in zip(times, poses, strict=True)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _write_index(file: Path, rows: Rows[tuple[float, str]]) -> None:
    # Programs for TUM's benchmark, such as ORB-SLAM2's, skip three lines.
    head = f"# {file.stem}\n# of a sequence of Gloam\n# time [s], file\n"
    file.write_text(head + "".join(f"{stamp:.9f} {name}\n" for stamp, name in rows), encoding="utf-8")


def _write_visibility(source: Path, file: Path, begin: float) -> None:
    """Time [s], visibility [m] and extinction [1/m] at 550 nm of each sample of the probe, which methods do not see."""
    with source.open(encoding="utf-8", newline="") as stream, file.open("w", encoding="utf-8", newline="") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow(["time_s", "visibility_m", "extinction_1_m"])
        reader = csv.reader(stream)
        names = next(reader)
        time, value = names.index("time_s"), next(k for k, name in enumerate(names) if name.startswith("visibility"))
        for row in reader:
            if float(row[time]) >= begin - 1e-9:
                rows.writerow([row[time], row[value], f"{KOSCHMIEDER / float(row[value]):.6g}"])


def _write_imu(log: gloam.Log, file: Path, sensors: Sensors) -> None:
    raw = file.with_suffix(".raw.csv")
    log.export(sensors.imu, raw, "csv")
    axes = [f"{name}.{axis}" for name in ("angular_velocity", "linear_acceleration") for axis in "xyz"]
    with raw.open(encoding="utf-8", newline="") as stream, file.open("w", encoding="utf-8", newline="") as out:
        out.write("#timestamp [ns],w_x [rad s^-1],w_y,w_z,a_x [m s^-2],a_y,a_z\n")
        rows = csv.writer(out, lineterminator="\n")
        for row in csv.DictReader(stream):
            stamp = int(row["header.stamp.sec"]) * 10**9 + int(row["header.stamp.nanosec"])
            if stamp >= (sensors.begin - 0.1) * 1e9:
                rows.writerow([stamp, *(row[axis] for axis in axes)])
    raw.unlink()
