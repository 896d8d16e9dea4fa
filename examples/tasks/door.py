"""A quadruped with an arm opens a door: it finds the lever, turns it, leans forward, and pushes the leaf open.

./gloam python examples/tasks/door.py [--seeds 20] [--first 0] [--log door.mcap]
"""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

import gloam

HINGE = np.array([0.112, 0.7275, 0])  # from the middle of the lever's bar, as on the door's drawing [m]
AXLE = np.array([0, -0.0625, 0])  # of the lever, likewise
LINK = 0.35  # thigh and calf [m]
OPEN = 0.04  # of each finger [m]
UP = np.array([0.0, 0.0, 1.0])


def turn(axis: ArrayLike, angle: float) -> np.ndarray:
    """Rotation matrix (Rodrigues)."""
    x, y, z = np.asarray(axis, dtype=float)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion(R: np.ndarray) -> np.ndarray:
    """wxyz: the eigenvector of the largest eigenvalue of Bar-Itzhack's matrix (2000)."""
    vector = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    matrix = np.block([[np.array([[np.trace(R)]]), vector[None]], [vector[:, None], R + R.T - np.trace(R) * np.eye(3)]])
    return np.linalg.eigh(matrix)[1][:, 3]


def facing(yaw: float) -> np.ndarray:
    """Orientation of the hand: forward along `yaw`, its fingers closing vertically."""
    return turn(UP, yaw) @ turn([1, 0, 0], np.pi / 2)


class Hand:
    """The hand. It moves along straight lines; in free motion an integrator removes what the arm sags."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self.sim, self.robot = sim, sim.robots["dog"]
        self.site = sim.world.info.sites.index("dog/tcp")
        self.p, self.sag = self.position, np.zeros(3)
        self.R = sim.memory.array("site_xmat")[self.site].reshape(3, 3).copy()

    @property
    def position(self) -> np.ndarray:
        return self.sim.memory.array("site_xpos")[self.site].copy()

    def at(self, p: np.ndarray, R: np.ndarray, free: bool = False) -> None:
        """Sends one goal, and waits for a fiftieth of a second."""
        if free:
            self.sag = np.clip(self.sag + 0.04 * (self.p - self.position), -0.06, 0.06)
        self.p, self.R = p, R
        self.robot.set_pose_goal((p + self.sag, quaternion(R)))
        self.sim.run_until(time=self.sim.time + 0.02)

    def go(self, p: ArrayLike, R: np.ndarray, seconds: float, settle: int = 0) -> None:
        p, start, first = np.asarray(p), self.p, self.R
        between = first.T @ R
        angle = np.arccos(np.clip((np.trace(between) - 1) / 2, -1, 1))
        axis = np.array([between[2, 1] - between[1, 2], between[0, 2] - between[2, 0], between[1, 0] - between[0, 1]])
        axis /= max(np.linalg.norm(axis), 1e-9)
        for s in [*np.linspace(0, 1, int(seconds * 50)), *[1.0] * settle]:
            s = s * s * (3 - 2 * s)
            self.at(start + s * (p - start), first @ turn(axis, s * angle), free=True)

    def grip(self, opening: float, seconds: float = 0.6) -> None:
        self.robot.set_joint_goals({"gripper_joint": opening})
        for _ in range(int(seconds * 50)):
            self.at(self.p, self.R)


def find_lever(sim: gloam.Simulation) -> np.ndarray:
    """Middle of the lever's bar in the world, from one picture of the wrist's depth camera."""
    frame = sim.cameras["dog/wrist_rgbd/depth"].render(("sensor_depth", "segmentation"))
    bar = [label.part for label in sim.labels() if label.geom == "lever_bar"]
    v, u = np.nonzero(np.isin(frame.part, bar))
    depth = frame.sensor_depth[v, u]
    if np.count_nonzero(depth) < 30:
        raise RuntimeError("the wrist's camera does not see the lever")
    rays_C = np.stack([(u + 0.5 - frame.K[0, 2]) / frame.K[0, 0], -(v + 0.5 - frame.K[1, 2]) / frame.K[1, 1], -np.ones(len(u))], axis=1)
    rays, eye = rays_C @ frame.X_WC[:3, :3].T, frame.X_WC[:3, 3]
    x = np.median((eye + rays * depth[:, None])[depth > 0, 0])  # the bar is parallel to the door: all of it has this x
    seen = eye + rays * ((x - eye[0]) / rays[:, :1])
    return (seen.min(axis=0) + seen.max(axis=0)) / 2 + [0.006, 0, 0]


def lean(robot: gloam.Robot, forward: float, height: float) -> None:
    """Moves the trunk over the standing feet: all legs bend so that the hips are `forward` of the feet and at `height`."""
    knee = -2 * np.arccos(np.hypot(forward, height) / (2 * LINK))
    thigh = np.arctan2(forward, height) - knee / 2
    names = [f"{leg}_{joint}_joint" for leg in ("FL", "FR", "RL", "RR") for joint in ("thigh", "calf")]
    robot.follow([thigh, knee] * 4, joints=names, profile="quintic", max_velocity=0.3, max_acceleration=1)


def open_door(sim: gloam.Simulation) -> None:
    sim.run_until(time=1)
    hand = Hand(sim)
    hand.go(hand.p + [0, 0, 0.2], hand.R, 1)
    hand.go([-0.21, -0.22, 1.0], turn(UP, -0.6), 1.5)  # before the lever, as the plan has it
    bar = find_lever(sim)
    hinge, axle = bar + HINGE, bar + AXLE
    hand.grip(OPEN)
    hand.go(bar - [0.13, 0, 0], facing(-0.5), 2)
    hand.go(bar + [0.008, 0, 0], facing(-0.5), 1, settle=30)
    hand.grip(0)
    for angle in np.linspace(0, 0.65, 50):  # the lever turns
        down = turn([-1, 0, 0], angle)
        hand.at(axle + down @ (bar - axle), down @ facing(-0.5))
    held, turned = hand.p, hand.R
    for angle in np.linspace(0, 0.45, 125):  # the door follows
        hand.at(hinge + turn(UP, angle) @ (held - hinge), turn(UP, 0.5 * angle) @ turned)
    hand.grip(OPEN, 0.3)
    lean(hand.robot, 0.17, 0.46)
    for s in np.linspace(0, 1, 250):  # the tips of the fingers slide along the leaf, off the lever, and push it open
        radius, down = 0.70 - 0.32 * s, min(0.14, 0.6 * s)
        on_leaf = np.array([-0.065, -radius, -down])
        hand.at(hinge + turn(UP, 0.45 + 1.05 * s) @ on_leaf, facing(0.2 + 0.5 * s))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--log", type=Path, help="of the first seed")
    arguments = parser.parse_args()
    opened = 0
    for seed in range(arguments.first, arguments.first + arguments.seeds):
        with gloam.load(Path(__file__).with_name("door.toml"), seed=seed) as sim:
            log = sim.record(arguments.log, ["/clock", "/tf*"], overwrite=True) if arguments.log and seed == arguments.first else nullcontext()
            with log:
                open_door(sim)
            angle = np.degrees(sim.joints["hinge"].position)
            upright = sim.robots["dog"].pose.p[2] > 0.4
            opened += angle > 60 and upright
            print(f"seed {seed}: {angle:.0f} degrees, {'upright' if upright else 'fallen'}, {sim.time:.1f} s, hash {sim.hash:016x}", flush=True)
    print(f"{opened} of {arguments.seeds} doors are open")


if __name__ == "__main__":
    main()
