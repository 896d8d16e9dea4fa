#!/usr/bin/env python3
"""Flight of the quadrotor with the controller "quadrotor", as JSON. `./gloam python bench/flight.py`

Rise time (10 to 90 %) and overshoot of a step of 1 m, and the error of hovering in still air and in gusty wind. All in simulation time: the figures
do not depend on the machine.
"""
from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

import gloam

ROOT = Path(gloam.home())
HEIGHT = 10  # at which wind speeds are defined [m]


def scene(waypoints: list[dict], weather: dict | None = None) -> dict:
    robot = {
        "name": "drone",
        "model": "quadrotor",
        "position": [0, 0, HEIGHT],
        "controller": {"flight": {"waypoints": waypoints}},
    }
    return {"robot": [robot]} | ({"weather": weather} if weather else {})


def flown(tables: dict, seconds: float, seed: int = 1) -> np.ndarray:
    """Positions of the vehicle at 100 Hz [m], (n, 3)."""
    sim = gloam.load(tables, seed=seed)
    body = sim.bodies["drone/frame"]
    path = []
    for step in range(int(seconds * 100)):
        sim.run_until((step + 1) / 100)
        path.append(body.pose.p.copy())
    return np.array(path)


def step_response(axis: int) -> dict:
    """Of a step of 1 m along an axis, after two seconds at rest."""
    base = [0.0, 0.0, HEIGHT]
    target = [*base]
    target[axis] += 1
    path = flown(scene([{"position": base, "hold": 2}, {"position": target}]), 12)[:, axis] - base[axis]
    settled = next(i for i in range(len(path)) if np.abs(path[i:i + 100]).max() < 0.02)  # at the first waypoint
    path = path[settled:]
    rise = (np.argmax(path > 0.9) - np.argmax(path > 0.1)) / 100
    return {"rise_s": float(rise), "overshoot_percent": float(max(0.0, path.max() - 1) * 100)}


def hover_error(weather: dict | None) -> dict:
    """Root mean square and largest distance from the place of hovering over a minute, after ten seconds [m]."""
    base = [0, 0, HEIGHT]
    away = np.linalg.norm(flown(scene([{"position": base}], weather), 70)[1000:] - base, axis=1)
    return {"rms_m": float(math.sqrt(np.mean(away**2))), "max_m": float(away.max())}


if __name__ == "__main__":
    print(json.dumps({
        "step_forward": step_response(0),
        "step_up": step_response(2),
        "hover_still": hover_error(None),
        "hover_gusts_8": hover_error({"wind": 8, "gusts": 0.15}),
        "hover_gusts_12": hover_error({"wind": 12, "gusts": 0.2}),
    }, indent=1))
