"""Models of the built-in tasks."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import gloam


@cache
def asset_folder() -> Path:
    """Folder of robots/ and environments/: beside the package in a wheel, at the root of a source tree.

    Errors: IoError if it is in neither place.
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "assets", package.parents[1] / "assets"):
        if (folder / "robots").is_dir():
            return folder
    raise gloam.IoError(f"the models of the built-in tasks are missing: there is no folder {package / 'assets'}")
