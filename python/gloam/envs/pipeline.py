"""The observation pipeline of n worlds: terms, each noise -> clip -> scale -> delay -> history.

The order and the terms follow mjlab's observation manager. Each world has its own state (noise generators, biases,
delays, delay buffers, histories): a reset of some worlds does not affect the others.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import spaces

from gloam.envs.noise import Array
from gloam.envs.terms import Term

Layout = Literal["dict", "vector"]
Observation = dict[str, Array] | Array


class TermBuffer:
    """State of one term for n worlds."""

    def __init__(self, term: Term, num_worlds: int) -> None:
        self.term = term
        self._rng = [np.random.default_rng() for _ in range(num_worlds)]
        self._pushed = np.zeros(num_worlds, dtype=np.int64)
        self._lag = np.zeros(num_worlds, dtype=np.int64)
        self._bias = np.zeros((num_worlds, *term.shape)) if term.noise is not None else None
        self._late: Array = np.zeros((num_worlds, term.lags[1] + 1, *term.shape), dtype=term.dtype)
        self._history: Array = np.zeros((num_worlds, term.history, *term.shape), dtype=term.dtype)

    def seed(self, world: int, seed: int) -> None:
        """Restarts the generator of a world. `seed`: >= 0; terms of other names draw other numbers."""
        self._rng[world] = np.random.default_rng([seed, zlib.crc32(self.term.name.encode())])

    def reset(self, worlds: Array) -> None:
        """Clears the state of these worlds, and draws new delays and biases of their noise."""
        self._pushed[worlds] = 0
        least, most = self.term.lags
        for world in worlds:
            rng = self._rng[world]
            if most > least:
                self._lag[world] = rng.integers(least, most, endpoint=True)
            else:
                self._lag[world] = least
            if self.term.noise is not None and self._bias is not None:
                self._bias[world] = self.term.noise.bias(rng, self.term.shape)

    def push(self, raw: Array, worlds: Array) -> Array:
        """The present observation of the term in these worlds. raw: (k, *shape), worlds: (k,); returns (k,
        *output_shape)."""
        term = self.term
        if raw.shape != (len(worlds), *term.shape):
            raise ValueError(f"term '{term.name}' has the shape {term.shape}, but its values have {raw.shape[1:]}, for {len(worlds)} worlds")
        seen = term.finish(self._with_noise(raw, worlds))
        if self._late.shape[1] > 1:
            seen = self._delayed(seen, worlds)
        is_first = self._pushed[worlds] == 0
        self._pushed[worlds] += 1
        if term.history == 1:
            return seen
        past = self._history[worlds]
        past[:, :-1] = past[:, 1:]
        past[:, -1] = seen
        past[is_first] = seen[is_first][:, None]
        self._history[worlds] = past
        return past

    def _with_noise(self, raw: Array, worlds: Array) -> Array:
        noise = self.term.noise
        if noise is None or self._bias is None:
            return raw
        error = [noise.sample(self._rng[world], value) for world, value in zip(worlds, raw, strict=True)]
        return np.asarray(raw + np.stack(error) + self._bias[worlds])

    def _delayed(self, seen: Array, worlds: Array) -> Array:
        """The value from `lag` steps ago; initially, the first value of the episode."""
        now = self._pushed[worlds]
        size = self._late.shape[1]
        self._late[worlds, now % size] = seen
        return np.asarray(self._late[worlds, np.maximum(now - self._lag[worlds], 0) % size])


class Pipeline:
    """Computes observations of n worlds from raw values.

    layout: "dict", one entry for each term, or "vector", all terms in a row, flattened (float32). Errors: ValueError
    without terms, or with two terms of one name.
    """

    def __init__(self, terms: Sequence[Term], num_worlds: int, layout: Layout = "dict") -> None:
        names = [term.name for term in terms]
        if not names:
            raise ValueError("an observation needs a term")
        if len(set(names)) < len(names):
            raise ValueError(f"observation terms must have different names: {sorted(names)}")
        if layout not in ("dict", "vector"):
            raise ValueError(f"layout must be 'dict' or 'vector', got {layout!r}")
        self.layout = layout
        self.num_worlds = num_worlds
        self._buffers = [TermBuffer(term, num_worlds) for term in terms]

    @property
    def terms(self) -> list[Term]:
        """The terms, in their order."""
        return [buffer.term for buffer in self._buffers]

    def space(self) -> spaces.Space[Any]:
        """Space of the observation of one world."""
        boxes = {term.name: term.space() for term in self.terms}
        if self.layout == "dict":
            return spaces.Dict(dict(boxes))
        low = np.concatenate([box.low.ravel() for box in boxes.values()]).astype(np.float32)
        high = np.concatenate([box.high.ravel() for box in boxes.values()]).astype(np.float32)
        return spaces.Box(low, high, dtype=np.float32)

    def seed(self, world: int, seed: int) -> None:
        """Restarts the random numbers of one world; they take effect with the next values, and wholly after a reset."""
        for buffer in self._buffers:
            buffer.seed(world, seed)

    def reset(self, worlds: Array) -> None:
        """Begins an episode in the worlds with these numbers."""
        for buffer in self._buffers:
            buffer.reset(worlds)

    def push(self, raw: Mapping[str, Array], worlds: Array) -> Observation:
        """Observation of these worlds, (k, …) in the order of `worlds`, out of raw values (k, *shape) by name.

        The arrays are new: the next call does not change them. Errors: KeyError for a term without a value,
        ValueError for a value of another shape.
        """
        seen = {buffer.term.name: buffer.push(np.asarray(raw[buffer.term.name]), worlds) for buffer in self._buffers}
        if self.layout == "dict":
            return seen
        flat = [value.reshape(len(worlds), -1).astype(np.float32) for value in seen.values()]
        return np.concatenate(flat, axis=1)
