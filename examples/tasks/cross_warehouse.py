"""A mobile base crosses a warehouse among people and carts, and touches nobody and nothing.

    ./gloam python examples/tasks/cross_warehouse.py [--seed 1] [--count 10] [--level none] [--out results/cross_warehouse]

The route is planned on the plan of the empty hall. Everything that the base avoids, it sees by its LiDAR; its true pose
stands for localisation. Each seed is another crowd, start and goal.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import gloam
import numpy as np
from gloam.envs.free_space import FreeSpace
from route import Points, Pursuit, bearing, shortest

RADIUS, MARGIN = 0.18, 0.15  # of the base, and kept from everything [m]
SPEED, BACK, TURN = 0.6, 0.3, 1.8  # largest commands [m/s, m/s, rad/s]
NOISE, TREND = 0.07, 1.2  # m between scans that are errors; s for which motions continue
BRAKE, TURN_UP = 0.8, 5.0  # used of the drive's accelerations [m/s², rad/s²]
LIDAR_AT = np.array([-0.045, 0.0])  # in the base's frame [m]
HORIZON, SIGHT, AHEAD, LIMIT = 2.0, 4.0, 1.2, 150.0  # s of prediction, m of obstacles and of pursuit, s for a run


class DynamicWindow:
    """Fox, Burgard and Thrun, "The dynamic window approach to collision avoidance" (1997).

    Of the velocities that the drive can reach before the next scan, and from which it can brake before an obstacle, it
    takes the one with the best sum of heading, clearance and speed.
    """

    def __init__(self, interval: float) -> None:
        self._interval = interval  # between scans [s]
        self._last = np.zeros(2)  # v, w
        self._seen: Points | None = None  # the previous scan, in the world

    def velocities(self, points: Points) -> Points:
        """Of points in the world [m/s]: each came from the nearest point of the previous scan, or stands still."""
        seen = self._seen if self._seen is not None else points
        self._seen = points
        moved = points[:, None] - seen[None]
        moved = moved[np.arange(len(points)), np.argmin(np.linalg.norm(moved, axis=2), axis=1)]
        length = np.linalg.norm(moved, axis=1, keepdims=True)
        return np.where((length > NOISE) & (length < 2.0 * self._interval), moved / self._interval, 0.0)

    def choose(self, obstacles: Points, moving: Points, target: Points) -> tuple[float, float]:
        """Speed [m/s] and yaw rate [rad/s] towards `target` among `obstacles` that move, in the base's frame."""
        reach = self._interval * np.array([BRAKE, TURN_UP])
        low = np.maximum(self._last - reach, [-BACK, -TURN])
        high = np.minimum(self._last + reach, [SPEED, TURN])
        v, w = (grid.ravel() for grid in np.meshgrid(np.linspace(low[0], high[0], 7), np.linspace(low[1], high[1], 15)))
        t = np.linspace(0.1, HORIZON, 14)[:, None]
        turned = w * t
        x = v * t * np.sinc(turned / (2 * np.pi)) * np.cos(turned / 2)  # chords of the arcs, (times, candidates)
        y = v * t * np.sinc(turned / (2 * np.pi)) * np.sin(turned / 2)
        there = obstacles + np.minimum(t, TREND)[..., None] * moving  # (times, points, 2)
        gap = np.hypot(x[..., None] - there[:, None, :, 0], y[..., None] - there[:, None, :, 1]).min(axis=2) - RADIUS
        now = np.linalg.norm(obstacles, axis=1).min() - RADIUS
        hits = gap < min(MARGIN, 0.8 * now)
        time_left = np.where(hits.any(axis=0), t[np.argmax(hits, axis=0), 0] - 0.1, np.inf)
        admissible = np.abs(v) <= 2 * BRAKE * np.maximum(time_left - self._interval, 0)
        heading = np.arctan2(target[1] - y[7], target[0] - x[7]) - turned[7]
        score = 0.8 * np.cos(heading) + 0.7 * np.minimum(gap.min(axis=0), 0.6) + 0.8 * v
        best = int(np.argmax(np.where(admissible | (v == 0), score, -np.inf)))
        self._last = np.array([v[best], w[best]])
        if not admissible.any():  # it brakes as hard as it can
            self._last = np.array([low[0], 0.0])
        return float(self._last[0]), float(self._last[1])


class Patience:
    """After 3 s in one place, as before a vehicle that waits too, the base drives back for 4 s to let the other pass."""

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
    space = FreeSpace.of(empty.compile(), (), 0.35, heights=(0.03, 0.5))
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
        sim.metrics  # from here on they count
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
        contacts = sim.metrics["base.collisions"]
        return {"seed": seed, "there": is_there, "contacts": contacts, "nearest": nearest, "time": sim.time, "hash": sim.hash}


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
