"""The observation of a policy: terms in order, each clipped, scaled and with its history."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from ..errors import DivergedError
from .spec import PolicySpec
from .terms import Array, GaitClock, RobotState, term_values


class Observer:
    """Remembers what one robot's observation needs of the past: histories, the gait's phase."""

    def __init__(self, spec: PolicySpec) -> None:
        self._spec = spec
        self._clock = GaitClock(spec.gait_period, spec.rate)
        self._scales = [None if set(term.scale) == {1.0} else np.array(term.scale) for term in spec.terms]
        self._clips = [None if np.isinf(term.clip).all() else term.clip for term in spec.terms]
        self._past: list[deque[Array]] = []
        self.reset()

    def reset(self) -> None:
        """Forgets the past."""
        self._clock.reset()
        self._past = [deque(maxlen=term.history) for term in self._spec.terms]

    def observe(self, state: RobotState, command: Array, action: Array) -> NDArray[np.float32]:
        """The network's input (observation_size,) at one control period; moves histories and phase on.

        command: (3,) vx, vy [m/s], yaw rate [rad/s]; action: (n,) the previous output. Raises DivergedError: a number
        is not finite.
        """
        self._clock.tick(command)
        parts: list[Array] = []
        for term, scale, clip, past in zip(self._spec.terms, self._scales, self._clips, self._past, strict=True):
            now = (
                state.sensors[term.sensor]
                if term.sensor
                else term_values(term.name, state, command, action, self._spec.default_positions, self._clock.phase)
            )
            if clip is not None:
                now = np.minimum(np.maximum(now, clip[0]), clip[1])  # NaN stays NaN
            if scale is not None:
                now = now * scale
            if not past:
                first = now if self._spec.history_start == "repeat" else np.zeros_like(now)
                past.extend([first] * (term.history - 1))
            past.append(now)
            parts.extend(past)
        observation = np.concatenate(parts).astype(np.float32)
        if not np.isfinite(observation).all():
            self._raise(observation)
        return observation

    def _raise(self, observation: NDArray[np.float32]) -> None:
        ends = np.cumsum(self._spec.term_sizes())
        place = int(np.flatnonzero(~np.isfinite(observation))[0])
        term = self._spec.terms[int(np.searchsorted(ends, place, side="right"))]
        raise DivergedError(f"observation term '{term.name}' of the policy is not finite")
