"""The mobile manipulator of assets/robots/mobile_manipulator: the policy moves the legs, another controller the arm."""

from __future__ import annotations

import numpy as np

from ..legged.robot import Arm, GaitChoice, Robot
from ..quadruped.robot import LEGS, MIRRORED_LEGS

ARM = Arm(
    joints=tuple(f"arm_joint{number}" for number in range(1, 7)),
    low=np.array([-2.0, 0.2, -2.5, -1.3, -1.2, -1.5]),
    high=np.array([2.0, 2.7, -0.2, 1.3, 1.2, 1.5]),
    stiffness=np.array([150.0, 150.0, 150.0, 60.0, 60.0, 60.0]),  # soft enough for explicit steps of 4 ms
    damping=np.array([4.0, 4.0, 4.0, 1.0, 1.0, 1.0]),
    torque_limit=np.array([30.0, 60.0, 30.0, 30.0, 30.0, 30.0]),
    hand="gripper",
    grip=(0.128, 0.0, 0.0),  # the site tcp
    mirrored_signs=np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0]),
)

ROBOT = Robot(
    name="mobile_manipulator",
    joints=tuple(f"{leg}_{part}_joint" for leg in LEGS for part in ("hip", "thigh", "calf")),
    default_positions=np.tile([0.0, 0.8, -1.5], 4),  # the keyframe "home"
    stiffness=np.full(12, 250.0),
    damping=np.full(12, 6.0),
    action_scale=np.tile([0.2, 0.3, 0.3], 4),
    torque_limit=np.tile([91.0, 93.33, 140.0], 4),
    friction=0.5,
    mirrored_joints=(3 * MIRRORED_LEGS[:, None] + np.arange(3)).ravel(),
    mirrored_signs=np.tile([-1.0, 1.0, 1.0], 4),
    feet=tuple(f"{leg}_calf" for leg in LEGS),
    shins=tuple(f"{leg}_calf" for leg in LEGS),
    sole=((0.0, 0.0, -0.35),),
    sole_radius=0.04,
    nominal_height=0.545,
    weight=637.0,
    abduction=(0, 3, 6, 9),
    nearby=tuple((x, y) for x in (0.7, 0.35, -0.35, -0.7) for y in (0.2, -0.2)),
    belly=tuple((x, y, -0.075) for x in (0.45, 0.0, -0.45) for y in (0.1, -0.1)),
    arm=ARM,
    welded={"gripper_joint": 0.02, "gripper_coupled_joint": 0.02},
    observes_velocity=True,
    gait=GaitChoice(frequency=1.8, duration=0.55, swing_height=0.08),
)
