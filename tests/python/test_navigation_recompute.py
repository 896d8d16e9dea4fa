"""The figures of a benchmark agree with its logs, which a program without gloam.navigation measures again."""

from __future__ import annotations

import json
from pathlib import Path

import navigation_page
import navigation_recompute
import pytest
from gloam.navigation.benchmark import write_report
from gloam.navigation.benchmark.runner import Request, run
from navigation_replay import measured


def changed(file: Path, **values: object) -> None:
    """Falsifies an episode.json."""
    file.write_text(json.dumps(json.loads(file.read_text()) | values))


@pytest.mark.slow
def test_a_benchmark_agrees_with_its_logs(tmp_path: Path) -> None:
    run(Request(("straight", "route"), ("house",), ("none", "major"), 2), tmp_path, workers=2)
    computed = navigation_recompute.cells(tmp_path, measured)  # does not change with the falsified values below

    def problems() -> list[str]:
        write_report(tmp_path)
        page = (tmp_path / "report.html").read_text()
        return navigation_recompute.differences(tmp_path, computed) + navigation_page.differences(page, computed[2])

    assert problems() == []
    file = tmp_path / "episodes" / "route" / "house" / "none" / "0001" / "episode.json"
    collisions = json.loads(file.read_text())["collisions"]
    changed(file, collisions=collisions + 1)
    found = "\n".join(problems())
    assert "collisions:" in found and "sc:" in found and "the page has" in found
    changed(file, collisions=collisions, path_length=99.0)
    assert "spl:" in "\n".join(problems())
    changed(file, path_length=99.0, outcome="fell", success=False)
    assert "success:" in "\n".join(problems())
