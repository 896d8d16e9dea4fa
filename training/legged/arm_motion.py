"""Random motions of an arm that the policy does not control."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp

from .commands import steps_until
from .robot import CONTROL_PERIOD, Robot


class ArmMotion(NamedTuple):
    """Arrays of no elements for robots without an arm."""

    goal: jax.Array  # (arm joints,) next posture [rad]
    target: jax.Array  # (arm joints,) on the way to it [rad]
    speed: jax.Array  # of each joint [rad/s]
    steps_left: jax.Array  # control steps until the next goal


def _draw(robot: Robot, key: jax.Array) -> ArmMotion:
    if robot.arm is None:
        return ArmMotion(jnp.zeros(0), jnp.zeros(0), jnp.zeros(()), jnp.zeros((), jnp.int32))
    keys, arm = jax.random.split(key, 3), robot.arm
    goal = jax.random.uniform(keys[0], arm.low.shape, minval=jnp.asarray(arm.low), maxval=jnp.asarray(arm.high))
    speed = jax.random.uniform(keys[1], (), minval=arm.speed[0], maxval=arm.speed[1])
    return ArmMotion(goal, goal, speed, steps_until(keys[2], arm.interval))


def begin(robot: Robot, key: jax.Array) -> ArmMotion:
    """At rest in a random posture."""
    return _draw(robot, key)


def advance(robot: Robot, motion: ArmMotion, key: jax.Array) -> ArmMotion:
    """One control period later: the target moves towards the goal, or a new goal is drawn."""
    most = motion.speed * CONTROL_PERIOD
    target = motion.target + jnp.clip(motion.goal - motion.target, -most, most)
    motion = motion._replace(target=target, steps_left=motion.steps_left - 1)
    fresh = _draw(robot, key)._replace(target=target)
    return jax.tree_util.tree_map(lambda new, old: jnp.where(motion.steps_left <= 0, new, old), fresh, motion)
