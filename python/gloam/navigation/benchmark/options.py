"""Options of the planners of a benchmark (`--set PLANNER.OPTION=VALUE`), and files that its results depend on."""

from __future__ import annotations

import hashlib
import math
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import gloam

from ..planner import Planner, make_planner
from ..planners.goal_image import own_weights
from ..plugins import absolute_name, load_plugin

_WEIGHTS = "weights"  # the option of all networks, which always names a file or folder


@dataclass(frozen=True)
class File:
    """A file or folder by its content: copies in other places are equal. name: its path, or a module."""

    name: str = field(compare=False)
    sha256: str = ""


@dataclass(frozen=True)
class Option:
    """An option of a planner of the request. value: text, number, boolean or tuple of these, or a File."""

    planner: str
    name: str
    value: Any

    def __str__(self) -> str:
        return f"{self.planner}.{self.name}"


def parse_options(texts: Iterable[str]) -> tuple[Option, ...]:
    """Options from "gnm.weights=gnm.onnx". A value is TOML (5, true, [1, 2], "text"), or else text as it is; `weights`, and
    texts with a slash that exist, are files. Errors: gloam.UsageError."""
    options: dict[str, Option] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        planner, _, name = key.strip().rpartition(".")
        if not (equals and planner and name.isidentifier()):
            raise gloam.UsageError(f"an option of a planner is PLANNER.OPTION=VALUE, got '{text}'", hint="--set gnm.weights=gnm.onnx")
        option = Option(planner, name, _value(name, value.strip()))
        if str(option) in options:
            raise gloam.UsageError(f"option {option} is given twice")
        options[str(option)] = option
    return tuple(options.values())


def _value(name: str, text: str) -> Any:
    if name == _WEIGHTS or ("/" in text and Path(text).exists()):
        return file_of(Path(text))
    try:
        return _frozen(tomllib.loads(f"value = {text}")["value"])
    except (tomllib.TOMLDecodeError, TypeError):
        return text


def _frozen(value: Any) -> Any:
    """Values that can be keys and JSON. Errors: TypeError for a table, a date, infinity or NaN."""
    if isinstance(value, list):
        return tuple(_frozen(part) for part in value)
    if isinstance(value, str | int) or (isinstance(value, float) and math.isfinite(value)):
        return value
    raise TypeError(type(value).__name__)


def read_options(values: Any) -> tuple[Option, ...]:
    """Options from request.json. Errors: KeyError, TypeError for anything else."""
    return tuple(Option(str(v["planner"]), str(v["name"]), _read(v["value"])) for v in values)


def read_files(values: Any) -> tuple[File, ...]:
    """Files from request.json. Errors: KeyError, TypeError for anything else."""
    return tuple(File(str(v["name"]), str(v["sha256"])) for v in values)


def _read(value: Any) -> Any:
    return read_files([value])[0] if isinstance(value, dict) else _frozen(value)


def file_of(path: Path, name: str = "") -> File:
    """The file or folder with the hash of its content. Errors: gloam.UsageError if it cannot be read."""
    try:
        digest = _sha256_of_folder(path) if path.is_dir() else _sha256(path)
    except OSError as error:
        raise gloam.UsageError(f"cannot read {path}: {error.strerror}") from None
    return File(name or str(path.resolve()), digest)


def _sha256_of_folder(folder: Path) -> str:
    digest = hashlib.sha256()
    for part in sorted(p for p in folder.rglob("*") if p.is_file() and "__pycache__" not in p.parts):
        digest.update(f"{part.relative_to(folder).as_posix()}\0{_sha256(part)}\0".encode())
    return digest.hexdigest()


def _sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def plugin_files(names: Iterable[str]) -> tuple[File, ...]:
    """Loads plugins (gloam.navigation.plugins), so that their planners have names. Errors: gloam.UsageError."""
    return tuple(file_of(load_plugin(name), absolute_name(name)) for name in names)


def type_of(planner: str, options: Iterable[Option]) -> str:
    """Its registered type: option `type`, by which a request compares several planners of one type; default: its name."""
    return next((str(o.value) for o in options if o.planner == planner and o.name == "type"), planner)


def completed(planners: Sequence[str], options: tuple[Option, ...]) -> tuple[Option, ...]:
    """The options with the weights of Gloam's own policy, so that a folder knows their content."""
    has_weights = {o.planner for o in options if o.name == _WEIGHTS}
    own = [p for p in planners if type_of(p, options) == "gloam" and p not in has_weights]
    if own and not own_weights().is_file():
        raise gloam.UsageError(
            f"planner '{own[0]}' has no network yet: {own_weights()} does not exist", hint=f"--set {own[0]}.weights=FILE"
        )
    return options + tuple(Option(planner, _WEIGHTS, file_of(own_weights())) for planner in own)


def arguments(planner: str, options: Iterable[Option]) -> tuple[tuple[str, Any], ...]:
    """Names and values for create(), which can be pickled and be keys."""
    chosen = [option for option in options if option.planner == planner]
    return tuple((o.name, o.value.name if isinstance(o.value, File) else o.value) for o in chosen)


def create(planner: str, options: Iterable[tuple[str, Any]]) -> Planner:
    """The planner. Errors: as its constructor."""
    given = dict(options)
    return make_planner(given.pop("type", planner), **given)


def check_planners(planners: Sequence[str], options: tuple[Option, ...]) -> dict[str, Planner]:
    """Creates each planner once, so that wrong options and weights stop a benchmark before its first episode. Returns them,
    closed. Errors: gloam.UsageError with the planner's name."""
    for option in options:
        if option.planner not in planners:
            raise gloam.UsageError(f"option {option} is for a planner that the benchmark does not have")
    return {planner: _checked(planner, options) for planner in planners}


def _checked(name: str, options: tuple[Option, ...]) -> Planner:
    try:
        planner = create(name, arguments(name, options))
        planner.close()
    except Exception as error:  # by anybody's planner
        cause = error if isinstance(error, gloam.Error) else f"{type(error).__name__}: {error}"
        raise gloam.UsageError(f"planner '{name}' cannot be created: {cause}") from error
    return planner
