"""Compares the policy with the trot controller in Gloam: `./gloam python -m training.quadruped.compare` (README.md).

Both walk the same courses with the same commands. Prints a table in Markdown; `--json` writes every run. Requires
openvino for the network.
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam

from ..legged.driver import Driver, load_network
from ..legged.meter import SETTLE, TIMESTEP, Measures, Meter
from ..legged.robot import CONTROL_PERIOD, ROOT, GaitChoice
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


def drive_by(driver: Driver) -> Callable[[Any, int], None]:
    """Writes the policy's torques before each step."""
    every = round(CONTROL_PERIOD / TIMESTEP)
    targets = ROBOT.default_positions

    def drive(memory: Any, step: int) -> None:
        nonlocal targets
        qpos, qvel = memory.array("qpos")[:19], memory.array("qvel")[:18]
        if step % every == 0:
            targets = driver.targets(qpos, qvel)
        memory.array("ctrl")[:12] = driver.torques(targets, qpos[7:], qvel[6:])

    return drive


class TrueVelocityDriver(Driver):
    """Adds the integral of the error of the true velocity to the command, as an experiment: the trot controller reads its
    true velocity, and the network does not."""

    GAIN, LIMIT = 0.8, 0.4  # [1/s], [m/s, rad/s]

    def reset(self) -> None:
        super().reset()
        self._integral = np.zeros(3)

    def targets(self, qpos: np.ndarray, qvel: np.ndarray) -> np.ndarray:
        w, x, y, z = qpos[3:7]
        ahead = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z)])
        ahead /= np.linalg.norm(ahead)
        velocity = np.array([ahead @ qvel[:2], ahead[0] * qvel[1] - ahead[1] * qvel[0], qvel[5]])
        command = self.command
        if np.linalg.norm(command) > 0:
            step = self.GAIN * CONTROL_PERIOD * (command - velocity)
            self._integral = np.clip(self._integral + step, -self.LIMIT, self.LIMIT)
        self.command = command + self._integral
        targets = super().targets(qpos, qvel)
        self.command = command
        return targets


class Session:
    """One simulation of one controller."""

    def __init__(self, scene: gloam.Scene, driver: Driver | None) -> None:
        self.sim, self.driver = gloam.load(scene), driver
        self.meter = Meter(self.sim.memory)
        self.drive = drive_by(driver) if driver is not None else None
        self.steps = 0
        self.sim.on_step(self._before_step)

    def _before_step(self, memory: Any) -> None:
        self.meter.read(float(memory.time))
        if self.drive is not None:
            self.drive(memory, self.steps)
        self.steps += 1

    def command(self, command: tuple[float, float, float]) -> None:
        if self.driver is not None:
            self.driver.command = np.array(command, float)
        else:
            self.sim.robots["go"].command(*command)

    def run(self, seconds: float) -> None:
        end = self.sim.time + seconds
        while self.sim.time < end - 1e-9 and not self.meter.fell:
            self.sim.run_until(time=min(end, self.sim.time + 0.25))


class Comparison:
    """Makes sessions of both controllers and measures them."""

    def __init__(self, network: Callable[[np.ndarray], np.ndarray], gait: GaitChoice, folder: Path, driver: type[Driver] = Driver) -> None:
        self.network, self.gait, self.folder, self.driver = network, gait, folder, driver

    def session(self, controller: str, course: str, pushes: str = "") -> Session:
        text = ground.scene(course, "trot" if controller == "trot" else "none", self.folder, TIMESTEP) + pushes
        driver = self.driver(ROBOT, self.network, self.gait) if controller == "policy" else None
        return Session(gloam.Scene.parse(text, self.folder), driver)

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
    parser.add_argument("--policy", type=Path, default=POLICY)
    parser.add_argument("--seconds", type=float, default=8, help="of each walk")
    parser.add_argument("--courses", nargs="+", default=["flat", "rough", "stairs", *SOILS])
    parser.add_argument("--frequency", type=float, default=ROBOT.gait.frequency)
    parser.add_argument("--true-velocity", action="store_true", help="correct the commands by the true velocity")
    parser.add_argument("--no-pushes", action="store_true")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    walks: list[Walk] = []
    print("| ground | m/s: trot | policy | rad/s: trot | policy | falls/km: trot | policy | cost: trot | policy |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        gait = GaitChoice(frequency=arguments.frequency)
        driver = TrueVelocityDriver if arguments.true_velocity else Driver
        comparison = Comparison(load_network(arguments.policy), gait, Path(folder), driver)
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
