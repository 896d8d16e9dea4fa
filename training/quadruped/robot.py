"""The quadruped of assets/robots/quadruped."""

from __future__ import annotations

import numpy as np

from ..legged.robot import GaitChoice, Robot

LEGS = ("FL", "FR", "RL", "RR")
MIRRORED_LEGS = np.array([1, 0, 3, 2])

ROBOT = Robot(
    name="quadruped",
    joints=tuple(f"{leg}_{part}_joint" for leg in LEGS for part in ("hip", "thigh", "calf")),
    default_positions=np.tile([0.0, 0.864, -1.728], 4),  # the keyframe "home": hips 0.276 m above the feet's centres
    stiffness=np.full(12, 25.0),
    damping=np.full(12, 0.6),
    action_scale=np.tile([0.2, 0.3, 0.3], 4),
    torque_limit=np.tile([23.7, 23.7, 35.55], 4),
    friction=0.2,
    mirrored_joints=(3 * MIRRORED_LEGS[:, None] + np.arange(3)).ravel(),
    mirrored_signs=np.tile([-1.0, 1.0, 1.0], 4),  # hips turn about x
    feet=tuple(f"{leg}_calf" for leg in LEGS),
    shins=tuple(f"{leg}_calf" for leg in LEGS),
    sole=((0.0, 0.0, -0.213),),
    sole_radius=0.022,
    nominal_height=0.29,
    weight=125.0,
    abduction=(0, 3, 6, 9),
    nearby=tuple((x, y) for x in (0.4, 0.2, -0.2, -0.4) for y in (0.13, -0.13)),
    belly=tuple((x, y, -0.057) for x in (0.26, 0.0, -0.19) for y in (0.05, -0.05)),
    gait=GaitChoice(frequency=2.0, swing_height=0.08),
)
