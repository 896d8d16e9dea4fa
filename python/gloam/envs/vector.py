"""n worlds as a gymnasium.vector.VectorEnv."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space, create_empty_array

import gloam
from gloam.envs.checks import checked_actions, checked_mask, checked_seeds
from gloam.envs.noise import Array
from gloam.envs.pipeline import Observation
from gloam.envs.settings import EnvSettings
from gloam.envs.task import Task
from gloam.envs.worlds import Worlds


class VectorEnv(gym.vector.VectorEnv[Observation, Array, Array]):
    """n worlds of a task that share one compiled World and step on all cores.

    World i of reset(seed=s) equals the Env of seed s + i, bit for bit. The caller owns the returned arrays.
    autoreset_mode: NEXT_STEP (the step after the last one resets), SAME_STEP (the last step does; the last
    observation is `info["final_obs"][i]`, its info `info["final_info"]`) or DISABLED (the caller resets, with
    `options={"reset_mask": mask}`). Others as of Env.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        task: Task,
        num_envs: int = 1,
        settings: EnvSettings | None = None,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode must be None or 'rgb_array', got {render_mode!r}")
        if max_episode_steps is not None and max_episode_steps < 1:
            raise ValueError(f"max_episode_steps must be at least 1, got {max_episode_steps}")
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.render_mode = render_mode
        self.num_envs = num_envs
        self._worlds = Worlds(task, num_envs, settings or EnvSettings())
        self._most_steps = max_episode_steps
        self._step_counts = np.zeros(num_envs, dtype=np.int64)
        self._is_done = np.zeros(num_envs, dtype=np.bool_)
        self._is_begun = np.zeros(num_envs, dtype=np.bool_)
        fps = max(1, round(1 / self._worlds.control_interval))
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode, "render_fps": fps}
        self.single_observation_space = self._worlds.pipeline.space()
        self.single_action_space = self._worlds.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._last: Any = create_empty_array(self.single_observation_space, num_envs)

    def __reduce__(self) -> Any:
        raise TypeError("a vector environment cannot be pickled or copied: create another with gym.make_vec(env.spec), "
                        "or send the function that creates it")

    @property
    def sims(self) -> list[gloam.Simulation]:
        """The simulations, by world. A reset with another seed replaces one. Errors: ClosedError."""
        if not self._worlds.slots:
            raise gloam.ClosedError("the environment is closed")
        return [slot.sim for slot in self._worlds.slots]

    @property
    def hashes(self) -> list[int]:
        """State hashes of all worlds."""
        return [sim.hash for sim in self.sims]

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode in all worlds, or in the worlds of options["reset_mask"], (num_envs,) bool.

        seed: None, one number s for the worlds' seeds s, s + 1, …, or a list with one for each world (None: its
        random numbers go on). Observations of worlds that are not reset are their last ones. Errors: TypeError,
        ValueError for a mask or seeds of another kind or shape.
        """
        assert self.sims is not None
        seeds = checked_seeds(seed, self.num_envs)
        others = dict(options or {})
        mask = np.ones(self.num_envs, dtype=np.bool_)
        if "reset_mask" in others:
            mask = checked_mask(others.pop("reset_mask"), self.num_envs)
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
        infos = self._begin(np.flatnonzero(mask), seeds, others, {})
        return self._copy(), infos

    def step(self, actions: Array) -> tuple[Observation, Array, Array, Array, dict[str, Any]]:
        """Takes one control step in every world; actions: (num_envs, …); actions of worlds that are reset have no
        effect.

        Returns observations, rewards, terminated, truncated, each of num_envs, and infos as gymnasium has them.
        Errors: ValueError for another shape or a number that is not finite; UsageError before the first reset and,
        in mode DISABLED, for a world whose episode has ended.
        """
        assert self.sims is not None
        if not self._is_begun.all():
            raise gloam.UsageError("call reset() before step()")
        checked = checked_actions(actions, self._worlds.action_space, self.num_envs)
        fresh = self._to_reset()
        going = np.flatnonzero(~fresh)
        rewards = np.zeros(self.num_envs)
        terminated, truncated = (np.zeros(self.num_envs, dtype=np.bool_) for _ in range(2))
        infos: dict[str, Any] = {}
        final: list[dict[str, Any]] = []
        if len(going) > 0:
            result = self._worlds.step(going, checked[going])
            self._store(going, result.observation)
            self._step_counts[going] += 1
            rewards[going], terminated[going] = result.rewards, result.terminated
            final = result.infos
        if self._most_steps is not None:
            truncated = ~terminated & ~fresh & (self._step_counts >= self._most_steps)
        self._is_done = terminated | truncated
        ended = (
            np.flatnonzero(self._is_done) if self.autoreset_mode is AutoresetMode.SAME_STEP else np.zeros(0, np.int64)
        )
        for world, info in zip(going, final, strict=True):
            if world in ended:
                info = {"final_obs": self._of(int(world)), "final_info": info}
            infos = self._add_info(infos, info, int(world))
        if fresh.any():
            infos = self._begin(np.flatnonzero(fresh), [None] * self.num_envs, {}, infos)
        if len(ended) > 0:
            infos = self._begin(ended, [None] * self.num_envs, {}, infos)
        return self._copy(), rewards, terminated, truncated, infos

    def render(self) -> tuple[Any, ...] | None:
        """An image of each world, (height, width, 3) uint8, in mode "rgb_array", else None."""
        if self.render_mode != "rgb_array":
            return None
        return tuple(self._worlds.render(world) for world in range(len(self.sims)))

    def close_extras(self, **kwargs: Any) -> None:
        """Ends the simulations."""
        if hasattr(self, "_worlds"):
            self._worlds.close()

    def _to_reset(self) -> Array:
        """Worlds that this step resets."""
        if self.autoreset_mode is AutoresetMode.NEXT_STEP:
            return self._is_done.copy()
        if self._is_done.any():
            raise gloam.UsageError(
                f"the episodes of worlds {np.flatnonzero(self._is_done).tolist()} have ended: "
                'reset them first with reset(options={"reset_mask": mask})'
            )
        return np.zeros(self.num_envs, dtype=np.bool_)

    def _begin(
        self, worlds: Array, seeds: list[int | None], options: dict[str, Any], infos: dict[str, Any]
    ) -> dict[str, Any]:
        observation, starts = self._worlds.reset(worlds, [seeds[world] for world in worlds], options)
        self._store(worlds, observation)
        self._step_counts[worlds] = 0
        self._is_done[worlds] = False
        self._is_begun[worlds] = True
        for world, info in zip(worlds, starts, strict=True):
            infos = self._add_info(infos, info, int(world))
        return infos

    def _store(self, worlds: Array, observation: Observation) -> None:
        if isinstance(observation, dict):
            for name, value in observation.items():
                self._last[name][worlds] = value
        else:
            self._last[worlds] = observation

    def _of(self, world: int) -> Observation:
        if isinstance(self._last, dict):
            return {name: value[world].copy() for name, value in self._last.items()}
        one: Array = self._last[world].copy()
        return one

    def _copy(self) -> Observation:
        if isinstance(self._last, dict):
            return {name: value.copy() for name, value in self._last.items()}
        copy: Array = self._last.copy()
        return copy
