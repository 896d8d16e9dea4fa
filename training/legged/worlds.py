"""Randomised robots: what differs between the training's worlds and stays for a whole run."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

from .robot import Robot, training_spec
from .settings import Settings


class World(NamedTuple):
    """Constants of one world; each with a leading axis of all worlds outside of vmap."""

    map: jax.Array  # kind of ground
    stiffness: jax.Array  # (joints,) kp of the policy's joints [N m/rad]
    damping: jax.Array  # (joints,) kd [N m s/rad]
    strength: jax.Array  # (joints,) factor of each motor's torque
    delay: jax.Array  # physics steps until new targets act
    compliance: jax.Array  # of soil [m/N]; 0 = rigid
    soil_drag: jax.Array  # [N s/m²]
    friction: jax.Array
    payload: jax.Array  # on the trunk [kg]
    load: jax.Array  # in the hand [kg]


def make_world(key: jax.Array, settings: Settings) -> World:
    r, robot = settings.randomisation, settings.robot
    keys = jax.random.split(key, 11)

    def uniform(number: int, low: float, high: float, shape: tuple[int, ...] = ()) -> jax.Array:
        return jax.random.uniform(keys[number], shape, minval=low, maxval=high)

    soft = uniform(0, 0, 1) < r.soft_share
    compliance = jnp.exp(uniform(1, *(float(np.log(c)) for c in r.compliance)))
    return World(
        map=jax.random.randint(keys[2], (), 0, r.maps),
        stiffness=robot.stiffness * uniform(3, 1 - r.gains, 1 + r.gains),
        damping=robot.damping * uniform(4, 1 - r.gains, 1 + r.gains),
        strength=uniform(5, 1 - r.strength, 1 + r.strength, (len(robot.joints),)),
        delay=jax.random.randint(keys[6], (), 0, r.delay + 1),
        compliance=jnp.where(soft, compliance, 0.0),
        soil_drag=jnp.where(soft, uniform(7, *r.soil_drag), 0.0),
        friction=uniform(8, *r.friction),
        payload=uniform(9, *r.payload),
        load=uniform(10, *robot.arm.load) if robot.arm else jnp.zeros(()),
    )


def trunk_id(model: mujoco.MjModel | mjx.Model) -> int:
    """The body of the free joint, which is the first joint."""
    return int(model.jnt_bodyid[0])


def _loaded(model: mjx.Model, hand: int, robot: Robot, load: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Mass and centre of mass of a hand that carries a point mass; the load's own inertia is neglected."""
    mass = model.body_mass[hand] + load
    grip = jnp.asarray(robot.arm.grip if robot.arm else (0.0, 0.0, 0.0))
    return mass, model.body_ipos[hand] + load / mass * (grip - model.body_ipos[hand])


def make_models(key: jax.Array, worlds: World, settings: Settings) -> tuple[mjx.Model, Any]:
    """A model whose randomised arrays have a leading axis of worlds, and the axes for vmap.

    The payload is spread over the trunk: its inertia grows with its mass.
    """
    r, robot = settings.randomisation, settings.robot
    compiled = training_spec(robot, settings.timestep).compile()
    trunk = trunk_id(compiled)
    model = mjx.put_model(compiled)

    def change(key: jax.Array, world: World) -> dict[str, jax.Array]:
        keys = jax.random.split(key)
        factor = 1 + world.payload / model.body_mass[trunk]
        shift = jax.random.uniform(keys[0], (3,), minval=-r.centre_of_mass, maxval=r.centre_of_mass)
        contact_time = jax.random.uniform(keys[1], (), minval=r.contact_time[0], maxval=r.contact_time[1])
        mass = model.body_mass.at[trunk].mul(factor)
        centre = model.body_ipos.at[trunk].add(shift)
        if robot.arm:
            hand = compiled.body(robot.arm.hand).id
            hand_mass, hand_centre = _loaded(model, hand, robot, world.load)
            mass, centre = mass.at[hand].set(hand_mass), centre.at[hand].set(hand_centre)
        return {
            "body_mass": mass,
            "body_inertia": model.body_inertia.at[trunk].mul(factor),
            "body_ipos": centre,
            "geom_friction": model.geom_friction.at[:, 0].set(world.friction),
            "geom_solref": model.geom_solref.at[:, 0].set(contact_time),
        }

    changed = jax.vmap(change)(jax.random.split(key, len(worlds.map)), worlds)
    axes = jax.tree_util.tree_map(lambda _: None, model)
    return model.tree_replace(changed), axes.tree_replace(dict.fromkeys(changed, 0))
