"""The check of the tier of images: pairs, means and files."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import gloam
import pytest
from gloam.navigation.benchmark.request import Request
from gloam.navigation.benchmark.tiers import ALL, FOLDER, tier_lines, tier_request, tier_rows, write_tiers
from gloam.navigation.plugins import load_plugin

from navigation_folder import episode, write_episode, write_request

PLUGIN = Path(__file__).with_name("navigation_plugin.py")


def write_both(folder: Path, path_episodes: int = 2) -> None:
    """gnm in a house: three episodes, in the path tier the first ones; SC 1, 1/2, 1 against 1, 1."""
    cell = ("gnm", "house", "none")
    for tier, count in (("interactive", 3), ("path", path_episodes)):
        to = folder / (FOLDER if tier == "path" else "")
        write_request(to, planners=["gnm"], scenes=["house"], levels=["none"], episodes=count, tier=tier)
        for number in range(count):
            hits = int(tier == "interactive" and number == 1)
            write_episode(to, episode(*cell, number, tier=tier, collisions=hits))


def test_pairs_of_both_tiers_are_compared(tmp_path: Path) -> None:
    write_both(tmp_path)
    cell, total = tier_rows(tmp_path)
    assert (cell.planner, cell.scene, cell.level, cell.pairs) == ("gnm", "house", "none", 2)
    assert (cell.same_outcome, cell.successes, cell.path_successes) == (2, 2, 2)
    assert cell.sc == pytest.approx(0.75) and cell.path_sc == 1.0 and cell.difference.value == pytest.approx(0.25)
    assert cell.success_p == 1.0 and cell.sc_p == 1.0, "one pair that differs shows nothing"
    assert (total.scene, total.level, total.difference.value) == (ALL, ALL, cell.difference.value)
    write_episode(tmp_path / FOLDER, episode("gnm", "house", "none", 0, outcome="fell", success=False))
    assert tier_rows(tmp_path)[0].same_outcome == 1
    rows = write_tiers(tmp_path)
    table = list(csv.DictReader((tmp_path / "tiers.csv").open()))
    assert float(table[0]["difference"]) == rows[0].difference.value == pytest.approx(-0.25) and len(table) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["episodes", FOLDER, "request.json", "tiers.csv"]
    lines = tier_lines(rows, "interactive")
    assert lines[0].split()[:3] == ["planner", "scene", "level"] and "1 of 2" in lines[1] and "2/1" in lines[1]


def test_without_a_check_or_pairs_there_is_nothing(tmp_path: Path) -> None:
    write_both(tmp_path)
    (tmp_path / FOLDER / "episodes/gnm/house/none/0001/episode.json").unlink()
    (tmp_path / FOLDER / "episodes/gnm/house/none/0000/episode.json").unlink()
    cell = tier_rows(tmp_path)[0]
    assert cell.pairs == 0 and cell.sc is None and cell.difference.value is None and cell.sc_p is None
    assert "0 of 0" in tier_lines([cell], "interactive")[1]
    assert tier_rows(tmp_path / FOLDER) == []


def test_the_page_compares_the_tiers(tmp_path: Path) -> None:
    for module in ("matplotlib", "jinja2", "pyarrow"):
        pytest.importorskip(module)
    from gloam.navigation.benchmark.report import PAGE, write_report

    write_both(tmp_path)
    write_report(tmp_path)
    page = (tmp_path / PAGE).read_text()
    assert 'id="tier"' in page and "<td>gnm</td><td>house</td><td>none</td>" in page and "2 of 2" in page
    shutil.rmtree(tmp_path / FOLDER)
    write_report(tmp_path)
    assert 'id="tier"' not in (tmp_path / PAGE).read_text()


def test_only_planners_with_images_are_checked() -> None:
    load_plugin(str(PLUGIN))
    request = Request(("route", "seeing", "brief"), ("house",), ("none", "major"), 9)
    assert tier_request(request, 3) == Request(("seeing",), ("house",), ("none", "major"), 3, tier="path")
    for wrong, count, message in (
        (request, 10, "1 to 9 episodes, got 10"),
        (request, -1, "1 to 9 episodes"),
        (Request(("route", "brief")), 1, "does not matter to route, brief"),
        (Request(("seeing",), tier="path"), 1, "uses the path tier already"),
    ):
        with pytest.raises(gloam.UsageError, match=message):
            tier_request(wrong, count)
