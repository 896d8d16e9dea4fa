"""Measures an episode of the navigation benchmark from its log alone, independently of gloam.navigation.

The scene and the commands of the log are stepped again; the state hash at the end, which covers all steps, shows that the
motion is that of the episode. Definitions are those of docs/navigation.md.
"""

from __future__ import annotations

import csv
import json
import math
import re
import tempfile
from pathlib import Path
from typing import Any

import gloam

START = 1.0  # the robot stands before an episode begins [s]
PERIOD = 0.05  # between two measurements [s]
RADIUS = 1.0  # of the goal [m]


def measure(log: Path, goal: list[float], limit: float) -> dict[str, Any]:
    """outcome, time [s], path_length [m], final_distance [m], collisions, collisions_by_object, hash.

    goal: (x, y) [m]; limit: time limit [s]. outcome: "success", "fell", "stayed" (stuck, collided or lost: which of them
    depends on the planner's reason) or "timed_out".
    """
    commands = _commands(log)
    places: list[tuple[float, float]] = []
    touched: dict[str, float] = {}
    touches: list[str] = []
    outcome, length, step = "timed_out", 0.0, 0
    end = float(gloam.replay(log).duration)
    with gloam.replay(log).at(0.0) as sim:
        while (now := START + (len(places) + 1) * PERIOD) <= end + 1e-6:
            step = _run(sim, commands, step, now)
            x, y, _ = (float(v) for v in sim.robots["go"].pose.p)
            length += math.dist(places[-1], (x, y)) if places else 0.0
            places.append((x, y))
            for other in _touching(sim):
                if sim.time - touched.get(other, -1.0) > 0.5:
                    touches.append(_kind(other))
                touched[other] = sim.time
            outcome = _ended(sim, places, goal)
            if outcome:
                break
        _run(sim, commands, step, end)
        if not outcome:
            outcome = "timed_out" if end >= START + limit - PERIOD else "unfinished"
        return {
            "outcome": outcome,
            "time": len(places) * PERIOD,
            "path_length": length,
            "final_distance": math.dist(places[-1], goal),
            "collisions": len(touches),
            "collisions_by_object": {name: touches.count(name) for name in touches},
            "hash": f"{sim.hash:#018x}",
        }


def measured(episode: dict[str, Any], log: Path) -> dict[str, Any]:
    """An episode.json with the values that the log gives. Values that the log does not have stay: the shortest path, the
    planner's answers, costs. AssertionError if the log is not of this episode."""
    if episode["outcome"] == "error":  # a program failed before the robot moved
        distance = math.dist(episode["start"][:2], episode["goal"])
        nothing = {"time": 0.0, "path_length": 0.0, "collisions": 0, "collisions_by_object": {}, "final_distance": distance}
        return {**episode, **nothing, "success": False}
    place = _commands(log)[0]["qpos"]
    assert math.dist(place[:2], episode["start"][:2]) < 1e-9, "the log begins elsewhere"
    values = measure(log, episode["goal"], episode["limit"])
    assert values.pop("hash") == episode["hash"], "the log ends in another state"
    assert episode["shortest"] > math.dist(episode["start"][:2], episode["goal"]) - 0.2, "shorter than the straight line"
    if values["outcome"] == "stayed":
        assert episode["outcome"] in ("stuck", "collided", "lost"), episode["outcome"]
        values["outcome"] = episode["outcome"]
    return {**episode, **values, "success": values["outcome"] == "success"}


def _commands(log: Path) -> list[dict[str, Any]]:
    with tempfile.TemporaryDirectory() as folder:
        gloam.replay(log).export("/gloam/commands", Path(folder) / "commands.csv")
        with open(Path(folder) / "commands.csv", newline="", encoding="utf-8") as file:
            return [json.loads(row["data"]) for row in csv.DictReader(file)]


def _run(sim: gloam.Simulation, commands: list[dict[str, Any]], step: int, until: float) -> int:
    """Steps on to a time [s], and gives each command at its step. Returns the number of steps since the start."""
    timestep = float(sim.world.timestep)
    last = round(until / timestep)
    while step < last:
        while commands and commands[0]["step"] <= step:
            _apply(sim, commands.pop(0))
        following = min(last, commands[0]["step"]) if commands else last
        sim.step(following - step)
        step = following
    return step


def _apply(sim: gloam.Simulation, command: dict[str, Any]) -> None:
    robot = sim.robots["go"]
    if command["command"] == "set_joint_state":
        robot.place(command["qpos"][:3], quat=command["qpos"][3:])
    elif command["command"] == "set_velocity_goal":
        robot.command(command["vx"], command["vy"], command["yaw_rate"])
    else:
        raise AssertionError(f"the benchmark gives no such command: {command}")


def _touching(sim: gloam.Simulation) -> list[str]:
    """Bodies of other things that the robot touches, above the floor's clutter and not from above."""
    found = []
    for contact in sim.contacts():
        robot, other = sorted(contact.geoms, key=lambda name: not name.startswith("go/"))
        inside = other.startswith("go/") or not robot.startswith("go/")
        level = float(contact.normal[2]) ** 2 > 0.5
        pushes = any(float(v) != 0.0 for v in contact.force)
        if not inside and not level and pushes and float(contact.position[2]) >= 0.05:
            found.append("/".join(other.split("/")[:-1]) or other)
    return found


def _kind(body: str) -> str:
    """living/chair_2 -> chair, people3 -> people."""
    name = body.split("/")[-1]
    return re.sub(r"_*\d+$", "", name) or name


def _ended(sim: gloam.Simulation, places: list[tuple[float, float]], goal: tuple[float, float]) -> str:
    if math.dist(places[-1], goal) < RADIUS:
        return "success"
    if float(sim.robots["go"].pose.R[2][2]) < 0.5:  # tilted by more than 60 degrees
        return "fell"
    recent = places[-1 - round(15.0 / PERIOD) :]  # 15 s have one instant more than intervals
    is_long = len(recent) > round(15.0 / PERIOD)
    return "stayed" if is_long and max(math.dist(place, places[-1]) for place in recent) < 0.25 else ""
