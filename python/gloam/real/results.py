"""Files with the numbers of a comparison: CSV for tables, JSON for all."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from gloam.experiments.files import replace_file
from gloam.experiments.tables import Row, estimate_columns, write_csv

from .compare import REAL, Comparison
from .images import shown
from .reasons import STATISTICS, Difference
from .summary import Line


def write_tables(found: Comparison, lines: list[Line], pairs: list[Row], reasons: dict[str, list[Difference]]) -> list[Path]:
    """Writes images.csv, pairs.csv, summary.csv, differences.csv and summary.json. Returns their paths."""
    summary = [_line_row(line) for line in lines]
    differing = [_difference_row(name, one) for name, every in reasons.items() for one in every]
    made = [
        _write_csv(
            found.out / "images.csv", ["set", "file", "sha256", "width", "height", *[s.key for s in STATISTICS]], _image_rows(found)
        ),
        _write_csv(found.out / "summary.csv", list(dict.fromkeys(key for row in summary for key in row)) or ["network"], summary),
        _write_csv(found.out / "differences.csv", list(differing[0]), differing),
    ]
    if pairs:
        made.append(_write_csv(found.out / "pairs.csv", list(pairs[0]), (_named(row) for row in pairs)))
    whole = {
        "sets": {name: _set_row(found, name) for name in found.sets},
        "summary": [{**asdict(line), "is_deficient": line.is_deficient} for line in lines],
        "differences": differing,
        "pairs": [_named(row) for row in pairs],
    }
    made.append(
        replace_file(
            found.out / "summary.json", lambda path: path.write_text(json.dumps(_finite(whole), indent=1) + "\n", encoding="utf-8")
        )
    )
    return made


def _set_row(found: Comparison, name: str) -> Row:
    one = found.sets[name]
    left_out = [{"file": shown(file), "reason": reason} for file, reason in one.left_out]
    return {"folder": str(one.folder), "images": len(one.pictures), "skipped": one.skipped, "left_out": left_out}


def _image_rows(found: Comparison) -> Iterator[Row]:
    for name, one in found.sets.items():
        for picture in one.pictures:
            yield {
                "set": name, "file": shown(picture.name), "sha256": picture.hash, "width": picture.width, "height": picture.height,
                **picture.numbers,
            }  # fmt: skip


def _named(row: Row) -> Row:
    return {**row, REAL: shown(row[REAL]), "other": shown(row["other"])}


def _line_row(line: Line) -> Row:
    row: Row = {"network": line.network, "set": line.name, "images": line.count, "real_images": line.real_count}
    for key, estimate in line.measures.items():
        row |= estimate_columns(key, estimate)
    return row


def _difference_row(name: str, one: Difference) -> Row:
    return {
        "set": name, "statistic": one.statistic.key, "unit": one.statistic.unit, "real": one.real, "other": one.other,
        "cliff_delta": one.delta.value, "cliff_delta_low": one.delta.low, "cliff_delta_high": one.delta.high,
        "cohen_d": one.standardised, "sentence": one.sentence,
    }  # fmt: skip


def _finite(value: Any) -> Any:
    """JSON has no NaN."""
    if isinstance(value, dict):
        return {key: _finite(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _write_csv(path: Path, names: list[str], rows: Iterable[Row]) -> Path:
    cleaned = [{key: None if isinstance(v, float) and math.isnan(v) else v for key, v in row.items()} for row in rows]
    return replace_file(path, lambda part: write_csv(part, cleaned, names))
