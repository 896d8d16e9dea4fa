"""Charts of the page as SVG text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from gloam.experiments.charts import GRID, INK, LEVEL_COLORS, PALETTE, SOFT, Chart, short
from gloam.experiments.optional import require

from .request import Request
from .results import OUTCOMES
from .summary import CellSummary, Summary

OUTCOME_COLORS = {
    "success": "#009e73", "collided": "#d55e00", "fell": "#8c2d04", "stuck": "#e69f00", "lost": "#cc79a7",
    "timed_out": "#56b4e9", "error": "#222222", "pending": "#ffffff",
}  # fmt: skip
_MOST_COLUMNS = 4
_MOST_OBJECTS = 12


def sc_by_level(request: Request, summary: Summary) -> str:
    """SC against level, one panel per scene and planner: its intervals in colour, the other planners in grey."""
    columns = min(len(request.planners), _MOST_COLUMNS)
    strips = -(-len(request.planners) // columns)  # rows of panels per scene
    rows = strips * len(request.scenes)
    with Chart(0.6 + min(3.4, max(2.6, 10.0 / columns)) * columns, 0.3 + 2.6 * rows, "sc") as chart:
        axes = chart.figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        chart.figure.get_layout_engine().set(h_pad=0.1, w_pad=0.08)
        for axis in axes.flat:
            axis.set_visible(False)
        for i, scene in enumerate(request.scenes):
            for k, planner in enumerate(request.planners):
                axis = axes[i * strips + k // columns][k % columns]
                axis.set_visible(True)
                _sc_panel(axis, request, summary, (planner, scene))
                if k % columns == 0:
                    axis.set_ylabel("SC")
                # Panels under which the grid has a hole still need their ticks.
                axis.tick_params(labelbottom=True, labelleft=k % columns == 0)
    return chart.svg


def _sc_panel(axis: Any, request: Request, summary: Summary, name: tuple[str, str]) -> None:
    planner, scene = name
    places = range(len(request.levels))
    for other in request.planners:
        if other != planner:
            values = [summary.cell(other, scene, level).sc.value for level in request.levels]
            axis.plot(places, _gaps(values), color="#c4c9d1", linewidth=1, zorder=1)
    color = PALETTE[request.planners.index(planner) % len(PALETTE)]
    cells = [summary.cell(planner, scene, level) for level in request.levels]
    axis.plot(places, _gaps([c.sc.value for c in cells]), color=color, linewidth=1.8, marker="o", markersize=4.5, zorder=3)
    for place, cell in zip(places, cells, strict=True):
        if cell.sc.low is not None and cell.sc.high is not None:
            axis.plot([place, place], [cell.sc.low, cell.sc.high], color=color, linewidth=5, alpha=0.28, zorder=2,
                      solid_capstyle="butt")  # fmt: skip
        if cell.sc.value is None:
            axis.text(place, 0.5, "no episode", color=SOFT, ha="center", va="center", rotation=90, fontsize=8)
    axis.set_title(f"{short(planner, 30)}\n{short(scene, 30)}", color=INK)
    axis.set_xticks(places, [short(level, 12) for level in request.levels])
    axis.set_xlim(-0.4, len(request.levels) - 0.6)
    axis.set_ylim(-0.03, 1.03)
    axis.grid(axis="y", color=GRID, linewidth=0.8)
    axis.set_axisbelow(True)


def outcome_bars(request: Request, summary: Summary) -> str:
    """Outcomes of each cell as stacked bars, one panel per scene; pending episodes are hatched."""
    count = len(request.planners) * len(request.levels)
    with Chart(2.4 + 4.2 * len(request.scenes), 1.0 + 0.27 * count, "outcomes") as chart:
        panels = chart.figure.subplots(1, len(request.scenes), sharey=True, squeeze=False)[0]
        used: list[str] = []
        for axis, scene in zip(panels, request.scenes, strict=True):
            labels: list[str] = []
            places: list[float] = []
            for i, planner in enumerate(request.planners):
                for k, level in enumerate(request.levels):
                    places.append(len(labels) + 0.5 * i)
                    labels.append(f"{short(planner)} · {short(level, 12)}")
                    _outcome_bar(axis, summary.cell(planner, scene, level), places[-1], used)
            axis.set_yticks(places, labels)
            axis.tick_params(axis="y", length=0)
            axis.set_ylim(places[-1] + 0.6, -0.6)
            axis.set_xlim(0, request.episodes)
            axis.xaxis.get_major_locator().set_params(integer=True)
            axis.set_title(short(scene, 40), color=INK)
            axis.set_xlabel("episodes")
        names = [name for name in (*OUTCOMES, "pending") if name in used]
        patch = require("matplotlib.patches").Patch
        handles = [patch(label=name.replace("_", " "), **_style(name)) for name in names]
        chart.figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), frameon=False)
    return chart.svg


def _style(outcome: str) -> dict[str, Any]:
    pending = outcome == "pending"
    return {"facecolor": OUTCOME_COLORS[outcome], "edgecolor": "#9aa1ac" if pending else "white",
            "hatch": "////" if pending else None, "linewidth": 0.8}  # fmt: skip


def _outcome_bar(axis: Any, cell: CellSummary, place: float, used: list[str]) -> None:
    left = 0
    for outcome in (*OUTCOMES, "pending"):
        count = len(cell.pending) if outcome == "pending" else cell.outcomes.get(outcome, 0)
        if not count:
            continue
        used.append(outcome)
        axis.barh(place, count, left=left, height=0.78, **_style(outcome))
        dark = outcome in ("success", "fell", "error", "collided")
        if outcome != "pending" and count >= 0.06 * cell.requested:
            axis.text(left + count / 2, place, str(count), ha="center", va="center_baseline", fontsize=8,
                      color="white" if dark else INK)  # fmt: skip
        left += count


def collision_bars(request: Request, summary: Summary) -> str:
    """Collisions per episode by object, one panel per scene, stacked by level; the mean over all planners' episodes.
    "" without collisions."""
    scenes = [scene for scene in request.scenes if any(cell.objects for cell in summary.cells if cell.scene == scene)]
    if not scenes:
        return ""
    totals = {scene: _top_objects([c for c in summary.cells if c.scene == scene]) for scene in scenes}
    height = 1.0 + 0.27 * max(len(total) for total in totals.values())
    with Chart(0.8 + 5.0 * len(scenes), height, "collisions") as chart:
        panels = chart.figure.subplots(1, len(scenes), squeeze=False)[0]
        for axis, scene in zip(panels, scenes, strict=True):
            _collision_panel(axis, request, [c for c in summary.cells if c.scene == scene], totals[scene])
            axis.set_ylim(max(map(len, totals.values())) - 0.4, -0.6)  # bars of all panels have one height
            axis.set_title(short(scene, 40), color=INK)
        patch = require("matplotlib.patches").Patch
        handles = [patch(facecolor=_level_color(k), label=str(k)) for k in range(len(request.levels))]
        legend = chart.figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), frameon=False)
        # Set afterwards, because matplotlib hides legends of labels that begin with an underscore.
        for text, level in zip(legend.get_texts(), request.levels, strict=True):
            text.set_text(short(level))
    return chart.svg


def _top_objects(cells: Sequence[CellSummary]) -> dict[str, list[str]]:
    """Labels of bars with the objects of each: the most frequent ones, and all others together."""
    counts: Counter[str] = Counter()
    for cell in cells:
        counts.update(cell.objects)
    names = sorted(counts, key=lambda name: (-counts[name], name))
    if len(names) <= _MOST_OBJECTS:
        return {name: [name] for name in names}
    top = {name: [name] for name in names[: _MOST_OBJECTS - 1]}
    rest = names[_MOST_OBJECTS - 1 :]
    return top | {f"{len(rest)} other objects": rest}


def _collision_panel(axis: Any, request: Request, cells: Sequence[CellSummary], bars: dict[str, list[str]]) -> None:
    places = list(range(len(bars)))
    left = [0.0] * len(bars)
    for k, level in enumerate(request.levels):
        there = [cell for cell in cells if cell.level == level]
        episodes = sum(cell.finished for cell in there)
        widths = [sum(cell.objects.get(name, 0) for cell in there for name in names) / max(1, episodes)
                  for names in bars.values()]  # fmt: skip
        axis.barh(places, widths, left=left, height=0.78, color=_level_color(k), edgecolor="white", linewidth=0.8)
        left = [a + b for a, b in zip(left, widths, strict=True)]
    axis.set_yticks(places, [short(name, 28) for name in bars])
    axis.tick_params(axis="y", length=0)
    axis.set_xlabel("collisions per episode, summed over levels")
    axis.grid(axis="x", color=GRID, linewidth=0.8)
    axis.set_axisbelow(True)


def _level_color(index: int) -> str:
    return LEVEL_COLORS[min(index, len(LEVEL_COLORS) - 1)]


def _gaps(values: Sequence[float | None]) -> list[float]:
    """Cells without episodes leave a gap in the line."""
    return [float("nan") if value is None else value for value in values]
