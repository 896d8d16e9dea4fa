"""Routes of all episodes on the floor plans, coloured by outcome."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gloam.experiments.charts import INK, Chart, short
from gloam.experiments.optional import require

from ..grid import Grid
from .charts import OUTCOME_COLORS
from .floor_plan import plan_of
from .results import OUTCOMES, Episode, Results

_MOST_COLUMNS = 4
_WIDTH = 3.3  # of a panel [in]
_WALL = "#c4c9d1"
_TOUCH = "#222222"


def route_charts(results: Results) -> dict[str, str]:
    """SVG text by scene: a row of panels per planner, a column per level; of one level, up to four planners in a row.
    Scenes and planners without a known route are left out.

    Errors: as plan_of().
    """
    scenes = dict.fromkeys(e.key.scene for e in results.episodes if e.track)
    return {scene: _chart(results, scene) for scene in scenes}


def _chart(results: Results, scene: str) -> str:
    request = results.request
    plans = {level: plan_of(results.folder, scene, level) for level in request.levels}
    planners = [p for p in request.planners if any(e.track for e in results.episodes if (e.key.planner, e.key.scene) == (p, scene))]
    cells = [(planner, level) for planner in planners for level in request.levels]
    columns = len(request.levels) if len(request.levels) > 1 else min(len(cells), _MOST_COLUMNS)
    rows = -(-len(cells) // columns)
    height = _WIDTH * max((_aspect(plan) for plan in plans.values()), default=1.0)
    used: set[str] = set()
    with Chart(_WIDTH * columns, (height + 0.35) * rows + 0.4, f"routes {scene}") as chart:
        axes = chart.figure.subplots(rows, columns, squeeze=False)
        for axis in axes.flat[len(cells) :]:
            axis.set_visible(False)
        for axis, (planner, level) in zip(axes.flat, cells, strict=False):
            episodes = results.cell(planner, scene, level)
            used |= {e.outcome for e in episodes if e.track}
            _panel(axis, plans[level], episodes)
            axis.set_title(f"{short(planner)} · {short(level, 12)}", color=INK)
        lines = require("matplotlib.lines")
        handles = [lines.Line2D([], [], color=OUTCOME_COLORS[name], linewidth=2, label=name.replace("_", " ")) for name in OUTCOMES if name in used]
        handles += [lines.Line2D([], [], color=_TOUCH, linestyle="", marker=".", label="collision")]
        chart.figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), frameon=False)
    return chart.svg


def _aspect(plan: Grid | None) -> float:
    if plan is None:
        return 1.0
    left, right, bottom, top = plan.extent
    return (top - bottom) / (right - left)


def _panel(axis: Any, plan: Grid | None, episodes: list[Episode]) -> None:
    if plan is not None:
        colors = require("matplotlib.colors").ListedColormap(["white", _WALL])
        axis.imshow(plan.blocked, origin="lower", extent=plan.extent, cmap=colors, vmin=0, vmax=1, interpolation="nearest")
    for episode in episodes:
        if not episode.track:
            continue
        color = OUTCOME_COLORS[episode.outcome]
        _, x, y = zip(*episode.track, strict=True)
        axis.plot(x, y, color=color, linewidth=1.2, alpha=0.8, rasterized=True)
        axis.plot(x[0], y[0], color=color, marker="o", markersize=2.5, rasterized=True)
        end = {"marker": "s", "markersize": 3.5} if episode.success else {"marker": "x", "markersize": 5, "markeredgewidth": 1.6}
        axis.plot(x[-1], y[-1], color=color, rasterized=True, **end)
        if episode.touches:
            axis.plot([t[1] for t in episode.touches], [t[2] for t in episode.touches], color=_TOUCH, linestyle="", marker=".",
                      markersize=3, rasterized=True, zorder=4)  # fmt: skip
    axis.set_aspect("equal")
    axis.set_xticks([])
    axis.set_yticks([])
    for side in axis.spines.values():
        side.set_visible(False)
