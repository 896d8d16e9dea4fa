"""The program `gloam` of an installed package, as the console script and as `python -m gloam`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from gloam import _core


def program() -> Path:
    """The program: bin/gloam of the package, in a source tree that of the build folder.

    Raises FileNotFoundError if neither exists.
    """
    module = Path(_core.__file__).resolve()
    candidates = [module.parent / "bin" / "gloam", module.parents[2] / "bin" / "gloam"]
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise FileNotFoundError(
        f"cannot find the gloam program: {' or '.join(map(str, candidates))}; build it with ./gloam setup"
    )


def main() -> None:
    """Replaces this process by the program, with the same arguments."""
    try:
        path = str(program())
    except FileNotFoundError as error:
        sys.exit(f"gloam: error: {error}")
    os.execv(path, [path, *sys.argv[1:]])
