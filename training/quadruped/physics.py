"""One control step of the physics: motors with delay and friction, soil under the feet."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from mujoco import mjx

from . import robot, terrain
from .worlds import World

FRICTION_SPEED = 0.3  # at which joint friction reaches 76 % of its full torque [rad/s]; keeps explicit steps stable
YIELD_TIME = 0.02  # in which soil yields to a load [s]
DEEPEST_PRINT = 0.15  # rigid ground below soil [m]
FIRST_CALF = 4  # body: world, trunk, then hip, thigh, calf of each leg


class Outcome(NamedTuple):
    """A control step as rewards see it; means are over its physics steps."""

    foot_force: jax.Array  # (4,) mean normal force [N]
    foot_velocity: jax.Array  # (4, 3) mean, world frame [m/s]
    torque: jax.Array  # (12,) mean of squares [N² m²]
    power: jax.Array  # mean of the positive mechanical power of all joints [W]


def foot_positions(data: mjx.Data) -> jax.Array:
    """(4, 3) centres of the feet, of the latest forward kinematics; geom 0 is the ground."""
    return data.geom_xpos[1:5]


def contact_forces(data: mjx.Data) -> jax.Array:
    """(4, 2) normal forces of the contacts below and beside each foot [N]: sums over the friction pyramid's edges."""
    return data._impl.efc_force.reshape(4, 2, 4).sum(axis=2)


def _soil(maps: jax.Array, world: World, data: mjx.Data, timestep: float) -> terrain.Ground:
    """Prints after a step: soil yields until it carries the load, and a lifted foot leaves its print behind."""
    ground = terrain.unpack(data.userdata)
    feet = foot_positions(data)
    bottom = feet[:, 2] - robot.FOOT_RADIUS
    surface = terrain.heights(maps, ground, feet[:, :2])
    load = contact_forces(data)[:, 0]
    yielding = jnp.maximum(load * world.compliance - ground.sinkage, 0) * timestep / YIELD_TIME
    sinkage = jnp.clip(ground.sinkage + yielding, 0, DEEPEST_PRINT)
    return ground._replace(sinkage=jnp.where(bottom > surface + 0.005, 0.0, sinkage))


def _drag(maps: jax.Array, world: World, data: mjx.Data, velocity: jax.Array) -> jax.Array:
    """(nbody, 6) forces of soil against the horizontal motion of feet below its surface."""
    feet = jnp.nan_to_num(foot_positions(data))  # of a world that has just been reset after it diverged
    surface = terrain.heights(maps, terrain.unpack(data.userdata), feet[:, :2])
    depth = jnp.clip(surface - feet[:, 2] + robot.FOOT_RADIUS, 0, DEEPEST_PRINT)
    force = -world.soil_drag * depth[:, None] * velocity[:, :2]
    calves = FIRST_CALF + 3 * jnp.arange(4)
    return jnp.zeros_like(data.xfrc_applied).at[calves, :2].set(jnp.clip(force, -40, 40))


def motor_torques(world: World, data: mjx.Data, target: jax.Array) -> jax.Array:
    """(12,) of motors with PD control, before joint friction [N m]."""
    position, velocity = data.qpos[7:], data.qvel[6:]
    torque = world.strength * (world.stiffness * (target - position) - world.damping * velocity)
    return jnp.clip(torque, -robot.TORQUE_LIMIT, robot.TORQUE_LIMIT)


def control_step(
    maps: jax.Array, world: World, model: mjx.Model, data: mjx.Data, targets: jax.Array, timestep: float
) -> tuple[mjx.Data, Outcome]:
    """Steps through one control period; `targets` (2, 12): until the delay has passed, and then [rad]."""
    steps = round(robot.CONTROL_PERIOD / timestep)

    def step(carry: tuple[mjx.Data, jax.Array], number: jax.Array) -> tuple[tuple[mjx.Data, jax.Array], Outcome]:
        data, velocity = carry
        before = foot_positions(data)
        torque = motor_torques(world, data, targets[(number >= world.delay).astype(jnp.int32)])
        speed = data.qvel[6:]
        friction = robot.JOINT_FRICTION * jnp.tanh(speed / FRICTION_SPEED)
        applied = jnp.concatenate([jnp.zeros(6), torque - friction])
        data = data.replace(qfrc_applied=applied, xfrc_applied=_drag(maps, world, data, velocity))
        data = mjx.step(model, data)
        velocity = jnp.where(number > 0, (foot_positions(data) - before) / timestep, 0.0)
        data = data.replace(userdata=terrain.pack(_soil(maps, world, data, timestep)))
        outcome = Outcome(contact_forces(data).sum(axis=1), velocity, torque**2, jnp.maximum(torque * speed, 0).sum())
        return (data, velocity), outcome

    (data, _), outcomes = jax.lax.scan(step, (data, jnp.zeros((4, 3))), jnp.arange(steps))
    mean = jax.tree_util.tree_map(lambda values: values.mean(axis=0), outcomes)
    return data, mean._replace(foot_velocity=mean.foot_velocity * steps / (steps - 1))
