"""Packages that only reports and their videos need."""

from __future__ import annotations

import importlib
from types import ModuleType

from gloam.errors import UnsupportedError

_PACKAGES = {"matplotlib": "matplotlib", "jinja2": "Jinja2", "pyarrow": "pyarrow", "PIL": "pillow"}


def require(module: str) -> ModuleType:
    """Imports "matplotlib.figure", "jinja2", "pyarrow.parquet" or "PIL.Image". Errors: gloam.UnsupportedError with the
    command that installs the package."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = _PACKAGES[module.split(".")[0]]
        raise UnsupportedError(
            f"the report needs the package {package}",
            hint=f"pip install {package}, or 'gloam[navigation]'",
        ) from error
