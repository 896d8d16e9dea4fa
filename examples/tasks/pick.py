"""An arm picks ten objects of the catalogue off a table and drops them into a bin, guided by a depth camera.

./gloam python examples/tasks/pick.py [--seeds 50] [--first 0] [--overlay pick_dust.toml] [--log pick.mcap]
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path

import numpy as np

import gloam

OBJECTS = ("mug_1", "mug_2", "bottle", "flask", "wine", "soap", "remote", "block", "ball_1", "vase")
TABLE = 0.745  # height of its top [m]
BIN = np.array([0.3, 0.62])  # its middle
PAD = 0.022  # from the point between the pads to the tips of the fingers [m]
OPEN = 0.0425  # of each finger [m]


def scatter(sim: gloam.Simulation, rng: np.random.Generator) -> None:
    """Puts the objects at random places of the table within reach, 0.14 m apart, turned by random angles."""
    placed: list[np.ndarray] = []
    while len(placed) < len(OBJECTS):
        placed = []
        for _ in range(1000):
            radius, angle = np.sqrt(rng.uniform(0.34**2, 0.68**2)), rng.uniform(-1.25, 0.2)
            place = radius * np.array([np.cos(angle), np.sin(angle)])
            if len(placed) < len(OBJECTS) and all(np.linalg.norm(place - other) > 0.14 for other in placed):
                placed.append(place)
    for name, place in zip(OBJECTS, placed):
        sim.joints[name].set([*place, TABLE + 0.001, *gloam.yaw_quaternion(rng.uniform(-np.pi, np.pi))])


def look(sim: gloam.Simulation) -> dict[str, np.ndarray]:
    """The points of each object that the camera measures, in the world, (n, 3)."""
    frame = sim.cameras["above"].render(("sensor_depth", "segmentation"))
    names = {label.instance: label.body for label in sim.labels()}
    v, u = np.nonzero(frame.sensor_depth)
    depth, ids = frame.sensor_depth[v, u], frame.ids[v, u]
    x, y = (u + 0.5 - frame.K[0, 2]) / frame.K[0, 0], (v + 0.5 - frame.K[1, 2]) / frame.K[1, 1]
    p_C = np.stack([x * depth, -y * depth, -depth], axis=1)
    p_W = p_C @ frame.X_WC[:3, :3].T + frame.X_WC[:3, 3]
    on_table = (p_W[:, 1] < 0.3) & (p_W[:, 2] > TABLE - 0.03)
    seen = {names.get(i, ""): p_W[(ids == i) & on_table] for i in np.unique(ids)}
    return {name: seen[name] for name in OBJECTS if len(seen.get(name, ())) >= 30}


def grasp(points: np.ndarray, again: bool) -> tuple[np.ndarray, float]:
    """Point between the pads, and direction in which they close: across the longer axis of the object's top, or, in a
    second try, along it, where it fits between the fingers."""
    top = np.percentile(points[:, 2], 95)
    high = points[points[:, 2] > top - 0.035, :2]
    axes = np.linalg.eigh(np.cov((high - high.mean(axis=0)).T))[1]  # of increasing extent
    along = (high - high.mean(axis=0)) @ axes
    low, up = np.percentile(along, [2, 98], axis=0)
    center = high.mean(axis=0) + axes[:, 0] * (low + up)[0] / 2
    closing = axes[:, 1 if again and (up - low)[1] < 0.07 else 0]
    return np.array([*center, max(top - 0.028, TABLE + PAD + 0.002)]), float(np.arctan2(closing[1], closing[0]))


class Arm:
    """The arm with its gripper pointing down."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self.sim, self.robot = sim, sim.robots["arm"]
        self.position, self.yaw = np.array([0.49, 0.13, 1.09]), np.pi / 2  # as in the keyframe

    def go(self, position: np.ndarray, yaw: float | None = None, speed: float = 0.6) -> None:
        """Moves along a straight line, starting and ending at rest."""
        start, turned = self.position, self.yaw
        goal = self.yaw if yaw is None else yaw
        ticks = int(50 * max(np.linalg.norm(position - start) / speed, abs(goal - turned) / 2)) + 10
        for s in np.linspace(0, 1, ticks):
            s = s * s * (3 - 2 * s)
            self.position, self.yaw = start + s * (position - start), turned + s * (goal - turned)
            half = self.yaw / 2
            self.robot.set_pose_goal((self.position, [0, np.cos(half), np.sin(half), 0]))
            self.wait(0.02)
        self.wait(0.25)

    def grip(self, opening: float) -> None:
        self.robot.set_joint_goals({"left_finger_joint": opening})
        self.wait(0.6)

    def wait(self, seconds: float) -> None:
        self.sim.run_until(time=self.sim.time + seconds)

    def holds(self) -> bool:
        return self.robot.joints["left_finger_joint"].position > 0.002

    def nearest(self, direction: float, place: np.ndarray) -> float:
        """The angle of the gripper that closes along `direction` and turns the wrist least."""
        natural = np.pi / 2 + np.arctan2(place[1], place[0])
        return direction + np.pi * np.round((natural - direction) / np.pi)


def pick(arm: Arm, points: np.ndarray, again: bool) -> str:
    """Brings one object to the bin; how that ended."""
    place, direction = grasp(points, again)
    yaw = arm.nearest(direction, place)
    above = np.array([0, 0, 0.12])
    arm.go(place + above, yaw)
    arm.go(place, speed=0.3)
    arm.grip(0.0)
    arm.go(place + above, speed=0.3)
    if not arm.holds():
        arm.grip(OPEN)
        return "missed"
    release = np.array([*BIN, 0.64 + place[2] - TABLE])
    arm.go(release + [0, -0.02, 0.08], arm.nearest(yaw, release))
    held = arm.holds()
    arm.go(release, speed=0.3)
    arm.grip(OPEN)
    arm.go(release + [0, 0, 0.1])
    return "in the bin" if held else "dropped"


def clear_table(sim: gloam.Simulation, seed: int) -> dict[str, tuple[str, int]]:
    """Each object's end, and the number of grasps that it took."""
    scatter(sim, np.random.default_rng(seed))
    arm = Arm(sim)
    arm.go(np.array([0.3, 0.55, 1.25]))
    tries: Counter[str] = Counter()
    ends: dict[str, str] = {}
    while candidates := {name: points for name, points in look(sim).items() if tries[name] < 2}:
        name = max(candidates, key=lambda n: np.arctan2(*candidates[n].mean(axis=0)[1::-1]))  # nothing stands before the bin
        tries[name] += 1
        ends[name] = pick(arm, candidates[name], again=tries[name] > 1)
    result = {}
    for name in OBJECTS:
        p = sim.bodies[name].pose.p
        inside = bool(np.all(np.abs(p[:2] - BIN) < [0.2, 0.3]) and 0.4 < p[2] < 0.75)
        result[name] = ("in the bin" if inside else ends.get(name, "not seen").replace("in the bin", "missed the bin"), tries[name])
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--overlay", help="a scene file that changes pick.toml")
    parser.add_argument("--log", type=Path, help="of the first seed")
    arguments = parser.parse_args()
    folder = Path(__file__).parent
    scene = gloam.Scene(folder / "pick.toml")
    world = (scene.overlay(folder / arguments.overlay) if arguments.overlay else scene).compile()
    first_try, ends = Counter[str](), {name: Counter[str]() for name in OBJECTS}
    for seed in range(arguments.first, arguments.first + arguments.seeds):
        with gloam.Simulation(world, seed=seed) as sim:
            log = sim.record(arguments.log, ["/clock", "/tf*"], overwrite=True) if arguments.log and seed == arguments.first else nullcontext()
            with log:
                result = clear_table(sim, seed)
            for name, (end, tries) in result.items():
                ends[name][end] += 1
                first_try[name] += end == "in the bin" and tries == 1
            print(f"seed {seed}: {sum(end == 'in the bin' for end, _ in result.values())} of {len(OBJECTS)}, "
                  f"{sim.time:.0f} s, hash {sim.hash:016x}", flush=True)
    for name, counts in ends.items():
        print(f"{name:8} first try {first_try[name]:3}, " + ", ".join(f"{end} {n}" for end, n in sorted(counts.items())))
    total = sum(counts["in the bin"] for counts in ends.values())
    print(f"{total} of {len(OBJECTS) * arguments.seeds} objects are in the bin, {sum(first_try.values())} at the first try")


if __name__ == "__main__":
    main()
