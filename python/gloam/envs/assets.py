"""Models of the built-in tasks."""

from __future__ import annotations

from pathlib import Path

import gloam


def asset_folder() -> Path:
    """Folder of robots/ and environments/, in a source tree or an installation. Errors: IoError if it is missing."""
    return Path(gloam.home()) / "assets"
