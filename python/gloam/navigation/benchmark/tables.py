"""Rows of the tables of results, and the table for LaTeX."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from gloam.experiments.statistics import Estimate
from gloam.experiments.tables import Row, estimate_columns, write_parquet

from .key import Key
from .results import OUTCOMES, Episode, Results
from .summary import CellSummary, PairedTest, Summary

ESTIMATES = ("success", "sc", "spl", "collisions", "time", "distance")
_KEY = ("planner", "scene", "level", "episode")
_INTEGERS = ("episode", "seed", "collisions", "plans", "late", "invalid")
_TEXTS = ("planner", "scene", "level", "status", "outcome", "collisions_by_object", "tier", "log", "hash", "message")


def episode_rows(results: Results) -> list[Row]:
    """One row per requested episode, in the order of the request; pending ones have status "pending" and no values."""
    columns = [*_KEY, "status", *_values_of_episode()]
    rows: dict[Key, Row] = {e.key: _episode_row(e) for e in results.episodes}
    rows |= {key: dict.fromkeys(columns) | asdict(key) | {"status": "pending"} for key in results.pending}
    request = results.request
    place = {name: i for i, name in enumerate(request.cells())}
    return [rows[k] for k in sorted(rows, key=lambda k: (place[k.planner, k.scene, k.level], k.episode))]


def _values_of_episode() -> list[str]:
    places = ["start_x", "start_y", "start_yaw", "goal_x", "goal_y"]
    names = [name for name in Episode.__dataclass_fields__ if name not in ("key", "start", "goal", "track", "touches")]
    return ["sc", "spl", *places, *names]


def _episode_row(episode: Episode) -> Row:
    x, y, yaw = episode.start
    places = {"start_x": x, "start_y": y, "start_yaw": yaw, "goal_x": episode.goal[0], "goal_y": episode.goal[1]}
    values = asdict(episode) | places | {"sc": episode.sc, "spl": episode.spl}
    values["collisions_by_object"] = json.dumps(episode.collisions_by_object, sort_keys=True, ensure_ascii=False)
    return asdict(episode.key) | {"status": "finished"} | {name: values[name] for name in _values_of_episode()}


def cell_rows(summary: Summary) -> list[Row]:
    """One row per cell: each estimate as NAME, NAME_low, NAME_high, then counts, shares and costs."""
    return [_cell_row(cell) for cell in summary.cells]


def _cell_row(cell: CellSummary) -> Row:
    row: Row = {name: getattr(cell, name) for name in ("planner", "scene", "level", "requested", "finished")}
    row |= {"pending": " ".join(map(str, cell.pending)), "successes": cell.successes}
    for name in ESTIMATES:
        row |= estimate_columns(name, getattr(cell, name))
    for name in ("visibility_mean", "visibility_min", "late", "invalid", "wall", "cpu"):
        row[name] = getattr(cell, name)
    row |= {f"outcome_{name}": cell.outcomes.get(name, 0) for name in OUTCOMES}
    row["collisions_by_object"] = json.dumps(cell.objects, sort_keys=True, ensure_ascii=False)
    row["median_episode"] = cell.median.key.episode if cell.median else None
    row["worst_episode"] = cell.worst.key.episode if cell.worst else None
    return row


def test_rows(tests: Sequence[PairedTest]) -> list[Row]:
    """One row per paired test."""
    rows = []
    for test in tests:
        row = asdict(test)
        del row["sc"]
        rows.append(row | estimate_columns("sc_difference", test.sc))
    return rows


def write_episodes(path: Path, rows: list[Row]) -> Path:
    """The rows of `episode_rows` as Parquet."""
    return write_parquet(path, rows, _TEXTS, _INTEGERS, ("success",))


_LATEX = str.maketrans({
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
    "[": "{[}", "]": "{]}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}", "<": r"\textless{}", ">": r"\textgreater{}",
})  # fmt: skip


def latex_text(text: str) -> str:
    """Text with LaTeX's special characters escaped."""
    return text.translate(_LATEX)


def latex_estimate(estimate: Estimate, digits: int) -> str:
    """ "0.81 {\\scriptsize [0.62, 0.92]}"; "--" without a value, and no brackets without an interval."""
    if estimate.value is None:
        return "--"
    text = f"{estimate.value:.{digits}f}"
    if estimate.low is None or estimate.high is None:
        return text
    return f"{text} {{\\scriptsize [{estimate.low:.{digits}f}, {estimate.high:.{digits}f}]}}"


def write_latex(path: Path, results: Results, summary: Summary) -> Path:
    """A table for the package booktabs."""
    lines = [
        "% Needs \\usepackage{booktabs}. 95 % intervals: Wilson for the success rate, percentile bootstrap otherwise.",
        "% Time to goal: successful episodes only; -- if there is none.",
        "\\begin{tabular}{llllccccc}", "\\toprule",
        "Scene & Level & Planner & $n$ & Success $\\uparrow$ & SC $\\uparrow$ & SPL $\\uparrow$ & "
        "Collisions $\\downarrow$ & Time [s] $\\downarrow$ \\\\",
    ]  # fmt: skip
    before: tuple[str, str] | None = None
    for cell in summary.cells:
        group = (cell.scene, cell.level)
        if group != before:
            lines.append("\\midrule" if before is None or before[0] != cell.scene else "\\addlinespace")
        heads = [latex_text(text) if group != before else "" for text in group]
        n = str(cell.finished) + (f" of {cell.requested}" if cell.pending else "")
        digits = {"success": 2, "sc": 2, "spl": 2, "collisions": 1, "time": 1}
        values = [latex_estimate(getattr(cell, name), count) for name, count in digits.items()]
        lines.append(" & ".join([*heads, latex_text(cell.planner), n, *values]) + " \\\\")
        before = group
    path.write_text("\n".join([*lines, "\\bottomrule", "\\end{tabular}", ""]), encoding="utf-8")
    return path
