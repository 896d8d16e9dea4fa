"""The quadruped's training. The published network was trained in these two stages."""

from __future__ import annotations

from ..legged.settings import Commands, Gaits, Randomisation, Settings, Stage
from .robot import ROBOT

REWARDS = {
    "velocity": 1.0,
    "velocity_mean": 0.8,
    "yaw_rate": 0.5,
    "yaw_rate_mean": 0.4,
    "vertical_speed": -1.0,
    "tilt_rate": -0.04,
    "tilt": -2.5,
    "height": -25.0,
    "torque": -1e-4,
    "joint_acceleration": -1e-7,
    "action_rate": -0.02,
    "action_jerk": -0.01,
    "hip": -0.3,
    "posture": -0.03,
    "standing": -0.3,
    "swing_force": -0.4,
    "stance_slip": -0.4,
    "clearance": -25.0,
    "shank": -0.4,
    "belly": -0.5,
}

SETTINGS = Settings(
    robot=ROBOT,
    commands=Commands(vx=(-0.8, 1.6), vy=(-0.5, 0.5), yaw_rate=(-1.3, 1.3)),
    gaits=Gaits(
        shares=(0.7, 0.15, 0.15),
        frequency=(1.8, 3.6),
        duration=(0.45, 0.6),
        swing_height=(0.04, 0.12),
        body_height=(-0.05, 0.03),
    ),
    randomisation=Randomisation(payload=(-1.5, 2.0), push=1.0),
    rewards=REWARDS,
    stages=(Stage(1047, -2e-3, 0.7, 0.005, 12), Stage(3375, -4e-3, 1.0, 0.003, 13)),
    fall_height=0.1,
    velocity_feedback=3.0,
)
