"""A quadruped walks through a burning house: from the fire to the farthest room, then out of the front door.

    ./gloam python examples/tasks/walk_out.py [--seed 3] [--count 10] [--out results/walk_out]

The network sees the gyroscope, gravity and joints only. The route is planned on the plan of the house, and pure pursuit
of the robot's true pose gives the velocity goals. Each seed is another house.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import gloam
import numpy as np
from gloam.navigation.free_space import free_space
from route import Points, Pursuit, bearing, nearest_free, shortest

SPEED, AHEAD, RADIUS = 0.7, 0.45, 0.3  # m/s, m, m: of walking, of pure pursuit, between the route and obstacles
LIMIT = 120.0  # s


class House:
    """Doors, rooms and the route of a generated house."""

    def __init__(self, scene: gloam.Scene) -> None:
        world = scene.compile()
        movable = {i for i, name in enumerate(world.bodies) if name.startswith("go/") or name == "bin"}
        self.space = free_space(world, movable, RADIUS, heights=(0.03, 0.5), cell=0.05)
        with gloam.Simulation(world) as sim:
            names = [name[: -len("/leaf")] for name in world.bodies if name.endswith("/leaf")]
            doors = [sim.bodies[name].pose for name in names]
        beyond = [door.p + 1.2 * door.R[:, 0] for door in doors]  # x of a door points out of the hall
        last = int(np.argmax([np.linalg.norm(nearest_free(self.space, point) - point[:2]) for point in beyond]))
        front = doors[last]
        self.front_leaf = names[last] + "/leaf"
        self.outward = front.R[:, 0]
        rooms = [nearest_free(self.space, point) for i, point in enumerate(beyond) if i != last]
        rooms.sort(key=lambda room: float(np.linalg.norm(room - front.p[:2])))
        self.start, self.fire = rooms[0], self._in_view_of(rooms[0])
        inside, garden = ((front.p + ahead * self.outward)[:2] for ahead in (-1.5, 1.2))
        self.to_room = shortest(self.space, self.start, rooms[-1])
        self.to_exit = np.vstack([shortest(self.space, rooms[-1], inside), np.linspace(inside, garden, 60)])

    def _in_view_of(self, start: Points) -> Points:
        """The farthest free point within 3.5 m to which the way is straight, so it is in the same room."""
        field = self.space.distances(start)
        points, lengths = self.space.middles(field < 3.5), field[field < 3.5]
        straight = lengths < 1.09 * np.linalg.norm(points - start, axis=1)
        return np.asarray(points[straight][np.argmax(lengths[straight])])


def prepare(seed: int) -> tuple[gloam.Scene, House]:
    """The scene with the house of a seed, and the burning bin and the robot in its first room."""
    scene = gloam.Scene(Path(__file__).with_name("house_fire.toml"))
    scene["environment.house.seed"] = seed
    house = House(scene)
    (x, y), (u, v) = house.start, house.fire
    angle = np.arctan2(v - y, u - x)
    scene["object.bin.position"] = [u, v, 0]
    scene["fire.paper.position"] = [u, v, 0.48]
    scene["robot.go.position"] = [x, y, 0]
    scene["robot.go.orientation"] = [np.cos(angle / 2), 0, 0, np.sin(angle / 2)]
    return scene, house


def follow(sim: gloam.Simulation, metrics: gloam.MetricStream, route: Points) -> bool:
    """Walks along a route; False: fell, or ran out of time."""
    dog, pursuit = sim.robots["go"], Pursuit(route, AHEAD)
    while np.linalg.norm(dog.pose.p[:2] - route[-1]) > 0.3:
        error = bearing(dog.pose, pursuit.target(dog.pose.p))
        dog.command(vx=SPEED * max(0.0, np.cos(error)) ** 3, yaw_rate=float(np.clip(2.5 * error, -1.2, 1.2)))
        sim.run_until(time=sim.time + 0.1)
        if metrics.latest()["go.fallen"] > 0 or sim.time > LIMIT:
            return False
    return True


def walk(seed: int, out: Path) -> dict[str, float]:
    """One run, recorded in out/SEED.mcap."""
    scene, house = prepare(seed)
    with gloam.load(scene) as sim:
        front = sim.bodies[house.front_leaf]
        metrics = sim.open_metrics()  # falls count from here on
        with sim.record(out / f"{seed}.mcap", ["/clock", "/tf*"], overwrite=True, embed=True):
            sim.run_until(time=4)  # the smoke spreads
            is_out = follow(sim, metrics, house.to_room)
            front.push(force=-60 * house.outward)  # N: someone pushes the front door open from outside
            is_out = is_out and follow(sim, metrics, house.to_exit)
            sim.robots["go"].command()
            sim.run_until(time=sim.time + 0.5)
        return {"seed": seed, "out": is_out, "time": sim.time, "hash": sim.hash, **metrics.latest()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=3, help="of the first house")
    parser.add_argument("--count", type=int, default=1, help="of houses")
    parser.add_argument("--out", type=Path, default=Path("results/walk_out"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for seed in range(arguments.seed, arguments.seed + arguments.count):
        print(walk(seed, arguments.out), flush=True)


if __name__ == "__main__":
    main()
