#!/usr/bin/env python3
"""Flight of the quadrotor with the controller "quadrotor", as JSON. `./gloam python bench/flight.py`

Rise time (10 to 90 %) and overshoot of a step of 1 m, the error of hovering in still air and in gusty wind, with the catalogue's models of motors,
propellers and battery and without them, and the power of hovering. All in simulation time: the figures do not depend on the machine.
"""
from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

import gloam

ROOT = Path(gloam.home())
HEIGHT = 10  # at which wind speeds are defined [m]


def scene(waypoints: list[dict], weather: dict | None = None, *, motors: bool = True) -> dict:
    robot = {
        "name": "drone",
        "model": "quadrotor",
        "position": [0, 0, HEIGHT],
        "controller": {"flight": {"waypoints": waypoints}},
    }
    if not motors:
        robot["actuator"] = []
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


def step_response(axis: int, *, motors: bool = True) -> dict:
    """Of a step of 1 m along an axis, after two seconds at rest."""
    base = [0.0, 0.0, HEIGHT]
    target = [*base]
    target[axis] += 1
    path = flown(scene([{"position": base, "hold": 2}, {"position": target}], motors=motors), 12)[:, axis] - base[axis]
    settled = next(i for i in range(len(path)) if np.abs(path[i:i + 100]).max() < 0.02)  # at the first waypoint
    path = path[settled:]
    rise = (np.argmax(path > 0.9) - np.argmax(path > 0.1)) / 100
    return {"rise_s": float(rise), "overshoot_percent": float(max(0.0, path.max() - 1) * 100)}


def hover_error(weather: dict | None) -> dict:
    """Root mean square and largest distance from the place of hovering over a minute, after ten seconds [m]."""
    base = [0, 0, HEIGHT]
    away = np.linalg.norm(flown(scene([{"position": base}], weather), 70)[1000:] - base, axis=1)
    return {"rms_m": float(math.sqrt(np.mean(away**2))), "max_m": float(away.max())}


def hover_power() -> dict:
    """Electrical power of hovering, and the ideal power T^1.5 / sqrt(2 rho A) of the rotors by momentum theory [W]."""
    sim = gloam.load(scene([]))
    sim.run_until(5)
    mass, radius, density = 1.325, 0.13, 1.225  # assets/robots/quadrotor
    ideal = (mass * 9.81) ** 1.5 / math.sqrt(2 * density * 4 * math.pi * radius**2)
    power = sim.robots["drone"].battery["power"]
    return {"power_W": power, "ideal_W": ideal, "minutes_of_82_Wh": 82 / power * 60}


if __name__ == "__main__":
    print(json.dumps({
        "step_forward": step_response(0),
        "step_up": step_response(2),
        "step_forward_without_motors": step_response(0, motors=False),
        "hover_still": hover_error(None),
        "hover_gusts_8": hover_error({"wind": 8, "gusts": 0.15}),
        "hover_gusts_12": hover_error({"wind": 12, "gusts": 0.2}),
        "hover_power": hover_power(),
    }))
