"""Page and tables of a SLAM benchmark."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import quote

from gloam.experiments import words
from gloam.experiments.charts import image
from gloam.experiments.checks import read_object
from gloam.experiments.page import PAGE, beside_paper, render_page, require_report_packages, write_report_files
from gloam.experiments.request import REQUEST_FILE
from gloam.experiments.tables import estimate_columns, write_csv, write_parquet
from gloam.experiments.videos import POSTER, VIDEO
from gloam.navigation.benchmark.visibility import KOSCHMIEDER

from . import paper
from .charts import tracking_chart, trajectory_chart, visibility
from .losses import find_losses
from .results import Key, Row, case_of, load_rows
from .summary import MEASURES, Cell, summarize

_TEXTS = ("method", "scene", "level", "state", "message")
_INTEGERS = ("number", "relocalisations", "frames")


def write_report(out: Path) -> list[Path]:
    """Writes report.html, results.csv, results.parquet and cells.csv into the folder of a benchmark. Returns their paths.

    Errors: gloam.UnsupportedError if matplotlib, jinja2 or pyarrow is missing; gloam.IoError; OSError.
    """
    require_report_packages()
    request = read_object(out / REQUEST_FILE)
    rows = load_rows(out, request)
    cells = summarize(rows, request["seed"])
    flat = [{**{k: row[k] for k in ("method", "scene", "level", "number", "state", "message", "wall")}, **row["measures"]} for row in rows]
    writers: dict[str, Callable[[Path], Any]] = {
        "results.csv": lambda path: write_csv(path, flat),
        "results.parquet": lambda path: write_parquet(path, flat, _TEXTS, _INTEGERS),
        "cells.csv": lambda path: write_csv(path, [_cell_row(cell) for cell in cells]),
        PAGE: lambda path: path.write_text(page_of(out, request, cells), encoding="utf-8"),
    }
    return write_report_files(out, writers)


def page_of(out: Path, request: Row, cells: list[Cell]) -> str:
    """The page as HTML without external requests."""
    scenes = list(dict.fromkeys(cell.scene for cell in cells))
    levels, methods = tuple(request["levels"]), tuple(request["methods"])
    shown = {scene: tuple(v for v in levels if any((c.scene, c.level) == (scene, v) for c in cells)) for scene in scenes}
    values: Row = {
        "request": request,
        "cells": cells,
        "failed": [cell for cell in cells if cell.failures],
        "visibility": {(cell.scene, cell.level): _visibility(out, cell) for cell in cells},
        "trajectories": {scene: image(trajectory_chart(out, scene, shown[scene], methods)) for scene in scenes},
        "tracking": {scene: image(tracking_chart(out, scene, shown[scene], methods)) for scene in scenes},
        "losses": [(cell, find_losses(out, cell.examples[0])) for cell in cells if cell.examples],
        "examples": [(cell, _examples(out, cell)) for cell in cells],
        "paper": paper,
        "tunnels": [cell for cell in cells if cell.scene in paper.TUNNEL_SCENES],
        "comparison": beside_paper(cells, lambda cell: (cell.scene, cell.level), paper.paper_rows),
    }
    return render_page(Path(__file__).with_name("report.html"), values)


def _examples(out: Path, cell: Cell) -> list[tuple[Row, str, str]]:
    """The median run of a cell, and the worst one if it is another, with the addresses of video and poster; "" = there is none."""

    def address(row: Row, file: str) -> str:
        path = Path("runs") / Key.of(row).path / file
        return quote(str(path)) if (out / path).is_file() else ""

    return [(row, address(row, VIDEO), address(row, POSTER)) for row in cell.examples]


def _visibility(out: Path, cell: Cell) -> str:
    """Mean, by the mean extinction, and least visibility along the tour; the probe ends at 100 km."""
    _, along, extinction = visibility(case_of(out, cell.scene, cell.level)).T
    mean, least = KOSCHMIEDER / extinction.mean(), along.min()
    return "clear" if least > 1e4 else f"{words.number(mean, 1)}, {words.number(least, 1)}"


def _cell_row(cell: Cell) -> Row:
    row: Row = {"method": cell.method, "scene": cell.scene, "level": cell.level, "runs": cell.runs, "failures": cell.failures}
    for name in MEASURES:
        row |= {**estimate_columns(name, cell.means[name]), f"{name}_runs": cell.means[name].count}
    return row
