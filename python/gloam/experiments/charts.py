"""Charts of pages as SVG text (matplotlib). Names are drawn verbatim: no part of them is parsed as mathematics."""

from __future__ import annotations

import base64
import io
from pathlib import Path
from typing import Any

from .optional import require

# Okabe and Ito's palette, which people with colour blindness can distinguish.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6a51a3", "#7f7f7f")
LEVEL_COLORS = ("#9ecae1", "#4292c6", "#08519c", "#08306b", "#000000")
INK, SOFT, GRID = "#222222", "#6b7280", "#e5e7eb"
_SETTINGS = {
    "text.parse_math": False,
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "svg.fonttype": "path",
}


class Chart:
    """A figure and its matplotlib settings, which apply only inside of the `with` block."""

    def __init__(self, width: float, height: float, name: str) -> None:
        self._context = require("matplotlib").rc_context({**_SETTINGS, "svg.hashsalt": name})
        self._size = (width, height)
        self.svg = ""

    def __enter__(self) -> Chart:
        self._context.__enter__()
        self.figure = require("matplotlib.figure").Figure(figsize=self._size, layout="constrained")
        return self

    def __exit__(self, *error: Any) -> None:
        try:
            if error[0] is None:
                file = io.StringIO()
                self.figure.savefig(file, format="svg", metadata={"Date": None}, dpi=200)
                self.svg = file.getvalue()
        finally:
            self._context.__exit__(*error)


def image(svg: str) -> str:
    """A chart as an address for <img>: names of gradients and clips of several charts cannot collide, nothing runs. "" for ""."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode() if svg else ""


def short(text: str, most: int = 20) -> str:
    """Long names would leave no room for the chart; the tables have them in full."""
    return text if len(text) <= most else text[: most - 1] + "…"


def label_font(size: int) -> Any:
    """A font for images (PIL): DejaVu Sans, which matplotlib contains. size: [px]."""
    path = Path(require("matplotlib").get_data_path()) / "fonts/ttf/DejaVuSans.ttf"
    return require("PIL.ImageFont").truetype(str(path), size)
