"""Modules of users that register planners: `--plugin FILE`."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import gloam

_loaded: dict[Path, ModuleType] = {}


def load_plugin(name: str) -> Path:
    """Imports a file (a name with a slash or the suffix .py), or else an importable module, once per process.

    A file may import its neighbours. Returns the file; of a package, its folder. Errors: gloam.UsageError if it does not
    exist or raises an exception.
    """
    try:
        module = _load_file(Path(name).resolve()) if _is_file(name) else importlib.import_module(name)
    except Exception as error:  # by anybody's module
        cause = error if isinstance(error, gloam.Error) else f"{type(error).__name__}: {error}"
        raise gloam.UsageError(f"plugin {name} cannot be imported: {cause}") from error
    if module.__file__ is None:
        raise gloam.UsageError(f"plugin {name} is a folder without __init__.py")
    file = Path(module.__file__)
    return file.parent if file.name == "__init__.py" else file


def absolute_name(name: str) -> str:
    """The same plugin for processes with another working directory."""
    return str(Path(name).resolve()) if _is_file(name) else name


def _is_file(name: str) -> bool:
    return name.endswith(".py") or "/" in name


def _load_file(path: Path) -> ModuleType:
    if path in _loaded:
        return _loaded[path]
    if not path.is_file():
        raise gloam.UsageError("there is no such file")
    name = f"gloam_plugin_{len(_loaded)}_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise gloam.UsageError("a plugin is a Python file or a module")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    _loaded[path] = module
    return module
