"""Parts that the experiments share: folders that appear when they are complete, locks, requests, tables and pages."""

from __future__ import annotations

import json
from pathlib import Path

import gloam
import pytest
from gloam.experiments.files import locked, remove_parts, whole
from gloam.experiments.page import beside_paper, render_page
from gloam.experiments.request import REQUEST_FILE, check_known, check_once, is_folder_name, keep_request
from gloam.experiments.statistics import Estimate
from gloam.experiments.tables import estimate_columns, write_csv, write_parquet
from gloam.experiments.words import Remaining


def test_a_folder_gets_its_name_when_it_is_complete(tmp_path: Path) -> None:
    folder = tmp_path / "runs" / "0001"
    with pytest.raises(ZeroDivisionError), whole(folder) as part:
        (part / "half").touch()
        raise ZeroDivisionError
    assert list(folder.parent.iterdir()) == [], "neither the folder nor its part"
    with whole(folder) as part:
        (part / "result").write_text("1")
        assert not folder.exists() and part.parent == folder.parent
    assert [path.name for path in folder.parent.iterdir()] == ["0001"] and (folder / "result").read_text() == "1"
    with whole(folder) as part:  # of a slower process
        (part / "result").write_text("2")
    assert (folder / "result").read_text() == "1" and len(list(folder.parent.iterdir())) == 1


def test_remains_of_killed_processes_are_removed(tmp_path: Path) -> None:
    for name in ("runs/a/.0001.abc", "runs/a/0002", "maps/.x", ".lock"):
        (tmp_path / name).mkdir(parents=True)
    remove_parts(tmp_path, "runs/*")
    assert sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*")) == [".lock", "maps", "maps/.x", "runs", "runs/a", "runs/a/0002"]


def test_one_process_at_a_time_uses_a_folder(tmp_path: Path) -> None:
    with locked(tmp_path / "new"):
        with pytest.raises(gloam.UsageError, match="in use"), locked(tmp_path / "new"):
            pytest.fail("the lock is held twice")
    with locked(tmp_path / "new"):
        pass
    (tmp_path / "file").touch()
    with pytest.raises(gloam.IoError, match="cannot write into the folder"), locked(tmp_path / "file"):
        pytest.fail("a file was locked as a folder")


def test_requests_are_checked_and_kept(tmp_path: Path) -> None:
    check_known("scene", ("a",), ("a", "b"))
    with pytest.raises(gloam.NotFoundError, match="there is no scene 'c'; there are: a, b"):
        check_known("scene", ("a", "c"), ("a", "b"))
    for names in ((), ("a", "a")):
        with pytest.raises(gloam.UsageError, match="name each scene once"):
            check_once("scene", names)
    assert [is_folder_name(name) for name in ("a.b", "_x", "+1", "..", "a/b", ".a", "", None, "ä")] == [True] * 3 + [False] * 5 + [True]
    keep_request(tmp_path, {"seed": 1}, [], "")
    kept = json.loads((tmp_path / REQUEST_FILE).read_text())
    assert kept["seed"] == 1 and kept["version"] == gloam.__version__ and len(kept["started"]) == 10 and kept["machine"]
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(seed 1 and 2, rate differ\)"):
        keep_request(tmp_path, {"seed": 2}, ["seed 1 and 2", "rate"], "")
    keep_request(tmp_path, {"seed": 1}, [], "2020-01-01")
    assert json.loads((tmp_path / REQUEST_FILE).read_text())["started"] == "2020-01-01"


def test_tables_have_types_that_do_not_depend_on_the_values(tmp_path: Path) -> None:
    from pyarrow import parquet

    rows = [{"name": "a", "count": 1, **estimate_columns("ate", Estimate(0.5, None, None, 1))}, {"name": "b", "count": None, "ate": None}]
    write_parquet(tmp_path / "a.parquet", rows, ("name",), ("count",))
    schema = parquet.read_schema(tmp_path / "a.parquet")
    assert [str(kind) for kind in schema.types] == ["string", "int64", "double", "double", "double"]
    assert parquet.read_table(tmp_path / "a.parquet").to_pylist()[1] == {"name": "b", "count": None, "ate": None, "ate_low": None, "ate_high": None}
    assert write_csv(tmp_path / "a.csv", rows).read_text() == "name,count,ate,ate_low,ate_high\na,1,0.5,,\nb,,,,\n"
    write_parquet(tmp_path / "none.parquet", [], (), ())
    assert parquet.read_table(tmp_path / "none.parquet").num_rows == 0


def test_pages_share_their_style_and_escape_names(tmp_path: Path) -> None:
    template = tmp_path / "mine.html"
    template.write_text(
        '{% extends "page.html" %}{% from "macros.html" import estimate %}'
        "{% block heading %}{{ name }}{% endblock %}{% block body %}{{ estimate(name, 'ate', e) }}{{ 2 | counted('run') }}{% endblock %}"
    )
    request = {"started": "now", "version": "1", "seed": 2, "machine": "<b>"}
    page = render_page(template, {"request": request, "name": "<script>", "e": Estimate(0.25, 0.2, 0.3, 4)})
    assert page.startswith("<!doctype html>") and "default-src 'none'" in page and "<script" not in page and "&lt;b&gt;" in page
    assert 'data-cell="&lt;script&gt;" data-metric="ate"><b>0.25</b> <i>[0.20,\u00a00.30]</i></td>' in page and "2 runs" in page
    with pytest.raises(Exception, match="'request' is undefined"):
        render_page(template, {"name": "a", "e": Estimate(None, None, None, 0)})


def test_cells_stand_beside_the_papers_rows() -> None:
    cells = [("a", "none"), ("b", "none"), ("a", "none")]
    table = beside_paper(cells, lambda cell: cell, lambda scene, level: [f"{scene} of the paper"] if scene == "a" else [])
    assert table == [("a", "none", ["a of the paper"], [cells[0], cells[2]])]


def test_the_time_left_is_unknown_before_the_first_part(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    remaining = Remaining(4)
    assert remaining.after(0) == ""
    now[0] += 60
    assert remaining.after(1) == ", 3 min left" and remaining.after(4) == ", 0.0 s left"
