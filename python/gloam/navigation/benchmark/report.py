"""Page and tables of a navigation benchmark: `python -m gloam.navigation.benchmark.report FOLDER`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from gloam.errors import Error
from gloam.experiments.charts import image
from gloam.experiments.page import PAGE, beside_paper, render_page, require_report_packages, write_report_files
from gloam.experiments.statistics import Estimate, wilson
from gloam.experiments.tables import write_csv
from gloam.experiments.videos import POSTER, VIDEO

from . import charts, paper, tables, words
from .findings import findings
from .results import Episode, Results, load_results
from .routes import route_charts
from .summary import CellSummary, Summary, summarize
from .tiers import tier_rows


def write_report(folder: str | Path) -> list[Path]:
    """Writes report.html, results.csv, cells.csv, paired_tests.csv, results.parquet and table.tex into the folder.

    Returns their paths. A file is replaced only when its new content is complete. Errors: as `load_results`;
    gloam.UnsupportedError if matplotlib, jinja2 or pyarrow is missing (nothing is written then); gloam.IoError if the
    folder cannot be written.
    """
    folder = Path(folder)
    require_report_packages()
    results = load_results(folder)
    summary = summarize(results)
    rows = tables.episode_rows(results)
    writers: dict[str, Callable[[Path], Any]] = {
        "results.csv": lambda path: write_csv(path, rows),
        "cells.csv": lambda path: write_csv(path, tables.cell_rows(summary)),
        "paired_tests.csv": lambda path: write_csv(path, tables.test_rows(summary.tests)),
        "results.parquet": lambda path: tables.write_episodes(path, rows),
        "table.tex": lambda path: tables.write_latex(path, results, summary),
        PAGE: lambda path: path.write_text(page_of(results, summary), encoding="utf-8"),
    }
    return write_report_files(folder, writers)


def page_of(results: Results, summary: Summary) -> str:
    """The page as HTML without external requests."""
    examples = [(cell, _examples(results, cell)) for cell in summary.cells]
    values: dict[str, Any] = {
        "request": results.request,
        "results": results,
        "cells": summary.cells,
        "tests": summary.tests,
        "words": words,
        "findings": findings(results, summary),
        "charts": {
            "sc": image(charts.sc_by_level(results.request, summary)),
            "outcomes": image(charts.outcome_bars(results.request, summary)),
            "collisions": image(charts.collision_bars(results.request, summary)),
        },
        "routes": {scene: image(svg) for scene, svg in route_charts(results).items()},
        "tiers": tier_rows(results.folder),
        "errors": _errors(summary),
        "few": [cell for cell in summary.cells if 0 < cell.finished < 10],
        "total_wall": sum(e.wall_seconds for e in results.episodes),
        "total_cpu": sum(e.cpu_seconds for e in results.episodes),
        "examples": examples,
        "has_videos": any(example.video for _, there in examples for example in there),
        "comparison": beside_paper(summary.cells, lambda cell: (cell.scene, cell.level), paper.paper_rows),
        "paper": paper,
        "paper_success": _paper_success,
    }
    return render_page(Path(__file__).with_name("report.html"), values)


def _errors(summary: Summary) -> list[tuple[str, str, int, list[str]]]:
    """(planner, message, number of episodes, "scene, level: episodes" of each cell): equal messages in one entry."""
    groups: dict[tuple[str, str], list[tuple[CellSummary, list[int]]]] = {}
    for cell in summary.cells:
        for message in dict.fromkeys(e.message for e in cell.errors):
            numbers = [e.key.episode for e in cell.errors if e.message == message]
            groups.setdefault((cell.planner, message), []).append((cell, numbers))
    return [
        (planner, message or "no message", sum(len(numbers) for _, numbers in there),
         [f"{cell.scene}, {cell.level}: {words.episodes(numbers, cell.requested)}" for cell, numbers in there])
        for (planner, message), there in groups.items()
    ]  # fmt: skip


@dataclass(frozen=True)
class _Example:
    """The median or the worst episode of a cell, with the addresses of its files; "" = there is none."""

    episode: Episode
    video: str
    poster: str
    log: str


def _examples(results: Results, cell: CellSummary) -> list[_Example]:
    """The median episode and the worst one, if it is another."""
    chosen = [e for e in (cell.median, cell.worst) if e is not None]
    if len(chosen) == 2 and chosen[0] is chosen[1]:
        chosen.pop()
    return [_Example(e, *(_address(results, e, file) for file in (VIDEO, POSTER, e.log))) for e in chosen]


def _address(results: Results, episode: Episode, file: str | None) -> str:
    path = f"{episode.key.folder}/{file}"
    return quote(path) if file and (results.folder / path).is_file() else ""


def _paper_success(row: paper.PaperRow) -> Estimate:
    return wilson(row.successes, paper.RUNS)


def main() -> int:
    """Command line. Exit status: 0 = written, 1 = error on stderr."""
    parser = argparse.ArgumentParser(
        prog="python -m gloam.navigation.benchmark.report",
        description="Writes the report of a navigation benchmark into its folder.",
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="output folder of gloam bench nav")
    try:
        for path in write_report(parser.parse_args().folder):
            print(path)
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
