"""Values of scene files: Python's as TOML text and back."""
from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

from .errors import UsageError


def to_text(value: Any, where: str = "value") -> str:
    """A value as written after "=" in a scene file. Raises TypeError: None, or a type that TOML does not have."""
    if value is None:
        raise TypeError(f"{where}: None is not a value; omit the option instead")
    if isinstance(value, bool):
        return "true" if value else "false"
    if hasattr(value, "tolist") and not isinstance(value, (str, bytes)):  # NumPy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        return ("inf" if value > 0 else "-inf") if math.isinf(value) else repr(value)
    if isinstance(value, PathLike):
        value = value.__fspath__()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key_text(k)} = {to_text(v, f'{where}.{k}')}" for k, v in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(to_text(v, f"{where}[{i}]") for i, v in enumerate(value)) + "]"
    raise TypeError(f"{where}: a {type(value).__name__} cannot be used in a scene")


def key_text(key: Any) -> str:
    """A key, quoted if TOML requires it."""
    if not isinstance(key, str):
        raise TypeError(f"a key must be a string, got {key!r}")
    bare = key and all(c.isascii() and (c.isalnum() or c in "-_") for c in key)
    return key if bare else json.dumps(key)


def from_text(text: str) -> Any:
    """The value of TOML text; None for "", an option that is not given."""
    if not text:
        return None
    try:
        return tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError as error:
        raise UsageError(f"'{text}' is not a TOML value: {error}") from None


def table_text(tables: Mapping[str, Any]) -> str:
    """A whole document of nested dicts, lists of dicts being arrays of tables."""
    lines: list[str] = []
    _write_table(tables, (), lines)
    return "\n".join(lines) + "\n"


def _is_tables(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes)) and len(value) > 0 and all(
        isinstance(v, Mapping) for v in value)


def _write_table(table: Mapping[str, Any], path: tuple[str, ...], lines: list[str]) -> None:
    later: list[tuple[str, Any]] = []
    for key, value in table.items():
        if isinstance(value, Mapping) or _is_tables(value):
            later.append((key, value))
        else:
            lines.append(f"{key_text(key)} = {to_text(value, '.'.join((*path, str(key))))}")
    for key, value in later:
        inner = (*path, key_text(key))
        name = ".".join(inner)
        if isinstance(value, Mapping):
            lines.append(f"[{name}]")
            _write_table(value, inner, lines)
            continue
        for one in value:
            lines.append(f"[[{name}]]")
            _write_table(one, inner, lines)
