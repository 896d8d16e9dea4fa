"""Writes policy.onnx and policy.toml of a checkpoint: `python3 -m training.legged.publish quadruped checkpoint.npz`."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

import numpy as np

from .. import export, tasks
from .robot import ACTION_CLIP, CONTROL_PERIOD, ROOT, Robot
from .settings import Settings
from .terms import GAIT_PARAMETERS, Term, actor_terms

_HEAD = """# Walking policy of assets/robots/{name} (README.md); written by training/legged/publish.py.
[policy]
rate = {rate:g}                  # Hz
joints = [
{joints}
]
kp = {kp}  # N m/rad
kd = {kd}  # N m s/rad
default_positions = {default}  # rad
action_scale = {scale}  # rad
action_clip = {clip:g}
torque_limit = {torque}  # N m
history_start = "repeat"
command_ranges = {{ vx = {vx}, vy = {vy}, yaw_rate = {yaw_rate} }}  # m/s, m/s, rad/s
{feedback}
[policy.gait]
{gait}
pacing_offset = true
parameters = [{parameters}]
"""


def _numbers(values: object) -> str:
    """A number if all are equal, else a list."""
    numbers = [f"{value:g}" for value in np.ravel(values)]
    return numbers[0] if len(set(numbers)) == 1 else f"[{', '.join(numbers)}]"


def _per_joint(robot: Robot, values: np.ndarray) -> str:
    """A number, or a table of patterns if joints whose names end alike have equal values, else a list."""
    if len(set(values)) == 1:
        return _numbers(values)
    ends = [name.split("_", 1)[1] for name in robot.joints]
    table = dict(zip(ends, values, strict=True))
    if len(table) == len(values) or any(table[end] != value for end, value in zip(ends, values, strict=True)):
        return _numbers(values)
    return "{ " + ", ".join(f'".*_{end}" = {value:g}' for end, value in table.items()) + " }"


def _term(term: Term) -> str:
    history = f"history = {term.history}\n" if term.history > 1 else ""
    return f'\n[[observation]]\nterm = "{term.name}"\nscale = {_numbers(term.scale)}\n{history}'


def policy_toml(settings: Settings) -> str:
    """The specification of the network for Gloam (docs/policies.md)."""
    robot, commands = settings.robot, settings.commands
    per_limb = len(robot.joints) // len(robot.feet)
    rows = [robot.joints[first : first + per_limb] for first in range(0, len(robot.joints), per_limb)]
    head = _HEAD.format(
        name=robot.name,
        rate=1 / CONTROL_PERIOD,
        joints="\n".join("  " + "".join(f'"{name}", ' for name in row).rstrip() for row in rows),
        kp=_per_joint(robot, robot.stiffness),
        kd=_per_joint(robot, robot.damping),
        default=_per_joint(robot, robot.default_positions),
        scale=_per_joint(robot, robot.action_scale),
        clip=ACTION_CLIP,
        torque=_per_joint(robot, robot.torque_limit),
        vx=list(commands.vx),
        vy=list(commands.vy),
        yaw_rate=list(commands.yaw_rate),
        feedback=f"velocity_feedback = {settings.velocity_feedback:g}  # 1/s\n" if settings.velocity_feedback else "",
        gait="\n".join(f"{name} = {value:g}" for name, value in asdict(robot.gait).items()),
        parameters=", ".join(f'"{name}"' for name in GAIT_PARAMETERS),
    )
    return head + "".join(_term(term) for term in actor_terms(robot))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", choices=tasks.NAMES)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("--folder", type=Path, help="default: assets/policies/TASK")
    arguments = parser.parse_args()
    folder = arguments.folder or ROOT / "assets/policies" / arguments.task
    folder.mkdir(parents=True, exist_ok=True)
    export.write_onnx(export.layers_of(arguments.checkpoint), folder / "policy.onnx")
    (folder / "policy.toml").write_text(policy_toml(tasks.settings(arguments.task)))


if __name__ == "__main__":
    main()
