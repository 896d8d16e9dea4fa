"""Compares the policy with the trot controller in Gloam: `./gloam python -m training.quadruped.compare` (README.md).

Both walk the same courses with the same commands. Prints a table in Markdown; `--json` writes every run. Requires
openvino for the network.
"""

from __future__ import annotations

import argparse
import json
import math
import shutil
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import gloam

from ..legged.meter import SETTLE, TIMESTEP, Measures, Meter
from ..legged.robot import ROOT
from . import ground
from .robot import ROBOT

POLICY = ROOT / "assets/policies/quadruped/policy.onnx"
SOILS = ("dry_sand", "sandy_loam", "clayey_soil", "lean_clay", "snow", "mud", "lunar")
WALKS = {  # commands of each kind of ground: vx, vy [m/s], yaw rate [rad/s]
    "flat": [(0.3, 0, 0), (0.5, 0, 0), (1.0, 0, 0), (1.5, 0, 0), (0, 0.3, 0), (0.5, 0, 1.0), (0, 0, 1.0)],
    "rough": [(0.3, 0, 0), (0.5, 0, 0), (1.0, 0, 0), (0, 0.3, 0), (0.5, 0, 0.5)],
    "stairs": [(0.3, 0, 0), (0.5, 0, 0), (0.8, 0, 0), (-0.4, 0, 0)],
    "soil": [(0.3, 0, 0), (0.5, 0, 0), (0.5, 0, 0.5)],
}
PUSHES = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0)  # changes of the trunk's velocity [m/s]


@dataclass
class Walk(Measures):
    """One run with a constant command."""

    controller: str
    course: str
    command: tuple[float, float, float]


class Session:
    """One simulation of one controller."""

    def __init__(self, scene: gloam.Scene) -> None:
        self.sim = gloam.load(scene)
        self.meter = Meter(self.sim.memory)
        self.sim.on_step(lambda memory: self.meter.read(float(memory.time)))

    def command(self, command: tuple[float, float, float]) -> None:
        self.sim.robots["go"].command(*command)

    def run(self, seconds: float) -> None:
        end = self.sim.time + seconds
        while self.sim.time < end - 1e-9 and not self.meter.fell:
            self.sim.run_until(time=min(end, self.sim.time + 0.25))


class Comparison:
    """Makes sessions of both controllers and measures them."""

    def __init__(self, network: Path, folder: Path, frequency: float, feedback: bool) -> None:
        self.folder = folder
        shutil.copy(network, folder / "policy.onnx")
        lines = network.with_suffix(".toml").read_text().splitlines()
        kept = (line for line in lines if feedback or not line.startswith("velocity_feedback"))
        (folder / "policy.toml").write_text("\n".join(kept))
        self.keys = f'network = "policy.onnx"\nsettings = "policy.toml"\nparams = {{ frequency = {frequency} }}\n'

    def session(self, controller: str, course: str, pushes: str = "") -> Session:
        keys = self.keys if controller == "policy" else ""
        text = ground.scene(course, controller, self.folder, TIMESTEP) + keys + pushes
        return Session(gloam.Scene.parse(text, self.folder))

    def walk(self, controller: str, course: str, command: tuple[float, float, float], seconds: float) -> Walk:
        session = self.session(controller, course)
        session.run(0.5)
        session.command(command)
        meter = session.meter
        meter.start = session.sim.time + SETTLE
        session.run(seconds)
        return Walk(**asdict(meter.measures(command)), controller=controller, course=course, command=command)

    def recovers(self, controller: str, speed: float) -> list[bool]:
        """Whether it is still walking 3 s after a push in each of eight directions, at 0.5 m/s on a floor."""
        results = []
        for number in range(8):
            angle = 2 * math.pi * number / 8
            velocity = [round(speed * math.cos(angle), 6), round(speed * math.sin(angle), 6), 0.0]
            push = f'\n[[push]]\nbody = "go/trunk"\ntime = {2.5 + 0.04 * number:.2f}\nvelocity = {velocity}\n'
            session = self.session(controller, "flat", push)
            session.command((0.5, 0.0, 0.0))
            session.run(2.5 + 0.04 * number + 2)
            start = session.sim.robots["go"].pose.p.copy()
            session.run(1)
            moved = float(np.linalg.norm(session.sim.robots["go"].pose.p - start))
            results.append(not session.meter.fell and moved > 0.3)
        return results


def row(label: str, walks: list[Walk]) -> str:
    """Velocity error, yaw rate error, falls per km, cost of transport of both controllers."""
    cells = []
    for controller in ("trot", "policy"):
        mine = [walk for walk in walks if walk.controller == controller]
        whole = [walk for walk in mine if not walk.fell] or mine
        distance = sum(walk.distance for walk in mine)
        falls = sum(walk.fell for walk in mine)
        moving = [walk for walk in whole if math.hypot(*walk.command[:2]) > 0] or whole
        work = sum(walk.energy / walk.weight for walk in moving) / max(sum(walk.walked for walk in moving), 1e-3)
        cells.append((np.mean([walk.velocity_error for walk in mine]), np.mean([walk.yaw_rate_error for walk in mine]),
                      1000 * falls / max(distance, 1e-3), work))  # fmt: skip
    pairs = (f"{trot:.{digits}f} | {policy:.{digits}f}" for (trot, policy), digits in zip(zip(*cells), (3, 3, 0, 2)))
    return f"| {label} | " + " | ".join(pairs) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--policy", type=Path, default=POLICY, help="ONNX file, with its settings beside it in a .toml")
    parser.add_argument("--seconds", type=float, default=8, help="of each walk")
    parser.add_argument("--courses", nargs="+", default=["flat", "rough", "stairs", *SOILS])
    parser.add_argument("--frequency", type=float, default=ROBOT.gait.frequency)
    parser.add_argument("--no-feedback", action="store_true", help="without the policy's velocity_feedback")
    parser.add_argument("--no-pushes", action="store_true")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    walks: list[Walk] = []
    print("| ground | m/s: trot | policy | rad/s: trot | policy | falls/km: trot | policy | cost: trot | policy |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(arguments.policy, Path(folder), arguments.frequency, not arguments.no_feedback)
        for course in arguments.courses:
            commands = WALKS.get(course, WALKS["soil"])
            now = [comparison.walk(controller, course, command, arguments.seconds)
                   for controller in ("trot", "policy") for command in commands]  # fmt: skip
            walks += now
            print(row(course, now), flush=True)
        for speed in () if arguments.no_pushes else PUSHES:
            shares = (sum(comparison.recovers(controller, speed)) for controller in ("trot", "policy"))
            print(f"pushes of {speed} m/s survived, of 8: trot {next(shares)}, policy {next(shares)}", flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(walk) for walk in walks], indent=1))


if __name__ == "__main__":
    main()
