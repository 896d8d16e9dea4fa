"""One control step of the physics: motors with delay and friction, soil under the feet."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

from . import terrain
from .robot import CONTROL_PERIOD, Robot, training_spec
from .worlds import World

FRICTION_SPEED = 0.3  # at which joint friction reaches 76 % of its full torque [rad/s]; keeps explicit steps stable
YIELD_TIME = 0.02  # in which soil yields to a load [s]
DEEPEST_PRINT = 0.15  # rigid ground below soil [m]
MOST_DRAG = 0.32  # of soil on one foot, in weights of the robot


class Outcome(NamedTuple):
    """A control step as rewards see it; means are over its physics steps."""

    foot_force: jax.Array  # (feet,) mean normal force [N]
    foot_velocity: jax.Array  # (feet, 3) mean, world frame [m/s]
    torque: jax.Array  # (joints,) mean of squares [N² m²]
    power: jax.Array  # mean of the positive mechanical power of the policy's joints [W]


class Physics:
    """Steps one world of a robot; `maps`: heights of the grounds, which terrain.install() made known to MJX."""

    def __init__(self, robot: Robot, maps: jax.Array, timestep: float) -> None:
        self.robot, self.maps, self.timestep = robot, maps, timestep
        model: mujoco.MjModel = training_spec(robot, timestep).compile()
        feet = [model.body(name).id for name in robot.feet]
        self.sphere_bodies = np.repeat(feet, len(robot.sole))
        # MuJoCo sorts geoms by their body, so the ground is geom 0 and the spheres follow in the order of their bodies.
        self.spheres = np.concatenate([np.flatnonzero(model.geom_bodyid == foot) for foot in feet])
        names = (*robot.joints, *(robot.arm.joints if robot.arm else ()))
        if [model.joint(number + 1).name for number in range(model.njnt - 1)] != list(names):
            raise ValueError(f"{robot.file}: its joints after the free joint are not {', '.join(names)}")
        if (np.diff(self.spheres) != 1).any():
            raise ValueError(f"{robot.file}: the order of its feet is not {', '.join(robot.feet)}")

    def sphere_positions(self, data: mjx.Data) -> jax.Array:
        """(spheres, 3) centres, of the latest forward kinematics."""
        return data.geom_xpos[self.spheres]

    def per_foot(self, values: jax.Array) -> jax.Array:
        """(feet, spheres of a foot, …) from (spheres, …)."""
        return values.reshape(len(self.robot.feet), len(self.robot.sole), *values.shape[1:])

    def foot_positions(self, data: mjx.Data) -> jax.Array:
        """(feet, 3) means of the spheres' centres."""
        return self.per_foot(self.sphere_positions(data)).mean(axis=1)

    def contact_forces(self, data: mjx.Data) -> jax.Array:
        """(spheres, 2) normal forces of the contacts below and beside [N]: sums over the friction pyramid's edges."""
        return data._impl.efc_force.reshape(-1, 2, 4).sum(axis=2)

    def _soil(self, world: World, data: mjx.Data) -> terrain.Ground:
        """Prints after a step: soil yields until it carries the load, and a lifted foot leaves its print behind."""
        ground = terrain.unpack(data.userdata)
        spheres = self.sphere_positions(data)
        bottom = spheres[:, 2] - self.robot.sole_radius
        surface = terrain.heights(self.maps, ground, spheres[:, :2])
        load = self.contact_forces(data)[:, 0]
        yielding = jnp.maximum(load * world.compliance - ground.sinkage, 0) * self.timestep / YIELD_TIME
        sinkage = jnp.clip(ground.sinkage + yielding, 0, DEEPEST_PRINT)
        return ground._replace(sinkage=jnp.where(bottom > surface + 0.005, 0.0, sinkage))

    def _drag(self, world: World, data: mjx.Data, velocity: jax.Array) -> jax.Array:
        """(nbody, 6) forces of soil against the horizontal motion of spheres below its surface."""
        spheres = jnp.nan_to_num(self.sphere_positions(data))  # of a world that has just been reset after it diverged
        surface = terrain.heights(self.maps, terrain.unpack(data.userdata), spheres[:, :2])
        depth = jnp.clip(surface - spheres[:, 2] + self.robot.sole_radius, 0, DEEPEST_PRINT)
        force = -world.soil_drag / len(self.robot.sole) * depth[:, None] * velocity[:, :2]
        most = MOST_DRAG * self.robot.weight / len(self.robot.sole)
        return jnp.zeros_like(data.xfrc_applied).at[self.sphere_bodies, :2].add(jnp.clip(force, -most, most))

    def _motor_torques(self, world: World, data: mjx.Data, target: jax.Array) -> jax.Array:
        """(joints,) of motors with PD control, before joint friction [N m]."""
        count, limit = len(self.robot.joints), self.robot.torque_limit
        position, velocity = data.qpos[7 : 7 + count], data.qvel[6 : 6 + count]
        torque = world.strength * (world.stiffness * (target - position) - world.damping * velocity)
        return jnp.clip(torque, -limit, limit)

    def _arm_torques(self, data: mjx.Data, target: jax.Array) -> jax.Array:
        """(arm joints,) [N m]"""
        arm, first = self.robot.arm, len(self.robot.joints)
        if arm is None:
            return jnp.zeros(0)
        torque = arm.stiffness * (target - data.qpos[7 + first :]) - arm.damping * data.qvel[6 + first :]
        return jnp.clip(torque, -arm.torque_limit, arm.torque_limit)

    def control_step(
        self, world: World, model: mjx.Model, data: mjx.Data, targets: jax.Array, arm_target: jax.Array
    ) -> tuple[mjx.Data, Outcome]:
        """Steps through one control period; `targets` (2, joints): until the delay has passed, and then [rad]."""
        steps, joints = round(CONTROL_PERIOD / self.timestep), slice(6, 6 + len(self.robot.joints))

        def step(carry: tuple[mjx.Data, jax.Array], number: jax.Array) -> tuple[tuple[mjx.Data, jax.Array], Outcome]:
            data, velocity = carry
            before = self.sphere_positions(data)
            torque = self._motor_torques(world, data, targets[(number >= world.delay).astype(jnp.int32)])
            speed = data.qvel[joints]
            friction = self.robot.friction * jnp.tanh(speed / FRICTION_SPEED)
            applied = jnp.concatenate([jnp.zeros(6), torque - friction, self._arm_torques(data, arm_target)])
            data = data.replace(qfrc_applied=applied, xfrc_applied=self._drag(world, data, velocity))
            data = mjx.step(model, data)
            velocity = jnp.where(number > 0, (self.sphere_positions(data) - before) / self.timestep, 0.0)
            data = data.replace(userdata=terrain.pack(self._soil(world, data)))
            force = self.per_foot(self.contact_forces(data).sum(axis=1)).sum(axis=1)
            power = jnp.maximum(torque * speed, 0).sum()
            return (data, velocity), Outcome(force, self.per_foot(velocity).mean(axis=1), torque**2, power)

        start = data, jnp.zeros((self.robot.spheres, 3))
        (data, _), outcomes = jax.lax.scan(step, start, jnp.arange(steps))
        mean = jax.tree_util.tree_map(lambda values: values.mean(axis=0), outcomes)
        return data, mean._replace(foot_velocity=mean.foot_velocity * steps / (steps - 1))
