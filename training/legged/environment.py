"""Environment: one world's state, step and reset, for jax.vmap over worlds."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from mujoco import mjx

from . import arm_motion, commands, observation, terrain
from . import gait as gaits
from .physics import Outcome, Physics
from .rewards import Scene, rewards
from .robot import ACTION_CLIP, CONTROL_PERIOD, training_spec
from .settings import Settings
from .terms import actor_terms, critic_terms
from .worlds import World

MEAN_TIME = 0.3  # of the averaged velocity [s]; about a stride
_SHANK_POINTS = (0.35, 0.65)  # along the line from knee to foot
_AROUND_FOOT = [[0.0, 0.0], [0.07, 0.0], [-0.07, 0.0], [0.0, 0.07], [0.0, -0.07]]  # [m]


class State(NamedTuple):
    data: mjx.Data
    key: jax.Array
    command: jax.Array  # (3,)
    gait: gaits.Gait
    index: jax.Array  # of the gait clock
    history: observation.History
    hidden: jax.Array  # values that only the critic sees
    actions: jax.Array  # (2, joints) the latest action and the one before it
    arm: arm_motion.ArmMotion
    mean_velocity: jax.Array  # (3,) heading frame: vx, vy, yaw rate
    level: jax.Array  # difficulty of the ground; survives a reset
    steps: jax.Array  # of this episode
    until_command: jax.Array  # control steps until the next command
    until_push: jax.Array
    tracking: jax.Array  # sum over the episode of the velocity reward


class Transition(NamedTuple):
    reward: jax.Array
    fell: jax.Array
    timed_out: jax.Array
    terms: dict[str, jax.Array]  # weighted reward rates and measures, for the log


def _rotation(quaternion: jax.Array) -> jax.Array:
    """R_WB of a unit quaternion w x y z."""
    w, x, y, z = quaternion
    return jnp.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _heading(R_WB: jax.Array) -> jax.Array:
    """R_WH (2, 2): the base's x axis in the world's xy plane."""
    x = R_WB[:2, 0] / (jnp.linalg.norm(R_WB[:2, 0]) + 1e-6)
    return jnp.array([[x[0], -x[1]], [x[1], x[0]]])


class Environment:
    """The functions of one world. `maps`: heights of the grounds, which terrain.install() made known to MJX."""

    def __init__(self, maps: jax.Array, settings: Settings) -> None:
        self.maps, self.settings, self.robot = maps, settings, settings.robot
        self.physics = Physics(settings.robot, maps, settings.timestep)
        self.actor, self.critic = actor_terms(settings.robot), critic_terms(settings.robot)
        self.joints = len(settings.robot.joints)
        self.steps_per_episode = round(settings.episode / CONTROL_PERIOD)
        model = training_spec(settings.robot, settings.timestep).compile()
        self.knees = np.array([model.body(name).id for name in settings.robot.shins])

    def _observed(self, state: State, key: jax.Array) -> dict[str, jax.Array]:
        """Values of the observation terms, with the noise of the sensors."""
        r, data, n = self.settings.randomisation, state.data, self.joints
        keys = jax.random.split(key, 5)
        R_WB = _rotation(data.qpos[3:7])

        def noise(number: int, size: int, limit: float) -> jax.Array:
            return jax.random.uniform(keys[number], (size,), minval=-limit, maxval=limit)

        return {
            "base_lin_vel": R_WB.T @ data.qvel[:3] + noise(4, 3, r.velocity_noise),
            "base_ang_vel": data.qvel[3:6] + noise(0, 3, r.gyro_noise),
            "projected_gravity": -R_WB[2] + noise(1, 3, r.gravity_noise),
            "joint_pos": data.qpos[7 : 7 + n] - self.robot.default_positions + noise(2, n, r.joint_noise),
            "joint_vel": data.qvel[6 : 6 + n] + noise(3, n, r.joint_speed_noise),
            "last_action": state.actions[0],
            "velocity_commands": state.command,
            "gait_parameters": jnp.stack(state.gait),
            "gait_clock": gaits.clock(gaits.foot_phases(state.index, state.gait)),
        }

    def _hidden(self, state: State, world: World, force: jax.Array) -> jax.Array:
        data, ground = state.data, terrain.unpack(state.data.userdata)
        R_WB = _rotation(data.qpos[3:7])
        feet = self.physics.foot_positions(data)
        nearby = data.qpos[:2] + jnp.array(self.robot.nearby) @ _heading(R_WB).T
        values = {
            "base_lin_vel": R_WB.T @ data.qvel[:3],
            "foot_height": feet[:, 2] - self.robot.sole_radius - terrain.heights(self.maps, ground, feet[:, :2]),
            "foot_force": force,
            "sinkage": self.physics.per_foot(ground.sinkage).mean(axis=1),
            "ground": data.qpos[2] - self.robot.nominal_height - terrain.heights(self.maps, ground, nearby),
            "world": jnp.stack([world.friction - 0.8, world.payload, world.compliance * 300, world.load]),
            "arm": jnp.concatenate([data.qpos[7 + self.joints :], state.arm.target]),
        }
        return observation.privileged(self.critic, values)

    def reset(self, state: State, world: World, progress: jax.Array, key: jax.Array) -> State:
        """The start of an episode on another part of the ground; keeps `state.level`."""
        keys, robot, n = jax.random.split(key, 12), self.robot, self.joints
        offset = jax.random.uniform(keys[0], (2,), maxval=terrain.CELLS * terrain.CELL)
        ground = terrain.Ground(world.map, offset, state.level, jnp.zeros(robot.spheres))
        yaw = jax.random.uniform(keys[1], (), maxval=2 * jnp.pi)
        quaternion = jnp.array([jnp.cos(yaw / 2), 0.0, 0.0, jnp.sin(yaw / 2)])
        under = jnp.array([[0.0, 0.0], *robot.nearby]) @ _heading(_rotation(quaternion)).T
        height = terrain.heights(self.maps, ground, under).max() + robot.nominal_height + 0.01
        start = self.settings.randomisation.start
        joints = robot.default_positions + jax.random.uniform(keys[2], (n,), minval=-start, maxval=start)
        arm = arm_motion.begin(robot, keys[11])
        speeds = jnp.concatenate([jax.random.uniform(keys[3], (6 + n,), minval=-0.3, maxval=0.3), jnp.zeros_like(arm.target)])
        data = state.data.replace(
            qpos=jnp.concatenate([jnp.array([0.0, 0.0]), height[None], quaternion, joints, arm.target]),
            qvel=speeds,
            qacc_warmstart=jnp.zeros_like(speeds),
            xfrc_applied=jnp.zeros_like(state.data.xfrc_applied),
            userdata=terrain.pack(ground),
        )
        fresh = state._replace(
            data=data,
            key=keys[4],
            command=commands.sample(keys[5], world.map, progress, self.settings.commands),
            gait=gaits.sample(keys[6], self.settings.gaits),
            index=jax.random.uniform(keys[7]),
            actions=jnp.zeros((2, n)),
            arm=arm,
            mean_velocity=jnp.zeros(3),
            steps=jnp.zeros((), jnp.int32),
            until_command=commands.steps_until(keys[8], self.settings.commands.interval),
            until_push=commands.steps_until(keys[9], self.settings.randomisation.push_interval),
            tracking=jnp.zeros(()),
        )
        history = observation.begin(self.actor, self._observed(fresh, keys[10]))
        return fresh._replace(history=history, hidden=self._hidden(fresh, world, jnp.zeros(len(robot.feet))))

    def first(self, data: mjx.Data, world: World, key: jax.Array) -> State:
        """The state before the first step; episodes start at random lengths so that worlds do not reset together."""
        keys = jax.random.split(key, 4)
        zero = jnp.zeros(())
        gait, arm = gaits.sample(keys[0], self.settings.gaits), arm_motion.begin(self.robot, keys[0])
        level = jax.random.uniform(keys[1], (), maxval=min(0.4, self.settings.randomisation.level))
        blank = State(data, key, jnp.zeros(3), gait, zero, (), zero, jnp.zeros((2, self.joints)), arm, jnp.zeros(3), level,
                      zero, zero, zero, zero)  # fmt: skip
        steps = jax.random.randint(keys[2], (), 0, self.steps_per_episode)
        return self.reset(blank, world, zero, keys[3])._replace(steps=steps)

    def _scene(self, state: State, action: jax.Array, outcome: Outcome, acceleration: jax.Array) -> Scene:
        """Measures of the state after the physics; the averaged velocity is state.mean_velocity."""
        data, ground = state.data, terrain.unpack(state.data.userdata)
        R_WB, feet = _rotation(data.qpos[3:7]), self.physics.foot_positions(data)
        R_WH = _heading(R_WB)
        planar = R_WH.T @ data.qvel[:2]
        sole_heights = self.physics.per_foot(self.physics.sphere_positions(data)[:, 2])
        under_feet = terrain.heights(self.maps, ground, feet[:, :2])
        around = (feet[:, None, :2] + jnp.array(_AROUND_FOOT)).reshape(-1, 2)
        highest = terrain.heights(self.maps, ground, around).reshape(len(feet), -1).max(axis=1)
        knees = data.xpos[self.knees]
        shank = jnp.concatenate([knees + s * (feet - knees) for s in _SHANK_POINTS])
        trunk = data.qpos[:3] + jnp.array(self.robot.belly).reshape(-1, 3) @ R_WB.T

        def inside(points: jax.Array) -> jax.Array:
            return jnp.sum(points[:, 2] < terrain.heights(self.maps, ground, points[:, :2]) - ground.sinkage.max())

        return Scene(
            command=state.command,
            gait=state.gait,
            phases=gaits.foot_phases(state.index, state.gait)[: len(feet)],
            velocity_h=jnp.concatenate([planar, data.qvel[2:3]]),
            mean_velocity_h=state.mean_velocity,
            angular_B=data.qvel[3:6],
            gravity_B=-R_WB[2],
            height=data.qpos[2] - jnp.mean(under_feet) + jnp.mean(ground.sinkage),
            foot_clearance=sole_heights.min(axis=1) - self.robot.sole_radius - highest,
            sole_slope=jnp.ptp(sole_heights, axis=1),
            stance_width=(R_WH.T @ (feet[0] - feet[1])[:2])[1],
            buried=inside(shank),
            belly=inside(trunk),
            position=data.qpos[7 : 7 + self.joints],
            acceleration=acceleration,
            actions=jnp.concatenate([action[None], state.actions]),
            outcome=outcome,
        )

    def _filtered(self, state: State, data: mjx.Data) -> jax.Array:
        planar = _heading(_rotation(data.qpos[3:7])).T @ data.qvel[:2]
        share = CONTROL_PERIOD / MEAN_TIME
        return state.mean_velocity + share * (jnp.append(planar, data.qvel[5]) - state.mean_velocity)

    def _level(self, state: State, fell: jax.Array, key: jax.Array) -> jax.Array:
        """Harder ground after a whole episode that followed its commands, easier ground after a fall."""
        share = state.tracking / jnp.maximum(state.steps, 1)
        level = state.level + jnp.where(fell, -0.1, jnp.where(share > 0.6, 0.1, 0.0)) * self.settings.randomisation.level / 1.2
        most = self.settings.randomisation.level
        return jnp.where(level > most, jax.random.uniform(key, (), minval=most / 4, maxval=most), jnp.maximum(level, 0.0))

    def _next_command(self, state: State, world: World, progress: jax.Array, key: jax.Array) -> State:
        keys = jax.random.split(key, 6)
        r = self.settings.randomisation
        renew, pushes = state.until_command <= 0, state.until_push <= 0
        angle, size = jax.random.uniform(keys[0], (), maxval=2 * jnp.pi), jax.random.uniform(keys[1]) * r.push
        spin = jax.random.uniform(keys[2], (3,), minval=-r.push_spin, maxval=r.push_spin)
        push = jnp.concatenate([jnp.stack([size * jnp.cos(angle), size * jnp.sin(angle), 0.0]), spin])
        gait = gaits.sample(keys[3], self.settings.gaits)
        return state._replace(
            data=state.data.replace(qvel=state.data.qvel.at[:6].add(pushes * push)),
            command=jnp.where(renew, commands.sample(keys[4], world.map, progress, self.settings.commands), state.command),
            gait=jax.tree_util.tree_map(lambda new, old: jnp.where(renew, new, old), gait, state.gait),
            until_command=jnp.where(renew, commands.steps_until(keys[5], self.settings.commands.interval), state.until_command - 1),
            until_push=jnp.where(pushes, commands.steps_until(keys[5], r.push_interval), state.until_push - 1),
        )

    def step(
        self, world: World, model: mjx.Model, state: State, action: jax.Array, progress: jax.Array
    ) -> tuple[State, Transition]:
        """One control step; a world that fell or timed out starts its next episode."""
        key, push_key, noise_key, level_key, reset_key, arm_key = jax.random.split(state.key, 6)
        robot, joints = self.robot, slice(6, 6 + self.joints)
        action = jnp.clip(action, -ACTION_CLIP, ACTION_CLIP)
        targets = robot.default_positions + robot.action_scale * jnp.stack([state.actions[0], action])
        before = state.data.qvel[joints]
        data, outcome = self.physics.control_step(world, model, state.data, targets, state.arm.target)
        state = state._replace(data=data, key=key, steps=state.steps + 1, mean_velocity=self._filtered(state, data))
        scene = self._scene(state, action, outcome, (data.qvel[joints] - before) / CONTROL_PERIOD)

        penalty_scale = 0.3 + 0.7 * progress
        weights = self.settings.rewards
        values = rewards(scene, robot)
        rates = {name: weight * values[name] for name, weight in weights.items()}
        rates = {name: rate * (penalty_scale if weights[name] < 0 else 1.0) for name, rate in rates.items()}
        fell = (scene.gravity_B[2] > -0.5) | (scene.height < self.settings.fall_height) | ~jnp.isfinite(data.qpos).all()
        reward = jnp.maximum(sum(rates.values()), 0.0) * CONTROL_PERIOD - self.settings.fall_penalty * fell
        state = state._replace(tracking=state.tracking + rates["velocity"] / weights["velocity"])

        timed_out = ~fell & (state.steps >= self.steps_per_episode)
        state = state._replace(
            level=jnp.where(fell | timed_out, self._level(state, fell, level_key), state.level),
            actions=jnp.stack([action, state.actions[0]]),
            arm=arm_motion.advance(robot, state.arm, arm_key),
            index=gaits.advance(state.index, state.gait, CONTROL_PERIOD),
        )
        state = self._next_command(state, world, progress, push_key)
        state = state._replace(
            history=observation.push(self.actor, state.history, self._observed(state, noise_key)),
            hidden=self._hidden(state, world, outcome.foot_force),
        )
        over = fell | timed_out
        fresh = self.reset(state, world, progress, reset_key)
        state = jax.tree_util.tree_map(lambda new, old: jnp.where(over, new, old), fresh, state)
        return state, Transition(jnp.nan_to_num(reward), fell, timed_out, self._log(rates, scene, state))

    @staticmethod
    def _log(rates: dict[str, jax.Array], scene: Scene, state: State) -> dict[str, jax.Array]:
        error = jnp.linalg.norm(scene.mean_velocity_h[:2] - scene.command[:2])
        return rates | {
            "velocity_error": error,
            "yaw_rate_error": jnp.abs(scene.mean_velocity_h[2] - scene.command[2]),
            "level": state.level,
            "watt": scene.outcome.power,
        }
