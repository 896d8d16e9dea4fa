"""The humanoid of assets/robots/humanoid: the policy moves the legs; waist and arms hold the keyframe "home"."""

from __future__ import annotations

import numpy as np

from ..legged.robot import GaitChoice, Robot

SIDES = ("left", "right")
_LEG = ("hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll")
_ARM = {"shoulder_pitch": 0.2, "shoulder_roll": 0.2, "shoulder_yaw": 0.0, "elbow": 0.6, "wrist_roll": 0.0, "wrist_pitch": 0.0,
        "wrist_yaw": 0.0}  # fmt: skip
HELD = {f"waist_{axis}_joint": 0.0 for axis in ("yaw", "roll", "pitch")} | {
    f"{side}_{part}_joint": -angle if side == "right" and part == "shoulder_roll" else angle
    for side in SIDES
    for part, angle in _ARM.items()
}

ROBOT = Robot(
    name="humanoid",
    joints=tuple(f"{side}_{part}_joint" for side in SIDES for part in _LEG),
    default_positions=np.tile([-0.312, 0.0, 0.0, 0.669, -0.363, 0.0], 2),  # the keyframe "home"
    stiffness=np.tile([100.0, 100.0, 100.0, 150.0, 40.0, 40.0], 2),
    damping=np.tile([2.0, 2.0, 2.0, 4.0, 1.0, 1.0], 2),
    action_scale=np.tile([0.3, 0.2, 0.2, 0.3, 0.3, 0.15], 2),
    torque_limit=np.tile([88.0, 139.0, 88.0, 139.0, 50.0, 50.0], 2),
    friction=0.1,
    mirrored_joints=(np.arange(12) + 6) % 12,
    mirrored_signs=np.tile([1.0, -1.0, -1.0, 1.0, 1.0, -1.0], 2),
    feet=tuple(f"{side}_ankle_roll_link" for side in SIDES),
    shins=tuple(f"{side}_knee_link" for side in SIDES),
    sole=tuple((x, y, -0.025) for x in (-0.046, 0.122) for y in (0.022, -0.022)),
    sole_radius=0.01,
    nominal_height=0.755,
    weight=327.0,
    abduction=(1, 2, 7, 8),
    nearby=tuple((x, y) for x in (0.3, 0.1, -0.1, -0.3) for y in (0.12, -0.12)),
    welded=HELD,
    observes_velocity=True,
    gait=GaitChoice(frequency=1.5, duration=0.58, swing_height=0.07),
)
