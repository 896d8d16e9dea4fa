"""Scenes from files, text, dicts or code."""
from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Self

from gloam import _core

from . import _toml
from .errors import Error, NotFoundError, UsageError
from .option_values import frozen
from .progress import ProgressLike, watch
from .world import World

PathLike = str | os.PathLike[str]


@dataclass(frozen=True)
class Option:
    """One option of a scene. `value` is None if it is not given; `low` and `high` are infinite without a limit."""

    path: str
    value: Any
    unit: str
    low: float
    high: float
    choices: tuple[str, ...]
    doc: str


@cache
def _schema() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(_core.scene_schema())
    return schema


def describe(path: str) -> str:
    """Description of an option, as in the documentation: describe("weather.visibility"),
    describe("robot.go.position"), where "go" may be any name. Raises NotFoundError, with the nearest name, if there
    is no such option.
    """
    node: Any = _schema()
    root = node
    may_be_a_name = False  # of an element of the list that came before
    for part in path.split("."):
        node = _resolve(node, root)
        inner = node.get("properties", {})
        if part not in inner:
            if may_be_a_name or isinstance(node.get("additionalProperties"), dict):
                may_be_a_name = False
                continue
            raise NotFoundError(f"there is no option '{path}': unknown part '{part}'", hint=_core.suggest_name(part, list(inner)))
        node = inner[part]
        may_be_a_name = False
        resolved = _resolve(node, root)
        if resolved.get("type") == "array" and "items" in resolved:
            items = _resolve(resolved["items"], root)
            if "properties" in items:
                node = items
                may_be_a_name = True
    return str(node.get("description", ""))


def _description(path: str) -> str:
    try:
        return describe(path)
    except NotFoundError:
        return ""


def _resolve(node: Any, root: Any) -> Any:
    while isinstance(node, dict) and "$ref" in node:
        target: Any = root
        for key in node["$ref"].removeprefix("#/").split("/"):
            target = target[key]
        node = {**target, **{k: v for k, v in node.items() if k != "$ref"}}
    choices = node.get("oneOf") or node.get("anyOf") or [] if isinstance(node, dict) else []
    for choice in choices:
        if "properties" in choice or "items" in choice:
            return {**choice, "description": node.get("description", "")}
    return node


class Scene:
    """A scene as written, editable until it is compiled. Options are accessed by their paths, as in `gloam run
    --set`:

        scene = gloam.Scene("house.toml")
        scene["weather.visibility"] = 8

    `path`: a scene (.toml) or a bare model (.xml, .urdf). `root`: files outside this folder are not read; `strict`:
    use the model's own folder as root. Raises InputError with file and line.
    """

    def __init__(self, path: PathLike, root: PathLike = "", strict: bool = False) -> None:
        self._scene = _core.Scene.load(Path(path), os.fspath(root), strict)

    @classmethod
    def _of(cls, scene: _core.Scene) -> Self:
        made = cls.__new__(cls)
        made._scene = scene
        return made

    @classmethod
    def parse(cls, text: str, folder: PathLike = ".", root: PathLike = "", strict: bool = False) -> Self:
        """A scene from the text of a scene file, as if that file were in `folder`."""
        return cls._of(_core.Scene.parse(text, Path(folder), os.fspath(root), strict))

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], folder: PathLike = ".", root: PathLike = "", strict: bool = False) -> Self:
        """A scene from nested dicts; lists of dicts correspond to [[…]] in a file: {"robot": [{"name": "go", "file":
        …}]}.

        Paths are relative to `folder`; files have to be below `root` (docs/security.md). root="/" allows every file
        that the scene names.
        """
        return cls.parse(_toml.table_text(tables), folder, root, strict)

    @property
    def name(self) -> str:
        return str(self._scene.name)

    @property
    def file(self) -> Path:
        """File from which it was read; empty for scenes made in code."""
        return Path(self._scene.file)

    @property
    def duration(self) -> float:
        """sim.duration [s]."""
        return float(self._scene.duration)

    def copy(self) -> Self:
        return self._of(self._scene.copy())

    __copy__ = copy

    def __deepcopy__(self, _: dict[int, Any]) -> Self:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles only the options: files that they name are read again when the scene is compiled."""
        root, strict = self._scene.access
        return _unpickled, (type(self), self.to_toml(), os.fspath(self._scene.bare_model), os.fspath(self.file), os.getcwd(), root, strict, self.name)

    def __getitem__(self, path: str) -> Any:
        """Value of an option, a copy; None if it is not given."""
        try:
            return frozen(_toml.from_text(self._scene.get(path)))
        except NotFoundError:
            raise
        except Error as error:
            if any(option["path"] == path for option in self._scene.options()):
                return None  # it is not given
            raise NotFoundError(error.message, error.file, error.line, error.column, error.hint) from None

    def __setitem__(self, path: str, value: Any) -> None:
        self._scene.set(path, _toml.to_text(value, path))

    def update(self, settings: Mapping[str, Any]) -> None:
        """Sets all of these options, or none."""
        changed = self._scene.copy()
        for path, value in settings.items():
            changed.set(path, _toml.to_text(value, path))
        self._scene = changed

    def options(self) -> list[Option]:
        """All options of the tables that the scene contains."""
        return [Option(o["path"], frozen(_toml.from_text(o["value"])), o["unit"], o["low"], o["high"], tuple(o["choices"]), _description(o["path"]))
                for o in self._scene.options()]

    def __iter__(self) -> Iterator[str]:
        return (option["path"] for option in self._scene.options())

    def __contains__(self, path: object) -> bool:
        try:
            self._scene.get(str(path))
        except Error:
            return False
        return True

    def add(self, table: str, **options: Any) -> str:
        """Adds a [[table]], or sets the single [table]: scene.add("camera", name="front", position=(2, 0, 1)).
        Returns its path, "camera.front"."""
        name = options.get("name")
        if name is not None and f"{table}.{name}.name" in self:
            raise UsageError(f"a {table} '{name}' already exists", hint=f'set its options with scene["{table}.{name}.…"]')
        value: Any = [options] if _is_list(table) else options
        self._scene = self._scene.overlay_text(_toml.table_text({table: value}), f"add('{table}')")
        return f"{table}.{name}" if name is not None else table

    def overlay(self, change: PathLike | Mapping[str, Any]) -> Self:
        """Returns the scene changed by a second scene file, or by tables as for from_dict: lists change elements of
        the same name and add others."""
        if isinstance(change, Mapping):
            return self._of(self._scene.overlay_text(_toml.table_text(change), "overlay"))
        text = os.fspath(change)
        if "\n" in text:
            return self._of(self._scene.overlay_text(text, "overlay"))
        return self._of(self._scene.overlay_file(Path(text)))

    def to_toml(self) -> str:
        """The options that differ from their defaults, as a scene file."""
        return str(self._scene.to_toml())

    def compile(self, progress: ProgressLike = None, keyframe: str = "") -> World:
        """Compiles the scene. `keyframe`: name or number of the initial keyframe of a bare model. Raises InputError
        with file and line."""
        with watch(progress, f"compiling {self.name}") as told:
            return World(_core.World.compile(self._scene, told, keyframe))

    def _repr_html_(self) -> str:
        from .notebook import scene_html

        return scene_html(f"Scene '{self.name}'", self.to_toml())

    def __repr__(self) -> str:
        return f"<gloam.Scene '{self.name}'>"


def _is_list(table: str) -> bool:
    node: Any = _schema()
    root = node
    for part in table.split("."):
        node = _resolve(node, root).get("properties", {}).get(part)
        if node is None:
            raise NotFoundError(f"a scene has no table '{table}'", hint=_core.suggest_name(table, list(root.get("properties", {}))))
    return _resolve(node, root).get("type") == "array" or "items" in _resolve(node, root)


def _unpickled(cls: type[Scene], text: str, model: str, file: str, folder: str, root: str, strict: bool, name: str) -> Scene:
    if model not in ("", "."):
        return cls(Path(folder, model), root, strict)
    path = Path(folder, file) if file not in ("", ".") else None
    scene = cls.parse(text, path.parent if path else folder, root, strict)
    scene._scene.set_origin(name, path or Path())
    return scene


def as_scene(source: Any) -> Scene:
    """A Scene of a path, a Scene, a dict of tables or the text of a scene file."""
    if isinstance(source, Scene):
        return source
    if isinstance(source, Mapping):
        return Scene.from_dict(source)
    if source is None:
        raise TypeError("expected a path, a Scene, a World or a dict, got None")
    if isinstance(source, str) and "\n" in source:
        return Scene.parse(source)
    return Scene(source)
