"""Small runs of real methods: adversity costs vision its track, darkness costs LiDAR nothing, and smoke costs it its returns."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from env import ROOT, python_env
from gloam.slam.benchmark import Request, case_of, run

LEVELS = ("none", "minor", "dark")


@pytest.fixture(scope="module")
def rows(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[str, str], dict[str, Any]]:
    """Measures of each method and level. The sequences are in rows["folder", ""]["path"]."""
    environments = tmp_path_factory.mktemp("environments")
    for name in ("opencv", "kiss_icp"):
        python = python_env(ROOT / "tools" / "slam" / f"{name}.txt")
        (environments / f"slam-{name}").symlink_to(python.parent.parent)
    out = tmp_path_factory.mktemp("slam")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GLOAM_SLAM_ENVIRONMENTS", str(environments))
        request = Request(
            ("odometry_rgbd", "kiss_icp"), ("house",), LEVELS, 1, legs=1, duration=4.0, width=320, height=240, rate=5
        )
        found = run(request, out)
    assert all(row["state"] == "ok" for row in found), [row["message"] for row in found]
    return {(row["method"], row["level"]): row["measures"] for row in found} | {("folder", ""): {"path": out}}


def test_odometry_follows_the_robot_in_clear_air(rows: dict[tuple[str, str], dict[str, Any]]) -> None:
    found = rows["odometry_rgbd", "none"]
    assert found["tracked"] > 0.9 and found["completeness"] > 0.85 and found["first_track"] == 0
    assert found["ate_se3"] < 0.25


@pytest.mark.parametrize("level", ["minor", "dark"])
def test_adversity_costs_vision_its_track(rows: dict[tuple[str, str], dict[str, Any]], level: str) -> None:
    clear, found = rows["odometry_rgbd", "none"], rows["odometry_rgbd", level]
    assert found["tracked"] < clear["tracked"] - 0.1 and found["coverage"] < clear["coverage"] - 0.1


def test_darkness_costs_lidar_nothing(rows: dict[tuple[str, str], dict[str, Any]]) -> None:
    clear, smoky, dark = (rows["kiss_icp", level] for level in LEVELS)
    assert clear["tracked"] == 1 and clear["ate_se3"] < 0.1 and smoky["tracked"] == 1
    assert {k: v for k, v in dark.items() if k != "seconds"} == {k: v for k, v in clear.items() if k != "seconds"}
    out: Path = rows["folder", ""]["path"]
    scans = [case_of(out, "house", level) / "sequence" / "scans" / "000012.bin" for level in LEVELS]
    assert scans[0].read_bytes() == scans[2].read_bytes() != scans[1].read_bytes()
    assert np.fromfile(scans[0], np.float32).reshape(-1, 5).shape[0] > 20_000


@pytest.mark.slow
def test_smoke_costs_lidar_its_track_as_it_costs_returns(rows: dict[tuple[str, str], dict[str, Any]], tmp_path: Path) -> None:
    """The same tour in smoke of a given visibility; images are small, since no method reads them."""
    shutil.copytree(rows["folder", ""]["path"] / "tours", tmp_path / "out" / "tours")
    for name, visibility in (("hazy", 1.5), ("thick", 0.8)):
        (tmp_path / f"{name}.toml").write_text(f"[weather]\nvisibility = {visibility}\nmedium = 'smoke'\n")
    levels = tuple(str(tmp_path / f"{name}.toml") for name in ("hazy", "thick"))
    request = Request(("kiss_icp",), ("house",), levels, 1, legs=1, duration=4.0, tier="direct", width=16, height=16, rate=5)
    found = {row["level"]: row["measures"] for row in run(request, tmp_path / "out")}
    clear, hazy, thick = rows["kiss_icp", "none"], found["hazy"], found["thick"]
    folders = [case_of(rows["folder", ""]["path"], "house", "none"), *(case_of(tmp_path / "out", "house", v) for v in ("hazy", "thick"))]
    returns = [[file.stat().st_size // 20 for file in sorted((f / "sequence" / "scans").glob("*.bin"))] for f in folders]
    mean = [float(np.mean(counts)) for counts in returns]
    assert mean[1] < 0.4 * mean[0] and mean[2] < 0.05 * mean[0]
    assert hazy["tracked"] == 1 and hazy["rpe"] > 2 * clear["rpe"] and hazy["ate_se3"] > 2 * clear["ate_se3"]
    assert thick["tracked"] == pytest.approx(np.mean(np.array(returns[2]) >= 100)) and thick["tracked"] < 0.5
    assert thick["completeness"] < 0.5
