"""Trains a policy: `python3 -m training.legged.train quadruped --out results/training` (training/README.md).

Passes through the stages of the task. Stops after `--seconds`, and writes checkpoint.npz every minute and log.csv, a row
every ten iterations. `--resume` continues from a checkpoint.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import math
import time
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from mujoco import mjx

from .. import checkpoint, ppo, tasks
from . import observation, terrain
from .environment import Environment, State
from .settings import Settings
from .terms import size
from .worlds import make_models, make_world

LOG_EVERY = 10  # iterations
SAVE_EVERY = 60.0  # [s]


def make_task(settings: Settings, key: jax.Array) -> tuple[ppo.Task, State]:
    """The task of PPO and the first states of all worlds."""
    maps = terrain.make_maps(settings.seed)
    terrain.install(maps, settings.robot.sole_radius)
    environment = Environment(maps, settings)
    keys = jax.random.split(key, 3)
    count = settings.ppo.worlds
    worlds = jax.vmap(partial(make_world, settings=settings))(jax.random.split(keys[0], count))
    models, axes = make_models(keys[1], worlds, settings)

    def first(model: mjx.Model, world: Any, key: jax.Array) -> State:
        return environment.first(mjx.make_data(model), world, key)

    def step(state: State, actions: jax.Array, progress: jax.Array) -> tuple[State, ppo.Step]:
        state, t = jax.vmap(environment.step, in_axes=(0, axes, 0, 0, None))(worlds, models, state, actions, progress)
        return state, ppo.Step(t.reward, t.fell | t.timed_out, t.timed_out, t.terms)

    def observe(state: State) -> tuple[jax.Array, jax.Array]:
        return jax.vmap(observation.flatten)(state.history), state.hidden

    state = jax.jit(jax.vmap(first, in_axes=(axes, 0, 0)))(models, worlds, jax.random.split(keys[2], count))
    sizes = size(environment.actor), size(environment.critic), environment.joints
    task = ppo.Task(*sizes, observe, step, observation.mirror(settings.robot))
    return task, state


class Run:
    """One run of one stage of the training, from a checkpoint if there is one."""

    def __init__(self, settings: Settings, out: Path, resume: Path | None) -> None:
        self.settings, self.out = settings, out
        out.mkdir(parents=True, exist_ok=True)
        key = jax.random.PRNGKey(settings.seed)
        self.task, self.state = make_task(settings, key)
        self.learner = ppo.make_learner(jax.random.fold_in(key, 1), self.task, settings.ppo)
        self.iteration = 0
        if resume is not None:
            self.learner, extra = checkpoint.load(resume, self.learner)
            self.iteration = int(extra["iteration"])
            self.state = self.state._replace(level=jnp.asarray(np.resize(extra["levels"], settings.ppo.worlds)))
        self.key = jax.random.fold_in(key, 2 + self.iteration)
        self.iterate = jax.jit(partial(ppo.iterate, self.task, settings.ppo), donate_argnums=(0, 1))

    def save(self) -> None:
        checkpoint.save(self.out / "checkpoint.npz", self.learner, iteration=self.iteration, levels=self.state.level)

    def one(self) -> dict[str, jax.Array]:
        self.key, key = jax.random.split(self.key)
        progress = jnp.asarray(min(1.0, self.iteration / self.settings.ramp), jnp.float32)
        self.learner, self.state, log = self.iterate(self.learner, self.state, (key, progress))
        self.iteration += 1
        return log

    def train(self, last: int, end: float) -> None:
        """Trains until iteration `last` or until time.monotonic() is `end` [s]."""
        start = saved = time.monotonic()
        with (self.out / "log.csv").open("a", newline="") as file:
            writer = None
            while self.iteration < last and time.monotonic() < end:
                log = self.one()
                if self.iteration % LOG_EVERY and self.iteration > 2:
                    continue
                row = {"iteration": self.iteration, "seconds": round(time.monotonic() - start, 1)}
                row |= {name: f"{float(value):.5g}" for name, value in log.items()}
                if writer is None:
                    writer = csv.DictWriter(file, fieldnames=list(row))
                    writer.writeheader()
                writer.writerow(row)
                file.flush()
                print(*(f"{name} {row[name]}" for name in SHOWN), flush=True)
                if time.monotonic() - saved > SAVE_EVERY:
                    self.save()
                    saved = time.monotonic()
        self.save()


SHOWN = ("iteration", "seconds", "reward", "failures", "velocity_error", "yaw_rate_error", "level", "watt", "deviation",
         "learning_rate")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", choices=tasks.NAMES)
    parser.add_argument("--out", type=Path, default=Path("results/training"))
    parser.add_argument("--resume", type=Path, help="a checkpoint.npz to continue")
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--iterations", type=int, help="the last iteration")
    parser.add_argument("--worlds", type=int)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    base = dataclasses.replace(tasks.settings(arguments.task), seed=arguments.seed)
    if arguments.worlds is not None:
        base = dataclasses.replace(base, ppo=dataclasses.replace(base.ppo, worlds=arguments.worlds))
    end, done, resume = time.monotonic() + arguments.seconds, 0, arguments.resume
    if resume is not None:
        done = checkpoint.progress(resume)
    for stage in base.stages:
        last = min(stage.until, arguments.iterations or stage.until)
        if done < last and time.monotonic() < end:
            run = Run(base.of(stage), arguments.out, resume)
            run.train(last, end)
            done, resume = run.iteration, arguments.out / "checkpoint.npz"


if __name__ == "__main__":
    main()
