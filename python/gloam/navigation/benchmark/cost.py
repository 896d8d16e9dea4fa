"""Cost of a benchmark in time, as lines for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .words import duration


def cost_lines(results: Sequence[dict[str, Any]], seconds: float, machine: str) -> list[str]:
    """A table of the mean cost of an episode by planner, and the sums.

    results: contents of episode.json, of earlier calls too; seconds: wall time of this call; machine: its name.
    """
    planners = list(dict.fromkeys(str(result["planner"]) for result in results))
    width = max([7, *map(len, planners)])
    lines = [f"{'planner':{width}}  episodes  wall s/episode  CPU s/episode"]
    for planner in planners:
        rows = [result for result in results if result["planner"] == planner]
        wall, cpu = (sum(row[f"{kind}_seconds"] for row in rows) / len(rows) for kind in ("wall", "cpu"))
        lines.append(f"{planner:{width}}  {len(rows):8}  {wall:14.1f}  {cpu:13.1f}")
    wall, cpu = (duration(sum(result[f"{kind}_seconds"] for result in results)) for kind in ("wall", "cpu"))
    lines.append(f"all {len(results)} episodes: {wall} in their processes, {cpu} of CPU time; this call took {duration(seconds)}")
    return [*lines, f"machine: {machine}"]
