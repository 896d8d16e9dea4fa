"""Where runs lose their track: distance along the true path and extinction, and the paper's mine on the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from gloam.slam import paper
from gloam.slam.losses import Losses, find_losses

STATES = ["initializing", "tracked", "tracked", "lost", "lost", "tracked", "initializing", "tracked", "lost"]


@pytest.fixture
def run(tmp_path: Path) -> tuple[Path, dict[str, Any]]:
    """Nine frames at 2 Hz: 1 m per frame along x, then after the fourth along y; smoke from the third second on."""
    case, folder = tmp_path / "cases/mine/none", tmp_path / "runs/m/mine/none/0000"
    case.mkdir(parents=True)
    folder.mkdir(parents=True)
    places = [(min(k, 4), max(0, k - 4)) for k in range(9)]
    (case / "truth.tum").write_text("".join(f"{1 + k / 2} {x} {y} 0 0 0 0 1\n" for k, (x, y) in enumerate(places)))
    (case / "visibility.csv").write_text("time_s,visibility_m,extinction_1_m\n1,4000,0.001\n3,4,1\n5,2,2\n")
    (folder / "frames.csv").write_text("time,state,seconds\n" + "".join(f"{1 + k / 2},{s},0.1\n" for k, s in enumerate(STATES)))
    (folder / "poses.tum").write_text("")
    return tmp_path, {"method": "m", "scene": "mine", "level": "none", "number": 0}


def test_losses_are_the_first_lost_frames_after_tracked_ones(run: tuple[Path, dict[str, Any]]) -> None:
    found = find_losses(*run)
    assert found.tracks and [loss.distance for loss in found.places] == pytest.approx([3, 8])
    assert [loss.extinction for loss in found.places] == pytest.approx([0.001 + 0.999 * 0.75, 2])


def test_a_run_without_a_track_has_no_losses(run: tuple[Path, dict[str, Any]]) -> None:
    out, row = run
    (out / "runs/m/mine/none/0000/frames.csv").write_text("time,state,seconds\n1,initializing,0.1\n1.5,lost,0.1\n")
    assert find_losses(out, row) == Losses((), False)
    (out / "runs/m/mine/none/0000/frames.csv").unlink()
    assert find_losses(out, row) == Losses((), False)


def test_the_papers_mine_is_as_printed() -> None:
    printed = [(method, f"{100 * clear:.3g}", f"{100 * smoky:.3g}") for method, clear, smoky in paper.TUNNEL]
    assert printed == [("ORB-SLAM2 mono", "7.83", "0"), ("ORB-SLAM3 mono", "59.6", "38.5"), ("MASt3R-SLAM", "100", "43.6")]
