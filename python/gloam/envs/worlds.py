"""n worlds of one task: one compiled World, one Simulation each, stepped on all cores."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from gymnasium.utils import seeding

import gloam
from gloam.dynamics import Dynamics
from gloam.envs.actuation import DelayedActions
from gloam.envs.noise import Array
from gloam.envs.pipeline import Observation, Pipeline
from gloam.envs.settings import EnvSettings
from gloam.envs.task import Outcome, SceneSource, Task, TaskWorld

T = TypeVar("T")


@dataclass
class Slot:
    """One world: its simulation, and all of its random numbers."""

    sim: gloam.Simulation
    bound: TaskWorld
    actions: DelayedActions
    rng: np.random.Generator = field(default_factory=np.random.default_rng)
    seed: int | None = None
    is_seeded: bool = False
    has_failed: bool = False
    last: dict[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class StepResult:
    """Arrays of k worlds: rewards (k,), terminated (k,), infos, and the observation (k, …)."""

    observation: Observation
    rewards: Array
    terminated: Array
    infos: list[dict[str, Any]]


class Worlds:
    """Steps, resets and observes n worlds, selected by arrays of their numbers.

    Errors: compile errors of the scene; ValueError for invalid numbers.
    """

    def __init__(self, task: Task, num_worlds: int, settings: EnvSettings) -> None:
        if num_worlds < 1:
            raise ValueError(f"num_envs must be at least 1, got {num_worlds}")
        self._process = os.getpid()
        self.task = task
        self.settings = settings
        self.world = compiled(task.scene())
        self.action_space = task.action_space(self.world)
        self.slots = [self._new_slot(None) for _ in range(num_worlds)]
        timestep = self.slots[0].sim.timestep
        self.steps = max(1, round(task.control_interval / timestep))
        self.control_interval = self.steps * timestep
        self._settle_steps = max(int(task.places), round(task.settle / timestep))
        self.pipeline = Pipeline(
            settings.applied_to(task.terms(self.world), self.control_interval), num_worlds, task.layout
        )
        self._neutral = task.neutral_action(self.action_space)
        threads = min(settings.threads or os.cpu_count() or 1, num_worlds)
        self._pool = ThreadPoolExecutor(threads, "gloam-env") if threads > 1 else None

    def close(self) -> None:
        """Ends all simulations; once is enough, more do no harm."""
        if self._pool is not None:
            self._pool.shutdown(wait=os.getpid() == self._process)
            self._pool = None
        for slot in self.slots:
            slot.bound.close()
            slot.sim.close()
        self.slots = []

    def reset(
        self, worlds: Array, seeds: Sequence[int | None], options: Mapping[str, Any]
    ) -> tuple[Observation, list[dict[str, Any]]]:
        """Begins an episode in these worlds. A seed restarts all random numbers of its world; None continues them."""
        for world, seed in zip(worlds, seeds, strict=True):
            self._seed(int(world), seed)
        self.pipeline.reset(worlds)
        raw = self._map([partial(self._begin, self.slots[world], options) for world in worlds])
        infos = [self.slots[world].bound.start_info() for world in worlds]
        return self.pipeline.push(_stacked(raw), worlds), infos

    def step(self, worlds: Array, actions: Array) -> StepResult:
        """Takes one control step in these worlds. actions: (k, …), in the order of `worlds`."""
        jobs = [
            partial(self._advance, self.slots[world], action) for world, action in zip(worlds, actions, strict=True)
        ]
        results = self._map(jobs)
        observation = self.pipeline.push(_stacked([raw for raw, _ in results]), worlds)
        outcomes = [outcome for _, outcome in results]
        rewards = np.array([outcome.reward for outcome in outcomes], dtype=np.float64)
        terminated = np.array([outcome.terminated for outcome in outcomes], dtype=np.bool_)
        return StepResult(observation, rewards, terminated, [outcome.info for outcome in outcomes])

    def render(self, world: int) -> Array | None:
        """Image of one world from the settings' camera, (height, width, 3) uint8; None without a camera."""
        sim = self.slots[world].sim
        name = self.settings.render_camera or next(iter(sim.world.cameras), None)
        if name is None:
            return None
        width, height = self.settings.render_size
        return np.array(sim.cameras[name].render(outputs=("rgb",), width=width, height=height).rgb)

    def _new_slot(self, seed: int | None) -> Slot:
        sim = new_simulation(self.world, seed)
        delayed = DelayedActions(self.settings.action_delay_steps(sim.timestep))
        return Slot(sim, self.task.bind(sim), delayed, seed=seed)

    def _seed(self, world: int, seed: int | None) -> None:
        """Creates a new simulation if its seed has changed, and restarts the generators."""
        slot = self.slots[world]
        if slot.has_failed or (seed is not None and (slot.seed != seed or self.settings.randomize)):
            new = self._new_slot(slot.seed if seed is None else seed)
            new.rng, new.is_seeded = slot.rng, slot.is_seeded
            slot.bound.close()
            slot.sim.close()
            slot = self.slots[world] = new
        if seed is not None or not slot.is_seeded:
            slot.rng, number = seeding.np_random(seed)
            slot.is_seeded = True
            self.pipeline.seed(world, number)

    def _begin(self, slot: Slot, options: Mapping[str, Any]) -> dict[str, Array]:
        if self.settings.randomize:
            drawn = self.settings.draw(slot.rng)
            slot.sim.set(drawn, progress=False)
        slot.sim.reset()
        if self.settings.dynamics:
            dynamics = Dynamics(slot.sim)
            dynamics.scale(**self.settings.draw_dynamics(slot.rng, dynamics.counts))
        slot.actions.reset(slot.rng)
        slot.bound.begin(slot.rng, options)
        if self._neutral is not None:
            slot.bound.apply(self._neutral)
        slot.sim.step(self._settle_steps)
        slot.last = slot.bound.observe()
        return slot.last

    def _advance(self, slot: Slot, action: Array) -> tuple[dict[str, Array], Outcome]:
        """One control step. If physics produces a value that is not finite, the episode ends with the last valid
        observation."""
        try:
            slot.bound.decide(action)
            slot.actions.advance(action, self.steps, slot.bound.apply, slot.sim.step)
            slot.last = slot.bound.observe()
            return slot.last, slot.bound.judge(action)
        except gloam.DivergedError:
            slot.has_failed = True
            return slot.last, Outcome(0.0, True, {"diverged": True})

    def _map(self, jobs: Sequence[Callable[[], T]]) -> list[T]:
        if os.getpid() != self._process:  # the threads are in the other one
            raise gloam.ForkedError("the environment belongs to the process that this one was forked from")
        if self._pool is None or len(jobs) == 1:
            return [job() for job in jobs]
        return list(self._pool.map(lambda job: job(), jobs))


def compiled(source: SceneSource) -> gloam.World:
    """The World of a path, dict or Scene; a World as it is."""
    if isinstance(source, gloam.World):
        return source
    if isinstance(source, gloam.Scene):
        scene = source
    elif isinstance(source, (str, Path)):
        scene = gloam.Scene(source)
    else:
        scene = gloam.Scene.from_dict(dict(source))
    return scene.compile(progress=False)


def new_simulation(world: gloam.World, seed: int | None = None) -> gloam.Simulation:
    """A simulation of a World with the time step, and without a seed with the one, that its scene asks for."""
    scene = world.scene
    timestep = scene["sim.timestep"] if "sim.timestep" in scene else None
    if seed is None:
        seed = scene["sim.seed"] if "sim.seed" in scene else 1
    return gloam.Simulation(world, seed=seed, timestep=timestep)


def _stacked(raw: Sequence[Mapping[str, Array]]) -> dict[str, Array]:
    return {name: np.stack([np.asarray(one[name]) for one in raw]) for name in raw[0]}
