"""Metadata of ONNX files as mjlab 1.6 and holosoma 0.1 write it, as settings in the form of a policy's TOML.

mjlab writes lists as text with commas (parts of an entry with semicolons), rounded to three decimals; holosoma writes
JSON.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from ..errors import InputError

_AXES = {"lin_vel_x": "vx", "lin_vel_y": "vy", "ang_vel_yaw": "yaw_rate", "ang_vel_z": "yaw_rate"}


def _split(text: str) -> list[str]:
    return [part.strip() for part in text.split(",")] if text.strip() else []


def _numbers(text: str, key: str, file: str, separator: str = ",") -> list[float]:
    try:
        return [float(part) for part in text.split(separator)] if text.strip() else []
    except ValueError:
        raise InputError(f"metadata '{key}' is not a list of numbers: {text[:60]!r}", file) from None


def _entries(metadata: Mapping[str, str], key: str, count: int, file: str) -> list[list[float]] | None:
    """Numbers of each observation term; None if the file does not contain them."""
    if key not in metadata:
        return None
    entries = [_numbers(part, key, file, ";") for part in _split(metadata[key])]
    if len(entries) != count or not all(entries):
        raise InputError(f"metadata '{key}' has {len(entries)} entries for {count} observation terms", file)
    return entries


def _length(number: float, name: str, file: str) -> int:
    """Length of a history, which mjlab writes as a number with decimals; its 0 means none."""
    if not number.is_integer():
        raise InputError(f"observation term '{name}' has an invalid history of {number:g} observations", file)
    return max(1, int(number))


def _mjlab_terms(metadata: Mapping[str, str], file: str) -> list[dict[str, Any]]:
    names = _split(metadata["observation_names"])
    scales = _entries(metadata, "observation_terms_scale", len(names), file)
    clips = _entries(metadata, "observation_terms_clip", len(names), file)
    lengths = _entries(metadata, "observation_terms_history_length", len(names), file)
    flat = metadata.get("observation_terms_flatten_history_dim")
    is_flat = [part.lower() not in ("false", "0", "0.000") for part in _split(flat)] if flat else [True] * len(names)
    terms: list[dict[str, Any]] = []
    for i, name in enumerate(names):
        term: dict[str, Any] = {"term": name}
        if scales:
            term["scale"] = scales[i]
        if clips:
            term["clip"] = clips[i]
        if lengths:
            term["history"] = _length(lengths[i][0], name, file)
        if term.get("history", 1) > 1 and not (len(is_flat) > i and is_flat[i]):
            raise InputError(
                f"observation term '{name}' has a history that is not flattened",
                file,
                hint="export the policy with flatten_history_dim",
            )
        terms.append(term)
    return terms


def _mjlab(metadata: Mapping[str, str], file: str) -> dict[str, Any]:
    policy: dict[str, Any] = {"joints": _split(metadata["joint_names"])}
    for key, name in (
        ("joint_stiffness", "kp"),
        ("joint_damping", "kd"),
        ("default_joint_pos", "default_positions"),
        ("action_scale", "action_scale"),
    ):
        if key in metadata:
            numbers = _numbers(metadata[key], key, file)
            policy[name] = numbers[0] if len(numbers) == 1 else numbers
    observation = _mjlab_terms(metadata, file) if "observation_names" in metadata else []
    return {"policy": policy, "observation": observation}


def _json(metadata: Mapping[str, str], key: str, file: str) -> Any:
    try:
        return json.loads(metadata[key])
    except json.JSONDecodeError as error:
        raise InputError(f"metadata '{key}' is not valid JSON: {error}", file) from None


def _holosoma(metadata: Mapping[str, str], file: str) -> dict[str, Any]:
    policy: dict[str, Any] = {"joints": _json(metadata, "dof_names", file), "history_start": "zeros"}
    for key in ("kp", "kd", "action_scale"):
        if key in metadata:
            policy[key] = _json(metadata, key, file)
    ranges = _json(metadata, "command_ranges", file) if "command_ranges" in metadata else None
    if isinstance(ranges, dict):  # null: the policy takes no command
        policy["command_ranges"] = {_AXES[key]: value for key, value in ranges.items() if key in _AXES}
    return {"policy": policy, "observation": []}


def settings_of(metadata: Mapping[str, str], file: str) -> dict[str, Any]:
    """{"policy": {...}, "observation": [...]} from the metadata of the file, empty without known metadata. Raises
    InputError."""
    if "joint_names" in metadata:
        return _mjlab(metadata, file)
    if "dof_names" in metadata:
        return _holosoma(metadata, file)
    return {"policy": {}, "observation": []}


def merge(base: Mapping[str, Any], over: Mapping[str, Any], file: str) -> dict[str, Any]:
    """Settings of the metadata, overridden by a TOML: keys of [policy] one by one, [[observation]] as a whole."""
    for key in over:
        if key not in ("policy", "observation"):
            raise InputError(f"a policy's TOML cannot contain [{key}]", file, hint="use [policy] and [[observation]]")
    policy, observation = over.get("policy", {}), over.get("observation", base.get("observation", []))
    if not isinstance(policy, Mapping):
        raise InputError("policy must be a table: [policy]", file)
    if not isinstance(observation, list):
        raise InputError("observation must be a list of tables: [[observation]]", file)
    return {"policy": {**base.get("policy", {}), **policy}, "observation": observation}
