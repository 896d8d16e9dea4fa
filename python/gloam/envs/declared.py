"""make_env: environments of any scene, out of the names of its cameras, topics and metrics, in Python or TOML."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode

import gloam
from gloam.envs.declared_actions import Actuation, parse_actions
from gloam.envs.declared_terms import (
    parse_observation,
    parse_rewards,
    parse_terminations,
)
from gloam.envs.noise import Array
from gloam.envs.pipeline import Layout
from gloam.envs.settings import EnvSettings
from gloam.envs.single import Env
from gloam.envs.sources import Metrics
from gloam.envs.task import Outcome, SceneSource, Task, TaskWorld
from gloam.envs.terms import Term
from gloam.envs.vector import VectorEnv
from gloam.envs.worlds import new_simulation

Observations = Mapping[str, Any]
Many = Sequence[Any] | Mapping[str, Any] | Callable[[gloam.Simulation], Any] | None

_KEYS = (
    "scene",
    "observations",
    "actions",
    "reward",
    "termination",
    "control_interval",
    "settle",
    "layout",
    "max_episode_steps",
    "settings",
)


class DeclaredTask(Task):
    """A task made from tables (docs/python_envs.md). Errors: ValueError for an invalid table."""

    places = False

    def __init__(
        self,
        scene: SceneSource,
        observations: Observations,
        actions: object = (),
        reward: Many = (),
        termination: Many = (),
        control_interval: float = 0.1,
        settle: float | None = None,
        layout: Layout = "dict",
    ) -> None:
        if not observations:
            raise ValueError("an environment needs an observation")
        if not 0 < control_interval < 1e6:
            raise ValueError(f"control_interval must be a time above 0 s, got {control_interval}")
        self._scene = scene
        self.layout = layout
        self.control_interval = control_interval
        self.observations = [parse_observation(name, table) for name, table in observations.items()]
        self.actions = parse_actions(actions)
        self.rewards = parse_rewards(reward)
        self.terminations = parse_terminations(termination)
        judged = [term.metric for term in self.rewards] + [end.metric for end in self.terminations]
        seen = [one.kind == "metric" for one in self.observations]
        self.uses_metrics = any(seen) or any(metric is not None for metric in judged)
        takes_time = any(observation.kind in ("lidar", "topic") for observation in self.observations)
        self.settle = settle if settle is not None else control_interval if takes_time else 0.0

    def scene(self) -> SceneSource:
        return self._scene

    def neutral_action(self, space: spaces.Box) -> Array | None:
        return None

    def action_space(self, world: gloam.World) -> spaces.Box:
        with new_simulation(world) as sim:
            limits = [actuation.limits(sim) for actuation in self.actions]
        low = np.concatenate([low for low, _ in limits] or [np.zeros(0)])
        high = np.concatenate([high for _, high in limits] or [np.zeros(0)])
        return spaces.Box(low.astype(np.float32), high.astype(np.float32), dtype=np.float32)

    def terms(self, world: gloam.World) -> Sequence[Term]:
        """Shapes are determined by a simulation of the World at its first observation."""
        with new_simulation(world) as sim:
            bound = _DeclaredWorld(sim, self)
            bound.begin(np.random.default_rng(0), {})
            sim.step(round(self.settle / sim.timestep))
            raw = bound.observe()
            bound.check_names()
            bound.close()
        return [observation.term(raw[observation.name]) for observation in self.observations]

    def bind(self, sim: gloam.Simulation) -> TaskWorld:
        return _DeclaredWorld(sim, self)


class _DeclaredWorld(TaskWorld):
    def __init__(self, sim: gloam.Simulation, task: DeclaredTask) -> None:
        super().__init__(sim)
        self._task = task
        self._metrics = Metrics(sim)
        self._sources = {one.name: one.open(sim, self._metrics) for one in task.observations}
        self._actuations: list[tuple[Actuation, slice]] = []
        start = 0
        for actuation in task.actions:
            size = len(actuation.limits(sim)[0])
            self._actuations.append((actuation, slice(start, start + size)))
            start += size
        self._before: dict[int, float] = {}

    def begin(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        if options:
            raise ValueError(f"this environment has no reset options, got {sorted(options)}")
        if self._task.uses_metrics:
            self._metrics.begin()
        for source in self._sources.values():
            source.begin()
        self._before = {}

    def apply(self, action: Array) -> None:
        for actuation, part in self._actuations:
            actuation.apply(self.sim, action[part])

    def observe(self) -> dict[str, Array]:
        values = {name: source.read() for name, source in self._sources.items()}
        if not self._before:
            self._before = {
                number: reward.raw(self.sim, self._metrics) for number, reward in enumerate(self._task.rewards)
            }
        return values

    def judge(self, action: Array) -> Outcome:
        total = 0.0
        for number, reward in enumerate(self._task.rewards):
            value = reward.raw(self.sim, self._metrics)
            total += reward.worth(value, self._before.get(number, value))
            self._before[number] = value
        met = [one for one in self._task.terminations if one.is_met(self.sim, self._metrics)]
        info = {"success": any(one.success for one in met)} if self._task.terminations else {}
        return Outcome(total, bool(met), info)

    def check_names(self) -> None:
        """Raises NotFoundError for a terminating metric that the scene does not have."""
        for one in self._task.terminations:
            if one.metric is not None:
                self._metrics.value(one.metric)

    def close(self) -> None:
        for source in self._sources.values():
            source.close()
        self._metrics.close()


def make_env(
    scene: SceneSource,
    observations: Observations | None = None,
    actions: object = (),
    reward: Many = (),
    termination: Many = (),
    *,
    max_episode_steps: int | None = None,
    render_mode: str | None = None,
    control_interval: float = 0.1,
    settle: float | None = None,
    layout: Layout = "dict",
    **settings: Any,
) -> Env:
    """An environment of a scene, or of a TOML file that contains all settings (without the other arguments).

    observations: by name, {"metric": …}, {"topic": …, "field": …}, {"camera": …, "output": …}, {"lidar": …},
    {"sensor": …}, {"joints": robot}, {"joint_velocities": robot} or a function of the Simulation, each with noise,
    clip, scale, delay and history. actions: {"controls": robot}, {"command": robot}, {"joint_goals": robot}, a list
    of them. reward: [{"metric": …, "weight": …}]. termination: [{"metric": …, "above": …}]. settings: as for
    EnvSettings. docs/python_envs.md lists all of them. Errors: ValueError, InputError of the scene, NotFoundError.
    """
    given = dict(observations=observations, actions=actions, reward=reward, termination=termination)
    task, made, steps = _parsed(
        scene, {**given, **dict(control_interval=control_interval, settle=settle, layout=layout)}, settings
    )
    return Env(task, made, steps if max_episode_steps is None else max_episode_steps, render_mode)


def make_vec_env(
    scene: SceneSource,
    num_envs: int,
    observations: Observations | None = None,
    actions: object = (),
    reward: Many = (),
    termination: Many = (),
    *,
    max_episode_steps: int | None = None,
    render_mode: str | None = None,
    autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
    control_interval: float = 0.1,
    settle: float | None = None,
    layout: Layout = "dict",
    **settings: Any,
) -> VectorEnv:
    """num_envs worlds of the environment of make_env."""
    given = dict(observations=observations, actions=actions, reward=reward, termination=termination)
    task, made, steps = _parsed(
        scene, {**given, **dict(control_interval=control_interval, settle=settle, layout=layout)}, settings
    )
    return VectorEnv(
        task, num_envs, made, steps if max_episode_steps is None else max_episode_steps, autoreset_mode, render_mode
    )


def _parsed(
    scene: SceneSource, given: dict[str, Any], settings: dict[str, Any]
) -> tuple[DeclaredTask, EnvSettings, int | None]:
    if given["observations"] is not None:
        return DeclaredTask(scene, **given), EnvSettings(**settings), None
    if not isinstance(scene, (str, Path)):
        raise ValueError("observations are missing; only the TOML file of an environment can define them")
    with open(scene, "rb") as file:
        try:
            tables = tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            raise ValueError(f"{scene}: {error}") from error
    unknown = sorted(set(tables) - set(_KEYS))
    if unknown:
        raise ValueError(f"{scene}: an environment has no key '{unknown[0]}'; it has {', '.join(_KEYS)}")
    if "scene" not in tables:
        raise ValueError(f"{scene}: the key 'scene' is missing: the scene file")
    steps = tables.pop("max_episode_steps", None)
    own = EnvSettings(**{**tables.pop("settings", {}), **settings})
    tables["scene"] = Path(scene).parent / tables["scene"]
    tables.setdefault("observations", {})
    return DeclaredTask(**tables), own, steps
