"""Page and tables of a SLAM benchmark."""

from __future__ import annotations

import base64
import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gloam.navigation.benchmark import words
from gloam.navigation.benchmark.files import replace_file
from gloam.navigation.benchmark.optional import require
from gloam.navigation.benchmark.visibility import KOSCHMIEDER

from . import paper
from .benchmark import REQUEST, Key, case_of
from .charts import tracking_chart, trajectory_chart, visibility
from .methods import load_method
from .summary import MEASURES, Cell, summarize

PAGE = "report.html"
Row = dict[str, Any]


def write_report(out: Path) -> list[Path]:
    """Writes report.html, results.csv, results.parquet and cells.csv into the folder of a benchmark. Returns their paths.

    Errors: gloam.UnsupportedError if matplotlib, jinja2 or pyarrow is missing; gloam.IoError; OSError.
    """
    for module in ("matplotlib.figure", "jinja2", "pyarrow.parquet"):
        require(module)
    request: Row = json.loads((out / REQUEST).read_text(encoding="utf-8"))
    rows = load_rows(out, request)
    cells = summarize(rows, request["seed"])
    flat = [{**{k: row[k] for k in ("method", "scene", "level", "number", "state", "message", "wall")}, **row["measures"]} for row in rows]
    writers: dict[str, Callable[[Path], Any]] = {
        "results.csv": lambda path: _write_csv(path, flat),
        "results.parquet": lambda path: _write_parquet(path, flat),
        "cells.csv": lambda path: _write_csv(path, [_cell_row(cell) for cell in cells]),
        PAGE: lambda path: path.write_text(render_page(out, request, cells), encoding="utf-8"),
    }
    return [replace_file(out / name, write) for name, write in writers.items()]


def load_rows(out: Path, request: Row) -> list[Row]:
    """Outcomes of all finished runs with their keys, in the order of the request."""
    rows = []
    for scene in request["scenes"]:
        for level in request["levels"]:
            for name in request["methods"]:
                method = load_method(name).name
                for number in range(request["runs"]):
                    file = out / "runs" / Key(method, scene, level, number).path / "outcome.json"
                    if file.is_file():
                        found = json.loads(file.read_text(encoding="utf-8"))
                        rows.append({"method": method, "scene": scene, "level": level, "number": number, **found})
    return rows


def render_page(out: Path, request: Row, cells: list[Cell]) -> str:
    """The page as HTML without external requests. All names are escaped."""
    jinja2 = require("jinja2")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {"number": words.number, "interval": words.interval, "percent": words.percent}
    template = environment.from_string(Path(__file__).with_name("report.html").read_text(encoding="utf-8"))
    scenes = list(dict.fromkeys(cell.scene for cell in cells))
    levels, methods = tuple(request["levels"]), tuple(request["methods"])
    shown = {scene: tuple(v for v in levels if any((c.scene, c.level) == (scene, v) for c in cells)) for scene in scenes}
    text: str = template.render(
        request=request,
        cells=cells,
        failed=[cell for cell in cells if cell.failures],
        visibility={(cell.scene, cell.level): _visibility(out, cell) for cell in cells},
        trajectories={scene: _image(trajectory_chart(out, scene, shown[scene], methods)) for scene in scenes},
        tracking={scene: _image(tracking_chart(out, scene, shown[scene], methods)) for scene in scenes},
        paper=paper,
        comparison=_comparison(cells),
    )
    return text


def _visibility(out: Path, cell: Cell) -> str:
    """Mean, by the mean extinction, and least visibility along the tour; the probe ends at 100 km."""
    _, along, extinction = visibility(case_of(out, cell.scene, cell.level)).T
    mean, least = KOSCHMIEDER / extinction.mean(), along.min()
    return "clear" if least > 1e4 else f"{words.number(mean, 1)}, {words.number(least, 1)}"


def _comparison(cells: list[Cell]) -> list[tuple[str, str, list[paper.PaperRow], list[Cell]]]:
    """(scene, level, rows of the paper, our cells) for each scene and level that the paper has too."""
    pairs = dict.fromkeys((cell.scene, cell.level) for cell in cells)
    rows = [(s, v, paper.paper_rows(s, v), [c for c in cells if (c.scene, c.level) == (s, v)]) for s, v in pairs]
    return [row for row in rows if row[2]]


def _image(svg: str) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()


def _cell_row(cell: Cell) -> Row:
    row: Row = {"method": cell.method, "scene": cell.scene, "level": cell.level, "runs": cell.runs, "failures": cell.failures}
    for name in MEASURES:
        mean = cell.means[name]
        row |= {name: mean.value, f"{name}_low": mean.low, f"{name}_high": mean.high, f"{name}_runs": mean.count}
    return row


def _write_csv(path: Path, rows: list[Row]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]) if rows else ["method"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _write_parquet(path: Path, rows: list[Row]) -> None:
    """Types do not depend on the values, so files of several benchmarks can be joined."""
    arrow, parquet = require("pyarrow"), require("pyarrow.parquet")
    texts, integers = {"method", "scene", "level", "state", "message"}, {"number", "relocalisations", "frames"}
    names = list(rows[0]) if rows else ["method"]
    kinds = [arrow.string() if name in texts else arrow.int64() if name in integers else arrow.float64() for name in names]
    schema = arrow.schema(list(zip(names, kinds, strict=True)))
    parquet.write_table(arrow.Table.from_pylist(rows, schema=schema), path)
