"""Extinction from the LiDAR of a SLAM sequence against known extinctions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gloam.slam.lidar_extinction import extinction_of_scans


def write_case(folder: Path, extinctions: list[float], lost: float = 0.0, smoke_at: float = 0.0) -> Path:
    """Scans of a room whose surfaces return exp(-2 extinction range); a share is lost, and with smoke_at > 0 half of the beams end there."""
    (folder / "sequence" / "scans").mkdir(parents=True)
    index = "# scans\n"
    for number, extinction in enumerate(extinctions):
        rng = np.random.default_rng(7)
        azimuth, elevation = np.meshgrid(np.linspace(0, 2 * np.pi, 180, endpoint=False), np.radians(np.arange(-15, 16, 2.0)))
        distance, full = rng.uniform(0.5, 12, azimuth.shape), rng.uniform(20, 200, azimuth.shape)
        intensity = full * np.exp(-2 * extinction * distance)
        if smoke_at > 0:
            near = rng.random(azimuth.shape) < 0.5
            distance, intensity = np.where(near, smoke_at, distance), np.where(near, 90.0, intensity)
        time = np.broadcast_to(np.arange(180) * 1e-4, azimuth.shape)
        cloud = np.stack([distance * np.cos(elevation) * np.cos(azimuth), distance * np.cos(elevation) * np.sin(azimuth),
                          distance * np.sin(elevation), intensity, time], axis=-1).reshape(-1, 5)  # fmt: skip
        cloud = cloud[rng.random(len(cloud)) >= lost]
        cloud.astype(np.float32).tofile(folder / "sequence" / "scans" / f"{number:06d}.bin")
        index += f"{0.1 * (number + 1):.9f} scans/{number:06d}.bin\n"
    (folder / "sequence" / "scans.txt").write_text(index)
    return folder


def test_extinction_is_that_of_the_medium(tmp_path: Path) -> None:
    clear = write_case(tmp_path / "none", [0.0] * 3)
    found = extinction_of_scans(write_case(tmp_path / "smoke", [0.0, 0.2, 1.3]), clear)
    assert found[:, 0] == pytest.approx([0.1, 0.2, 0.3])
    assert found[:, 1] == pytest.approx([0.0, 0.2, 1.3], abs=1e-3)


def test_lost_beams_and_returns_of_smoke_do_not_count(tmp_path: Path) -> None:
    clear = write_case(tmp_path / "none", [0.0], lost=0.3)
    found = extinction_of_scans(write_case(tmp_path / "smoke", [0.5], smoke_at=0.9), clear)
    assert found[0, 1] == pytest.approx(0.5, abs=0.01)


def test_too_few_beams_give_no_extinction(tmp_path: Path) -> None:
    clear = write_case(tmp_path / "none", [0.0])
    assert np.isnan(extinction_of_scans(write_case(tmp_path / "smoke", [0.5], lost=0.999), clear)[0, 1])


def test_a_tour_without_a_lidar_has_no_rows(tmp_path: Path) -> None:
    clear = write_case(tmp_path / "none", [0.0])
    (tmp_path / "dark").mkdir()
    assert extinction_of_scans(tmp_path / "dark", clear).shape == (0, 2)
