"""Charts of the page: trajectories on the floor plan, and the state of tracking over time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam.experiments.charts import INK, LEVEL_COLORS, PALETTE, Chart
from gloam.experiments.optional import require
from gloam.navigation.benchmark.floor_plan import plan_of
from gloam.navigation.grid import Grid

from .adapters.contract import INITIALIZING, LOST, TRACKED
from .estimate import Array, Trajectory, read_run, read_tum
from .lidar_extinction import extinction_of_scans
from .methods import load_method
from .results import Key, case_of
from .sequence import TRUTH, TRUTH_LIDAR, VISIBILITY

STATE_COLORS = {INITIALIZING: "#969ca6", TRACKED: "#009e73", LOST: "#d55e00"}
_WALL = "#e3e6ea"
_WIDTH = 3.6  # of a panel [in]
_MARGIN = 1.0  # of the floor plan around the path [m]


def trajectory_chart(out: Path, scene: str, levels: tuple[str, ...], methods: tuple[str, ...]) -> str:
    """SVG text: a panel per level with the true path and the aligned estimate of the first run of every method."""
    plan = plan_of_tour(out, scene)
    width, height = np.ptp(read_tum(case_of(out, scene, levels[0]) / TRUTH).poses[:, :2], axis=0) + 2 * _MARGIN
    legend = 0.25 * -(-(len(methods) + 1) // 4)
    with Chart(_WIDTH * len(levels), _WIDTH * height / width + 0.4 + legend, f"slam {scene}") as chart:
        axes = chart.figure.subplots(1, len(levels), squeeze=False)[0]
        for axis, level in zip(axes, levels, strict=True):
            _panel(axis, plan, out, scene, level, methods)
            axis.set_title(level, color=INK)
        lines = require("matplotlib.lines")
        handles = [lines.Line2D([], [], color="#222222", linewidth=2.4, label="truth")]
        handles += [lines.Line2D([], [], color=_color(k), label=name) for k, name in enumerate(methods)]
        chart.figure.legend(handles=handles, loc="outside upper left", ncols=min(len(handles), 4), frameon=False)
    return chart.svg


def plan_of_tour(out: Path, scene: str) -> Grid | None:
    """The floor plan of a scene, which is the same at all levels: tours have no clutter of adversity."""
    return plan_of(out, scene, "none")


def visibility(case: Path) -> Array:
    """(n, 3): time [s], visibility [m] and extinction [1/m] at the camera."""
    return np.loadtxt(case / VISIBILITY, delimiter=",", skiprows=1, ndmin=2)


def _color(k: int) -> str:
    return PALETTE[k % len(PALETTE)]


def _panel(axis: Any, plan: Grid | None, out: Path, scene: str, level: str, methods: tuple[str, ...]) -> None:
    if plan is not None:
        colors = require("matplotlib.colors").ListedColormap(["white", _WALL])
        axis.imshow(plan.blocked, origin="lower", extent=plan.extent, cmap=colors, vmin=0, vmax=1, interpolation="nearest")
    case = case_of(out, scene, level)
    truth = read_tum(case / TRUTH)
    axis.plot(truth.poses[:, 0], truth.poses[:, 1], color="#222222", linewidth=2.4, alpha=0.5, rasterized=True)
    for k, name in enumerate(methods):
        method = load_method(name)
        estimate = read_run(out / "runs" / Key(method.name, scene, level, 0).path)
        own_truth = read_tum(case / (TRUTH_LIDAR if method.has_lidar else TRUTH))
        points = aligned(estimate.trajectory, own_truth, method.is_metric)
        if points is not None:
            axis.plot(points[:, 0], points[:, 1], color=_color(k), linewidth=1, rasterized=True)
    low, high = truth.poses[:, :2].min(0) - _MARGIN, truth.poses[:, :2].max(0) + _MARGIN
    axis.set_xlim(low[0], high[0])
    axis.set_ylim(low[1], high[1])
    axis.set_aspect("equal")
    axis.set_xticks([])
    axis.set_yticks([])


def aligned(estimate: Trajectory, truth: Trajectory, is_metric: bool) -> np.ndarray | None:
    """(n, 3): positions of the estimate in the world of the truth; None if it admits no alignment."""
    if len(estimate) < 3:
        return None
    half = float(np.median(np.diff(truth.times))) / 2
    try:
        found = gloam.evaluate(
            (estimate.times, estimate.poses), (truth.times, truth.poses), align="se3" if is_metric else "sim3", max_difference=half
        )["align"]
    except gloam.InputError:
        return None
    turn = np.array(found["rotation_rows"]).reshape(3, 3)
    return np.asarray(found["scale"] * estimate.poses[:, :3] @ turn.T + np.array(found["translation_m"]))


def tracking_chart(out: Path, scene: str, levels: tuple[str, ...], methods: tuple[str, ...]) -> str:
    """SVG text: the extinction by the probe at the camera and, dashed, by the LiDAR, where it has scans in clear air too; the state of
    every frame of the first run, a bar per level and method."""
    rows = [(load_method(name).name, level) for level in levels for name in methods]
    height = 0.22 * len(rows)
    with Chart(9.0, 2.2 + height, f"tracking {scene}") as chart:
        above, axis = chart.figure.subplots(2, 1, sharex=True, height_ratios=[1.4, max(height, 0.5)])
        for level in levels:
            time, _, extinction = visibility(case_of(out, scene, level)).T
            color = LEVEL_COLORS[levels.index(level) % len(LEVEL_COLORS)]
            above.plot(time, extinction, label=level, color=color)
            by_lidar = extinction_of_scans(case_of(out, scene, level), case_of(out, scene, "none"))
            above.plot(*by_lidar.T, color=color, linestyle="--")
        above.set_ylabel("extinction [1/m]")
        above.legend(frameon=False)
        for y, (name, level) in enumerate(rows):
            frames = read_run(out / "runs" / Key(name, scene, level, 0).path).frames
            begin = 0
            for k in range(1, len(frames) + 1):
                if k == len(frames) or frames[k].state != frames[begin].state:
                    end = frames[min(k, len(frames) - 1)].time
                    axis.barh(y, end - frames[begin].time, left=frames[begin].time, height=0.8, color=STATE_COLORS[frames[begin].state])
                    begin = k
        axis.set_yticks(range(len(rows)), [f"{name}, {level}" for name, level in rows])
        axis.invert_yaxis()
        axis.set_xlabel("time [s]")
        patches = require("matplotlib.patches")
        handles = [patches.Patch(color=color, label=state) for state, color in STATE_COLORS.items()]
        chart.figure.legend(handles=handles, loc="outside upper left", ncols=3, frameon=False)
    return chart.svg
