"""Randomised robots: what differs between the training's worlds and stays for a whole run."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import mujoco
from mujoco import mjx

from . import robot
from .settings import Settings


class World(NamedTuple):
    """Constants of one world; each with a leading axis of all worlds outside of vmap."""

    map: jax.Array  # kind of ground
    stiffness: jax.Array  # kp [N m/rad]
    damping: jax.Array  # kd [N m s/rad]
    strength: jax.Array  # (12,) factor of each motor's torque
    delay: jax.Array  # physics steps until new targets act
    compliance: jax.Array  # of soil [m/N]; 0 = rigid
    soil_drag: jax.Array  # [N s/m²]
    friction: jax.Array
    payload: jax.Array  # [kg]


def make_world(key: jax.Array, settings: Settings) -> World:
    r = settings.randomisation
    keys = jax.random.split(key, 10)

    def uniform(number: int, low: float, high: float, shape: tuple[int, ...] = ()) -> jax.Array:
        return jax.random.uniform(keys[number], shape, minval=low, maxval=high)

    soft = uniform(0, 0, 1) < r.soft_share
    compliance = jnp.exp(uniform(1, *(float(jnp.log(c)) for c in r.compliance)))
    return World(
        map=jax.random.randint(keys[2], (), 0, r.maps),
        stiffness=robot.STIFFNESS * uniform(3, 1 - r.gains, 1 + r.gains),
        damping=robot.DAMPING * uniform(4, 1 - r.gains, 1 + r.gains),
        strength=uniform(5, 1 - r.strength, 1 + r.strength, (12,)),
        delay=jax.random.randint(keys[6], (), 0, r.delay + 1),
        compliance=jnp.where(soft, compliance, 0.0),
        soil_drag=jnp.where(soft, uniform(7, *r.soil_drag), 0.0),
        friction=uniform(8, *r.friction),
        payload=uniform(9, *r.payload),
    )


def make_models(key: jax.Array, worlds: World, settings: Settings) -> tuple[mjx.Model, Any]:
    """A model whose randomised arrays have a leading axis of worlds, and the axes for vmap.

    The payload is spread over the trunk: its inertia grows with its mass.
    """
    r = settings.randomisation
    compiled = robot.feet_only_spec(settings.timestep).compile()
    trunk = mujoco.mj_name2id(compiled, mujoco.mjtObj.mjOBJ_BODY, "trunk")
    model = mjx.put_model(compiled)

    def change(key: jax.Array, world: World) -> dict[str, jax.Array]:
        keys = jax.random.split(key)
        factor = 1 + world.payload / model.body_mass[trunk]
        shift = jax.random.uniform(keys[0], (3,), minval=-r.centre_of_mass, maxval=r.centre_of_mass)
        contact_time = jax.random.uniform(keys[1], (), minval=r.contact_time[0], maxval=r.contact_time[1])
        return {
            "body_mass": model.body_mass.at[trunk].mul(factor),
            "body_inertia": model.body_inertia.at[trunk].mul(factor),
            "body_ipos": model.body_ipos.at[trunk].add(shift),
            "geom_friction": model.geom_friction.at[:, 0].set(world.friction),
            "geom_solref": model.geom_solref.at[:, 0].set(contact_time),
        }

    changed = jax.vmap(change)(jax.random.split(key, len(worlds.map)), worlds)
    axes = jax.tree_util.tree_map(lambda _: None, model)
    return model.tree_replace(changed), axes.tree_replace(dict.fromkeys(changed, 0))
