"""The SLAM benchmark: one motion under several conditions, resumption, the page, and its numbers computed independently."""

from __future__ import annotations

import csv
import json
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.slam.adapters.contract import Sequence
from gloam.slam.benchmark import OUTCOME, Key, Request, case_of, run
from gloam.slam.report import write_report
from PIL import Image
from slam_recompute import differences

FAILS = """import sys, pathlib
sequence, out = map(pathlib.Path, sys.argv[1:])
if "minor" in str(sequence):
    sys.exit("too much smoke")
(out / "poses.tum").write_text((sequence.parent / "truth.tum").read_text())
(out / "frames.csv").write_text("time,state\\n" + "".join(line.split()[0] + ",tracked\\n" for line in (out / "poses.tum").open()))
"""


@pytest.fixture(scope="module")
def request_(tmp_path_factory: pytest.TempPathFactory) -> Request:
    """Two methods, one of which fails in smoke, on two seconds of a small tour."""
    folder = tmp_path_factory.mktemp("methods")
    (folder / "fails.py").write_text(FAILS)
    command = json.dumps([sys.executable, str(folder / "fails.py"), "{sequence}", "{out}"])
    (folder / "fails.toml").write_text(f'sensors = "stereo"\ncommand = {command}\n')
    methods = ("noisy_truth", str(folder / "fails.toml"))
    (folder / "haze.toml").write_text("[weather]\nvisibility = 10\nmedium = 'smoke'\n")
    levels = ("none", "minor", str(folder / "haze.toml"))
    return Request(methods, ("house",), levels, 2, legs=1, duration=2.0, tier="direct", width=64, height=48, rate=5)


@pytest.fixture(scope="module")
def out(request_: Request, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slam")
    run(request_, folder)
    return folder


def outcomes(out: Path) -> dict[Path, int]:
    return {file: file.stat().st_mtime_ns for file in out.glob(f"runs/*/*/*/*/{OUTCOME}")}


def test_all_conditions_have_one_motion(out: Path) -> None:
    clear, smoky = (case_of(out, "house", level) for level in ("none", "minor"))
    for name in ("truth.tum", "truth_lidar.tum"):
        if (clear / name).exists():
            assert (clear / name).read_text() == (smoky / name).read_text()
    assert (clear / "sequence/imu.csv").read_text() == (smoky / "sequence/imu.csv").read_text()
    images = [[(case / "sequence/rgb" / f"{k:06}.png").read_bytes() for k in (6, 12)] for case in (clear, smoky)]
    assert images[0][0] != images[1][0] and images[0][1] != images[1][1], "but not one appearance"


def measured_pixels(sequence: Sequence) -> float:
    """The share of pixels whose depth was measured."""
    return float(np.mean([np.asarray(Image.open(file)) > 0 for _, (file,) in sequence.images(("depth",))]))


def test_sequences_are_complete_and_calibrated(out: Path) -> None:
    sequence = Sequence(case_of(out, "house", "none") / "sequence")
    camera = sequence.camera
    assert camera is not None and (camera.width, camera.height) == (64, 48) and camera.baseline == pytest.approx(0.06)
    assert camera.fx == pytest.approx(24 / np.tan(np.radians(30)), rel=1e-6) and camera.cx == 31.5
    frames = list(sequence.images(("rgb", "right", "depth")))
    assert len(frames) == 11 and np.allclose(np.diff([stamp for stamp, _ in frames]), 0.2)
    assert all(file.is_file() for _, files in frames for file in files)
    measured = measured_pixels(sequence)
    hidden = measured_pixels(Sequence(case_of(out, "house", "minor") / "sequence"))
    assert 0.5 < measured < 1 and hidden < measured - 0.05, "smoke hides surfaces from a depth camera"
    imu = sequence.imu()
    assert imu[0, 0] < frames[0][0] and imu[-1, 0] > frames[-1][0] and np.median(np.diff(imu[:, 0])) == pytest.approx(0.005, abs=0.001)
    assert imu[:, 4:].mean(0)[2] == pytest.approx(9.8, abs=1.0), "the trunk is level"
    model = sequence.imu_model
    assert model is not None
    in_camera = np.array(model.in_camera)
    assert in_camera[2, 0] > 0.99, "the IMU's x axis is the camera's optical axis"
    assert in_camera[2, 3] == pytest.approx(-0.32, abs=0.02), "behind the camera"


def test_the_camera_moves_as_the_truth_tells(out: Path) -> None:
    rows = np.loadtxt(case_of(out, "house", "none") / "truth.tum")
    way = np.linalg.norm(np.diff(rows[:, 1:4], axis=0), axis=1).sum()
    assert 0.2 < way < 1.2 and 0.2 < rows[:, 3].min() < rows[:, 3].max() < 0.45, "a walk of two seconds, 0.3 m above the floor"


def test_levels_may_be_scene_files(request_: Request, out: Path) -> None:
    haze, clear = (np.loadtxt(case_of(out, "house", level) / "visibility.csv", delimiter=",", skiprows=1) for level in ("haze", "none"))
    assert np.allclose(haze[:, 1], 10, rtol=0.01) and np.allclose(haze[:, 2], 0.3912, rtol=0.01) and clear[:, 1].min() > 1e4
    assert (out / "overlays" / "haze.toml").read_text() == Path(request_.levels[2]).read_text()
    Path(request_.levels[2]).write_text("[weather]\nvisibility = 5\n")
    try:
        with pytest.raises(gloam.UsageError, match="has changed since"):
            run(request_, out)
    finally:
        Path(request_.levels[2]).write_bytes((out / "overlays" / "haze.toml").read_bytes())
    with pytest.raises(gloam.IoError, match="cannot read the scene file"):
        run(replace(request_, levels=("none", str(out / "nothing.toml"))), out / "other")


def test_failures_are_in_the_results(request_: Request, out: Path) -> None:
    rows = run(request_, out)
    states = {(row["method"], row["level"]): row["state"] for row in rows}
    assert {key for key, state in states.items() if state != "ok"} == {("fails", "minor")} and len(states) == 6
    assert states["fails", "minor"] == "crashed"
    failed = next(row for row in rows if row["state"] == "crashed")
    assert "too much smoke" in failed["message"] and failed["measures"]["coverage"] == 0 and failed["measures"]["tracked"] == 0
    noisy = [row["measures"]["ate_sim3"] for row in rows if row["method"] == "noisy_truth" and row["level"] == "none"]
    assert noisy[0] != noisy[1], "runs have seeds of their own"


def test_a_repeated_call_does_what_is_missing(request_: Request, out: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(out, copy)
    before = outcomes(copy)
    gone = copy / "runs" / Key("noisy_truth", "house", "minor", 1).path
    shutil.rmtree(gone)
    (gone.parent / ".0001.abc").mkdir()  # of a process that was killed
    first = run(request_, copy)
    after = outcomes(copy)
    assert {file for file in after if after[file] != before.get(file)} == {gone / OUTCOME} and len(after) == len(before)
    assert not list(gone.parent.glob(".*"))
    more = run(replace(request_, runs=3), copy)
    assert len(more) == 18 and all(old in more for old in first)
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(rate 5.* and 10 differ"):
        run(replace(request_, rate=10), copy)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"scenes": ("moon",)}, "no scene 'moon'"),
        ({"levels": ("none", "none")}, "name each level once"),
        ({"methods": ()}, "name each method once"),
        ({"runs": 0}, "expected 1 to 10000 runs"),
        ({"width": 5}, "16 to 4096 pixels"),
        ({"methods": ("vins",)}, "no method 'vins'"),
    ],
)
def test_wrong_requests(request_: Request, tmp_path: Path, changed: dict[str, object], words: str) -> None:
    with pytest.raises(gloam.InputError if "no " in words and "name" not in words else gloam.UsageError, match=words):
        run(replace(request_, **changed), tmp_path / "out")
    assert not (tmp_path / "out" / "tours").exists()


def test_the_page_has_the_numbers_of_the_raw_files(out: Path) -> None:
    files = write_report(out)
    assert {file.name for file in files} == {"report.html", "results.csv", "results.parquet", "cells.csv"}
    assert differences(out, {"noisy_truth": "mono", "fails": "stereo"}) == []
    page = (out / "report.html").read_text()
    with (out / "cells.csv").open(newline="") as file:
        cells = {(row["method"], row["level"]): row for row in csv.DictReader(file)}
    cell = cells["noisy_truth", "none"]
    assert f'data-cell="noisy_truth/house/none" data-metric="ate_sim3"><b>{float(cell["ate_sim3"]):.2f}</b>' in page
    assert "too much smoke" in page and "http://" not in page.replace("http://www.w3.org", "") and "<script" not in page
    assert cells["fails", "minor"]["ate_se3"] == "" and cells["fails", "minor"]["failures"] == "2"


def test_a_killed_benchmark_continues(request_: Request, out: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(out, copy)
    shutil.rmtree(copy / "runs")
    slow = tmp_path / "slow.toml"
    slow.write_text('sensors = "mono"\ncommand = ["sleep", "30"]\n')
    program = (
        "import sys\nfrom pathlib import Path\nfrom gloam.slam.benchmark import Request, run\n"
        f"run(Request(('noisy_truth', {str(slow)!r}), ('house',), {request_.levels!r}, 2, legs=1, duration=2.0, tier='direct', "
        "width=64, height=48, rate=5), Path(sys.argv[1]))"
    )
    process = subprocess.Popen([sys.executable, "-c", program, str(copy)])
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and not outcomes(copy):
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = outcomes(copy)
    assert kept
    rows = run(replace(request_, methods=("noisy_truth",)), copy)
    assert len(rows) == 6 and all(outcomes(copy)[file] == stamp for file, stamp in kept.items())
