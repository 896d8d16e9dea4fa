"""Page and tables of a navigation benchmark: `python -m gloam.navigation.benchmark.report FOLDER`."""

from __future__ import annotations

import argparse
import base64
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from gloam.errors import Error

from . import charts, paper, tables, words
from .files import replace_file
from .findings import findings
from .optional import require
from .results import POSTER, VIDEO, Episode, Results, load_results
from .routes import route_charts
from .statistics import Estimate, wilson
from .summary import CellSummary, Summary, summarize
from .tiers import tier_rows

PAGE = "report.html"


def write_report(folder: str | Path) -> list[Path]:
    """Writes report.html, results.csv, cells.csv, paired_tests.csv, results.parquet and table.tex into the folder.

    Returns their paths. A file is replaced only when its new content is complete. Errors: as `load_results`;
    gloam.UnsupportedError if matplotlib, jinja2 or pyarrow is missing (nothing is written then); gloam.IoError if the
    folder cannot be written.
    """
    folder = Path(folder)
    for module in ("matplotlib.figure", "jinja2", "pyarrow.parquet"):
        require(module)
    results = load_results(folder)
    summary = summarize(results)
    rows = tables.episode_rows(results)
    writers: dict[str, Callable[[Path], Any]] = {
        "results.csv": lambda path: tables.write_csv(path, rows),
        "cells.csv": lambda path: tables.write_csv(path, tables.cell_rows(summary)),
        "paired_tests.csv": lambda path: tables.write_csv(path, tables.test_rows(summary.tests)),
        "results.parquet": lambda path: tables.write_parquet(path, rows),
        "table.tex": lambda path: tables.write_latex(path, results, summary),
        PAGE: lambda path: path.write_text(render_page(results, summary), encoding="utf-8"),
    }
    return [replace_file(folder / name, write) for name, write in writers.items()]


def render_page(results: Results, summary: Summary) -> str:
    """The page as HTML without external requests. All names are escaped."""
    jinja2 = require("jinja2")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {
        "number": words.number,
        "interval": words.interval,
        "percent": words.percent,
        "duration": words.duration,
        "p": words.p_value,
    }
    environment.tests["clear_test"] = words.is_clear
    examples = [(cell, _examples(results, cell)) for cell in summary.cells]
    template = environment.from_string(Path(__file__).with_name("report.html").read_text(encoding="utf-8"))
    text: str = template.render(
        request=results.request,
        results=results,
        cells=summary.cells,
        tests=summary.tests,
        words=words,
        findings=findings(results, summary),
        charts={
            "sc": _image(charts.sc_by_level(results.request, summary)),
            "outcomes": _image(charts.outcome_bars(results.request, summary)),
            "collisions": _image(charts.collision_bars(results.request, summary)),
        },
        routes={scene: _image(svg) for scene, svg in route_charts(results).items()},
        tiers=tier_rows(results.folder),
        errors=_errors(summary),
        few=[cell for cell in summary.cells if 0 < cell.finished < 10],
        total_wall=sum(e.wall_seconds for e in results.episodes),
        total_cpu=sum(e.cpu_seconds for e in results.episodes),
        examples=examples,
        has_videos=any(example.video for _, there in examples for example in there),
        comparison=_comparison(results, summary),
        paper=paper,
        paper_success=_paper_success,
    )
    return text


def _image(svg: str) -> str:
    """A chart as an address for <img>: names of gradients and clips of several charts cannot collide, nothing runs."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode() if svg else ""


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


def _comparison(results: Results, summary: Summary) -> list[tuple[str, str, list[paper.PaperRow], list[CellSummary]]]:
    """(scene, level, rows of the paper, our cells) for each scene and level that the paper has too."""
    pairs = [(scene, level) for scene in results.request.scenes for level in results.request.levels]
    rows = [(s, v, paper.paper_rows(s, v), [c for c in summary.cells if (c.scene, c.level) == (s, v)]) for s, v in pairs]
    return [row for row in rows if row[2]]


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
