"""Page of the navigation benchmark: agreement with an independent computation, escaping, missing packages."""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import gloam
import navigation_page
import navigation_recompute
import pytest
from gloam.navigation.benchmark import write_report
from navigation_folder import episode, write_episode, write_folder, write_request

HOSTILE = '<script>alert("1")</script>&\'$x_{$-->'.replace("/", "∕")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A large folder with its report."""
    folder = tmp_path_factory.mktemp("nav")
    write_folder(folder, missing=3)
    names = [path.name for path in write_report(folder)]
    assert names == ["results.csv", "cells.csv", "paired_tests.csv", "results.parquet", "table.tex", "report.html"]
    return folder


@pytest.fixture(scope="module")
def computed(report: Path) -> Any:
    """Request, episodes and figures as the independent script has them."""
    return navigation_recompute.cells(report)


def test_an_independent_computation_agrees(report: Path, computed: Any) -> None:
    assert navigation_recompute.differences(report, computed) == []


@pytest.mark.parametrize("column", ["success", "sc_low", "spl", "time", "late", "cpu", "finished"])
def test_a_wrong_figure_is_noticed(report: Path, computed: Any, tmp_path: Path, column: str) -> None:
    for name in ("request.json", "episodes", "paired_tests.csv"):
        (tmp_path / name).symlink_to(report / name)
    with open(report / "cells.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    rows[4][column] = str(float(rows[4][column]) * 1.2 + 0.1)
    with open(tmp_path / "cells.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    assert len(navigation_recompute.differences(tmp_path, computed)) == 1


def test_a_wrong_p_value_is_noticed(report: Path, computed: Any, tmp_path: Path) -> None:
    (tmp_path / "cells.csv").symlink_to(report / "cells.csv")
    text = (report / "paired_tests.csv").read_text()
    line = next(line for line in text.splitlines() if line.startswith("levels,house,route,none,major"))
    values = line.split(",")
    values[9] = str(float(values[9]) + 0.02)
    (tmp_path / "paired_tests.csv").write_text(text.replace(line, ",".join(values)))
    assert text.splitlines()[0].split(",")[9] == "success_p"
    assert "success_p" in "".join(navigation_recompute.differences(tmp_path, computed))


def test_the_page_prints_the_recomputed_figures(report: Path, computed: Any) -> None:
    text = (report / "report.html").read_text()
    assert navigation_page.differences(text, computed[2]) == []
    assert len(navigation_page.Page(text).figures) == 18 * 8


@pytest.mark.parametrize("metric", ["success", "collisions", "time", "wall"])
def test_a_wrong_figure_of_the_page_is_noticed(report: Path, computed: Any, metric: str) -> None:
    text = (report / "report.html").read_text()
    found = re.search(rf'data-cell="gnm/house/major" data-metric="{metric}"><b>([\d.]+)', text)
    assert found
    changed = text[: found.start(1)] + f"{float(found[1]) + 0.2:.2f}" + text[found.end(1) :]
    (wrong,) = navigation_page.differences(changed, computed[2])
    assert metric in wrong and "gnm" in wrong


def test_pending_episodes_are_listed(report: Path) -> None:
    text = (report / "report.html").read_text()
    assert "3 episodes are pending" in text and "vint, warehouse, major: episodes 17–19" in text


def test_the_page_requests_nothing_and_its_links_exist(report: Path) -> None:
    page = navigation_page.Page((report / "report.html").read_text())
    assert page.tags.isdisjoint({"script", "iframe", "link", "object"})
    links = [address for address in page.addresses if address.startswith("episodes/")]
    assert len(links) == 18 * 2 and all((report / link).is_file() for link in links)
    others = {address.split(":")[0] for address in page.addresses if not address.startswith(("episodes/", "#", "https:"))}
    assert others == {"data", "cells.csv", "paired_tests.csv", "results.csv", "results.parquet", "table.tex"}
    assert [address for address in page.addresses if address.startswith("https")] == ["https://arxiv.org/abs/2504.14135"]
    # Links wait for a click; only these would be requested with the page.
    text = (report / "report.html").read_text()
    assert not re.search(r"url\(|@import|srcset|src=\"(?!data:)", text)


def test_videos_have_addresses_in_the_folder(tmp_path: Path) -> None:
    name = "a planner #1"  # its address must be quoted
    write_request(tmp_path, planners=[name], scenes=["b"], levels=["c"], episodes=3)
    for number, collisions in enumerate((0, 4, 9)):
        home = write_episode(tmp_path, episode(name, "b", "c", number, collisions=collisions)).parent
        (home / "video.mp4").touch()
        (home / "poster.jpg").touch()
    write_report(tmp_path)
    page = navigation_page.Page((tmp_path / "report.html").read_text())
    addresses = [unquote(address) for address in page.addresses if address.startswith("episodes/")]
    assert "video" in page.tags and all("#" not in address and " " not in address for address in page.addresses if "mp4" in address)
    expected = [f"episodes/{name}/b/c/{number:04}/{file}" for number in (1, 2) for file in ("poster.jpg", "video.mp4")]
    assert sorted(addresses) == sorted(expected), "of the median and the worst episode"


def test_equal_errors_are_one_entry(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["a", "b"], scenes=["s"], levels=["x", "y"], episodes=4)
    for level in ("x", "y"):
        for number in range(4):
            broken = {"outcome": "error", "success": False, "message": "needs weights"}
            write_episode(tmp_path, episode("a", "s", level, number, **broken))
            write_episode(tmp_path, episode("b", "s", level, number, **(broken if (level, number) in (("x", 0), ("x", 2)) else {})))
    write_report(tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert text.count("needs weights") == 2
    assert "a, 8 episodes: needs weights" in text and "s, x: all 4 episodes; s, y: all 4 episodes" in text
    assert "b, 2 episodes: needs weights" in text and "s, x: episodes 0, 2" in text
    assert "a ended with an error in all its episodes" in text and "b ended" not in text


def test_the_same_folder_gives_the_same_files(report: Path) -> None:
    before = {name: (report / name).read_bytes() for name in ("report.html", "cells.csv", "results.parquet", "table.tex")}
    write_report(report)
    assert {name: (report / name).read_bytes() for name in before} == before


def test_parquet_has_every_episode(report: Path) -> None:
    from pyarrow import parquet

    rows = parquet.read_table(report / "results.parquet").to_pylist()
    assert len(rows) == 360 and sum(row["status"] == "pending" for row in rows) == 3
    with open(report / "results.csv", newline="") as file:
        for row, text in zip(rows, csv.DictReader(file), strict=True):
            assert row["planner"] == text["planner"] and str(row["sc"] if row["sc"] is not None else "") == text["sc"]


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    names = {"planners": [HOSTILE, "_b"], "scenes": [HOSTILE], "levels": ["_none", "$"]}
    write_request(tmp_path, **names, episodes=2, machine=HOSTILE, version=HOSTILE)
    for planner in (HOSTILE, "_b"):
        values = episode(planner, HOSTILE, "_none", 0, collisions=2, collisions_by_object={HOSTILE: 1, "$\\frac{": 1})
        write_episode(tmp_path, values, video=HOSTILE, message=HOSTILE, outcome="error", success=False)
    write_report(tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "<script" not in text.lower() and "&lt;script&gt;" in text
    assert navigation_page.Page(text).tags.isdisjoint({"script", "iframe"})


def test_a_folder_without_an_episode_has_a_page(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["a"], scenes=["b"], levels=["c"], episodes=1)
    write_report(tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "1 episode is pending" in text and "a, b, c: the only episode" in text and "No collision was counted" in text


@pytest.mark.parametrize(("module", "package"), [("matplotlib", "matplotlib"), ("jinja2", "Jinja2"), ("pyarrow", "pyarrow")])
def test_a_missing_package_is_named_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, package: str
) -> None:
    write_request(tmp_path)
    for name in [name for name in sys.modules if name == module or name.startswith(module + ".")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(gloam.UnsupportedError, match=re.escape(f"pip install {package}")):
        write_report(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["request.json"]


def test_the_command_line(report: Path, tmp_path: Path) -> None:
    import subprocess

    command = [sys.executable, "-W", "error::RuntimeWarning", "-m", "gloam.navigation.benchmark.report"]
    good = subprocess.run([*command, str(report)], capture_output=True, text=True)
    assert good.returncode == 0 and str(report / "report.html") in good.stdout and good.stderr == ""
    bad = subprocess.run([*command, str(tmp_path)], capture_output=True, text=True)
    assert bad.returncode == 1 and "request.json" in bad.stderr and "Traceback" not in bad.stderr
