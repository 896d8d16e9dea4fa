"""PPO of the training (training/ppo.py): advantages by hand, and a task that it has to learn in seconds."""

import dataclasses
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

jax = pytest.importorskip("jax")
pytest.importorskip("optax")
jnp = jax.numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from training import checkpoint, ppo  # noqa: E402
from training.legged.settings import Ppo  # noqa: E402

SMALL = Ppo(worlds=64, horizon=8, epochs=4, minibatches=2, hidden=(16,), learning_rate=5e-3, most_learning_rate=2e-2)


def reach_task() -> ppo.Task:
    """A point on a line observes its place and moves by its action: the reward is highest at 0."""

    def observe(state):
        return state["x"][:, None], jnp.zeros((len(state["x"]), 0))

    def step(state, actions, progress):
        x = jnp.clip(state["x"] + 0.3 * actions[:, 0], -3, 3)
        count = state["count"] + 1
        timed_out = count >= 12
        key, draw = jax.random.split(state["key"])
        fresh = jax.random.uniform(draw, x.shape, minval=-2, maxval=2)
        reward = jnp.exp(-(x**2))
        state = {"x": jnp.where(timed_out, fresh, x), "count": jnp.where(timed_out, 0, count), "key": key}
        return state, ppo.Step(reward, timed_out, timed_out, {})

    return ppo.Task(1, 0, 1, observe, step, lambda o, h, a: (-o, h, -a))


def first_state(count):
    key = jax.random.PRNGKey(3)
    return {"x": jax.random.uniform(key, (count,), minval=-2, maxval=2), "count": jnp.arange(count) % 12, "key": key}


def test_learns_to_reach_a_place():
    task, key = reach_task(), jax.random.PRNGKey(0)
    learner, state = ppo.make_learner(key, task, SMALL), first_state(SMALL.worlds)
    iterate = jax.jit(partial(ppo.iterate, task, SMALL))
    rewards = []
    for number in range(60):
        learner, state, log = iterate(learner, state, (jax.random.fold_in(key, number), jnp.float32(1)))
        rewards.append(float(log["reward"]))
    places = jnp.linspace(-2, 2, 41)[:, None]
    moves = 0.3 * np.asarray(ppo.apply(learner.parameters.actor, places))[:, 0]
    assert np.mean(rewards[:3]) < 0.6 * np.mean(rewards[-3:]), rewards
    assert (np.sign(moves[[0, 5, 35, 40]]) == [1, 1, -1, -1]).all()
    assert abs(moves[20]) < 0.15  # stays where it is at the goal


def test_advantages_of_two_worlds():
    h = dataclasses.replace(SMALL, discount=0.9, lam=0.5)
    value = jnp.array([[1.0, 1.0], [2.0, 2.0]])
    reward = jnp.array([[0.5, 0.5], [1.0, 1.0]])
    ended = jnp.array([[False, True], [False, False]])
    got = np.asarray(ppo.advantages(value, jnp.array([3.0, 3.0]), reward, ended, h))
    last = 1.0 + 0.9 * 3 - 2
    np.testing.assert_allclose(got[1], last, rtol=1e-6)
    np.testing.assert_allclose(got[0], [0.5 + 0.9 * 2 - 1 + 0.45 * last, 0.5 - 1], rtol=1e-6)


def test_checkpoints_continue_and_reject_other_networks(tmp_path):
    task = reach_task()
    learner = ppo.make_learner(jax.random.PRNGKey(5), task, SMALL)
    checkpoint.save(tmp_path / "a.npz", learner, iteration=7)
    loaded, extra = checkpoint.load(tmp_path / "a.npz", ppo.make_learner(jax.random.PRNGKey(6), task, SMALL))
    assert int(extra["iteration"]) == 7
    same = jax.tree_util.tree_map(lambda a, b: bool((a == b).all()), learner, loaded)
    assert all(jax.tree_util.tree_leaves(same))
    wider = ppo.make_learner(jax.random.PRNGKey(5), task, dataclasses.replace(SMALL, hidden=(17,)))
    with pytest.raises(ValueError, match="another network"):
        checkpoint.load(tmp_path / "a.npz", wider)
