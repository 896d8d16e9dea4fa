"""Methods that the user has installed: installed.py SEQUENCE OUT --method orb_slam2|mast3r_slam --home FOLDER.

orb_slam2: FOLDER is a built checkout of ORB-SLAM2 (Mur-Artal and Tardós 2017); its mono_tum reads the sequence and writes the poses
of keyframes. mast3r_slam: FOLDER is a checkout of MASt3R-SLAM (Murai et al. 2024) with its weights, whose Python is
FOLDER/.venv/bin/python or `python`; it needs an NVIDIA GPU. Both read the sequence in the layout of TUM's benchmark, and neither
reports the state of frames, so only frames with a pose count as tracked.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

from contract import POSES, Sequence


def orb_slam2(sequence: Path, out: Path, home: Path, vocabulary: str) -> Path:
    """Runs it; the file of its keyframes."""
    camera = Sequence(sequence).camera
    if camera is None:
        raise SystemExit("the sequence has no camera")
    d = [*camera.distortion, 0.0, 0.0, 0.0, 0.0][:4]
    lines = ["%YAML:1.0", f"Camera.fx: {camera.fx}", f"Camera.fy: {camera.fy}", f"Camera.cx: {camera.cx}", f"Camera.cy: {camera.cy}"]
    lines += [f"Camera.{name}: {value}" for name, value in zip(("k1", "k2", "p1", "p2"), d, strict=True)]
    lines += [f"Camera.fps: {float(camera.rate)}", "Camera.RGB: 1", "ORBextractor.nFeatures: 1000", "ORBextractor.scaleFactor: 1.2"]
    lines += ["ORBextractor.nLevels: 8", "ORBextractor.iniThFAST: 20", "ORBextractor.minThFAST: 7"]
    viewer = {"KeyFrameSize": 0.05, "KeyFrameLineWidth": 1, "GraphLineWidth": 0.9, "PointSize": 2, "CameraSize": 0.08}
    viewer |= {"CameraLineWidth": 3, "ViewpointX": 0, "ViewpointY": -0.7, "ViewpointZ": -1.8, "ViewpointF": 500}
    lines += [f"Viewer.{name}: {float(value)}" for name, value in viewer.items()]
    (out / "settings.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    run([str(home / "Examples" / "Monocular" / "mono_tum"), vocabulary, str(out / "settings.yaml"), str(sequence)], out)
    return out / "KeyFrameTrajectory.txt"


def mast3r_slam(sequence: Path, out: Path, home: Path) -> Path:
    """Runs it; the file of its keyframes. It recognises the layout by the folder's name, so it gets a link with one."""
    link = out / "tum" / "sequence"
    link.parent.mkdir()
    link.symlink_to(sequence.resolve())
    camera = Sequence(sequence).camera
    if camera is None:
        raise SystemExit("the sequence has no camera")
    calibration = out / "intrinsics.yaml"
    numbers = [camera.fx, camera.fy, camera.cx, camera.cy, *camera.distortion]
    calibration.write_text(f"width: {camera.width}\nheight: {camera.height}\ncalibration: {numbers}\n", encoding="utf-8")
    own = home / ".venv" / "bin" / "python"
    python = str(own) if own.is_file() else "python"
    command = [python, "main.py", "--dataset", str(link), "--config", "config/calib.yaml", "--calib", str(calibration)]
    run([*command, "--no-viz", "--save-as", out.name], home)
    return home / "logs" / out.name / f"{link.name}.txt"


def run(command: list[str], folder: Path) -> None:
    """Runs a command in a folder, with its output in the log. Ends with its exit code if it fails."""
    try:
        code = subprocess.run(command, cwd=folder, check=False).returncode
    except OSError as error:
        raise SystemExit(f"cannot start {command[0]}: {error.strerror}") from None
    if code != 0:
        sys.exit(code if code > 0 else 1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--method", choices=["orb_slam2", "mast3r_slam"], required=True)
    parser.add_argument("--home", type=Path, required=True)
    parser.add_argument("--vocabulary", default="")
    given = parser.parse_args()
    if given.method == "orb_slam2":
        found = orb_slam2(given.sequence, given.out, given.home, given.vocabulary)
    else:
        found = mast3r_slam(given.sequence, given.out, given.home)
    if not found.is_file():
        raise SystemExit(f"it has not written {found.name}")
    shutil.copyfile(found, given.out / POSES)


if __name__ == "__main__":
    main()
