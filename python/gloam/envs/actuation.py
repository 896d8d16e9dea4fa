"""Delay between an action and the robot: to the physics step, not the control step."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np

from gloam.envs.noise import Array


class DelayedActions:
    """Delayed actions of one world.

    delay: least and most [physics steps]; one of them is drawn for an episode.
    """

    def __init__(self, delay: tuple[int, int]) -> None:
        if not 0 <= delay[0] <= delay[1]:
            raise ValueError(f"an action delay must be a range of physics steps of at least 0, got {delay}")
        self._range = delay
        self._delay = delay[0]
        self._now = 0
        self._waiting: deque[tuple[int, Array]] = deque()

    def reset(self, rng: np.random.Generator) -> None:
        """Discards delayed actions, and draws the delay of the episode."""
        self._waiting.clear()
        self._now = 0
        least, most = self._range
        self._delay = int(rng.integers(least, most, endpoint=True)) if most > least else least

    def advance(self, action: Array, steps: int, apply: Callable[[Array], None], step: Callable[[int], None]) -> None:
        """Takes `steps` physics steps; calls `apply` when an action arrives and `step(n)` in between."""
        self._waiting.append((self._now + self._delay, action))
        end = self._now + steps
        while self._now < end:
            while self._waiting and self._waiting[0][0] <= self._now:
                apply(self._waiting.popleft()[1])
            until = min(end, self._waiting[0][0]) if self._waiting else end
            step(until - self._now)
            self._now = until
