"""Evaluates a network in MuJoCo with the whole model, at 2 ms: `python3 -m training.quadruped.evaluate NETWORK`.

NETWORK is a policy.onnx or a checkpoint.npz. The training steps at 4 ms and collides feet only, so this is a test on another simulator.
"""

from __future__ import annotations

import argparse
import itertools
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ..legged.driver import Driver, load_network
from ..legged.robot import CONTROL_PERIOD, GaitChoice
from . import courses
from .robot import ROBOT

TIMESTEP = 0.002  # [s]
SETTLE = 1.0  # until a command counts [s]
GRAVITY = 9.81  # [m/s²]


@dataclass
class Result:
    """Means over the time after SETTLE."""

    velocity_error: float  # of the velocity averaged over the run [m/s]
    yaw_rate_error: float  # [rad/s]
    fell: bool
    transport_cost: float  # positive mechanical energy per weight and distance
    distance: float  # [m]


def build(course: str, friction: float = 0.8) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_file(str(ROBOT.file))
    courses.add(spec, course)
    spec.option.timestep = TIMESTEP
    for geom in spec.geoms:
        if geom.contype or geom.conaffinity:
            geom.friction[0] = friction
    return spec.compile()


def run(model: mujoco.MjModel, driver: Driver, command: tuple[float, float, float], seconds: float) -> Result:
    """Walks with a constant command from the course's start."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    driver.command = np.array(command)
    every = round(CONTROL_PERIOD / TIMESTEP)
    planar, turned, energy, distance, fell = np.zeros(2), 0.0, 0.0, 0.0, False
    steps, settled = round(seconds / TIMESTEP), round(SETTLE / TIMESTEP)
    for step in range(steps):
        if step % every == 0:
            targets = driver.targets(data.qpos, data.qvel)
        data.ctrl[:] = driver.torques(targets, data.qpos[7:], data.qvel[6:])
        mujoco.mj_step(model, data)
        R_WB = data.xmat[1].reshape(3, 3)
        fell = R_WB[2, 2] < 0.5
        if fell or step < settled:
            if fell:
                break
            continue
        heading = R_WB[:2, 0] / np.linalg.norm(R_WB[:2, 0])
        velocity = data.qvel[:2]
        planar += [heading @ velocity, heading[0] * velocity[1] - heading[1] * velocity[0]]
        turned += data.qvel[3:6] @ R_WB[2]
        distance += np.linalg.norm(velocity) * TIMESTEP
        energy += np.maximum(data.ctrl * data.qvel[6:], 0).sum() * TIMESTEP
    count = max(step - settled, 1)
    weight = GRAVITY * float(model.body_mass.sum())
    return Result(
        float(np.linalg.norm(planar / count - command[:2])),
        float(abs(turned / count - command[2])),
        bool(fell),
        float(energy / (weight * max(distance, 1e-3))),
        float(distance),
    )


COMMANDS = ((0.3, 0, 0), (0.5, 0, 0), (1.0, 0, 0), (1.5, 0, 0), (-0.5, 0, 0), (0, 0.3, 0), (0.5, 0, 1.0), (0, 0, 1.0),
            (0, 0, 0))  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("network", type=Path)
    parser.add_argument("--courses", nargs="+", default=["flat", "rough", "stairs"])
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--frequency", type=float, default=ROBOT.gait.frequency)
    parser.add_argument("--swing-height", type=float, default=ROBOT.gait.swing_height)
    parser.add_argument("--friction", type=float, default=0.8)
    arguments = parser.parse_args()
    network = load_network(arguments.network)
    gait = GaitChoice(frequency=arguments.frequency, swing_height=arguments.swing_height)
    print("course    vx   vy   yaw  | error m/s  rad/s  cost of transport  distance")
    models = {course: build(course, arguments.friction) for course in arguments.courses}
    for course, command in itertools.product(arguments.courses, COMMANDS):
        r = run(models[course], Driver(ROBOT, network, gait), command, arguments.seconds)
        print(f"{course:8} {command[0]:4.1f} {command[1]:4.1f} {command[2]:4.1f}  | {r.velocity_error:6.3f} "
              f"{r.yaw_rate_error:8.3f} {r.transport_cost:10.2f} {r.distance:10.2f}  {'FELL' if r.fell else ''}")  # fmt: skip


if __name__ == "__main__":
    main()
