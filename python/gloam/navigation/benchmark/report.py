"""Page and tables of a navigation benchmark: `python -m gloam.navigation.benchmark.report FOLDER`."""

from __future__ import annotations

import argparse
import base64
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import quote

from gloam.errors import Error, IoError

from . import charts, paper, tables, words
from .optional import require
from .results import Episode, Results, load_results
from .statistics import Estimate, wilson
from .summary import CellSummary, Summary, summarize

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
    return [_replace(folder / name, write) for name, write in writers.items()]


def _replace(path: Path, write: Callable[[Path], Any]) -> Path:
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        os.close(handle)
        try:
            write(Path(name))
            os.chmod(name, 0o644)  # mkstemp lets only the owner read
            os.replace(name, path)
        finally:
            Path(name).unlink(missing_ok=True)
    except OSError as error:
        raise IoError(f"cannot write the file: {error.strerror}", str(path)) from error
    return path


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
    template = environment.from_string(Path(__file__).with_name("report.html").read_text(encoding="utf-8"))
    text: str = template.render(
        request=results.request,
        results=results,
        cells=summary.cells,
        tests=summary.tests,
        words=words,
        findings=words.findings(results, summary),
        charts={
            "sc": _image(charts.sc_by_level(results.request, summary)),
            "outcomes": _image(charts.outcome_bars(results.request, summary)),
            "collisions": _image(charts.collision_bars(results.request, summary)),
        },
        few=[cell for cell in summary.cells if 0 < cell.finished < 10],
        total_wall=sum(e.wall_seconds for e in results.episodes),
        total_cpu=sum(e.cpu_seconds for e in results.episodes),
        examples=[(cell, _examples(results, cell)) for cell in summary.cells],
        comparison=_comparison(results, summary),
        paper=paper,
        paper_success=_paper_success,
    )
    return text


def _image(svg: str) -> str:
    """A chart as an address for <img>: names of gradients and clips of several charts cannot collide, nothing runs."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode() if svg else ""


def _examples(results: Results, cell: CellSummary) -> list[tuple[str, Episode, list[tuple[str, str]]]]:
    """("median" or "worst", episode, links to files that exist)."""
    chosen = [(name, e) for name, e in (("median", cell.median), ("worst", cell.worst)) if e is not None]
    return [(name, e, _links(results, e)) for name, e in chosen]


def _links(results: Results, episode: Episode) -> list[tuple[str, str]]:
    files = [(name, file) for name, file in (("video", episode.video), ("log", episode.log)) if file is not None]
    paths = [(name, f"{episode.key.folder}/{file}") for name, file in files]
    return [(name, quote(path)) for name, path in paths if (results.folder / path).is_file()]


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
