"""Means of the runs of each method, scene and level, with their intervals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from gloam.experiments.statistics import Estimate, bootstrap_mean, generator

from .results import Row, chosen_rows

MEASURES = (
    "ate_se3", "ate_sim3", "rpe", "rpe_angle", "coverage", "coverage_printed", "scaled_ate", "scaled_ate_printed",
    "completeness", "tracked", "first_track", "relocalisations", "seconds",
)  # fmt: skip


@dataclass(frozen=True)
class Cell:
    """runs: finished; states: how they ended; means: by measure, over the runs in which it is defined; examples: the median run and
    the worst one, if it is another."""

    method: str
    scene: str
    level: str
    runs: int
    states: Counter[str]
    messages: tuple[str, ...]
    means: dict[str, Estimate]
    examples: tuple[Row, ...]

    @property
    def failures(self) -> int:
        """Runs that crashed, timed out or were malformed."""
        return self.runs - self.states["ok"]

    @property
    def name(self) -> str:
        """METHOD/SCENE/LEVEL."""
        return f"{self.method}/{self.scene}/{self.level}"


def summarize(rows: Sequence[Row], seed: int) -> list[Cell]:
    """Cells in the order of their first run; rows: outcomes with their keys (benchmark.run)."""
    groups: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["scene"], row["level"], row["method"]), []).append(row)
    cells = []
    for (scene, level, method), mine in groups.items():
        means = {}
        for name in MEASURES:
            values = [row["measures"][name] for row in mine if row["measures"][name] is not None]
            means[name] = bootstrap_mean(values, generator(seed, f"{method}/{scene}/{level}/{name}"))
        messages = tuple(dict.fromkeys(row["message"] for row in mine if row["message"]))
        cells.append(Cell(method, scene, level, len(mine), Counter(row["state"] for row in mine), messages, means, tuple(chosen_rows(mine))))
    return cells
