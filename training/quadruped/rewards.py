"""Rewards of one control step, as rates per second before their weights (settings.REWARDS)."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp

from . import gait as gaits
from . import robot
from .physics import Outcome


class Scene(NamedTuple):
    """What happened in one control step of one world; h: heading frame, B: base frame, lengths above the ground."""

    command: jax.Array  # (3,) vx, vy, yaw rate [m/s, m/s, rad/s]
    gait: gaits.Gait
    phases: jax.Array  # (4,) of the feet
    velocity_h: jax.Array  # (3,) of the trunk's origin [m/s]
    mean_velocity_h: jax.Array  # (3,) vx, vy, yaw rate, averaged over about a stride
    angular_B: jax.Array  # (3,) [rad/s]
    gravity_B: jax.Array  # (3,) direction of gravity
    height: jax.Array  # of the trunk's origin above the ground under the feet [m]
    foot_clearance: jax.Array  # (4,) of each foot's lowest point above the highest ground near it [m]
    buried: jax.Array  # number of points of the shanks inside the ground
    belly: jax.Array  # number of points of the trunk inside the ground
    position: jax.Array  # (12,) joints [rad]
    acceleration: jax.Array  # (12,) joints [rad/s²]
    actions: jax.Array  # (3, 12) this action, the previous one, the one before it
    outcome: Outcome


def is_standing(command: jax.Array) -> jax.Array:
    return jnp.linalg.norm(command) < 0.05


def _velocity(s: Scene) -> dict[str, jax.Array]:
    error = jnp.sum((s.velocity_h[:2] - s.command[:2]) ** 2)
    mean_error = jnp.sum((s.mean_velocity_h[:2] - s.command[:2]) ** 2)
    yaw_error = (s.angular_B[2] - s.command[2]) ** 2
    mean_yaw_error = (s.mean_velocity_h[2] - s.command[2]) ** 2
    return {
        "velocity": jnp.exp(-error / 0.25),
        "velocity_mean": jnp.exp(-mean_error / 0.02),
        "yaw_rate": jnp.exp(-yaw_error / 0.25),
        "yaw_rate_mean": jnp.exp(-mean_yaw_error / 0.03),
    }


def _body(s: Scene) -> dict[str, jax.Array]:
    error = s.height - robot.NOMINAL_HEIGHT - s.gait.body_height
    return {
        "vertical_speed": s.velocity_h[2] ** 2,
        "tilt_rate": jnp.sum(s.angular_B[:2] ** 2),
        "tilt": jnp.sum(s.gravity_B[:2] ** 2),
        "height": error**2,
        "belly": s.belly,
    }


def _effort(s: Scene) -> dict[str, jax.Array]:
    now, last, before = s.actions
    deviation = s.position - robot.DEFAULT_POSITIONS
    return {
        "torque": s.outcome.torque.sum(),
        "power": s.outcome.power,
        "joint_acceleration": jnp.sum(s.acceleration**2),
        "action_rate": jnp.sum((now - last) ** 2),
        "action_jerk": jnp.sum((now - 2 * last + before) ** 2),
        "hip": jnp.sum(deviation[0::3] ** 2),
        "posture": jnp.sum(deviation**2),
        "standing": is_standing(s.command) * jnp.sum(jnp.abs(deviation)),
    }


def _feet(s: Scene) -> dict[str, jax.Array]:
    stance = jnp.where(is_standing(s.command), 1.0, gaits.wanted_contacts(s.phases))
    speed = jnp.sum(s.outcome.foot_velocity**2, axis=1)
    low = s.foot_clearance - gaits.wanted_clearances(s.phases, s.gait)
    return {
        "swing_force": jnp.sum((1 - stance) * (1 - jnp.exp(-((s.outcome.foot_force / 30) ** 2)))),
        "stance_slip": jnp.sum(stance * (1 - jnp.exp(-speed / 0.1))),
        "clearance": jnp.sum((1 - stance) * jnp.where(low < 0, 1.0, 0.3) * low**2),
        "shank": s.buried,
    }


def rewards(s: Scene) -> dict[str, jax.Array]:
    """One number for each key of settings.REWARDS, without its weight."""
    return _velocity(s) | _body(s) | _effort(s) | _feet(s)
