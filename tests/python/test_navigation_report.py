"""Page of the navigation benchmark: agreement with an independent computation, escaping, missing packages."""

from __future__ import annotations

import csv
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import gloam
import navigation_recompute
import pytest
from gloam.navigation.benchmark import write_report
from navigation_folder import episode, write_episode, write_folder, write_request

DIGITS = {"time": 1, "wall": 1, "cpu": 1}
HOSTILE = '<script>alert("1")</script>&\'$x_{$-->'.replace("/", "∕")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A large folder with its report."""
    for module in ("matplotlib", "jinja2", "pyarrow"):
        pytest.importorskip(module)
    folder = tmp_path_factory.mktemp("nav")
    write_folder(folder, missing=3)
    names = [path.name for path in write_report(folder)]
    assert names == ["results.csv", "cells.csv", "paired_tests.csv", "results.parquet", "table.tex", "report.html"]
    return folder


@pytest.fixture(scope="module")
def computed(report: Path) -> Any:
    """Request, episodes and figures as the independent script has them."""
    return navigation_recompute.cells(report)


class Page(HTMLParser):
    """Numbers of cells by (cell, metric), addresses, and tags."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.figures: dict[tuple[str, str], str] = {}
        self.addresses: list[str] = []
        self.tags: set[str] = set()
        self._cell: tuple[str, str] | None = None
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        self.tags.add(tag)
        self.addresses += [value for name, value in attributes if name in ("href", "src") and value]
        if tag == "td":
            self._cell = (values["data-cell"] or "", values["data-metric"] or "") if "data-cell" in values else None

    def handle_endtag(self, tag: str) -> None:
        if tag == "td":
            self._cell = None

    def handle_data(self, data: str) -> None:
        if self._cell:
            self.figures[self._cell] = self.figures.get(self._cell, "") + data + " "


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
    page = Page((report / "report.html").read_text())
    _, episodes, figures = computed
    seen = 0
    for (cell, metric), text in page.figures.items():
        figure = figures[tuple(cell.split("/"))][metric]
        triple = figure if isinstance(figure, tuple) else (figure,)
        printed = [float(number.replace("−", "-")) for number in re.findall(r"[−\d.]+", text.split("success")[0])]
        half = 0.5 * 10 ** -DIGITS.get(metric, 2) + 1e-9
        assert printed[0] == pytest.approx(triple[0], abs=half), (cell, metric)
        if metric == "success":
            assert printed[1:3] == pytest.approx(list(triple[1:]), abs=half), cell
        seen += 1
    assert seen == 18 * 8 and len(episodes) == 18


def test_pending_episodes_are_listed(report: Path) -> None:
    text = (report / "report.html").read_text()
    assert "3 episodes are pending" in text and "vint, warehouse, major: episode 17, 18, 19" in text


def test_the_page_requests_nothing_and_its_links_exist(report: Path) -> None:
    page = Page((report / "report.html").read_text())
    assert page.tags.isdisjoint({"script", "iframe", "link", "object"})
    links = [address for address in page.addresses if address.startswith("episodes/")]
    assert len(links) == 18 * 4 and all((report / link).is_file() for link in links)
    others = {address.split(":")[0] for address in page.addresses if not address.startswith(("episodes/", "#", "https:"))}
    assert others == {"data", "cells.csv", "paired_tests.csv", "results.csv", "results.parquet", "table.tex"}
    assert [address for address in page.addresses if address.startswith("https")] == ["https://arxiv.org/abs/2504.14135"]
    # Links wait for a click; only these would be requested with the page.
    text = (report / "report.html").read_text()
    assert not re.search(r"url\(|@import|srcset|src=\"(?!data:)", text)


def test_the_same_folder_gives_the_same_files(report: Path) -> None:
    before = {name: (report / name).read_bytes() for name in ("report.html", "cells.csv", "results.parquet", "table.tex")}
    write_report(report)
    assert {name: (report / name).read_bytes() for name in before} == before


def test_parquet_has_every_episode(report: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    rows = parquet.read_table(report / "results.parquet").to_pylist()
    assert len(rows) == 360 and sum(row["status"] == "pending" for row in rows) == 3
    with open(report / "results.csv", newline="") as file:
        for row, text in zip(rows, csv.DictReader(file), strict=True):
            assert row["planner"] == text["planner"] and str(row["sc"] if row["sc"] is not None else "") == text["sc"]


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    for module in ("matplotlib", "jinja2", "pyarrow"):
        pytest.importorskip(module)
    names = {"planners": [HOSTILE, "_b"], "scenes": [HOSTILE], "levels": ["_none", "$"]}
    write_request(tmp_path, **names, episodes=2, machine=HOSTILE, version=HOSTILE)
    for planner in (HOSTILE, "_b"):
        values = episode(planner, HOSTILE, "_none", 0, collisions=2, collisions_by_object={HOSTILE: 1, "$\\frac{": 1})
        write_episode(tmp_path, values, video=HOSTILE, message=HOSTILE, outcome="error", success=False)
    write_report(tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "<script" not in text.lower() and "&lt;script&gt;" in text
    assert Page(text).tags.isdisjoint({"script", "iframe"})


def test_a_folder_without_an_episode_has_a_page(tmp_path: Path) -> None:
    for module in ("matplotlib", "jinja2", "pyarrow"):
        pytest.importorskip(module)
    write_request(tmp_path, planners=["a"], scenes=["b"], levels=["c"], episodes=1)
    write_report(tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "1 episode is pending" in text and "a, b, c: all 1" in text and "No robot collided" in text


@pytest.mark.parametrize(("module", "package"), [
    ("matplotlib", "matplotlib==3.11.2"), ("jinja2", "Jinja2==3.1.6"), ("pyarrow", "pyarrow==26.0.1"),
])  # fmt: skip
def test_a_missing_package_is_named_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, package: str
) -> None:
    for name in ("matplotlib", "jinja2", "pyarrow"):
        if name != module:
            pytest.importorskip(name)
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
