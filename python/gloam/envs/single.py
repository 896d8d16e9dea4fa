"""One world as a gymnasium.Env."""

from __future__ import annotations

from typing import Any, SupportsFloat

import gymnasium as gym
import numpy as np
from gymnasium.envs.registration import EnvSpec

import gloam
from gloam.envs.checks import checked_actions
from gloam.envs.noise import Array
from gloam.envs.pipeline import Observation
from gloam.envs.settings import EnvSettings
from gloam.envs.task import Task
from gloam.envs.worlds import Worlds

_FIRST = np.zeros(1, dtype=np.int64)


class Env(gym.Env[Observation, Array]):
    """One world of a task. The same seed and actions give the same results as world 0 of a VectorEnv, bit for bit.

    task: the task. settings: delays, noise and so on. max_episode_steps: control steps after which an episode is
    truncated; None = never, or by gymnasium's TimeLimit. render_mode: None or "rgb_array". Errors: errors of the
    scene; ValueError for invalid settings.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        task: Task,
        settings: EnvSettings | None = None,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode must be None or 'rgb_array', got {render_mode!r}")
        if max_episode_steps is not None and max_episode_steps < 1:
            raise ValueError(f"max_episode_steps must be at least 1, got {max_episode_steps}")
        self.render_mode = render_mode
        self._worlds = Worlds(task, 1, settings or EnvSettings())
        self._most_steps = max_episode_steps
        self._step_count: int | None = None
        self.metadata = {**self.metadata, "render_fps": max(1, round(1 / self._worlds.control_interval))}
        self.observation_space = self._worlds.pipeline.space()
        self.action_space = self._worlds.action_space

    @property
    def sim(self) -> gloam.Simulation:
        """The simulation; a reset with another seed replaces it. Errors: ClosedError."""
        if not self._worlds.slots:
            raise gloam.ClosedError("the environment is closed")
        return self._worlds.slots[0].sim

    @property
    def hash(self) -> int:
        """State hash of the simulation: equal hashes mean equal runs."""
        return self.sim.hash

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode. seed: >= 0, for all random numbers, including the simulation's; None continues the
        present sequences.

        options: options of the task, see its page. Returns the observation and `info`.
        """
        assert self.sim is not None
        super().reset(seed=seed)
        observation, infos = self._worlds.reset(_FIRST, [seed], options or {})
        self._np_random = self._worlds.slots[0].rng
        self._step_count = 0
        return _only(observation), infos[0]

    def step(self, action: Array) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """Takes one control step. Errors: ValueError for another shape, or a number that is not finite."""
        assert self.sim is not None
        if self._step_count is None:
            raise gloam.UsageError("call reset() before step()")
        actions = checked_actions(np.asarray(action)[None], self._worlds.action_space, 1)
        result = self._worlds.step(_FIRST, actions)
        self._step_count += 1
        is_late = self._most_steps is not None and self._step_count >= self._most_steps
        is_done = bool(result.terminated[0])
        return _only(result.observation), float(result.rewards[0]), is_done, is_late and not is_done, result.infos[0]

    def render(self) -> Any:
        """Image of the present instant, (height, width, 3) uint8, in mode "rgb_array", else None."""
        assert self.sim is not None
        return self._worlds.render(0) if self.render_mode == "rgb_array" else None

    def __reduce__(self) -> Any:
        """A pickled or copied environment is made again from its spec, and has to be reset."""
        if self.spec is None:
            raise TypeError("an environment without a spec cannot be pickled or copied: register it and create it with gym.make(), whose "
                            "env.spec creates another one, or send the function that creates it")
        return made_by_spec, (self.spec,)

    def __deepcopy__(self, _: dict[int, Any]) -> Any:
        make, arguments = self.__reduce__()
        return make(*arguments)

    def close(self) -> None:
        """Ends the simulation."""
        if hasattr(self, "_worlds"):
            self._worlds.close()


def made_by_spec(spec: EnvSpec) -> gym.Env[Any, Any]:
    """The environment of gym.make(spec) without its wrappers, which are pickled separately."""
    return gym.make(spec).unwrapped


def _only(observation: Observation) -> Observation:
    if isinstance(observation, dict):
        return {name: value[0] for name, value in observation.items()}
    value: Array = observation[0]
    return value
