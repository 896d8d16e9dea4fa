"""Proximal policy optimisation (Schulman et al. 2017) with an asymmetric critic (Pinto et al. 2017) in JAX.

The task is a function of batches, so that PPO knows nothing of robots: see Task.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
import numpy as np
import optax

Layers = list[dict[str, jax.Array]]  # of a multilayer perceptron: weight (inputs, outputs), bias (outputs,)


class Hyperparameters(Protocol):
    worlds: int
    horizon: int
    epochs: int
    minibatches: int
    discount: float
    lam: float
    clip: float
    entropy: float
    value_weight: float
    target_kl: float
    learning_rate: float
    least_learning_rate: float
    most_learning_rate: float
    gradient_norm: float
    hidden: tuple[int, ...]
    initial_deviation: float


class Step(NamedTuple):
    """Result of one step of all worlds; `ended` without `timed_out` means that no reward follows."""

    reward: jax.Array  # (worlds,)
    ended: jax.Array  # (worlds,) bool
    timed_out: jax.Array  # (worlds,) bool
    log: dict[str, jax.Array]  # (worlds,) each


class Task(NamedTuple):
    """What PPO learns. States are pytrees with a leading axis of worlds."""

    observation_size: int
    hidden_size: int  # of what only the critic sees; 0 if nothing
    action_size: int
    observe: Callable[[Any], tuple[jax.Array, jax.Array]]  # state → observation, hidden values
    step: Callable[[Any, jax.Array, jax.Array], tuple[Any, Step]]  # state, actions, progress
    mirror: Callable[[jax.Array, jax.Array, jax.Array], tuple[jax.Array, jax.Array, jax.Array]] | None = None


class Parameters(NamedTuple):
    actor: Layers
    critic: Layers
    log_deviation: jax.Array  # (actions,)


class Learner(NamedTuple):
    parameters: Parameters
    optimizer: Any
    learning_rate: jax.Array


class Batch(NamedTuple):
    observation: jax.Array
    hidden: jax.Array
    action: jax.Array
    log_probability: jax.Array
    mean: jax.Array
    value: jax.Array
    advantage: jax.Array
    target: jax.Array
    is_image: jax.Array  # 1: the mirror image of a sample, 0: a sample


def make_layers(key: jax.Array, sizes: tuple[int, ...], last_gain: float) -> Layers:
    layers = []
    for number, (inputs, outputs) in enumerate(zip(sizes[:-1], sizes[1:], strict=True)):
        gain = last_gain if number == len(sizes) - 2 else 2.0**0.5
        weight = jax.nn.initializers.orthogonal(gain)(jax.random.fold_in(key, number), (inputs, outputs))
        layers.append({"weight": weight, "bias": jnp.zeros(outputs)})
    return layers


def apply(layers: Layers, x: jax.Array) -> jax.Array:
    for layer in layers[:-1]:
        x = jax.nn.elu(x @ layer["weight"] + layer["bias"])
    return x @ layers[-1]["weight"] + layers[-1]["bias"]


def value_of(parameters: Parameters, observation: jax.Array, hidden: jax.Array) -> jax.Array:
    return apply(parameters.critic, jnp.concatenate([observation, hidden], axis=-1))[..., 0]


def _log_probability(mean: jax.Array, log_deviation: jax.Array, action: jax.Array) -> jax.Array:
    z = (action - mean) * jnp.exp(-log_deviation)
    return -0.5 * jnp.sum(z**2 + 2 * log_deviation + jnp.log(2 * jnp.pi), axis=-1)


def _optimizer(h: Hyperparameters) -> optax.GradientTransformation:
    return optax.chain(optax.clip_by_global_norm(h.gradient_norm), optax.scale_by_adam())


def make_learner(key: jax.Array, task: Task, h: Hyperparameters) -> Learner:
    keys = jax.random.split(key)
    parameters = Parameters(
        make_layers(keys[0], (task.observation_size, *h.hidden, task.action_size), 0.01),
        make_layers(keys[1], (task.observation_size + task.hidden_size, *h.hidden, 1), 1.0),
        jnp.full(task.action_size, np.log(h.initial_deviation), jnp.float32),
    )
    return Learner(parameters, _optimizer(h).init(parameters), jnp.asarray(h.learning_rate, jnp.float32))


def _collect(task: Task, h: Hyperparameters, learner: Learner, state: Any, key: jax.Array, progress: jax.Array) -> Any:
    """`horizon` steps of all worlds: final state, batch of (horizon, worlds, …) without advantages, steps."""
    parameters = learner.parameters

    def one(state: Any, key: jax.Array) -> Any:
        observation, hidden = task.observe(state)
        mean = apply(parameters.actor, observation)
        action = mean + jnp.exp(parameters.log_deviation) * jax.random.normal(key, mean.shape)
        value = value_of(parameters, observation, hidden)
        likelihood = _log_probability(mean, parameters.log_deviation, action)
        state, step = task.step(state, action, progress)
        # A time limit is no property of the task: the rewards that would have followed are worth the value.
        step = step._replace(reward=step.reward + h.discount * value * step.timed_out)
        step = step._replace(log={name: values.mean() for name, values in step.log.items()})
        return state, (Batch(observation, hidden, action, likelihood, mean, value, value, value, jnp.zeros_like(value)), step)

    state, (batch, steps) = jax.lax.scan(one, state, jax.random.split(key, h.horizon))
    return state, batch, steps


def advantages(
    value: jax.Array, last_value: jax.Array, reward: jax.Array, ended: jax.Array, h: Hyperparameters
) -> jax.Array:
    """Generalised advantage estimates (Schulman et al. 2016) of (horizon, worlds) values and rewards."""
    goes_on = 1.0 - ended
    next_value = jnp.concatenate([value[1:], last_value[None]])
    delta = reward + h.discount * next_value * goes_on - value

    def back(later: jax.Array, now: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        advantage = now[0] + h.discount * h.lam * now[1] * later
        return advantage, advantage

    return jax.lax.scan(back, jnp.zeros_like(last_value), (delta, goes_on), reverse=True)[1]


def _loss(parameters: Parameters, batch: Batch, h: Hyperparameters) -> tuple[jax.Array, jax.Array]:
    """Clipped surrogate, clipped value loss and entropy; and the mean KL divergence from the collecting policy."""
    mean = apply(parameters.actor, batch.observation)
    ratio = jnp.exp(_log_probability(mean, parameters.log_deviation, batch.action) - batch.log_probability)
    advantage = (batch.advantage - batch.advantage.mean()) / (batch.advantage.std() + 1e-8)
    surrogate = jnp.minimum(ratio * advantage, jnp.clip(ratio, 1 - h.clip, 1 + h.clip) * advantage).mean()
    value = value_of(parameters, batch.observation, batch.hidden)
    clipped = batch.value + jnp.clip(value - batch.value, -h.clip, h.clip)
    value_loss = jnp.maximum((value - batch.target) ** 2, (clipped - batch.target) ** 2).mean()
    entropy = parameters.log_deviation.sum()
    # Of the samples only: a policy that is not yet symmetric differs from its image however small the step.
    change = 0.5 * jnp.sum(((mean - batch.mean) * jnp.exp(-parameters.log_deviation)) ** 2, axis=-1)
    divergence = jnp.average(change, weights=1 - batch.is_image + 1e-6)
    return -surrogate + h.value_weight * value_loss - h.entropy * entropy, divergence


def _with_mirror_images(task: Task, batch: Batch, key: jax.Array) -> Batch:
    """Half of the samples, drawn at random, as their mirror images; the likelihoods stay (Mittal et al. 2024)."""
    if task.mirror is None:
        return batch
    images = task.mirror(batch.observation, batch.hidden, batch.action)
    flip = jax.random.bernoulli(key, 0.5, (batch.value.shape[0], 1))
    pairs = zip(images, (batch.observation, batch.hidden, batch.action), strict=True)
    observation, hidden, action = (jnp.where(flip, image, plain) for image, plain in pairs)
    is_image = flip[:, 0].astype(jnp.float32)
    return batch._replace(observation=observation, hidden=hidden, action=action, is_image=is_image)


def _improve(task: Task, h: Hyperparameters, learner: Learner, batch: Batch, key: jax.Array) -> tuple[Learner, jax.Array]:
    optimizer, size = _optimizer(h), batch.value.shape[0]

    def minibatch(learner: Learner, inputs: tuple[jax.Array, jax.Array]) -> tuple[Learner, jax.Array]:
        rows, key = inputs
        part = _with_mirror_images(task, jax.tree_util.tree_map(lambda values: values[rows], batch), key)
        (_, divergence), gradient = jax.value_and_grad(_loss, has_aux=True)(learner.parameters, part, h)
        rate = learner.learning_rate
        rate = jnp.where(divergence > 2 * h.target_kl, rate / 1.5, jnp.where(divergence < h.target_kl / 2, rate * 1.5, rate))
        rate = jnp.clip(rate, h.least_learning_rate, h.most_learning_rate)
        direction, state = optimizer.update(gradient, learner.optimizer)
        parameters = optax.apply_updates(learner.parameters, jax.tree_util.tree_map(lambda d: -rate * d, direction))
        return Learner(parameters, state, rate), divergence

    def epoch(learner: Learner, key: jax.Array) -> tuple[Learner, jax.Array]:
        keys = jax.random.split(key, h.minibatches + 1)
        rows = jax.random.permutation(keys[0], size).reshape(h.minibatches, -1)
        return jax.lax.scan(minibatch, learner, (rows, keys[1:]))

    learner, divergence = jax.lax.scan(epoch, learner, jax.random.split(key, h.epochs))
    return learner, divergence.mean()


def iterate(
    task: Task, h: Hyperparameters, learner: Learner, state: Any, inputs: tuple[jax.Array, jax.Array]
) -> tuple[Learner, Any, dict[str, jax.Array]]:
    """One iteration with `inputs` = (key, progress): collects, improves, and returns means for the log."""
    key, progress = inputs
    keys = jax.random.split(key)
    state, batch, steps = _collect(task, h, learner, state, keys[0], progress)
    last_value = value_of(learner.parameters, *task.observe(state))
    advantage = advantages(batch.value, last_value, steps.reward, steps.ended, h)
    batch = batch._replace(advantage=advantage, target=advantage + batch.value)
    flat = jax.tree_util.tree_map(lambda values: values.reshape(h.horizon * h.worlds, *values.shape[2:]), batch)
    learner, divergence = _improve(task, h, learner, flat, keys[1])
    log = {name: values.mean() for name, values in steps.log.items()}
    log |= {
        "reward": steps.reward.mean(),
        "failures": (steps.ended & ~steps.timed_out).mean(),
        "divergence": divergence,
        "learning_rate": learner.learning_rate,
        "deviation": jnp.exp(learner.parameters.log_deviation).mean(),
    }
    return learner, state, log
