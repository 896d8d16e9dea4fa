"""Writes policy.onnx and policy.toml of a checkpoint: `python3 -m training.quadruped.publish checkpoint.npz FOLDER`."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from .. import export
from . import robot
from .driver import GaitChoice
from .terms import GAIT_PARAMETERS, TERMS

_HEAD = """# The quadruped's walking policy (README.md); written by training/quadruped/publish.py.
[policy]
rate = {rate:g}                  # Hz
joints = [{joints}]
kp = {kp:g}                    # N m/rad
kd = {kd:g}                   # N m s/rad
default_positions = {{ ".*_hip_joint" = {hip:g}, ".*_thigh_joint" = {thigh:g}, ".*_calf_joint" = {calf:g} }}  # rad
action_scale = {{ ".*_hip_joint" = {hip_scale:g}, ".*_(thigh|calf)_joint" = {leg_scale:g} }}  # rad
action_clip = {clip:g}
torque_limit = {{ ".*_(hip|thigh)_joint" = {torque:g}, ".*_calf_joint" = {calf_torque:g} }}  # N m
history_start = "repeat"
command_ranges = {{ vx = [-0.8, 1.6], vy = 0.5, yaw_rate = 1.3 }}  # m/s, m/s, rad/s

[policy.gait]
{gait}
pacing_offset = true
parameters = [{parameters}]
"""
_TERM = '\n[[observation]]\nterm = "{name}"\nscale = {scale}\n'


def policy_toml() -> str:
    """The specification of the network for Gloam (docs/policies.md)."""
    quoted = ", ".join(f'"{name}"' for name in robot.JOINTS)
    hip, thigh, calf = robot.DEFAULT_POSITIONS[:3]
    text = _HEAD.format(
        rate=1 / robot.CONTROL_PERIOD,
        joints=quoted,
        kp=robot.STIFFNESS,
        kd=robot.DAMPING,
        hip=hip,
        thigh=thigh,
        calf=calf,
        hip_scale=robot.ACTION_SCALE[0],
        leg_scale=robot.ACTION_SCALE[1],
        clip=robot.ACTION_CLIP,
        torque=robot.TORQUE_LIMIT[0],
        calf_torque=robot.TORQUE_LIMIT[2],
        gait="\n".join(f"{name} = {value:g}" for name, value in asdict(GaitChoice()).items()),
        parameters=", ".join(f'"{name}"' for name in GAIT_PARAMETERS),
    )
    for term in TERMS:
        scale = f"{term.scale[0]:g}" if len(term.scale) == 1 else f"[{', '.join(f'{s:g}' for s in term.scale)}]"
        text += _TERM.format(name=term.name, scale=scale)
        text += f"history = {term.history}\n" if term.history > 1 else ""
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("folder", type=Path)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    export.write_onnx(export.layers_of(arguments.checkpoint), arguments.folder / "policy.onnx")
    (arguments.folder / "policy.toml").write_text(policy_toml())


if __name__ == "__main__":
    main()
