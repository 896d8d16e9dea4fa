"""Settings of every environment, independent of its task."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from gloam.dynamics import QUANTITIES
from gloam.envs.noise import Array, Noise, parse_noise
from gloam.envs.terms import Term

Range = float | tuple[float, float]
Limits = tuple[Any, Any]


@dataclass(frozen=True)
class EnvSettings:
    """Settings of an environment.

    action_delay: time from an action to the robot [s], a number or (least, most), drawn for each episode; exact to
        the physics step.
    sensor_latency: by the name of a term [s], a number or (least, most); rounded up to control steps. It adds to
        the delay that the term has.
    noise: by the name of a term, in its raw unit; replaces the noise of the term.
    history: by the name of a term: number of its newest values in the observation.
    randomize: by the path of an option of the scene: (low, high), numbers or lists of numbers, drawn uniformly for
        each episode. The scene is compiled again at each reset, which takes time.
    dynamics: factors (low, high) of the values in the model's files, by "mass", "friction", "gains", "armature" or
        "damping", drawn uniformly for each episode and each body, geom, actuator or joint of the model. They are inputs
        of the episode's first step, without a recompile.
    threads: number of threads that step worlds; None = one for each core.
    render_camera: name of the camera of render(); None = the scene's first. render_size: (width, height) [px].
    """

    action_delay: Range = 0.0
    sensor_latency: Mapping[str, Range] = field(default_factory=dict)
    noise: Mapping[str, Any] = field(default_factory=dict)
    history: Mapping[str, int] = field(default_factory=dict)
    randomize: Mapping[str, Limits] = field(default_factory=dict)
    dynamics: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    threads: int | None = None
    render_camera: str | None = None
    render_size: tuple[int, int] = (320, 240)

    def __post_init__(self) -> None:
        _seconds("action_delay", self.action_delay)
        for name, latency in self.sensor_latency.items():
            _seconds(f"sensor_latency of '{name}'", latency)
        for name, limits in self.randomize.items():
            if not isinstance(limits, Sequence) or isinstance(limits, str) or len(limits) != 2:
                raise ValueError(f"randomize '{name}' must be a range (low, high), got {limits!r}")
            low, high = (np.asarray(limit, dtype=np.float64) for limit in limits)
            if low.shape != high.shape or not (
                np.isfinite(low).all() and np.isfinite(high).all() and (low <= high).all()
            ):
                raise ValueError(f"randomize '{name}': {limits!r} is not a range (low, high)")
        for name, limits in self.dynamics.items():
            if name not in QUANTITIES:
                raise ValueError(f"dynamics has no quantity '{name}'; the quantities are {', '.join(QUANTITIES)}")
            if len(limits) != 2 or not (0 < limits[0] <= limits[1] < math.inf):
                raise ValueError(f"dynamics '{name}': {limits!r} is not a range (low, high) of positive factors")
        if self.threads is not None and self.threads < 1:
            raise ValueError(f"threads must be at least 1, got {self.threads}")

    def action_delay_steps(self, timestep: float) -> tuple[int, int]:
        """Least and most delay of actions [physics steps]; timestep [s]."""
        low, high = _seconds("action_delay", self.action_delay)
        return round(low / timestep), round(high / timestep)

    def applied_to(self, terms: Sequence[Term], interval: float) -> list[Term]:
        """The terms with these latencies, noises and histories; interval: of the control [s].

        Errors: ValueError for a name that no term has.
        """
        names = {term.name for term in terms}
        for key in ("sensor_latency", "noise", "history"):
            for name in getattr(self, key):
                if name not in names:
                    raise ValueError(f"{key}: there is no term '{name}'; the terms are {sorted(names)}")
        return [self._applied(term, interval) for term in terms]

    def _applied(self, term: Term, interval: float) -> Term:
        low, high = _seconds("sensor_latency", self.sensor_latency.get(term.name, 0.0))
        late = tuple(math.ceil(time / interval - 1e-9) for time in (low, high))
        noise: Noise | None = parse_noise(self.noise[term.name]) if term.name in self.noise else term.noise
        return replace(
            term,
            delay=(term.lags[0] + late[0], term.lags[1] + late[1]),
            noise=noise,
            history=self.history.get(term.name, term.history),
        )

    def draw_dynamics(self, rng: np.random.Generator, counts: Mapping[str, int]) -> dict[str, Array]:
        """Factors of the quantities that are randomised, one for each of `counts` elements."""
        return {name: rng.uniform(low, high, counts[name]) for name, (low, high) in self.dynamics.items()}

    def draw(self, rng: np.random.Generator) -> dict[str, Any]:
        """Values of the options that are randomised."""
        return {
            name: rng.uniform(np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64)).tolist()
            if np.ndim(low)
            else float(rng.uniform(low, high))
            for name, (low, high) in self.randomize.items()
        }


def _seconds(name: str, value: Range) -> tuple[float, float]:
    """A time or range of times [s] as (least, most)."""
    low, high = (value, value) if isinstance(value, (int, float)) else value
    if not (math.isfinite(low) and math.isfinite(high) and 0 <= low <= high):
        raise ValueError(f"{name} must be a time [s] of at least 0 or a range (least, most) of such times, got {value!r}")
    return float(low), float(high)
