"""Specification of a policy: joints, gains, scales, observation terms. Checked, in the order of the policy's
joints."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError
from .terms import Array, term_info

AXES = ("vx", "vy", "yaw_rate")
POLICY_KEYS = (
    "rate",
    "joints",
    "model_joints",
    "kp",
    "kd",
    "default_positions",
    "action_scale",
    "action_clip",
    "torque_limit",
    "history_start",
    "gait_period",
    "command_ranges",
)
TERM_KEYS = ("term", "scale", "clip", "history", "sensor")


@dataclass(frozen=True)
class Term:
    """One part of the observation. Order of work: value, clip, scale, history (as mjlab)."""

    name: str
    scale: tuple[float, ...] = (1.0,)  # one number, or one of each value
    clip: tuple[float, float] = (-math.inf, math.inf)  # in the term's unit
    history: int = 1  # observations that are handed in, oldest first
    sensor: str = ""  # name of the robot's sensor that gives the values instead of the true state


@dataclass(frozen=True)
class PolicySpec:
    """Arrays are (n,) in the order of `joints`."""

    joints: tuple[str, ...]
    kp: Array  # [N m/rad]
    kd: Array  # [N m s/rad]
    default_positions: Array  # [rad]
    action_scale: Array  # target = default + scale * action [rad]
    torque_limit: Array  # [N m], infinite where not given
    terms: tuple[Term, ...]
    action_clip: tuple[float, float] = (-math.inf, math.inf)
    rate: float = 50.0  # [Hz]
    history_start: str = "repeat"  # what stands before the first observation: "repeat" of it, or "zeros"
    gait_period: float = 1.0  # [s], of the terms phase, sin_phase, cos_phase
    command_ranges: dict[str, tuple[float, float]] = field(default_factory=dict)  # of vx, vy [m/s], yaw_rate [rad/s]
    model_joints: dict[str, str] = field(default_factory=dict)  # names in the model where they are others

    def term_sizes(self) -> list[int]:
        """Numbers of each term with its history."""
        return [term_info(term.name).size(len(self.joints)) * term.history for term in self.terms]

    @property
    def observation_size(self) -> int:
        return sum(self.term_sizes())


def _number(value: Any, what: str, file: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{what} must be a number, got {value!r}", file)
    return float(value)


def _finite(value: Any, what: str, file: str, above: float = -math.inf) -> float:
    number = _number(value, what, file)
    if not math.isfinite(number) or number <= above:
        bound = f" above {above:g}" if math.isfinite(above) else ""
        raise InputError(f"{what} must be a finite number{bound}, got {number:g}", file)
    return number


def _range(value: Any, what: str, file: str) -> tuple[float, float]:
    """[low, high], or one number for -number … number."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = [-abs(value), abs(value)]
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 2:
        raise InputError(f"{what} must be [low, high], got {value!r}", file)
    low, high = (_number(v, what, file) for v in value)
    if not low <= high:
        raise InputError(f"{what}: low {low:g} is not below high {high:g}", file)
    return low, high


def per_joint(value: Any, joints: Sequence[str], what: str, file: str, default: float | None = None) -> Array:
    """(n,) of one number, of a list, or of a table {pattern = number} (regular expressions for whole names).

    An exact name takes precedence over a pattern, a later pattern over an earlier one. Raises InputError: another
    length, a pattern that matches no joint, a joint without a number if there is no default.
    """
    n = len(joints)
    if isinstance(value, Mapping):
        return _by_pattern(value, joints, what, file, default)
    if isinstance(value, Sequence) and not isinstance(value, str):
        if len(value) != n:
            raise InputError(f"{what} has {len(value)} numbers for {n} joints of the policy", file)
        return np.array([_finite(v, f"{what} of {joints[i]}", file) for i, v in enumerate(value)])
    return np.full(n, _finite(value, what, file))


def _by_pattern(table: Mapping[str, Any], joints: Sequence[str], what: str, file: str, default: float | None) -> Array:
    numbers: list[float | None] = [default] * len(joints)
    for exact in (False, True):
        for pattern, value in table.items():
            number = _finite(value, f"{what}.{pattern}", file)
            try:
                fits = [i for i, name in enumerate(joints) if re.fullmatch(pattern, name)]
            except re.error as error:
                raise InputError(f"{what}: '{pattern}' is not a valid regular expression: {error}", file) from None
            if not fits:
                raise InputError(f"{what}: '{pattern}' matches no joint", file, hint="joints: " + ", ".join(joints))
            for i in fits:
                if not exact or joints[i] == pattern:
                    numbers[i] = number
    missing = [joints[i] for i, number in enumerate(numbers) if number is None]
    if missing:
        raise InputError(f"{what} has no number for {', '.join(missing)}", file)
    return np.array(numbers, dtype=np.float64)


def _check_keys(table: Mapping[str, Any], known: Sequence[str], where: str, file: str) -> None:
    for key in table:
        if key not in known:
            raise InputError(f"{where} has no '{key}'", file, hint="one of: " + ", ".join(known))


def _term(table: Any, joints: int, file: str) -> Term:
    if not isinstance(table, Mapping) or not isinstance(table.get("term"), str):
        raise InputError("an [[observation]] needs a term", file, hint='for example term = "base_ang_vel"')
    _check_keys(table, TERM_KEYS, "[[observation]]", file)
    info = term_info(table["term"], file)
    what = f"observation term '{table['term']}'"
    scale = table.get("scale", 1.0)
    numbers = scale if isinstance(scale, Sequence) and not isinstance(scale, str) else [scale]
    size = info.size(joints)
    if len(numbers) not in (1, size):
        raise InputError(f"{what}: scale has {len(numbers)} numbers, but the term has {size}", file)
    history = table.get("history", 1)
    if isinstance(history, bool) or not isinstance(history, int) or not 1 <= history <= 1000:
        raise InputError(f"{what}: history must be a whole number from 1 to 1000, got {history!r}", file)
    sensor = table.get("sensor", "")
    if not isinstance(sensor, str):
        raise InputError(f"{what}: sensor must be a name, got {sensor!r}", file)
    clip = _range(table["clip"], f"{what}: clip", file) if "clip" in table else (-math.inf, math.inf)
    return Term(info.name, tuple(_finite(v, f"{what}: scale", file) for v in numbers), clip, history, sensor)


def _names(value: Any, file: str) -> tuple[str, ...]:
    if not isinstance(value, Sequence) or isinstance(value, str) or not all(isinstance(v, str) for v in value):
        raise InputError(f"joints must be a list of names, got {value!r}", file)
    if len(set(value)) != len(value):
        raise InputError(f"joints lists {next(v for v in value if list(value).count(v) > 1)} twice", file)
    return tuple(value)


def _require(policy: Mapping[str, Any], observation: Sequence[Any], file: str) -> None:
    missing = [key for key in ("joints", "kp", "kd", "action_scale") if not policy.get(key) and policy.get(key) != 0]
    if "default_positions" not in policy:
        missing.append("default_positions")
    parts = [f"[policy] {', '.join(missing)}"] if missing else []
    parts += [] if observation else ["[[observation]] terms"]
    if parts:
        raise InputError(
            f"the network's metadata does not contain {' and '.join(parts)}",
            file,
            hint='write them to a TOML file: gloam.Policy("x.onnx", "x.toml"), docs/policies.md',
        )


def _command_ranges(value: Any, file: str) -> dict[str, tuple[float, float]]:
    if not isinstance(value, Mapping):
        raise InputError(f"command_ranges must be a table of {', '.join(AXES)}, got {value!r}", file)
    _check_keys(value, AXES, "command_ranges", file)
    return {axis: _range(limits, f"command_ranges.{axis}", file) for axis, limits in value.items()}


def build_spec(settings: Mapping[str, Any], file: str) -> PolicySpec:
    """The checked spec of {"policy": {...}, "observation": [...]}. Raises InputError naming `file`."""
    policy: Mapping[str, Any] = settings.get("policy", {})
    observation: Sequence[Any] = settings.get("observation", [])
    _check_keys(policy, POLICY_KEYS, "[policy]", file)
    _require(policy, observation, file)
    joints = _names(policy["joints"], file)
    numbers = {
        key: per_joint(policy[key], joints, key, file, default)
        for key, default in (("kp", None), ("kd", None), ("action_scale", None), ("default_positions", 0.0))
    }
    limit = (
        per_joint(policy["torque_limit"], joints, "torque_limit", file, math.inf)
        if "torque_limit" in policy
        else np.full(len(joints), math.inf)
    )
    for key in ("kp", "kd"):
        if (numbers[key] < 0).any():
            raise InputError(f"{key} of {joints[int(np.argmin(numbers[key]))]} is negative", file)
    start = policy.get("history_start", "repeat")
    if start not in ("repeat", "zeros"):
        raise InputError(f'history_start must be "repeat" or "zeros", got {start!r}', file)
    renamed = policy.get("model_joints", {})
    if not isinstance(renamed, Mapping):
        raise InputError("model_joints must be a table {policy's name = model's name}", file)
    _check_keys(renamed, joints, "model_joints", file)
    return PolicySpec(
        joints=joints,
        torque_limit=limit,
        terms=tuple(_term(t, len(joints), file) for t in observation),
        action_clip=_range(policy.get("action_clip", math.inf), "action_clip", file),
        rate=_finite(policy.get("rate", 50.0), "rate", file, 0.0),
        history_start=start,
        gait_period=_finite(policy.get("gait_period", 1.0), "gait_period", file, 0.0),
        command_ranges=_command_ranges(policy.get("command_ranges", {}), file),
        model_joints={k: str(v) for k, v in renamed.items()},
        **numbers,
    )
