"""PPO learns PointGoal: a cart finds its way to points of a small room, by depth pictures of 16 x 12 or a LiDAR.

The learner is that of skrl (pip install skrl jax flax optax). A run on two cores takes some minutes and prints the
curve:

    python examples/python/point_goal_ppo.py --observation lidar --steps 100000
"""

from __future__ import annotations

import argparse
import time
from collections import deque
from typing import Any

import flax.linen as nn
import gymnasium as gym
import jax
import jax.numpy as jnp
import numpy as np
from skrl.agents.jax.ppo import PPO
from skrl.envs.wrappers.jax import wrap_env
from skrl.memories.jax import RandomMemory
from skrl.models.jax import DeterministicMixin, GaussianMixin, Model
from skrl.resources.preprocessors.jax import RunningStandardScaler
from skrl.utils.spaces.jax import flatten_tensorized_space, tensorize_space

import gloam  # noqa: F401 (registers gloam/PointGoal-v0)

ROLLOUT = 128  # steps of each world between two updates


class Policy(GaussianMixin, Model):  # type: ignore[misc]
    """Means of the actions, and a standard deviation that is learnt."""

    def __init__(self, **spaces: Any) -> None:
        Model.__init__(self, **spaces)
        GaussianMixin.__init__(self, clip_actions=False)

    @nn.compact  # type: ignore[untyped-decorator]
    def __call__(self, inputs: dict[str, Any], role: str) -> tuple[Any, dict[str, Any]]:
        x = inputs["observations"]
        for width in (128, 64):
            x = nn.tanh(nn.Dense(width)(x))
        mean = jnp.tanh(nn.Dense(self.num_actions, kernel_init=nn.initializers.orthogonal(0.01))(x))
        return mean, {"log_std": self.param("log_std", lambda _: jnp.full(self.num_actions, -0.5))}


class Value(DeterministicMixin, Model):  # type: ignore[misc]
    """What an observation is worth."""

    def __init__(self, **spaces: Any) -> None:
        Model.__init__(self, **spaces)
        DeterministicMixin.__init__(self)

    @nn.compact  # type: ignore[untyped-decorator]
    def __call__(self, inputs: dict[str, Any], role: str) -> tuple[Any, dict[str, Any]]:
        x = inputs["observations"]
        for width in (128, 64):
            x = nn.tanh(nn.Dense(width)(x))
        return nn.Dense(1)(x), {}


def make_agent(env: Any) -> PPO:
    """A PPO agent for an environment that skrl has wrapped."""
    spaces = {"observation_space": env.observation_space, "action_space": env.action_space}
    models: dict[str, Any] = {"policy": Policy(**spaces), "value": Value(**spaces)}
    for role, model in models.items():
        model.init_state_dict(role=role)
    settings = {
        "rollouts": ROLLOUT,
        "learning_epochs": 6,
        "mini_batches": 8,
        "discount_factor": 0.98,
        "learning_rate": 5e-4,
        "value_loss_scale": 0.5,
        "time_limit_bootstrap": True,
        "observation_preprocessor": RunningStandardScaler,
        "observation_preprocessor_kwargs": {"size": env.observation_space},
        "value_preprocessor": RunningStandardScaler,
        "value_preprocessor_kwargs": {"size": 1},
        "experiment": {"write_interval": 0, "checkpoint_interval": 0},
    }
    memory = RandomMemory(memory_size=ROLLOUT, num_envs=env.num_envs)
    agent = PPO(models=models, memory=memory, cfg=settings, **spaces)
    agent.init()
    agent.enable_training_mode(True)
    return agent


def with_final(env: Any, observations: Any, infos: dict[str, Any]) -> Any:
    """What followed a step: where an episode ended, its terminal observation in place of the next one's first."""
    for world in np.flatnonzero(infos.get("_final_obs", [])):
        final = {name: value[None] for name, value in infos["final_obs"][world].items()}
        flat = flatten_tensorized_space(tensorize_space(env.observation_space, final))
        observations = observations.at[world].set(flat[0])
    return observations


def train(env: Any, agent: PPO, steps: int) -> list[tuple[int, float, float]]:
    """Trains for `steps` steps of all worlds together. Returns the curve: steps, fraction of successes, mean SPL."""
    ended: deque[tuple[float, float]] = deque(maxlen=100)
    curve = []
    begun = time.monotonic()
    observations, _ = env.reset()
    rounds = steps // env.num_envs
    print("   steps  episodes that reach the goal   SPL   steps/s")
    for k in range(rounds):
        actions, _ = agent.act(observations, None, timestep=k, timesteps=rounds)
        following, rewards, terminated, truncated, infos = env.step(actions)
        agent.record_transition(
            observations=observations,
            states=None,
            actions=actions,
            rewards=rewards,
            next_observations=with_final(env, following, infos),
            next_states=None,
            terminated=terminated,
            truncated=truncated,
            infos={},
            timestep=k,
            timesteps=rounds,
        )
        agent.post_interaction(timestep=k, timesteps=rounds)
        observations = following
        for world in np.flatnonzero(infos.get("_final_info", [])):
            last = infos["final_info"]
            ended.append((float(last["success"][world]), float(last["spl"][world])))
        if (k + 1) % (8 * ROLLOUT) == 0 and ended:
            done = (k + 1) * env.num_envs
            success, spl = np.mean(ended, axis=0)
            curve.append((done, float(success), float(spl)))
            bar = "#" * round(20 * success)
            print(
                f"{done:8d}  {100 * success:5.0f} % {bar:20s} {spl:7.2f} {done / (time.monotonic() - begun):8.0f}",
                flush=True,
            )
    return curve


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--observation", choices=("depth", "lidar"), default="lidar")
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("--worlds", type=int, default=8)
    options = parser.parse_args()
    jax.config.update("jax_platforms", "cpu")
    env = gym.make_vec(
        "gloam/PointGoal-v0",
        num_envs=options.worlds,
        observation=options.observation,
        size=(16, 12),
        beams=24,
        autoreset_mode="SameStep",
        max_episode_steps=150,
    )
    wrapped = wrap_env(env, wrapper="gymnasium")
    train(wrapped, make_agent(wrapped), options.steps)
    env.close()


if __name__ == "__main__":
    main()
