"""Packages that only the report needs."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

from gloam.errors import UnsupportedError

REQUIREMENTS = Path(__file__).with_name("requirements.txt")
_PACKAGES = {"matplotlib": "matplotlib", "jinja2": "Jinja2", "pyarrow": "pyarrow"}


def require(module: str) -> ModuleType:
    """Imports "matplotlib.figure", "jinja2" or "pyarrow.parquet". Errors: gloam.UnsupportedError with the command that
    installs the package."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = _PACKAGES[module.split(".")[0]]
        pins = [line for line in REQUIREMENTS.read_text().split() if line.startswith(f"{package}==")]
        raise UnsupportedError(
            f"the report of the navigation benchmark needs the package {package}",
            hint=f"pip install {(pins or [package])[0]}",
        ) from error
