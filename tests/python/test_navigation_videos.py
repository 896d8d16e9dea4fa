"""Videos of the navigation benchmark: which episodes have one, resumption, failures, and the map beside the camera."""

from __future__ import annotations

import errno
import json
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.navigation.benchmark import load_results, write_report
from gloam.experiments.files import locked
from gloam.navigation.benchmark.floor_plan import plan_of
from gloam.experiments.movie import write_movie
from gloam.navigation.benchmark.route_view import RouteView
from gloam.navigation.benchmark.videos import render_videos
from gloam.navigation.grid import Grid
from navigation_folder import episode, write_episode, write_request
from navigation_scene import arena
from PIL import Image

NAME = ("straight", "arena", "none")


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of a run of 0.6 s."""
    file = tmp_path_factory.mktemp("log") / "run.mcap"
    with gloam.Simulation(arena().compile()) as sim, sim.record(file, ["/clock", "/tf*"]):
        sim.run_until(time=0.6)
    return file


def folder_of(path: Path, log: Path, collisions: list[int]) -> Path:
    """A benchmark of one cell, whose episodes have these collisions."""
    write_request(path, planners=["straight"], scenes=["arena"], levels=["none"], episodes=len(collisions))
    for number, count in enumerate(collisions):
        track = [[0.0, 0.0, float(number)], [0.5, 1.0, float(number)]]
        home = write_episode(path, episode(*NAME, number, collisions=count, log="run.mcap", track=track)).parent
        (home / "run.mcap").hardlink_to(log)
    return path


def videos(folder: Path) -> dict[int, int]:
    """Episodes with a video, and the time of its file."""
    found = {int(path.parent.name): path.stat().st_mtime_ns for path in folder.glob("episodes/*/*/*/*/video.mp4")}
    assert all((folder / "episodes" / Path(*NAME) / f"{number:04}" / "poster.jpg").is_file() for number in found)
    assert not list(folder.glob("episodes/*/*/*/*/.video-*"))
    return found


def test_the_median_and_the_worst_episode_have_a_video(log: Path, tmp_path: Path) -> None:
    folder, lines = folder_of(tmp_path, log, [0, 3, 9]), []
    (folder / "episodes" / Path(*NAME) / "0000" / ".video-killed").mkdir()
    assert render_videos(folder, lines.append) == []
    first = videos(folder)
    assert set(first) == {1, 2} and lines[0] == "video 1 of 2: straight/arena/none/0001" and lines[1].endswith(" left")
    assert render_videos(folder, lines.append) == [] and videos(folder) == first and len(lines) == 2
    write_report(folder)
    assert (folder / "report.html").read_text().count("<video ") == 2
    # Another episode becomes the worst.
    file = folder / "episodes" / Path(*NAME) / "0000" / "episode.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {"collisions": 20}))
    assert render_videos(folder, lines.append) == []
    now = videos(folder)
    assert set(now) == {0, 2} and now[2] == first[2], "the worst one is the median now"


def test_a_damaged_log_leaves_the_others(log: Path, tmp_path: Path) -> None:
    folder = folder_of(tmp_path, log, [0, 3, 9])
    damaged = folder / "episodes" / Path(*NAME) / "0001" / "run.mcap"
    damaged.unlink()
    damaged.write_bytes(b"no log")
    (problem,) = render_videos(folder, lambda _: None)
    assert problem.startswith("no video of straight/arena/none/0001: ") and str(damaged) in problem
    assert set(videos(folder)) == {2}
    write_report(folder)
    assert (folder / "report.html").read_text().count("<video ") == 1


def test_a_full_disk_is_reported(log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("gloam.experiments.videos.write_movie", full)
    folder = folder_of(tmp_path, log, [0])
    (problem,) = render_videos(folder, lambda _: None)
    assert "No space left on device" in problem and videos(folder) == {}


def test_one_process_at_a_time(log: Path, tmp_path: Path) -> None:
    folder = folder_of(tmp_path, log, [0])
    with locked(folder), pytest.raises(gloam.UsageError, match="in use"):
        render_videos(folder, lambda _: None)


def test_a_movie_has_all_images(tmp_path: Path) -> None:
    images = [Image.new("RGB", (64, 48), (20 * k, 0, 0)) for k in range(12)]
    assert write_movie(tmp_path / "m.mp4", images, 8.0) == 12
    data = (tmp_path / "m.mp4").read_bytes()
    box = data.index(b"avc1", data.index(b"stsd"))
    width, height = (int.from_bytes(data[box + k : box + k + 2], "big") for k in (28, 30))
    assert data[4:8] == b"ftyp" and (width, height) == (64, 48)
    assert [path.name for path in tmp_path.iterdir()] == ["m.mp4"]
    with pytest.raises(gloam.InputError, match="contains no messages"):
        write_movie(tmp_path / "none.mp4", [], 8.0)


def test_the_map_shows_route_goal_and_obstacles(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["straight"], scenes=["arena"], levels=["none"], episodes=1)
    track = [[1.0, 0.0, 0.0], [2.0, 2.0, 0.0], [3.0, 4.0, 0.0]]
    write_episode(tmp_path, episode(*NAME, 0, start=[0.0, 0.0, 0.0], goal=[5.6, 0.0], track=track, touches=[[2.5, 2.0, 1.0, "box"]]))
    blocked = np.zeros((41, 101), bool)
    blocked[28:31, 48:53] = True  # x 2.3 … 2.7 m and y 0.8 … 1.0 m
    plan = Grid((-2.5, -2.0), 0.1, blocked)
    # 5.6 m and margins of 1.2 m in 320 px: 40 px/m around (2.8, 0).
    view = RouteView(load_results(tmp_path).episodes[0], plan, (320, 240))

    def color(image: Any, x: float, y: float) -> tuple[int, ...]:
        return tuple(image.getpixel((round(160 + 40 * (x - 2.8)), round(120 - 40 * y))))

    early, late = view.at(2.0), view.at(9.0)
    white, grey, blue = (255, 255, 255), (190, 196, 204), (0, 114, 178)
    assert color(early, 2.5, 0.9) == grey and color(early, 2.5, 1.4) == color(early, 2.5, 0.5) == white
    assert color(early, 1.0, 0.0) == color(early, 2.0, 0.0) == blue and color(early, 3.0, 0.0) == white
    assert color(late, 3.0, 0.0) == color(late, 4.0, 0.0) == blue
    assert color(early, 2.0, 1.0) == white and color(late, 2.0, 1.0) == (213, 94, 0)
    assert color(early, 4.6, 0.0) == (0, 158, 115), "the goal's circle has a radius of 1 m"


def test_plans_are_kept_and_checked(tmp_path: Path) -> None:
    assert plan_of(tmp_path, "arena", "none") is None
    plan = plan_of(tmp_path, "house", "none")
    assert plan is not None and 0.2 < plan.blocked.mean() < 0.8
    file = tmp_path / "plans" / "house" / "none.npz"
    made = file.stat().st_mtime_ns
    again = plan_of(tmp_path, "house", "none")
    assert again is not None and np.array_equal(again.blocked, plan.blocked) and file.stat().st_mtime_ns == made
    file.write_bytes(b"PK")
    with pytest.raises(gloam.InputError, match="floor plan"):
        plan_of(tmp_path, "house", "none")
