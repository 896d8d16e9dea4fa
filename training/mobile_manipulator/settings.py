"""The mobile manipulator's training."""

from __future__ import annotations

from ..legged.settings import Commands, Gaits, Randomisation, Settings, Stage
from .robot import ROBOT

REWARDS = {
    "velocity": 1.0,
    "velocity_mean": 0.8,
    "yaw_rate": 0.5,
    "yaw_rate_mean": 0.4,
    "vertical_speed": -2.0,
    "tilt_rate": -0.1,
    "tilt": -3.0,
    "height": -80.0,
    "torque": -3e-6,
    "joint_acceleration": -1e-7,
    "action_rate": -0.02,
    "action_jerk": -0.01,
    "hip": -0.3,
    "posture": -0.03,
    "standing": -0.2,
    "swing_force": -0.4,
    "stance_slip": -0.4,
    "clearance": -25.0,
    "shank": -0.4,
    "belly": -0.5,
}

SETTINGS = Settings(
    robot=ROBOT,
    commands=Commands(vx=(-0.6, 1.1), vy=(-0.4, 0.4), yaw_rate=(-0.9, 0.9), standing=0.15),
    gaits=Gaits(
        shares=(1.0, 0.0, 0.0),
        frequency=(1.4, 2.4),
        duration=(0.5, 0.65),
        swing_height=(0.05, 0.12),
        body_height=(-0.12, 0.02),
    ),
    randomisation=Randomisation(payload=(-3.0, 5.0), push=0.6, soft_share=0.2, compliance=(2e-5, 5e-4), soil_drag=(100.0, 1000.0)),
    rewards=REWARDS,
    stages=(Stage(3000, -3e-4, 0.6, 0.004, 6),),
    fall_height=0.2,
)
