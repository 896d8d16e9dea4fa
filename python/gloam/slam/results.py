"""Places of runs and sequences in the folder of a benchmark, and its outcomes."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gloam.experiments.videos import median_and_worst

from .methods import load_method

OUTCOME = "outcome.json"
Row = dict[str, Any]


@dataclass(frozen=True)
class Key:
    """The place of a run in the benchmark."""

    method: str
    scene: str
    level: str
    number: int

    @classmethod
    def of(cls, row: Row) -> Key:
        """The key of an outcome (load_rows)."""
        return cls(row["method"], row["scene"], row["level"], row["number"])

    @property
    def path(self) -> Path:
        """Its folder in `runs` of the results."""
        return Path(self.method, self.scene, self.level, f"{self.number:04}")


def case_of(out: Path, scene: str, level: str) -> Path:
    """Folder of a sequence and its truth."""
    return out / "cases" / scene / level


def load_rows(out: Path, request: Row) -> list[Row]:
    """Outcomes of all finished runs with their keys, in the order of the request."""
    rows = []
    for scene in request["scenes"]:
        for level in request["levels"]:
            for name in request["methods"]:
                method = load_method(name).name
                for number in range(request["runs"]):
                    file = out / "runs" / Key(method, scene, level, number).path / OUTCOME
                    if file.is_file():
                        found = json.loads(file.read_text(encoding="utf-8"))
                        rows.append({"method": method, "scene": scene, "level": level, "number": number, **found})
    return rows


def chosen_rows(rows: Sequence[Row]) -> list[Row]:
    """The median and the worst run of one cell, or one run if both are equal: by completeness, then by the share of tracked
    frames, then by ATE (Sim(3)), then by number."""
    chosen = median_and_worst(rows, _goodness)
    if chosen is None:
        return []
    keys = {_goodness(row)[:-1] for row in chosen}
    return list(chosen)[: len(keys)]


def _goodness(row: Row) -> tuple[float, ...]:
    found = row["measures"]
    ate = math.inf if found["ate_sim3"] is None else found["ate_sim3"]
    return found["completeness"], found["tracked"], -ate, -row["number"]
