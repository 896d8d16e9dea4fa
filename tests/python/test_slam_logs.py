"""Logs of users as tours of the SLAM benchmark: one motion at all levels, resumption, and logs that cannot be replayed."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.envs.assets import asset_folder
from gloam.slam.adapters.contract import Sequence
from gloam.slam.benchmark import Request, case_of, run
from gloam.slam.recorded import examine, scene_name
from gloam.slam.report import write_report
from navigation_scene import arena


def record(file: Path, scene: gloam.Scene, seconds: float = 2.2, speed: float = 0.4) -> Path:
    with gloam.Simulation(scene.compile()) as sim, sim.record(file, ("/clock",)):
        sim.robots["go"].command(vx=speed)
        sim.run_until(time=seconds)
    return file


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return record(tmp_path_factory.mktemp("log") / "my walk.mcap", arena())


def request(**changes: Any) -> Request:
    small = {"levels": ("none", "minor"), "runs": 1, "tier": "direct", "width": 64, "height": 48, "rate": 5}
    return Request(**{"methods": ("noisy_truth",), **small, **changes})


def path(file: Path) -> float:
    return float(np.linalg.norm(np.diff(np.loadtxt(file)[:, 1:4], axis=0), axis=1).sum())


def test_a_log_is_replayed_at_all_levels(log: Path, tmp_path: Path) -> None:
    asked = request().of_log(log, "")
    rows = run(asked, tmp_path)
    assert [row["level"] for row in rows] == ["none", "minor"] and all(row["state"] == "ok" for row in rows), rows
    clear, smoky = (case_of(tmp_path, "my_walk", level) for level in ("none", "minor"))
    assert (clear / "truth.tum").read_text() == (smoky / "truth.tum").read_text() and 0.4 < path(clear / "truth.tum") < 1.2
    frames = [list(Sequence(case / "sequence").images(("rgb", "depth"))) for case in (clear, smoky)]
    assert len(frames[0]) == len(frames[1]) == 12 and frames[0][0][0] == 0, "from the start of the log"
    assert frames[0][4][1][0].read_bytes() != frames[1][4][1][0].read_bytes()
    visibility = [np.loadtxt(case / "visibility.csv", delimiter=",", skiprows=1)[:, 1] for case in (clear, smoky)]
    assert (visibility[0] > 1e4).all() and (visibility[1] < 500).all()
    assert Sequence(clear / "sequence").imu_model is None and not (clear / "sequence" / "imu.csv").exists()
    write_report(tmp_path)
    assert "Motion and scene of the log my_walk" in (tmp_path / "report.html").read_text() and (tmp_path / "plans/my_walk/none.npz").is_file()
    # Another call does nothing, from a copy too, unless the log has changed.
    copy = tmp_path / "my walk.mcap"
    copy.write_bytes(log.read_bytes())
    lines: list[str] = []
    assert run(request().of_log(copy, ""), tmp_path, tell=lines.append) == rows and lines == []
    copy.write_bytes(log.read_bytes() + b"\0")
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(log_hash"):
        run(request().of_log(copy, ""), tmp_path)
    with pytest.raises(gloam.UsageError, match="camera"):
        run(replace(asked, camera="go/front"), tmp_path)


@pytest.mark.parametrize(("sensors", "words"), [("stereo", "a stereo pair"), ("mono_imu", "a calibrated IMU")])
def test_methods_need_the_sensors_of_the_robot(log: Path, tmp_path: Path, sensors: str, words: str) -> None:
    (tmp_path / "mine.toml").write_text(f'sensors = "{sensors}"\ncommand = ["true"]\n')
    with pytest.raises(gloam.UsageError, match=f"'mine' needs {words}, which the log does not have"):
        run(request(methods=(str(tmp_path / "mine.toml"),)).of_log(log, ""), tmp_path / "out")


def test_people_of_the_run_stay_and_no_others_come(tmp_path: Path) -> None:
    log = record(tmp_path / "people.mcap", arena(crowd=[{"name": "people", "count": 1}]))
    rows = run(request(levels=("none", "major")).of_log(log, "go/front"), tmp_path / "out")
    assert len(rows) == 2 and all(row["state"] == "ok" for row in rows)
    clear, smoky = (Sequence(case_of(tmp_path / "out", "people", level) / "sequence") for level in ("none", "major"))
    for (_, (a, shown)), (_, (b, hidden)) in zip(clear.images(("depth", "rgb")), smoky.images(("depth", "rgb")), strict=True):
        assert a.read_bytes() == b.read_bytes() and shown.read_bytes() != hidden.read_bytes()


def test_logs_that_cannot_be_tours(log: Path, tmp_path: Path) -> None:
    def check(file: Path, error: type[gloam.Error], words: str, camera: str = "") -> None:
        with pytest.raises(error, match=words):
            examine(file, camera, tmp_path / "plan.npz")

    check(log, gloam.NotFoundError, "no camera 'go/rear'; there are: go/front", "go/rear")
    check(record(tmp_path / "short.mcap", arena(), 0.5), gloam.InputError, "the run lasts 0.5 s")
    check(record(tmp_path / "still.mcap", arena(), 2.2, 0.0), gloam.InputError, "moves 0.* m; a tour needs")
    check(record(tmp_path / "hazy.mcap", arena(adversity={"level": "minor"})), gloam.UsageError, r"has \[adversity\]")
    data = bytearray(log.read_bytes())
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    check(tmp_path / "cut.mcap", gloam.InputError, "the log is damaged: .*present")
    data[len(data) // 2] ^= 255
    (tmp_path / "flipped.mcap").write_bytes(data)
    check(tmp_path / "flipped.mcap", gloam.InputError, "CRC of a chunk is wrong")
    (tmp_path / "bad.mcap").write_bytes(b"no log at all")
    check(tmp_path / "bad.mcap", gloam.Error, "bad.mcap")
    check(tmp_path / "none.mcap", gloam.Error, "none.mcap")
    with pytest.raises(gloam.UsageError, match="cannot read"):
        request().of_log(tmp_path / "none.mcap", "")


def test_a_scene_that_has_changed(tmp_path: Path) -> None:
    for folder in ("environments/arena", "robots/quadruped"):
        shutil.copytree(asset_folder() / folder, tmp_path / folder)
    model = tmp_path / "environments/arena/arena.xml"
    log = record(tmp_path / "run.mcap", arena(tmp_path))
    examine(log, "", tmp_path / "plan.npz")
    model.write_text(model.read_text().replace("</worldbody>", '<geom type="box" size=".1 .1 .1" pos="1 1 .1"/></worldbody>'))
    with pytest.raises(gloam.Error, match="arena.xml"):
        examine(log, "", tmp_path / "plan.npz")


@pytest.mark.parametrize(("file", "name"), [("run.mcap", "run"), ("a b/ü c.mcap", "ü_c"), (".mcap", "mcap"), ("..mcap", "log")])
def test_names_of_scenes(file: str, name: str) -> None:
    assert scene_name(Path(file)) == name
