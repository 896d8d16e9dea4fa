"""Pages of results: one HTML file that makes no requests. A template extends page.html, and may import macros.html."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from . import words
from .files import replace_file
from .optional import require

PAGE = "report.html"
Theirs = TypeVar("Theirs")
Cell = TypeVar("Cell")


def write_report_files(folder: Path, writers: Mapping[str, Callable[[Path], Any]]) -> list[Path]:
    """Writes files by name; each one is replaced when its new content is complete. Returns their paths. Errors: gloam.IoError."""
    return [replace_file(folder / name, write) for name, write in writers.items()]


def require_report_packages() -> None:
    """Errors: gloam.UnsupportedError if matplotlib, jinja2 or pyarrow is missing."""
    for module in ("matplotlib.figure", "jinja2", "pyarrow.parquet"):
        require(module)


def render_page(template: Path, values: Mapping[str, Any], filters: Mapping[str, Callable[..., Any]] | None = None) -> str:
    """The page. filters: more filters by name. All names are escaped; a name without a value is an error (jinja2.UndefinedError)."""
    jinja2 = require("jinja2")
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([template.parent, Path(__file__).parent]),
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters |= {
        "number": words.number, "interval": words.interval, "percent": words.percent, "duration": words.duration,
        "p": words.p_value, "counted": words.count, **(filters or {}),
    }  # fmt: skip
    text: str = environment.get_template(template.name).render(values)
    return text


def beside_paper(
    cells: Sequence[Cell], place: Callable[[Cell], tuple[str, str]], rows: Callable[[str, str], list[Theirs]]
) -> list[tuple[str, str, list[Theirs], list[Cell]]]:
    """(scene, level, rows of the paper, our cells) of each scene and level that the paper has too, in the order of our cells."""
    table = [(*pair, rows(*pair), [cell for cell in cells if place(cell) == pair]) for pair in dict.fromkeys(map(place, cells))]
    return [row for row in table if row[2]]
