"""The humanoid's training."""

from __future__ import annotations

from ..legged.settings import Commands, Gaits, Randomisation, Settings, Stage
from .robot import ROBOT

REWARDS = {
    "alive": 0.5,
    "velocity": 1.0,
    "velocity_mean": 0.8,
    "yaw_rate": 0.5,
    "yaw_rate_mean": 0.4,
    "vertical_speed": -0.5,
    "tilt_rate": -0.08,
    "tilt": -5.0,
    "height": -30.0,
    "torque": -1e-5,
    "joint_acceleration": -1e-7,
    "action_rate": -0.02,
    "action_jerk": -0.01,
    "hip": -1.0,
    "posture": -0.03,
    "standing": -0.2,
    "swing_force": -0.5,
    "stance_slip": -0.5,
    "clearance": -25.0,
    "sole": -100.0,
    "narrow": -100.0,
}

SETTINGS = Settings(
    robot=ROBOT,
    commands=Commands(vx=(-0.4, 0.9), vy=(-0.3, 0.3), yaw_rate=(-0.8, 0.8)),
    gaits=Gaits(
        shares=(1.0, 0.0, 0.0),
        frequency=(1.25, 1.75),
        duration=(0.54, 0.62),
        swing_height=(0.05, 0.09),
        body_height=(-0.03, 0.01),
    ),
    randomisation=Randomisation(payload=(-1.0, 2.0), push=0.5, level=0.5, friction=(0.4, 1.3), soft_share=0.0, start=0.05),
    rewards=REWARDS,
    stages=(Stage(3000, -8e-4, 0.5, 0.004, 6),),
    fall_height=0.45,
)
