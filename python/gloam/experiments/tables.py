"""Tables of results: CSV and Parquet."""

from __future__ import annotations

import csv
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

from .optional import require
from .statistics import Estimate

Row = dict[str, Any]


def estimate_columns(name: str, estimate: Estimate) -> Row:
    """NAME, NAME_low and NAME_high."""
    return {name: estimate.value, f"{name}_low": estimate.low, f"{name}_high": estimate.high}


def write_csv(path: Path, rows: Sequence[Row], names: Sequence[str] | None = None) -> Path:
    """UTF-8, a header, empty fields for None, floats with all digits. names: of the columns, None = of the first row."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names or (list(rows[0]) if rows else []), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return path


def write_parquet(path: Path, rows: Sequence[Row], texts: Collection[str], integers: Collection[str], booleans: Collection[str] = ()) -> Path:
    """Other columns are real numbers. Types do not depend on the values, so files of several benchmarks can be joined."""
    arrow, parquet = require("pyarrow"), require("pyarrow.parquet")

    def kind(name: str) -> Any:
        if name in texts:
            return arrow.string()
        return arrow.int64() if name in integers else arrow.bool_() if name in booleans else arrow.float64()

    schema = arrow.schema([(name, kind(name)) for name in (rows[0] if rows else ())])
    parquet.write_table(arrow.Table.from_pylist(rows, schema=schema), path)
    return path
