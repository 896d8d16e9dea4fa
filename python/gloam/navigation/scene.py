"""Planners of scenes: the table [planner], and its run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gloam

from .driver import Driver, Rig
from .planner import Planner, Task, make_planner
from .topological_map import TopologicalMap


def planner_of(scene: gloam.Scene, allow_programs: bool = False) -> Planner:
    """The planner of a scene's [planner]. allow_programs: whether the scene may start a program, load a library and
    connect to another machine. Errors: UsageError without a planner, and for one that is not allowed; as make_planner().
    """
    table = _table(scene)
    if not allow_programs and (deed := _deed(table)):
        raise gloam.UsageError(
            f"[planner] of scene '{scene.name}' {deed}, which is not allowed",
            hint="if you trust the scene: --allow-programs, in Python allow_programs=True",
        )
    options: dict[str, Any] = {key: table[key] for key in ("command", "address") if table.get(key)}
    options |= {key: _resolved(scene, table[key]) for key in ("weights", "library") if table.get(key)}
    planner = make_planner(table["type"], **options)
    if table.get("rate"):
        planner.rate = float(table["rate"])
    if table.get("latency", -1.0) >= 0:
        planner.latency = float(table["latency"])
    return planner


def task_of(scene: gloam.Scene, world: gloam.World) -> Task:
    """The task of a scene's planner: the first [[goal]] of its robot, and its map. Errors: UsageError."""
    table = _table(scene)
    robot = rig_of(scene, world).robot
    goals = [goal for goal in _tables(scene).get("goal", []) if goal.get("robot", robot) == robot]
    goal = goals[0] if goals else None
    map_ = TopologicalMap.load(_resolved(scene, table["map"])) if table.get("map") else None
    if map_ is not None:
        map_.check_scene(world)
    return Task(
        robot,
        int(scene["sim.seed"]),
        None if goal is None else (float(goal["position"][0]), float(goal["position"][1])),
        map_,
        world,
        float(table.get("top_speed", 0.4)),
        float(goal.get("radius", 0.5)) if goal else 0.5,
    )


def rig_of(scene: gloam.Scene, world: gloam.World) -> Rig:
    """The parts of the robot that the planner uses: as [planner] names them, or the first ones. Errors: as Rig.of()."""
    table = _table(scene)
    return Rig.of(world, *(table.get(part) or "" for part in ("robot", "camera", "lidar")))


def drive(sim: gloam.Simulation, until: float, allow_programs: bool = False) -> Driver:
    """Runs a simulation until the time [s] with the planner of its scene. Returns the closed driver, with its
    statistics. Errors: as planner_of(), task_of() and Driver.run()."""
    rig = rig_of(sim.scene, sim.world)
    planner = planner_of(sim.scene, allow_programs)
    try:
        driver = Driver(sim, rig, planner)
    except gloam.Error:
        planner.close()
        raise
    try:
        driver.run(task_of(sim.scene, sim.world), until)
    finally:
        driver.close()
    return driver


def _deed(table: dict[str, Any]) -> str:
    """The action of a planner that needs permission: it loads code, starts a program or connects to another machine; "" = none."""
    if table.get("library"):
        return f"loads the library {table['library']}"
    if table.get("command"):
        return f"starts the program '{table['command']}'"
    address = str(table.get("address", ""))
    host = address.removeprefix("tcp://").rpartition(":")[0]
    if address.startswith("tcp://") and host not in ("127.0.0.1", "localhost", "[::1]"):
        return f"connects to {address}"
    return ""


def _tables(scene: gloam.Scene) -> dict[str, Any]:
    import tomllib

    return tomllib.loads(scene.to_toml())


def _table(scene: gloam.Scene) -> dict[str, Any]:
    table = _tables(scene).get("planner")
    if table is None:
        raise gloam.UsageError(f"scene '{scene.name}' has no [planner]", hint='add [planner] with a type, such as "route"')
    return dict(table)


def _resolved(scene: gloam.Scene, path: str) -> Path:
    return scene.file.parent / path
