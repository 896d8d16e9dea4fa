"""Reaching while walking, in Gloam: `./gloam python -m training.mobile_manipulator.compare`.

The arm's `ik` controller holds the hand at a goal in the world's frame, which moves along with the commanded velocity and
up and down, while the legs are moved by the policy or by the trot controller. Prints a table in Markdown.
"""

from __future__ import annotations

import argparse
import math
import shutil
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam

from ..legged.meter import SETTLE, TIMESTEP, Measures, Meter
from ..legged.robot import ROOT
from ..quadruped import courses
from .robot import ROBOT

CONTROLLERS = {
    "trot": 'type = "trot"',
    "policy": 'type = "policy"\nnetwork = "policy/policy.onnx"\nsettings = "policy/policy.toml"',
}
COMMANDS = ((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 0.0), (0.5, 0.0, 0.3), (0.0, 0.0, 0.5))
GOAL_PERIOD = 0.02  # between new goals of the hand [s]
HAND = (0.55, 0.0, 0.35)  # of the goal's mean, from the trunk [m]
SWAY = (0.10, 5.0)  # vertical amplitude and period of the goal [m, s]
_SCENE = """
[sim]
timestep = {timestep}
[environment]
{environment}
[[robot]]
name = "mm"
model = "mobile_manipulator"
[robot.controller]
{controller}
[[robot.part]]
name = "arm"
joints = ["arm_joint[1-6]"]
[robot.part.controller]
type = "ik"
rate = 500
frame = "site tcp"
time_constant = 0.02
orientation_cost = 0.3
posture_cost = 0.001
velocity_limit = 3.1
kp = {kp}
kd = {kd}
"""


@dataclass
class Reach(Measures):
    """A walk of which the hand's distance from its goal was measured after SETTLE."""

    hand_error: float  # mean [m]
    worst_hand_error: float  # [m]


class HandGoal:
    """Moves with the commanded velocity from the trunk's place at the start, upright."""

    def __init__(self, start: np.ndarray, command: tuple[float, float, float]) -> None:
        self.place, self.yaw, self.command = np.array(start[:2]), 0.0, command
        self.height = float(start[2]) + HAND[2]

    def advance(self, seconds: float) -> None:
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        self.place += seconds * np.array([c * self.command[0] - s * self.command[1], s * self.command[0] + c * self.command[1]])
        self.yaw += seconds * self.command[2]

    def at(self, time: float) -> np.ndarray:
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        height = self.height + SWAY[0] * math.sin(2 * math.pi * time / SWAY[1])
        return np.array([self.place[0] + c * HAND[0], self.place[1] + s * HAND[0], height])


def scene(controller: str, course: str, folder: Path, gains: tuple[float, float]) -> gloam.Scene:
    environment = ""
    if course != "flat":
        import mujoco  # boxes of the rough ground only

        spec = mujoco.MjSpec()
        courses.add(spec, course)
        spec.compile()
        (folder / f"{course}.xml").write_text(spec.to_xml())
        environment = f'file = "{course}.xml"'
    shutil.copytree(ROOT / "assets/policies" / ROBOT.name, folder / "policy")  # scenes read from their own folder only
    text = _SCENE.format(timestep=TIMESTEP, environment=environment, controller=CONTROLLERS[controller], kp=gains[0], kd=gains[1])
    return gloam.Scene.parse(text, folder)


def reach(
    controller: str,
    command: tuple[float, float, float],
    seconds: float = 10.0,
    course: str = "flat",
    gains: tuple[float, float] = (1500.0, 30.0),
) -> Reach:
    """Walks with a constant command while the hand follows its goal."""
    with tempfile.TemporaryDirectory() as folder:
        sim = gloam.load(scene(controller, course, Path(folder), gains))
    robot, meter = sim.robots["mm"], Meter(sim.memory)

    def before_step(memory: Any) -> None:
        meter.read(float(memory.time))

    sim.on_step(before_step)
    sim.run_until(time=1.0)
    goal, errors = HandGoal(meter.qpos[:3].copy(), command), []
    robot.command(*command)
    start = sim.time
    meter.start = start + SETTLE
    while sim.time < start + seconds - 1e-9 and not meter.fell:
        robot.set_pose_goal((goal.at(sim.time), [math.cos(goal.yaw / 2), 0, 0, math.sin(goal.yaw / 2)]))
        wanted = goal.at(sim.time)
        hand = sim.bodies["mm/gripper"].pose
        if sim.time >= meter.start:
            errors.append(float(np.linalg.norm(hand.p + hand.R @ np.array(ROBOT.arm.grip) - wanted)))  # type: ignore[union-attr]
        sim.run_until(time=sim.time + GOAL_PERIOD)
        goal.advance(GOAL_PERIOD)
    worst = max(errors, default=math.inf)
    return Reach(**asdict(meter.measures(command)), hand_error=float(np.mean(errors or [math.inf])), worst_hand_error=worst)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--courses", nargs="+", default=["flat"], help=", ".join(courses.KINDS))
    parser.add_argument("--controllers", nargs="+", default=list(CONTROLLERS))
    arguments = parser.parse_args()
    print("| ground | vx, vy, yaw rate | legs | m/s error | rad/s error | hand error: mean | worst [mm] | cost | fell |")
    print("|---|---|---|---|---|---|---|---|---|")
    for course in arguments.courses:
        for command in COMMANDS:
            for controller in arguments.controllers:
                r = reach(controller, command, arguments.seconds, course)
                cost = f"{r.energy / r.weight / r.walked:.2f}" if math.hypot(*command[:2]) > 0 else ""
                words = ", ".join(f"{number:g}" for number in command)
                print(f"| {course} | {words} | {controller} | {r.velocity_error:.3f} | {r.yaw_rate_error:.3f} | "
                      f"{1000 * r.hand_error:.0f} | {1000 * r.worst_hand_error:.0f} | {cost} | {'yes' if r.fell else ''} |",
                      flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
