"""Rewards of one control step, as rates per second before their weights (Settings.rewards)."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp

from . import gait as gaits
from .physics import Outcome
from .robot import Robot

LEAST_STANCE_WIDTH = 0.17  # between the feet of a robot with two legs [m]


class Scene(NamedTuple):
    """What happened in one control step of one world; h: heading frame, B: base frame, lengths above the ground."""

    command: jax.Array  # (3,) vx, vy, yaw rate [m/s, m/s, rad/s]
    gait: gaits.Gait
    phases: jax.Array  # (feet,)
    velocity_h: jax.Array  # (3,) of the trunk's origin [m/s]
    mean_velocity_h: jax.Array  # (3,) vx, vy, yaw rate, averaged over about a stride
    angular_B: jax.Array  # (3,) [rad/s]
    gravity_B: jax.Array  # (3,) direction of gravity
    height: jax.Array  # of the trunk's origin above the ground under the feet [m]
    foot_clearance: jax.Array  # (feet,) of each foot's lowest point above the highest ground near it [m]
    sole_slope: jax.Array  # (feet,) differences of height of each sole's spheres [m]
    stance_width: jax.Array  # distance of the first two feet across the heading [m]
    buried: jax.Array  # number of points of the shanks inside the ground
    belly: jax.Array  # number of points of the trunk inside the ground
    position: jax.Array  # (joints,) [rad]
    acceleration: jax.Array  # (joints,) [rad/s²]
    actions: jax.Array  # (3, joints) this action, the previous one, the one before it
    outcome: Outcome


def is_standing(command: jax.Array) -> jax.Array:
    return jnp.linalg.norm(command) < 0.05


def _velocity(s: Scene) -> dict[str, jax.Array]:
    error = jnp.sum((s.velocity_h[:2] - s.command[:2]) ** 2)
    mean_error = jnp.sum((s.mean_velocity_h[:2] - s.command[:2]) ** 2)
    yaw_error = (s.angular_B[2] - s.command[2]) ** 2
    mean_yaw_error = (s.mean_velocity_h[2] - s.command[2]) ** 2
    return {
        "alive": jnp.ones(()),
        "velocity": jnp.exp(-error / 0.25),
        "velocity_mean": jnp.exp(-mean_error / 0.02),
        "yaw_rate": jnp.exp(-yaw_error / 0.25),
        "yaw_rate_mean": jnp.exp(-mean_yaw_error / 0.03),
    }


def _body(s: Scene, robot: Robot) -> dict[str, jax.Array]:
    error = s.height - robot.nominal_height - s.gait.body_height
    return {
        "vertical_speed": s.velocity_h[2] ** 2,
        "tilt_rate": jnp.sum(s.angular_B[:2] ** 2),
        "tilt": jnp.sum(s.gravity_B[:2] ** 2),
        "height": error**2,
        "belly": s.belly,
    }


def _effort(s: Scene, robot: Robot) -> dict[str, jax.Array]:
    now, last, before = s.actions
    deviation = s.position - robot.default_positions
    return {
        "torque": s.outcome.torque.sum(),
        "power": s.outcome.power,
        "joint_acceleration": jnp.sum(s.acceleration**2),
        "action_rate": jnp.sum((now - last) ** 2),
        "action_jerk": jnp.sum((now - 2 * last + before) ** 2),
        "hip": jnp.sum(deviation[jnp.asarray(robot.abduction)] ** 2),
        "posture": jnp.sum(deviation**2),
        "standing": is_standing(s.command) * jnp.sum(jnp.abs(deviation)),
    }


def _feet(s: Scene, robot: Robot) -> dict[str, jax.Array]:
    stance = jnp.where(is_standing(s.command), 1.0, gaits.wanted_contacts(s.phases))
    speed = jnp.sum(s.outcome.foot_velocity**2, axis=1)
    low = s.foot_clearance - gaits.wanted_clearances(s.phases, s.gait)
    return {
        "swing_force": jnp.sum((1 - stance) * (1 - jnp.exp(-((4 * s.outcome.foot_force / robot.weight) ** 2)))),
        "stance_slip": jnp.sum(stance * (1 - jnp.exp(-speed / 0.1))),
        "clearance": jnp.sum((1 - stance) * jnp.where(low < 0, 1.0, 0.3) * low**2),
        "shank": s.buried,
        "sole": jnp.sum(s.sole_slope**2),
        "narrow": jnp.maximum(LEAST_STANCE_WIDTH - s.stance_width, 0) ** 2,
    }


def rewards(s: Scene, robot: Robot) -> dict[str, jax.Array]:
    """All rewards, without their weights."""
    return _velocity(s) | _body(s, robot) | _effort(s, robot) | _feet(s, robot)
