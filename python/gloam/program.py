"""The program `gloam` of an installed package, as the console script and as `python -m gloam`."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def program() -> Path:
    """The program: bin/gloam of the package, in a source tree that of the build folder.

    Raises FileNotFoundError where neither is there.
    """
    candidates = [Path(__file__).resolve().parent / "bin" / "gloam"]
    if built := os.environ.get("GLOAM_BUILT"):
        candidates.append(Path(built).parents[1] / "bin" / "gloam")
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise FileNotFoundError(f"the program gloam is not there: {' or '.join(map(str, candidates))}")


def main() -> None:
    """Becomes the program, with this process's arguments."""
    path = str(program())
    os.execv(path, [path, *sys.argv[1:]])
