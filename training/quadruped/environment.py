"""Environment: one world's state, step and reset, for jax.vmap over worlds."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from mujoco import mjx

from . import commands, observation, robot, terrain
from . import gait as gaits
from .physics import control_step, foot_positions
from .rewards import Scene, rewards
from .settings import FALL_PENALTY, Settings
from .worlds import World

MEAN_TIME = 0.3  # of the averaged velocity [s]; about a stride
_SHANK_POINTS = (0.35, 0.65)  # along the line from knee to foot
_TRUNK_POINTS = [[x, y, -0.057] for x in (0.26, 0.0, -0.19) for y in (0.05, -0.05)]  # base frame [m]
_NEARBY = [[x, y] for x in (0.4, 0.2, -0.2, -0.4) for y in (0.13, -0.13)]  # seen by the critic, heading frame [m]
_AROUND_FOOT = [[0.0, 0.0], [0.07, 0.0], [-0.07, 0.0], [0.0, 0.07], [0.0, -0.07]]  # [m]


class State(NamedTuple):
    data: mjx.Data
    key: jax.Array
    command: jax.Array  # (3,)
    gait: gaits.Gait
    index: jax.Array  # of the gait clock
    history: observation.History
    hidden: jax.Array  # (PRIVILEGED_SIZE,)
    actions: jax.Array  # (2, 12) the latest action and the one before it
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
        self.maps, self.settings = maps, settings
        self.steps_per_episode = round(settings.episode / robot.CONTROL_PERIOD)

    def _observed(self, state: State, key: jax.Array) -> dict[str, jax.Array]:
        """Values of the observation terms, with the noise of the sensors."""
        r, data = self.settings.randomisation, state.data
        keys = jax.random.split(key, 4)

        def noise(number: int, size: int, limit: float) -> jax.Array:
            return jax.random.uniform(keys[number], (size,), minval=-limit, maxval=limit)

        return {
            "base_ang_vel": data.qvel[3:6] + noise(0, 3, r.gyro_noise),
            "projected_gravity": -_rotation(data.qpos[3:7])[2] + noise(1, 3, r.gravity_noise),
            "joint_pos": data.qpos[7:] - robot.DEFAULT_POSITIONS + noise(2, 12, r.joint_noise),
            "joint_vel": data.qvel[6:] + noise(3, 12, r.joint_speed_noise),
            "last_action": state.actions[0],
            "velocity_commands": state.command,
            "gait_parameters": jnp.stack(state.gait),
            "gait_clock": gaits.clock(gaits.foot_phases(state.index, state.gait)),
        }

    def _hidden(self, state: State, world: World, force: jax.Array) -> jax.Array:
        data, ground = state.data, terrain.unpack(state.data.userdata)
        R_WB = _rotation(data.qpos[3:7])
        feet = foot_positions(data)
        nearby = data.qpos[:2] + jnp.array(_NEARBY) @ _heading(R_WB).T
        values = {
            "base_lin_vel": R_WB.T @ data.qvel[:3],
            "foot_height": feet[:, 2] - robot.FOOT_RADIUS - terrain.heights(self.maps, ground, feet[:, :2]),
            "foot_force": force,
            "sinkage": ground.sinkage,
            "ground": data.qpos[2] - robot.NOMINAL_HEIGHT - terrain.heights(self.maps, ground, nearby),
            "world": jnp.stack([world.friction - 0.8, world.payload, world.compliance * 300]),
        }
        return observation.privileged(values)

    def reset(self, state: State, world: World, progress: jax.Array, key: jax.Array) -> State:
        """The start of an episode on another part of the ground; keeps `state.level`."""
        keys = jax.random.split(key, 12)
        ground = terrain.Ground(
            world.map, jax.random.uniform(keys[0], (2,), maxval=terrain.CELLS * terrain.CELL), state.level, jnp.zeros(4)
        )
        yaw = jax.random.uniform(keys[1], (), maxval=2 * jnp.pi)
        quaternion = jnp.array([jnp.cos(yaw / 2), 0.0, 0.0, jnp.sin(yaw / 2)])
        under = jnp.array([[0.0, 0.0], *_NEARBY]) @ _heading(_rotation(quaternion)).T
        height = terrain.heights(self.maps, ground, under).max() + 0.3
        joints = robot.DEFAULT_POSITIONS + jax.random.uniform(keys[2], (12,), minval=-0.15, maxval=0.15)
        data = state.data.replace(
            qpos=jnp.concatenate([jnp.array([0.0, 0.0]), height[None], quaternion, joints]),
            qvel=jax.random.uniform(keys[3], (18,), minval=-0.3, maxval=0.3),
            qacc_warmstart=jnp.zeros(18),
            xfrc_applied=jnp.zeros_like(state.data.xfrc_applied),
            userdata=terrain.pack(ground),
        )
        fresh = state._replace(
            data=data,
            key=keys[4],
            command=commands.sample(keys[5], world.map, progress, self.settings),
            gait=gaits.sample(keys[6]),
            index=jax.random.uniform(keys[7]),
            actions=jnp.zeros((2, 12)),
            mean_velocity=jnp.zeros(3),
            steps=jnp.zeros((), jnp.int32),
            until_command=commands.steps_until(keys[8], self.settings.commands.interval),
            until_push=commands.steps_until(keys[9], self.settings.randomisation.push_interval),
            tracking=jnp.zeros(()),
        )
        history = observation.begin(self._observed(fresh, keys[10]))
        return fresh._replace(history=history, hidden=self._hidden(fresh, world, jnp.zeros(4)))

    def first(self, data: mjx.Data, world: World, key: jax.Array) -> State:
        """The state before the first step; episodes start at random lengths so that worlds do not reset together."""
        keys = jax.random.split(key, 4)
        zero = jnp.zeros(())
        gait = gaits.sample(keys[0])
        blank = State(data, key, jnp.zeros(3), gait, zero, (), zero, jnp.zeros((2, 12)), jnp.zeros(3),
                      jax.random.uniform(keys[1], (), maxval=0.4), zero, zero, zero, zero)  # fmt: skip
        steps = jax.random.randint(keys[2], (), 0, self.steps_per_episode)
        return self.reset(blank, world, zero, keys[3])._replace(steps=steps)

    def _scene(self, state: State, action: jax.Array, outcome: Any, acceleration: jax.Array) -> Scene:
        """Measures of the state after the physics; the averaged velocity is state.mean_velocity."""
        data, ground = state.data, terrain.unpack(state.data.userdata)
        R_WB, feet = _rotation(data.qpos[3:7]), foot_positions(data)
        planar = _heading(R_WB).T @ data.qvel[:2]
        under_feet = terrain.heights(self.maps, ground, feet[:, :2])
        around = (feet[:, None, :2] + jnp.array(_AROUND_FOOT)).reshape(-1, 2)
        highest = terrain.heights(self.maps, ground, around).reshape(4, -1).max(axis=1)
        knees = data.xpos[4:14:3]
        shank = jnp.concatenate([knees + s * (feet - knees) for s in _SHANK_POINTS])
        trunk = data.qpos[:3] + jnp.array(_TRUNK_POINTS) @ R_WB.T

        def inside(points: jax.Array) -> jax.Array:
            return jnp.sum(points[:, 2] < terrain.heights(self.maps, ground, points[:, :2]) - ground.sinkage.max())

        return Scene(
            command=state.command,
            gait=state.gait,
            phases=gaits.foot_phases(state.index, state.gait),
            velocity_h=jnp.concatenate([planar, data.qvel[2:3]]),
            mean_velocity_h=state.mean_velocity,
            angular_B=data.qvel[3:6],
            gravity_B=-R_WB[2],
            height=data.qpos[2] - jnp.mean(under_feet - ground.sinkage),
            foot_clearance=feet[:, 2] - robot.FOOT_RADIUS - highest,
            buried=inside(shank),
            belly=inside(trunk),
            position=data.qpos[7:],
            acceleration=acceleration,
            actions=jnp.concatenate([action[None], state.actions]),
            outcome=outcome,
        )

    def _filtered(self, state: State, data: mjx.Data) -> jax.Array:
        planar = _heading(_rotation(data.qpos[3:7])).T @ data.qvel[:2]
        share = robot.CONTROL_PERIOD / MEAN_TIME
        return state.mean_velocity + share * (jnp.append(planar, data.qvel[5]) - state.mean_velocity)

    def _level(self, state: State, fell: jax.Array, key: jax.Array) -> jax.Array:
        """Harder ground after a whole episode that followed its commands, easier ground after a fall."""
        share = state.tracking / jnp.maximum(state.steps, 1)
        level = state.level + jnp.where(fell, -0.1, jnp.where(share > 0.6, 0.1, 0.0))
        return jnp.where(level > 1.2, jax.random.uniform(key, (), minval=0.3, maxval=1.2), jnp.maximum(level, 0.0))

    def _next_command(self, state: State, world: World, progress: jax.Array, key: jax.Array) -> State:
        keys = jax.random.split(key, 6)
        r = self.settings.randomisation
        renew, pushes = state.until_command <= 0, state.until_push <= 0
        angle, size = jax.random.uniform(keys[0], (), maxval=2 * jnp.pi), jax.random.uniform(keys[1]) * r.push
        spin = jax.random.uniform(keys[2], (3,), minval=-r.push_spin, maxval=r.push_spin)
        push = jnp.concatenate([jnp.stack([size * jnp.cos(angle), size * jnp.sin(angle), 0.0]), spin, jnp.zeros(12)])
        gait = gaits.sample(keys[3])
        return state._replace(
            data=state.data.replace(qvel=state.data.qvel + pushes * push),
            command=jnp.where(renew, commands.sample(keys[4], world.map, progress, self.settings), state.command),
            gait=jax.tree_util.tree_map(lambda new, old: jnp.where(renew, new, old), gait, state.gait),
            until_command=jnp.where(renew, commands.steps_until(keys[5], self.settings.commands.interval), state.until_command - 1),
            until_push=jnp.where(pushes, commands.steps_until(keys[5], r.push_interval), state.until_push - 1),
        )

    def step(
        self, world: World, model: mjx.Model, state: State, action: jax.Array, progress: jax.Array
    ) -> tuple[State, Transition]:
        """One control step; a world that fell or timed out starts its next episode."""
        key, push_key, noise_key, level_key, reset_key = jax.random.split(state.key, 5)
        action = jnp.clip(action, -robot.ACTION_CLIP, robot.ACTION_CLIP)
        targets = robot.DEFAULT_POSITIONS + robot.ACTION_SCALE * jnp.stack([state.actions[0], action])
        before = state.data.qvel[6:]
        data, outcome = control_step(self.maps, world, model, state.data, targets, self.settings.timestep)
        state = state._replace(data=data, key=key, steps=state.steps + 1, mean_velocity=self._filtered(state, data))
        scene = self._scene(state, action, outcome, (data.qvel[6:] - before) / robot.CONTROL_PERIOD)

        penalty_scale = 0.3 + 0.7 * progress
        weights = self.settings.rewards
        rates = {name: weights[name] * value for name, value in rewards(scene).items()}
        rates = {name: rate * (penalty_scale if weights[name] < 0 else 1.0) for name, rate in rates.items()}
        fell = (scene.gravity_B[2] > -0.5) | (scene.height < 0.1) | ~jnp.isfinite(data.qpos).all()
        reward = jnp.maximum(sum(rates.values()), 0.0) * robot.CONTROL_PERIOD - FALL_PENALTY * fell
        state = state._replace(tracking=state.tracking + rates["velocity"] / weights["velocity"])

        timed_out = ~fell & (state.steps >= self.steps_per_episode)
        state = state._replace(
            level=jnp.where(fell | timed_out, self._level(state, fell, level_key), state.level),
            actions=jnp.stack([action, state.actions[0]]),
            index=gaits.advance(state.index, state.gait, robot.CONTROL_PERIOD),
        )
        state = self._next_command(state, world, progress, push_key)
        state = state._replace(
            history=observation.push(state.history, self._observed(state, noise_key)),
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
