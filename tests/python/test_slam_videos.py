"""Videos of the SLAM benchmark: which runs have one, features, the state of tracking, both paths, and resumption."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.experiments.files import locked
from gloam.experiments.videos import POSTER, VIDEO, median_and_worst
from gloam.navigation.grid import Grid
from gloam.slam.adapters.contract import INITIALIZING, LOST, TRACKED, Output
from gloam.slam.estimate import Frame, Trajectory, read_features
from gloam.slam.measures import returns
from gloam.slam.report import write_report
from gloam.slam.results import Key, chosen_rows
from gloam.slam.run_view import NO_STATE, RELOCALISED, RunView, Shown, states_at
from gloam.slam.summary import MEASURES
from gloam.slam.videos import render_videos
from PIL import Image
from slam_sequences import slide

GREEN, ORANGE, BLUE, GREY, YELLOW, INK = (0, 158, 115), (213, 94, 0), (0, 114, 178), (150, 156, 166), (255, 214, 10), (34, 34, 34)


def row(number: int, completeness: float, ate: float | None = 0.1) -> dict[str, Any]:
    measures = dict.fromkeys(MEASURES) | {"ate_sim3": ate, "completeness": completeness, "tracked": 1.0, "frames": 40}
    key = {"method": "noisy_truth", "scene": "a", "level": "none", "number": number}
    return {**key, "state": "ok", "message": "", "wall": 1.0, "measures": measures}


def test_the_median_and_the_worst_run_are_chosen() -> None:
    rows = [row(0, 0.5), row(1, 1.0, 0.3), row(2, 1.0, 0.1), row(3, 0.0, None)]
    assert [r["number"] for r in chosen_rows(rows)] == [1, 3], "of an even number, the better one in the middle"
    assert [r["number"] for r in chosen_rows([row(0, 0.5), row(1, 0.5)])] == [0], "equal runs need one video"
    assert chosen_rows([]) == [] and median_and_worst([], len) is None


def test_states_have_returns_and_gaps() -> None:
    states = [INITIALIZING, TRACKED, LOST, TRACKED, TRACKED, INITIALIZING, TRACKED]
    assert returns(states) == [3, 6] and returns([INITIALIZING] * 3) == [] and returns([LOST, TRACKED]) == [1]
    frames = tuple(Frame(float(k), state, 0.0) for k, state in enumerate(states))
    expected = [INITIALIZING, TRACKED, LOST, RELOCALISED, TRACKED, INITIALIZING, RELOCALISED, NO_STATE]
    assert states_at(np.arange(8.0), frames, 0.5) == expected
    assert states_at(np.arange(2.0), (), 0.5) == [NO_STATE] * 2


def shown(folder: Path, **changes: Any) -> Shown:
    """Ten frames of 160 x 120 grey pixels along x from 0 to 9 m; tracked from the third on, lost at the sixth."""
    Image.new("L", (160, 120), 128).save(folder / "a.png")
    times = 1 + np.arange(10) / 5
    states = [INITIALIZING] * 2 + [TRACKED] * 3 + [LOST] + [TRACKED] * 4
    poses = np.array([[k, 0, 0.3, 1, 0, 0, 0] for k in range(10)], np.float64)
    values: dict[str, Any] = {
        "title": "a run", "times": times, "files": (folder / "a.png",) * 10,
        "frames": tuple(Frame(float(t), s, 0.1) for t, s in zip(times, states, strict=True)),
        "features": {float(times[3]): np.array([[40.0, 30.0], [100.0, 90.0]])}, "truth": Trajectory(times, poses),
        "estimate_times": times[[2, 3, 4, 8, 9]], "estimate": np.array([[2, 1], [3, 1], [4, 1], [8, 1], [9, 1.0]]),
        "extinction": np.array([[0.0, 0.5], [10.0, 0.5]]), "plan": None,
    }  # fmt: skip
    return Shown(**values | changes)


def test_an_image_shows_features_state_and_paths(tmp_path: Path) -> None:
    images = list(RunView(shown(tmp_path)).images(1))
    assert len(images) == 10 and all(image.size == (840, 420) for image in images)
    # The camera's image of 160 x 120 fills the panel of 480 x 360 below a title of 26 pixels, so a pixel is 3 x 3.
    around = np.array(images[3].crop((120 - 4, 26 + 90 - 4, 120 + 8, 26 + 90 + 8))).reshape(-1, 3)
    assert (around == YELLOW).all(1).any() and not (np.array(images[4].crop((0, 60, 480, 386))).reshape(-1, 3) == YELLOW).all(1).any()
    # The state is in the corner, and in the band below: past in full colours, future pale.
    assert [images[k].getpixel((2, 28)) for k in (0, 3, 5, 6)] == [GREY, GREEN, ORANGE, BLUE]
    band = [images[5].getpixel((84 * k + 20, 410)) for k in range(10)]
    assert band[:6] == [GREY, GREY, GREEN, GREEN, GREEN, ORANGE] and band[6] not in (BLUE, GREEN) and min(band[6]) > 150
    # Paths on the map: 11 x 3 m in 360 x 360 pixels around (4.5, 0.5).
    scale = 360 / 11

    def place(x: float, y: float) -> tuple[int, int]:
        return round(480 + 180 + scale * (x - 4.5)), round(26 + 180 - scale * (y - 0.5))

    early, late = images[3], images[9]
    white = (255, 255, 255)
    assert early.getpixel(place(2.5, 1)) == BLUE and early.getpixel(place(8.5, 1)) == white and late.getpixel(place(8.5, 1)) == BLUE
    assert late.getpixel(place(6, 1)) == white, "no line where the method has no poses"
    assert early.getpixel(place(3, 0)) == INK and late.getpixel(place(9, 0)) == INK and late.getpixel(place(3, 0)) == (120, 126, 136)


def test_scans_and_runs_without_poses_are_shown(tmp_path: Path) -> None:
    # Half of the panel's height is 12 m, as far as most points.
    scan = np.array([[6, 0, 0, 1, 0], [0, -6, 0, 1, 0], [99, 0, 0, 1, 0], *([[-12, 0, 0, 1, 0]] * 60)], np.float32)
    scan.tofile(tmp_path / "s.bin")
    np.zeros((0, 5), np.float32).tofile(tmp_path / "none.bin")
    files = (tmp_path / "s.bin",) * 9 + (tmp_path / "none.bin",)
    blocked = np.zeros((20, 60), bool)
    blocked[0:4] = True
    plan = Grid((-1.0, -1.0), 0.2, blocked)
    empty = {"estimate_times": np.zeros(0), "estimate": np.zeros((0, 2)), "frames": (), "features": {}}
    images = list(RunView(shown(tmp_path, files=files, plan=plan, **empty)).images(3))
    assert len(images) == 4
    forward, right = images[0].getpixel((240, 26 + 90)), images[0].getpixel((240 + 90, 26 + 180))
    assert forward == right != INK and images[0].getpixel((240 - 90, 26 + 180)) == INK and images[3].getpixel((240, 26 + 90)) == INK
    assert images[0].getpixel((10, 410)) == images[0].getpixel((2, 28)) == (228, 231, 235), "no state"


def test_features_are_written_and_checked(tmp_path: Path) -> None:
    with Output(tmp_path) as output:
        output.frame(1.0, TRACKED, np.eye(4), np.array([[1.25, 2.0], [3.0, 4.0]]))
        output.frame(2.0, LOST, None, np.zeros((0, 2)))
    assert {t: f.tolist() for t, f in read_features(tmp_path).items()} == {1.0: [[1.2, 2.0], [3.0, 4.0]], 2.0: []}
    with Output(tmp_path / "..") as output:
        output.frame(1.0, TRACKED, np.eye(4))
    assert read_features(tmp_path / "..") == {}, "a method need not know its features"
    for text, words in (("1.0 2.0", "pairs"), ("1 2 x", "expected numbers"), ("1 nan 2", "finite")):
        (tmp_path / "features.txt").write_text(f"0.5\n{text}\n")
        with pytest.raises(gloam.InputError, match=words) as error:
            read_features(tmp_path)
        assert "features.txt:2" in str(error.value)


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A benchmark of three runs on an artificial sequence: complete, half, and crashed."""
    out = tmp_path_factory.mktemp("slam")
    case = out / "cases" / "a" / "none"
    slide(case)
    (case / "visibility.csv").write_text("time_s,visibility_m,extinction_1_m\n1.0,39.12,0.1\n3.0,39.12,0.1\n")
    request = {"methods": ["noisy_truth"], "scenes": ["a"], "levels": ["none"], "runs": 3, "seed": 1, "width": 320, "height": 240}
    request |= {"rate": 20, "tier": "direct"} | dict.fromkeys(("started", "version", "machine", "log"), "")
    (out / "request.json").write_text(json.dumps(request))
    truth = (case / "truth.tum").read_text().splitlines()
    for number, count in enumerate((40, 20, 0)):
        home = out / "runs" / Key("noisy_truth", "a", "none", number).path
        home.mkdir(parents=True)
        (home / "poses.tum").write_text("".join(f"{line}\n" for line in truth[:count]))
        end = {} if count else {"state": "crashed", "message": "no memory"}
        found = row(number, count / 40, 0.0 if count else None) | end
        (home / "outcome.json").write_text(json.dumps(found))
    return out


def videos(out: Path) -> dict[int, int]:
    found = {int(file.parent.name): file.stat().st_mtime_ns for file in out.glob(f"runs/*/*/*/*/{VIDEO}")}
    assert not list(out.glob("runs/*/*/*/*/.video-*"))
    return found


def test_videos_are_made_once_and_follow_the_results(bench: Path, tmp_path: Path) -> None:
    out, lines = tmp_path / "copy", []
    shutil.copytree(bench, out)
    home = out / "runs" / Key("noisy_truth", "a", "none", 0).path.parent
    (home / "0000" / ".video-killed").mkdir()
    assert render_videos(out, lines.append) == []
    first = videos(out)
    assert set(first) == {1, 2} and lines[0] == "video 1 of 2: noisy_truth/a/none/0001" and lines[1].endswith(" left")
    with Image.open(home / "0001" / POSTER) as poster:
        assert poster.size == (840, 420)
    assert render_videos(out, lines.append) == [] and videos(out) == first and len(lines) == 2
    write_report(out)
    page = (out / "report.html").read_text()
    assert page.count("<video ") == 2 and 'src="runs/noisy_truth/a/none/0002/video.mp4"' in page and "no memory" in page
    # The first run becomes the worst one, and the crashed one the median.
    (home / "0000" / "outcome.json").write_text(json.dumps(row(0, -1.0)))
    (home / "0000" / "features.txt").write_text("1 2\n")
    (problem,) = render_videos(out, lines.append)
    assert problem.startswith("no video of noisy_truth/a/none/0000: ") and "features.txt:1" in problem and set(videos(out)) == {2}
    write_report(out)
    assert (out / "report.html").read_text().count("<video ") == 1
    (home / "0000" / "features.txt").unlink()
    assert render_videos(out, lines.append) == [] and videos(out)[2] == first[2] and set(videos(out)) == {0, 2}


def test_one_process_at_a_time(bench: Path) -> None:
    with locked(bench), pytest.raises(gloam.UsageError, match="in use"):
        render_videos(bench, lambda _: None)
