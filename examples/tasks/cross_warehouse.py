"""A mobile base crosses a warehouse among people and carts, and touches nobody.

    ./gloam python examples/tasks/cross_warehouse.py [--seed 1] [--count 10] [--level none] [--out results/cross_warehouse]

The route is planned on the plan of the empty hall. Everything that the base avoids, it sees by its LiDAR; its true pose
stands for localisation. Each seed is another crowd, start and goal.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import gloam
import numpy as np
from dynamic_window import RADIUS, DynamicWindow
from gloam.navigation.free_space import free_space
from route import Points, Pursuit, bearing, shortest

LIDAR_AT = np.array([-0.045, 0.0])  # in the base's frame [m]
SIGHT, AHEAD, LIMIT = 4.0, 1.2, 150.0  # m of obstacles, m of pursuit, s for a run


class Patience:
    """After 3 s in one place, as before a vehicle that waits too, the base drives back for 4 s and lets it pass."""

    def __init__(self, position: Points) -> None:
        self._place, self._since, self._until = position, 0.0, 0.0

    def is_at_end(self, position: Points, time: float) -> bool:
        if np.linalg.norm(position - self._place) > 0.25:
            self._place, self._since = position, time
        if time - self._since > 3.0:
            self._since, self._until = time + 4.0, time + 4.0
        return time < self._until


class People:
    """The distances of the people's legs from the base, which it does not know."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self._sim = sim
        owner = np.array(sim.memory.array("geom_bodyid"))
        solid = np.array(sim.memory.array("geom_contype")) > 0
        people = [i for i, name in enumerate(sim.world.bodies) if name.startswith("worker") or name.startswith("people")]
        self._geoms = np.flatnonzero(np.isin(owner, people) & solid)
        self._size = np.array(sim.memory.array("geom_size"))[self._geoms]

    def nearest(self, position: Points) -> float:
        """From the base's shell to the nearest leg, over the floor [m]."""
        middle = np.array(self._sim.memory.array("geom_xpos"))[self._geoms]
        axis = np.array(self._sim.memory.array("geom_xmat")).reshape(-1, 3, 3)[self._geoms, :, 2]
        along = np.linspace(-1, 1, 9)[:, None, None] * self._size[:, 1, None] * axis
        points = middle + along
        gap = np.linalg.norm(points[..., :2] - position[:2], axis=2) - self._size[:, 0] - RADIUS
        return float(np.where(points[..., 2] < 0.4, gap, np.inf).min())


def prepare(seed: int, level: str) -> tuple[gloam.Scene, Points]:
    """The scene with the crowd, start and goal of a seed, and the route on the plan of the empty hall."""
    scene = gloam.Scene(Path(__file__).with_name("crowded_warehouse.toml"))
    empty = gloam.Scene.from_dict({"environment": {"warehouse": dict(scene["environment.warehouse"])}})
    space = free_space(empty.compile(), (), 0.35, heights=(0.03, 0.5))
    rng = np.random.default_rng(seed)
    left = space.origin[0] + space.cell * np.arange(space.blocked.shape[1])
    ends = []
    for within in (left < left[0] + 3.0, left > left[-1] - 3.0):
        ends.append(space.sample(rng, np.where(within, 0.0, np.inf)[None] * np.ones(space.blocked.shape)))
    route = shortest(space, *ends)
    scene["crowd.worker.seed"] = seed
    scene["robot.base.position"] = [*route[0], 0]
    if level != "none":
        scene["adversity.level"] = level
    return scene, route


def cross(seed: int, level: str, out: Path) -> dict[str, float]:
    """One run, recorded in out/LEVEL_SEED.mcap."""
    scene, route = prepare(seed, level)
    with gloam.load(scene, seed=seed) as sim:
        base, people = sim.robots["base"], People(sim)
        lidar = sim.lidars["scan"].open()
        pursuit, window, patience = Pursuit(route, AHEAD), DynamicWindow(0.2), Patience(route[0])
        nearest = np.inf
        metrics = sim.open_metrics()  # contacts count from here on
        with sim.record(out / f"{level}_{seed}.mcap", ["/clock", "/tf*"], overwrite=True, embed=True):
            while np.linalg.norm(base.pose.p[:2] - route[-1]) > 0.3 and sim.time < LIMIT:
                points, turn = sim.step_until(lidar).points[:, :2] + LIDAR_AT, base.pose.R[:2, :2]
                points = points[np.linalg.norm(points, axis=1) < SIGHT]
                moving = window.velocities(base.pose.p[:2] + points @ turn.T) @ turn
                angle = bearing(base.pose, pursuit.target(base.pose.p))
                if patience.is_at_end(base.pose.p[:2], sim.time):
                    angle += np.pi
                v, w = window.choose(points, moving, AHEAD * np.array([np.cos(angle), np.sin(angle)]))
                base.command(vx=v, yaw_rate=w)
                nearest = min(nearest, people.nearest(base.pose.p))
        is_there = bool(np.linalg.norm(base.pose.p[:2] - route[-1]) <= 0.3)
        contacts = metrics.latest()["base.collisions"]
        numbers = {"contacts": contacts, "nearest": nearest, "time": sim.time, "hash": sim.hash}
        return {"seed": seed, "there": is_there, **numbers}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1, help="the first one")
    parser.add_argument("--count", type=int, default=1, help="of seeds")
    parser.add_argument("--level", choices=("none", "minor", "major"), default="none", help="of adversity")
    parser.add_argument("--out", type=Path, default=Path("results/cross_warehouse"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for seed in range(arguments.seed, arguments.seed + arguments.count):
        print(cross(seed, arguments.level, arguments.out), flush=True)


if __name__ == "__main__":
    main()
