"""Walks of the humanoid in Gloam: `./gloam python -m training.humanoid.compare`. Prints a table in Markdown.

The policy moves the legs; a part of the robot holds waist and arms (docs/controllers.md).
"""

from __future__ import annotations

import argparse
import math
import shutil
import tempfile
from pathlib import Path
from typing import Any

import mujoco

import gloam

from ..legged.meter import SETTLE, TIMESTEP, Measures, Meter
from ..legged.robot import ROOT
from ..quadruped import courses
from .robot import ROBOT

COMMANDS = ((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.5, 0.0, 0.0), (0.8, 0.0, 0.0), (0.0, 0.2, 0.0), (0.5, 0.0, 0.5), (0.0, 0.0, 0.5))
ROUGH_HEIGHT = 0.025  # [m]
PUSHES = (0.3, 0.6, 0.9)  # changes of the pelvis' velocity [m/s]
_SCENE = """
[sim]
timestep = {timestep}
[environment]
file = "{course}.xml"
[[robot]]
name = "hum"
model = "humanoid"
[robot.controller]
type = "policy"
network = "policy/policy.onnx"
settings = "policy/policy.toml"
[[robot.part]]
name = "upper_body"
joints = ["waist_.*", ".*_(shoulder|elbow|wrist).*"]
[robot.part.controller]
type = "joint_position"
kp = 300
kd = 3
{push}
"""


def walk(command: tuple[float, float, float], seconds: float = 10.0, course: str = "flat", push: str = "") -> Measures:
    """Walks with a constant command after a second at rest; the network is that of assets/policies."""
    spec = mujoco.MjSpec()
    courses.add(spec, course, ROUGH_HEIGHT)
    spec.compile()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / f"{course}.xml").write_text(spec.to_xml())
        shutil.copytree(ROOT / "assets/policies" / ROBOT.name, folder / "policy")
        sim = gloam.load(gloam.Scene.parse(_SCENE.format(timestep=TIMESTEP, course=course, push=push), folder))
    meter = Meter(sim.memory)

    def before_step(memory: Any) -> None:
        meter.read(float(memory.time))

    sim.on_step(before_step)
    sim.run_until(time=1.0)
    sim.robots["hum"].command(*command)
    meter.start = sim.time + SETTLE
    while sim.time < 1.0 + seconds - 1e-9 and not meter.fell:
        sim.run_until(time=sim.time + 0.25)
    return meter.measures(command)


def survives(speed: float) -> int:
    """The number of pushes in eight directions, at 0.5 m/s on a floor, after which it walks on for 3 s."""
    count = 0
    for number in range(8):
        angle = 2 * math.pi * number / 8
        velocity = [round(speed * math.cos(angle), 6), round(speed * math.sin(angle), 6), 0.0]
        push = f'\n[[push]]\nbody = "hum/pelvis"\ntime = {3.5 + 0.08 * number:.2f}\nvelocity = {velocity}\n'
        count += not walk((0.5, 0.0, 0.0), 5.5 + 0.08 * number, "flat", push).fell
    return count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10)
    arguments = parser.parse_args()
    print("| ground | vx, vy, yaw rate | m/s error | rad/s error | m walked | cost | fell |\n|---|---|---|---|---|---|---|")
    for course in ("flat", "rough"):
        for command in COMMANDS:
            r = walk(command, arguments.seconds, course)
            cost = f"{r.energy / r.weight / r.walked:.2f}" if math.hypot(*command[:2]) > 0 else ""
            words = ", ".join(f"{number:g}" for number in command)
            print(f"| {course} | {words} | {r.velocity_error:.3f} | {r.yaw_rate_error:.3f} | {r.distance:.1f} | {cost} | "
                  f"{'yes' if r.fell else ''} |", flush=True)  # fmt: skip
    for speed in PUSHES:
        print(f"pushes of {speed} m/s survived, of 8: {survives(speed)}", flush=True)


if __name__ == "__main__":
    main()
