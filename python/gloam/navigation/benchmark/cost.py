"""Cost of a benchmark in time, as lines for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gloam.experiments.words import duration


def cost_lines(results: Sequence[dict[str, Any]], seconds: float, machine: str) -> list[str]:
    """A table of the mean cost of an episode by planner and tier of images, and the sums.

    results: contents of episode.json, of earlier calls too; seconds: wall time of this call; machine: its name.
    """
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for result in results:
        groups.setdefault((result["planner"], result["tier"]), []).append(result)
    width = max([7, *(len(planner) for planner, _ in groups)])
    lines = [f"{'planner':{width}}  images       episodes  wall s/episode  CPU s/episode"]
    for (planner, tier), rows in groups.items():
        wall, cpu = (sum(row[f"{kind}_seconds"] for row in rows) / len(rows) for kind in ("wall", "cpu"))
        lines.append(f"{planner:{width}}  {tier:11}  {len(rows):8}  {wall:14.1f}  {cpu:13.1f}")
    wall, cpu = (duration(sum(result[f"{kind}_seconds"] for result in results)) for kind in ("wall", "cpu"))
    lines.append(f"all {len(results)} episodes: {wall} in their processes, {cpu} of CPU time; this call took {duration(seconds)}")
    return [*lines, f"machine: {machine}"]
