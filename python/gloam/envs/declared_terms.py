"""Tables of observations, rewards and terminations for make_env."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import gloam
from gloam.envs.noise import Array, Noise, parse_noise
from gloam.envs.sources import (
    CameraSource,
    FunctionSource,
    JointSource,
    LidarSource,
    Metrics,
    MetricSource,
    SensorSource,
    Source,
    TopicSource,
)
from gloam.envs.terms import Term

_KINDS: dict[str, tuple[str, ...]] = {  # and keys that go with them
    "metric": (),
    "topic": ("field",),
    "camera": ("output", "size", "far", "tier", "spp", "denoise"),
    "lidar": ("rings", "columns", "far"),
    "sensor": (),
    "joints": (),
    "joint_velocities": (),
    "function": (),
}
_STAGES = ("noise", "clip", "scale", "delay", "history")


@dataclass(frozen=True)
class ObservationSpec:
    """One observation: kind and value define its source, `keys` its other options."""

    name: str
    kind: str
    value: Any
    keys: Mapping[str, Any]
    noise: Noise | None
    stages: Mapping[str, Any]

    def open(self, sim: gloam.Simulation, metrics: Metrics) -> Source:
        """The quantity in a simulation. Errors: NotFoundError for a name that is not there."""
        keys = self.keys
        if self.kind == "camera":
            look = {"tier": "direct", "spp": 1, "denoise": False}
            look |= {key: keys[key] for key in look if key in keys}
            size = tuple(keys.get("size", (0, 0)))
            return CameraSource(sim, self.value, keys.get("output", "rgb"), size, float(keys.get("far", 100.0)), look)
        if self.kind == "lidar":
            return LidarSource(
                sim, self.value, int(keys.get("rings", 1)), int(keys["columns"]), float(keys.get("far", 100.0))
            )
        if self.kind == "topic":
            return TopicSource(sim, self.value, keys.get("field", ""))
        if self.kind == "sensor":
            return SensorSource(sim, self.value)
        if self.kind in ("joints", "joint_velocities"):
            return JointSource(sim, self.value, is_velocity=self.kind == "joint_velocities")
        if self.kind == "metric":
            return MetricSource(metrics, self.value)
        return FunctionSource(sim, self.value)

    def term(self, example: Array) -> Term:
        """The term of what `example` is a raw value of."""
        is_picture = example.dtype == np.uint8
        low, high = (0.0, 255.0) if is_picture else (-math.inf, math.inf)
        keeps_bytes = is_picture and "scale" not in self.stages
        dtype = np.uint8 if keeps_bytes else np.float32
        return Term(self.name, example.shape, low, high, noise=self.noise, dtype=dtype, **self.stages)


def parse_observation(name: str, table: object) -> ObservationSpec:
    """One observation out of its table. Errors: ValueError."""
    if callable(table):
        table = {"function": table}
    if isinstance(table, str):
        table = {"metric": table}
    if not isinstance(table, Mapping):
        raise ValueError(f"observation '{name}' must be a table or a function, got {table!r}")
    kinds = [key for key in table if key in _KINDS]
    if len(kinds) != 1:
        raise ValueError(f"observation '{name}' must have one of {', '.join(_KINDS)}; got {sorted(table)}")
    kind = kinds[0]
    for key in table:
        if key not in (kind, *_KINDS[kind], *_STAGES):
            raise ValueError(
                f"observation '{name}' of a {kind} has no key '{key}'; it has {', '.join((*_KINDS[kind], *_STAGES))}"
            )
    if kind == "lidar" and "columns" not in table:
        raise ValueError(f"observation '{name}' of a lidar needs the key columns")
    stages = {key: table[key] for key in _STAGES if key in table and key != "noise"}
    for key in ("clip", "delay", "scale"):
        if isinstance(stages.get(key), list):
            stages[key] = tuple(stages[key])
    keys = {key: table[key] for key in _KINDS[kind] if key in table}
    return ObservationSpec(name, kind, table[kind], keys, parse_noise(table.get("noise")), stages)


@dataclass(frozen=True)
class RewardSpec:
    """weight times a metric at each control step, or, with `change`, times what it gained in it; or a constant."""

    metric: str | None = None
    function: Callable[[gloam.Simulation], Any] | None = None
    weight: float = 1.0
    change: bool = False
    constant: float = 0.0

    def raw(self, sim: gloam.Simulation, metrics: Metrics) -> float:
        """The quantity now; NaN where it has no value."""
        if self.function is not None:
            return float(self.function(sim))
        return math.nan if self.metric is None else metrics.value(self.metric)

    def worth(self, value: float, before: float) -> float:
        """The reward; what has no value counts nothing."""
        amount = value - before if self.change else value
        return self.constant + (self.weight * amount if math.isfinite(amount) else 0.0)


@dataclass(frozen=True)
class TerminationSpec:
    """Ends an episode when a metric is above or below a limit, or a function is true. success: whether this counts as
    success."""

    metric: str | None = None
    function: Callable[[gloam.Simulation], Any] | None = None
    above: float = math.inf
    below: float = -math.inf
    success: bool = False

    def is_met(self, sim: gloam.Simulation, metrics: Metrics) -> bool:
        """Whether it ends now; a metric without a value ends nothing."""
        if self.function is not None:
            return bool(self.function(sim))
        value = math.nan if self.metric is None else metrics.value(self.metric)
        return value > self.above or value < self.below


def parse_rewards(tables: object) -> list[RewardSpec]:
    """Rewards out of a table, a list of tables, or functions. Errors: ValueError."""
    made = []
    for table in _listed(tables, "reward"):
        spec = RewardSpec(**_keys(table, "reward", ("metric", "function", "weight", "change", "constant")))
        if (spec.metric is None and spec.function is None) == (spec.constant == 0.0):
            raise ValueError(f"a reward must have either a metric, a function or a constant: {table!r}")
        if not (math.isfinite(spec.weight) and math.isfinite(spec.constant)):
            raise ValueError(f"a reward's weight and constant must be finite: {table!r}")
        made.append(spec)
    return made


def parse_terminations(tables: object) -> list[TerminationSpec]:
    """Terminations out of a table, a list of tables, or functions. Errors: ValueError."""
    made = []
    for table in _listed(tables, "termination"):
        spec = TerminationSpec(**_keys(table, "termination", ("metric", "function", "above", "below", "success")))
        if (spec.metric is None) == (spec.function is None):
            raise ValueError(f"a termination must have either a metric or a function: {table!r}")
        if spec.metric is not None and math.isinf(spec.above) and math.isinf(spec.below):
            raise ValueError(f"the termination by '{spec.metric}' needs a limit: above or below")
        made.append(spec)
    return made


def _listed(tables: object, what: str) -> Sequence[object]:
    if tables is None:
        return []
    if isinstance(tables, Mapping) or callable(tables):
        return [tables]
    if isinstance(tables, Sequence) and not isinstance(tables, str):
        return tables
    raise ValueError(f"{what} must be a list of tables, got {tables!r}")


def _keys(table: object, what: str, known: Sequence[str]) -> dict[str, Any]:
    if callable(table):
        return {"function": table}
    if not isinstance(table, Mapping):
        raise ValueError(f"a {what} must be a table, got {table!r}")
    for key in table:
        if key not in known:
            raise ValueError(f"a {what} has no key '{key}'; it has {', '.join(known)}")
    return {str(key): value for key, value in table.items()}
