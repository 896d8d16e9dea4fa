"""The claims of the navigation benchmark, at small n: cameras suffer from darkness and smoke, a LiDAR not from darkness."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gloam
import pytest
from gloam.navigation.benchmark.episode import EpisodeSpec, run_episode
from gloam.navigation.benchmark.places import Course

pytest.importorskip("openvino")  # of the walking policy


@pytest.fixture(scope="module")
def course() -> Course:
    return Course("house")


def episode(course: Course, folder: Path, planner: str, level: str, number: int = 1) -> dict[str, Any]:
    spec = EpisodeSpec(planner, "house", level, number, log=False)
    return run_episode(spec, course.pair(spec.pair_seed), folder / planner / level / str(number), folder / "maps")


def test_darkness_does_not_change_an_episode_of_the_lidar(course: Course, tmp_path: Path) -> None:
    lit, dark = (episode(course, tmp_path, "lidar", level) for level in ("none", "dark"))
    assert lit["outcome"] == "success" and lit["hash"] == dark["hash"]


def test_a_camera_sees_nothing_in_darkness(course: Course) -> None:
    from gloam.navigation.benchmark.places import CAMERA, world_of

    with gloam.Simulation(world_of("house", "dark")) as sim:
        assert sim.cameras[CAMERA].render(("rgb",), width=85, height=64, tier="interactive").rgb.max() <= 1


def test_smoke_and_clutter_stop_the_own_policy(course: Course, tmp_path: Path) -> None:
    """The paper's claim for planners with cameras: success and SC fall with adversity. Start and goal are the same."""
    clear, major = (episode(course, tmp_path, "gloam", level) for level in ("none", "major"))
    assert clear["outcome"] == "success" and clear["collisions"] == 0  # SC 1
    assert major["outcome"] != "success"
