"""Page and tables of a comparison."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from gloam.experiments import words
from gloam.experiments.charts import image
from gloam.experiments.files import replace_file
from gloam.experiments.optional import require
from gloam.experiments.page import PAGE, render_page
from gloam.experiments.statistics import Estimate

from . import paper
from .charts import feature_chart, histogram_chart
from .compare import REAL, REQUEST, Comparison
from .examples import make_examples
from .images import shown
from .reasons import Difference, differences
from .results import write_tables
from .summary import HALVES, Line, summarize

_FEW = 20  # images, below which the page warns
_MOST_LEFT_OUT = 30  # files that are named on the page


def write_report(found: Comparison) -> list[Path]:
    """Writes report.html and the tables into the folder of results. Returns their paths.

    Errors: gloam.UnsupportedError if matplotlib or jinja2 is missing; gloam.IoError.
    """
    for module in ("matplotlib.figure", "jinja2"):
        require(module)
    lines, pairs = summarize(found)
    reasons = {name: differences(found.sets[REAL], found.sets[name]) for name in found.request.others}
    files = write_tables(found, lines, pairs, reasons)
    page = page_of(found, lines, pairs, reasons)
    return [*files, replace_file(found.out / PAGE, lambda path: path.write_text(page, encoding="utf-8"))]


def page_of(found: Comparison, lines: list[Line], pairs: list[dict[str, Any]], reasons: dict[str, list[Difference]]) -> str:
    """The page as HTML without external requests."""
    first = next(iter(found.request.others))
    values = {
        "request": json.loads((found.out / REQUEST).read_text(encoding="utf-8")),
        "found": found,
        "first": first,
        "tables": _tables(lines, found),
        "likeness": _likeness(lines),
        "has_pairs": bool(found.pairs),
        "pair_count": {name: len(every) for name, every in found.pairs.items()},
        "uncompared": sorted({row["reason"] for row in pairs if row["reason"]}),
        "findings": _findings(found, lines, reasons[first], first),
        "reasons": reasons,
        "hints": _hints(found),
        "left_out": {name: (one.left_out[:_MOST_LEFT_OUT], len(one.left_out)) for name, one in found.sets.items() if one.left_out},
        "histograms": image(histogram_chart(found)),
        "scatter": {network.settings.name: image(feature_chart(found, network)) for network in found.networks},
        "examples": make_examples(found, pairs),
        "paper": paper,
        "HALVES": HALVES,
        "REAL": REAL,
    }
    return render_page(Path(__file__).with_name("report.html"), values, {"shown": shown})


def _tables(lines: list[Line], found: Comparison) -> dict[str, list[Line]]:
    """Lines by network. The halves of the real images come first: they show the numbers of equal sets."""
    names = [network.settings.name for network in found.networks]
    return {name: sorted((line for line in lines if line.network == name), key=lambda line: line.name != HALVES) for name in names}


def _likeness(lines: list[Line]) -> list[Line]:
    """A line per set with FLIP and SSIM, which no network changes."""
    first: dict[str, Line] = {}
    for line in lines:
        if "flip" in line.measures:
            first.setdefault(line.name, line)
    return list(first.values())


_NAMES = {"cosine_of_means": "cosine of mean features", "fid": "FID", "kid": "KID"}


def _findings(found: Comparison, lines: list[Line], reasons: list[Difference], first: str) -> list[str]:
    """The answer in sentences."""
    told = []
    for network in found.networks:
        mine = {line.name: line for line in lines if line.network == network.settings.name}
        line, halves = mine[first], mine.get(HALVES)
        key = "kid" if line.is_deficient and line.measures["kid"].value is not None else "fid"
        value = line.measures[key]
        if value.value is None:
            told.append(f"{network.settings.name}: a single image has no FID or KID. The cosine of features is the number to read.")
            continue
        equal = "" if halves is None else f"; two halves of the real images have {words.number(halves.measures[key].value, 3)}"
        told.append(
            f"{network.settings.name}: {_NAMES[key]} of “{first}” is {words.number(value.value, 3)} {words.interval(value, 3)}{equal}."
        )
        known = [
            (one.measures[key], name) for name, one in mine.items() if name not in (first, HALVES) and one.measures[key].value is not None
        ]
        if known:
            told.append(f"{network.settings.name}: {_closest(_NAMES[key], value, *min(known, key=lambda one: one[0].value or 0.0))}")
    clear = [one for one in reasons if not one.sentence.startswith("No clear")]
    told += [one.sentence for one in clear[:3]]
    if not clear:
        told.append("No statistic of colour, contrast, noise or sharpness differs clearly.")
    return told


def _closest(measure: str, mine: Estimate, best: Estimate, name: str) -> str:
    """Whether the closest baseline is closer than the simulation, in words; not where their intervals overlap."""
    a, b = mine.value or 0.0, best.value or 0.0
    bounds = (mine.low, mine.high, best.low, best.high)
    if None in bounds or max(mine.low or 0.0, best.low or 0.0) <= min(mine.high or 0.0, best.high or 0.0):
        return f"by {measure}, the closest baseline, “{name}” with {words.number(b, 3)}, is not clearly closer or farther."
    return f"by {measure}, “{name}” is {'closer' if b < a else 'the closest baseline, but farther'} with {words.number(b, 3)}."


def _hints(found: Comparison) -> list[str]:
    """Properties of the sets that limit the comparison."""
    hints = []
    counts = {name: len(one.pictures) for name, one in found.sets.items()}
    few = min(counts.values())
    if few < _FEW:
        hints.append(
            f"The smallest set has {words.count(few, 'image')}: distances between sets of fewer than {_FEW} images are mostly chance."
        )
    real = {picture.name.rpartition(".")[0] for picture in found.sets[REAL].pictures}
    same = [name for name in found.request.others if real == {p.name.rpartition(".")[0] for p in found.sets[name].pictures}]
    if same and not found.pairs:
        hints.append(f"The file names of “{same[0]}” match the real ones. If equal names show one view, --pairs compares them one by one.")
    sizes = {name: {(p.width, p.height) for p in one.pictures} for name, one in found.sets.items()}
    if len(set().union(*sizes.values())) > 1:
        hints.append("The images have different sizes, so statistics that are marked with † are not comparable.")
    skipped = {name: one.skipped for name, one in found.sets.items() if one.skipped and not found.pairs}
    hints += [f"{count} images of “{name}” were not compared (--most)." for name, count in skipped.items()]
    alone = {name: one.skipped for name, one in found.sets.items() if one.skipped and found.pairs}
    hints += [
        f"{words.count(count, 'image')} of “{name}” without a partner, or beyond --most, were not compared."
        for name, count in alone.items()
    ]
    return hints
