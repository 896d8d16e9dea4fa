"""SLAM methods as processes: those that fail in every way, files that define them, and the check of the benchmark itself."""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import time
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.slam.adapters.contract import Camera, Sequence
from gloam.slam.methods import METHODS, SENSORS, Method, load_method
from gloam.slam.run import LOG, Outcome, run_method

COUNT = 101


@pytest.fixture
def case(tmp_path: Path) -> Path:
    """A sequence of ten seconds along a curve, with empty images."""
    sequence = tmp_path / "case" / "sequence"
    sequence.mkdir(parents=True)
    times = 1 + np.linspace(0, 10, COUNT)
    camera = {"width": 8, "height": 6, "fx": 5, "fy": 5, "cx": 3.5, "cy": 2.5, "rate": 10, "distortion": []}
    (sequence / "calibration.json").write_text(json.dumps({"camera": camera}))
    (sequence / "rgb.txt").write_text("# a\n# b\n# c\n" + "".join(f"{t:.9f} rgb/{k}.png\n" for k, t in enumerate(times)))
    rows = [f"{t:.9f} {t:.9f} {math.sin(t):.9f} 0.3 0 0 {math.sin(t / 2):.9f} {math.cos(t / 2):.9f}" for t in times]
    (tmp_path / "case" / "truth.tum").write_text("\n".join(rows) + "\n")
    return tmp_path / "case"


def outcome(case: Path, program: str, limit: float = 20.0) -> Outcome:
    method = Method("probe", "mono", (sys.executable, "-c", program, "{sequence}", "{out}", "{truth}"))
    return run_method(method, case, case.parent / "out", {}, limit)


HEAD = "import sys, pathlib, shutil\nsequence, out, truth = map(pathlib.Path, sys.argv[1:])\n"


def test_the_true_poses_are_perfect(case: Path) -> None:
    found = outcome(case, HEAD + "shutil.copyfile(truth, out / 'poses.tum')")
    assert found.state == "ok" and found.measures.ate_se3 == pytest.approx(0, abs=1e-8) and found.measures.tracked == 1
    assert found.measures.coverage == pytest.approx(1, abs=1e-6) and found.measures.seconds is None


@pytest.mark.parametrize(
    ("program", "state", "words"),
    [
        ("print('no vocabulary'); sys.exit(4)", "crashed", "exit code 4: no vocabulary"),
        ("import os; os.abort()", "crashed", "SIGABRT: no output"),
        ("pass", "malformed", "has not written its poses"),
        ("(out / 'poses.tum').write_text('1 2 3')", "malformed", "eight finite numbers"),
        ("(out / 'poses.tum').write_text(''.join('%d %d 0 0 0 0 0 1\\n' % (500 + k, k) for k in range(9)))", "malformed", "at a time"),
        ("import time; time.sleep(60)", "timed_out", "longer than 1 s"),
        ("import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)", "timed_out", "longer"),
    ],
)
def test_failures_are_outcomes(case: Path, program: str, state: str, words: str) -> None:
    begin = time.monotonic()
    found = outcome(case, HEAD + program, 1.0)
    assert found.state == state and words in found.message
    assert found.measures.ate_se3 is None and found.measures.coverage == 0 and found.measures.frames == COUNT
    assert time.monotonic() - begin < 12


def test_frames_of_a_crash_are_kept(case: Path) -> None:
    rows = "time,state,seconds\\n1,initializing,0.1\\n1.1,tracked,0.1\\n"
    found = outcome(case, HEAD + f"(out / 'frames.csv').write_text('{rows}'); sys.exit(1)")
    assert found.state == "crashed" and found.measures.tracked == pytest.approx(1 / COUNT) and found.measures.coverage == 0


def test_children_do_not_outlive_a_method(case: Path) -> None:
    program = "import subprocess; child = subprocess.Popen(['sleep', '100']); (out / 'pid').write_text(str(child.pid))"
    assert outcome(case, HEAD + program).state == "malformed"
    child = int((case.parent / "out" / "pid").read_text())
    deadline = time.monotonic() + 5
    while time.monotonic() < deadline and Path(f"/proc/{child}").exists() and "Z" not in Path(f"/proc/{child}/stat").read_text().split()[2]:
        time.sleep(0.05)
    if Path(f"/proc/{child}").exists() and "Z" not in Path(f"/proc/{child}/stat").read_text().split()[2]:
        os.kill(child, signal.SIGKILL)
        pytest.fail("the child still runs")


def test_the_noisy_truth_has_its_noise_scale_and_gap(case: Path) -> None:
    method = METHODS["noisy_truth"]
    more = ("--sigma", "0.02", "--scale", "0.5", "--lost", "0.2")
    found = run_method(Method("n", "mono", (*method.command, *more)), case, case.parent / "out", {"seed": "3"}, 30)
    assert found.state == "ok", found.message
    assert found.measures.ate_sim3 == pytest.approx(0.02 * math.sqrt(3), rel=0.15) and found.measures.scale == pytest.approx(2, rel=0.01)
    assert found.measures.tracked == pytest.approx(80 / COUNT, abs=0.02) and found.measures.relocalisations == 1
    assert found.measures.first_track == pytest.approx(0.1) and found.measures.completeness == pytest.approx(0.8, abs=0.06)
    assert (case.parent / "out" / LOG).read_text() == ""


def test_methods_of_files(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('sensors = "rgbd"\ncommand = ["./track", "{sequence}", "--fast"]\n')
    found = load_method(str(file))
    assert found.name == "mine" and found.is_metric and not found.has_lidar and found.command[0] == str(tmp_path / "track")
    with pytest.raises(gloam.UsageError, match="there is no program"):
        found.words({"sequence": "s"})
    with pytest.raises(gloam.UsageError, match="no value for '{map}'"):
        Method("a", "mono", ("sh", "{map}")).words({"out": "o"})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("sensors = 'mono'", "command must be"),
        ("command = ['a']", "sensors must be one of"),
        ("sensors = 'sonar'\ncommand = ['a']", "sensors must be one of"),
        ("sensors = 'mono'\ncommand = []", "command must be"),
        ("sensors = 'mono'\ncommand = ['a', 3]", "command must be"),
        ("sensors = 'mono'\ncommand = ['a']\nname = '../x'", "the name of a method"),
        ("sensors = 'mono'\ncommand = ['a']\ncolour = 1", "unknown key 'colour'"),
        ("sensors = 'mono'\ncommand = ['a']\nenvironment = 3", "environment must be a name"),
        ("sensors = ", "not valid TOML"),
    ],
)
def test_malformed_files_of_methods(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "m.toml"
    file.write_text(text)
    with pytest.raises(gloam.InputError, match=words):
        load_method(str(file))


def test_unknown_methods_and_missing_environments(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(gloam.NotFoundError, match="there is no method 'vins'"):
        load_method("vins")
    with pytest.raises(gloam.IoError, match="cannot read the method"):
        load_method(str(tmp_path / "none.toml"))
    monkeypatch.setenv("GLOAM_SLAM_ENVIRONMENTS", str(tmp_path))
    with pytest.raises(gloam.UsageError, match="slam install kiss_icp"):
        METHODS["kiss_icp"].words({"sequence": "s", "out": "o"})
    assert all(method.sensors in SENSORS and method.name == name for name, method in METHODS.items())


def test_sequences_are_read(case: Path) -> None:
    sequence = Sequence(case / "sequence")
    assert sequence.camera == Camera(8, 6, 5, 5, 3.5, 2.5, 10) and sequence.imu_model is None
    assert len(sequence.files("rgb")) == COUNT and sequence.files("depth") == [] and list(sequence.images(("rgb", "depth"))) == []
    (case / "sequence" / "depth.txt").write_text("1.1 depth/1.png\n1.15 depth/x.png\n1.3 depth/3.png\n")
    assert [stamp for stamp, _ in sequence.images(("rgb", "depth"))] == [1.1, 1.3]
    (case / "sequence" / "imu.csv").write_text("#head\n1000000000,1,2,3,4,5,6\n")
    assert sequence.imu().tolist() == [[1, 1, 2, 3, 4, 5, 6]]
