"""ORB-SLAM3 (Campos et al. 2021): orb_slam3.py SEQUENCE OUT --sensors mono|stereo|rgbd[_imu] --vocabulary FILE.

Requires pyorbslam3 (GPL-3.0), which `gloam slam install orb_slam3` puts into an environment of its own. The vocabulary is a text
file of DBoW2, such as ORBvoc.txt of the authors or one made by `gloam slam vocabulary`.
"""

from __future__ import annotations

import argparse
import os
import signal
import time
from pathlib import Path

import cv2
import numpy as np
import pyorbslam3
from contract import INITIALIZING, LOST, TRACKED, Array, Camera, Output, Sequence, rotation

KINDS = {"mono": ("rgb",), "stereo": ("rgb", "right"), "rgbd": ("rgb", "depth")}
SENSORS = {
    "mono": "MONOCULAR", "stereo": "STEREO", "rgbd": "RGBD",
    "mono_imu": "IMU_MONOCULAR", "stereo_imu": "IMU_STEREO", "rgbd_imu": "IMU_RGBD",
}  # fmt: skip
FEATURES = 1250
SAVING = 20  # longest time that saving the trajectory may take [s]
FARTHEST = 40.0  # of stereo and depth points that count as near: times the baseline (ThDepth)


def settings(sequence: Sequence, sensors: str) -> str:
    """The settings file of ORB-SLAM3 (File.version 1.0). Errors: ValueError without a camera, or without the IMU's model."""
    camera, imu = sequence.camera, sequence.imu_model
    if camera is None or (sensors.endswith("_imu") and imu is None):
        raise ValueError("the sequence has no camera or no IMU")
    lines = [
        "%YAML:1.0", "---", 'File.version: "1.0"', 'Camera.type: "PinHole"',
        *_lens("Camera1", camera),
        f"Camera.width: {camera.width}", f"Camera.height: {camera.height}", f"Camera.fps: {max(1, round(camera.rate))}", "Camera.RGB: 0",
    ]  # fmt: skip
    if sensors.startswith(("stereo", "rgbd")):
        lines += [f"Stereo.ThDepth: {FARTHEST}", f"Stereo.b: {camera.baseline or 0.05}"]
        lines += [f"RGBD.DepthMapFactor: {float(camera.depth_scale)}"]
    if sensors.startswith("stereo"):
        lines += _lens("Camera2", camera)
        right = np.eye(4)
        right[0, 3] = camera.baseline
        lines += _matrix("Stereo.T_c1_c2", right)
    if sensors.endswith("_imu") and imu is not None:
        lines += _matrix("IMU.T_b_c1", np.linalg.inv(np.array(imu.in_camera)))
        noise = {"NoiseGyro": imu.gyro_noise, "NoiseAcc": imu.accel_noise, "GyroWalk": imu.gyro_walk, "AccWalk": imu.accel_walk}
        lines += [f"IMU.{name}: {float(value)}" for name, value in (noise | {"Frequency": imu.rate}).items()]
    lines += [f"ORBextractor.nFeatures: {FEATURES}", "ORBextractor.scaleFactor: 1.2", "ORBextractor.nLevels: 8"]
    lines += ["ORBextractor.iniThFAST: 20", "ORBextractor.minThFAST: 7"]
    viewer = {"KeyFrameSize": 0.05, "KeyFrameLineWidth": 1.0, "GraphLineWidth": 0.9, "PointSize": 2.0, "CameraSize": 0.08}
    viewer |= {"CameraLineWidth": 3.0, "ViewpointX": 0.0, "ViewpointY": -0.7, "ViewpointZ": -1.8, "ViewpointF": 500.0}
    return "\n".join([*lines, *(f"Viewer.{name}: {value}" for name, value in viewer.items())]) + "\n"


def _lens(name: str, camera: Camera) -> list[str]:
    """Parameters of a camera. ORB-SLAM3 takes real numbers only if they have a decimal point."""
    numbers = {"fx": camera.fx, "fy": camera.fy, "cx": camera.cx, "cy": camera.cy}
    numbers |= dict(zip(("k1", "k2", "p1", "p2"), [*camera.distortion, 0.0, 0.0, 0.0, 0.0], strict=False))
    return [f"{name}.{key}: {float(value)}" for key, value in numbers.items()]


def _matrix(name: str, values: Array) -> list[str]:
    numbers = ", ".join(f"{value:.9g}" for value in np.asarray(values).ravel())
    return [f"{name}: !!opencv-matrix", "   rows: 4", "   cols: 4", "   dt: f", f"   data: [{numbers}]"]


def track(slam: pyorbslam3.Slam, sequence: Sequence, sensors: str, output: Output) -> None:
    """Feeds all frames, not faster than they were recorded, as the authors' programs do: the map grows in other threads meanwhile,
    and would fall behind the camera."""
    kind = sensors.removesuffix("_imu")
    imu = sequence.imu() if sensors.endswith("_imu") else None
    before, start = -np.inf, None
    has_tracked = False
    for stamp, files in sequence.images(KINDS[kind]):
        flag = cv2.IMREAD_UNCHANGED if kind == "rgbd" else cv2.IMREAD_COLOR
        images = [cv2.imread(str(files[0]), cv2.IMREAD_COLOR), *(cv2.imread(str(file), flag) for file in files[1:])]
        more = {} if imu is None else {"imu": imu[(imu[:, 0] > before) & (imu[:, 0] <= stamp)]}
        before = stamp
        start = time.monotonic() - stamp if start is None else start
        time.sleep(max(0.0, start + stamp - time.monotonic()))
        output.begin()
        result = {"mono": slam.track_monocular, "stereo": slam.track_stereo, "rgbd": slam.track_rgbd}[kind](*images, stamp, **more)
        is_tracked = bool(result.pose_valid) and result.state in (pyorbslam3.TrackingState.OK, pyorbslam3.TrackingState.OK_KLT)
        has_tracked |= is_tracked
        state = TRACKED if is_tracked else LOST if has_tracked else INITIALIZING
        pose = np.array(result.pose_wc) if is_tracked else None
        output.frame(stamp, state, pose, seen(sequence.camera, pose, np.asarray(slam.tracked_map_points(), np.float64)))


def seen(camera: Camera | None, pose: Array | None, points: Array) -> Array:
    """(n, 2) pixels of the points (m, 3) of the map that are in front of a camera with this pose (4, 4)."""
    inverse = np.linalg.inv(np.eye(4) if pose is None else pose)
    there = points.reshape(-1, 3) @ inverse[:3, :3].T + inverse[:3, 3]
    there = there[there[:, 2] > 0]
    if camera is None or pose is None or not len(there):
        return np.zeros((0, 2))
    lens = np.array(camera.distortion or (0.0, 0.0, 0.0, 0.0))
    pixels: Array = cv2.projectPoints(there, np.zeros(3), np.zeros(3), camera.matrix, lens)[0].reshape(-1, 2)
    return pixels


def final_poses(file: Path, tracked: dict[float, Array], camera_in_body: Array) -> dict[float, Array]:
    """The optimised poses of the camera at the times of tracked frames, from a trajectory of the body in EuRoC's form: time [ns]
    x y z qx qy qz qw. They replace the poses of the moment, because a loop or the IMU's scale changes the past."""
    if not file.is_file() or file.stat().st_size == 0:
        return tracked
    answer: dict[float, Array] = {}
    times = np.array(sorted(tracked))
    for row in np.loadtxt(file, ndmin=2):
        stamp = row[0] * 1e-9
        nearest = times[np.argmin(np.abs(times - stamp))]
        if abs(nearest - stamp) < 1e-3:
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = rotation(row[[7, 4, 5, 6]]), row[1:4]
            answer[float(nearest)] = pose @ camera_in_body
    return answer or tracked


def save_final(slam: pyorbslam3.Slam, file: Path) -> None:
    """Saves the optimised poses from a process of its own, because ORB-SLAM3 crashes if its map has just been reset, and may hang
    while one of its threads is still running. If saving fails, no file is left."""
    child = os.fork()
    if child == 0:
        signal.alarm(SAVING)  # ends the process
        slam.save_trajectory_euroc(str(file))
        os._exit(0)
    if os.waitpid(child, 0)[1] != 0:
        file.unlink(missing_ok=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence")
    parser.add_argument("out")
    parser.add_argument("--sensors", choices=sorted(SENSORS), default="mono")
    parser.add_argument("--vocabulary", required=True)
    given = parser.parse_args()
    sequence, out = Sequence(given.sequence), Path(given.out).resolve()
    (out / "settings.yaml").write_text(settings(sequence, given.sensors), encoding="utf-8")
    sensor = getattr(pyorbslam3.Sensor, SENSORS[given.sensors])
    slam = pyorbslam3.Slam(given.vocabulary, str(out / "settings.yaml"), sensor, use_viewer=False)
    with Output(out) as output:
        track(slam, sequence, given.sensors, output)
        slam.shutdown()
        if output.poses:
            save_final(slam, out / "final.txt")
            has_imu = given.sensors.endswith("_imu") and sequence.imu_model is not None
            camera_in_body = np.linalg.inv(np.array(sequence.imu_model.in_camera)) if has_imu else np.eye(4)
            output.poses = final_poses(out / "final.txt", output.poses, camera_in_body)
    os._exit(0)  # its threads may crash at the end of the process


if __name__ == "__main__":
    main()
