"""Small runs of real methods: adversity costs vision its track, darkness costs LiDAR nothing, and smoke costs it its returns."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from env import ROOT, python_env
from gloam.envs.assets import asset_folder
from gloam.slam.benchmark import Request, case_of, run
from gloam.slam.tour import TOPICS, tour_scene

LEVELS = ("none", "smoke", "dark")
SMOKE = "[weather]\nvisibility = {}\nmedium = 'smoke'\n"
VISION = ("odometry_stereo", "odometry_rgbd", "orb_slam3_mono", "orb_slam3_stereo", "orb_slam3_rgbd")
Rows = dict[tuple[str, str], dict[str, Any]]


@pytest.fixture(scope="module")
def environments(tmp_path_factory: pytest.TempPathFactory) -> pytest.FixtureRequest:
    folder = tmp_path_factory.mktemp("environments")
    for name in ("opencv", "orb_slam3", "kiss_icp"):
        (folder / f"slam-{name}").symlink_to(python_env(ROOT / "tools" / "slam" / f"{name}.txt").parent.parent)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GLOAM_SLAM_ENVIRONMENTS", str(folder))
        yield folder


def measured(request: Request, out: Path) -> Rows:
    """Measures of each method and level."""
    found = run(request, out)
    assert all(row["state"] == "ok" for row in found), [row["message"] for row in found]
    return {(row["method"], row["level"]): row["measures"] for row in found}


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("slam")


@pytest.fixture(scope="module")
def rows(environments: Path, out: Path) -> Rows:
    """Of a walk through the furnished room of the demo: sideways and turning, so that one camera sees depth."""
    room = {"file": str(asset_folder() / "environments" / "room" / "room.xml")}
    log = out / "room.mcap"
    scene = tour_scene("room", room)
    scene.update({"robot.go.position": [-1.0, -0.5, 0.0], "robot.go.orientation": [np.cos(0.25), 0.0, 0.0, np.sin(0.25)]})
    with gloam.Simulation(scene.compile(), seed=1) as sim, sim.record(log, TOPICS):
        sim.robots["go"].command(vx=0.2, vy=0.25, yaw_rate=-0.2)
        sim.run_until(time=3.2)
    (out / "smoke.toml").write_text(SMOKE.format(1.0))
    levels = ("none", str(out / "smoke.toml"), "dark")
    return measured(Request((*VISION, "kiss_icp"), (), levels, 1, width=320, height=240, rate=10).of_log(log, ""), out)


@pytest.mark.parametrize("method", VISION)
def test_vision_follows_the_robot_in_clear_air(rows: Rows, method: str) -> None:
    found = rows[method, "none"]
    assert found["tracked"] > 0.5 and found["completeness"] > 0.5 and found["first_track"] < 1.5
    if not method.endswith("mono"):
        assert found["tracked"] > 0.9 and found["completeness"] > 0.9 and found["ate_se3"] < 0.05


@pytest.mark.parametrize("level", LEVELS[1:])
@pytest.mark.parametrize("method", VISION)
def test_adversity_costs_vision_its_track(rows: Rows, method: str, level: str) -> None:
    clear, found = rows[method, "none"], rows[method, level]
    assert found["tracked"] < clear["tracked"] - 0.1 and found["coverage"] < clear["coverage"] - 0.1
    assert found["completeness"] < clear["completeness"] - 0.1


def test_darkness_costs_lidar_nothing(rows: Rows, out: Path) -> None:
    clear, smoky, dark = ({k: v for k, v in rows["kiss_icp", level].items() if k != "seconds"} for level in LEVELS)
    assert clear["tracked"] == 1 and clear["ate_se3"] < 0.1 and dark == clear != smoky
    scans = [case_of(out, "room", level) / "sequence" / "scans" / "000012.bin" for level in LEVELS]
    assert scans[0].read_bytes() == scans[2].read_bytes() != scans[1].read_bytes()
    assert np.fromfile(scans[0], np.float32).reshape(-1, 5).shape[0] > 20_000


@pytest.mark.slow
def test_smoke_costs_lidar_its_track_as_it_costs_returns(environments: Path, tmp_path: Path) -> None:
    """A tour of the house in smoke of a given visibility; images are small, since no method reads them."""
    for name, visibility in (("hazy", 1.5), ("thick", 0.8)):
        (tmp_path / f"{name}.toml").write_text(SMOKE.format(visibility))
    levels = ("none", *(str(tmp_path / f"{name}.toml") for name in ("hazy", "thick")))
    request = Request(("kiss_icp",), ("house",), levels, 1, legs=1, duration=4.0, tier="direct", width=16, height=16, rate=5)
    found = measured(request, tmp_path / "out")
    clear, hazy, thick = (found["kiss_icp", level] for level in ("none", "hazy", "thick"))
    folders = [case_of(tmp_path / "out", "house", level) / "sequence" / "scans" for level in ("none", "hazy", "thick")]
    returns = [[file.stat().st_size // 20 for file in sorted(folder.glob("*.bin"))] for folder in folders]
    mean = [float(np.mean(counts)) for counts in returns]
    assert mean[1] < 0.4 * mean[0] and mean[2] < 0.05 * mean[0]
    assert clear["tracked"] == 1 and clear["ate_se3"] < 0.1
    assert hazy["tracked"] == 1 and hazy["rpe"] > 2 * clear["rpe"] and hazy["ate_se3"] > 2 * clear["ate_se3"]
    assert thick["tracked"] == pytest.approx(np.mean(np.array(returns[2]) >= 100)) and thick["tracked"] < 0.5
    assert thick["completeness"] < 0.5
