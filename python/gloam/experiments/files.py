"""Files and folders of results: they get their names when they are complete, and one process at a time writes them."""

from __future__ import annotations

import os
import shutil
import tempfile
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from gloam._distribute.manifest import lock, publish
from gloam.errors import IoError

_PART = "."  # begins the names of folders that are being written


def replace_file(path: Path, write: Callable[[Path], Any]) -> Path:
    """Lets `write` write a new file, which then gets the name `path`. Errors: gloam.IoError."""
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        os.close(handle)
        try:
            write(Path(name))
            os.chmod(name, 0o644)  # mkstemp lets only the owner read
            os.replace(name, path)
        finally:
            Path(name).unlink(missing_ok=True)
    except OSError as error:
        raise IoError(f"cannot write the file: {error.strerror or error}", str(path)) from error
    return path


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Makes a results folder if it is missing, and holds its lock. Errors: UsageError if another process has it; gloam.IoError."""
    with lock(folder):
        yield


@contextmanager
def whole(folder: Path) -> Iterator[Path]:
    """A new folder that gets the name `folder` when the block ends well. If another process was faster, its folder counts.
    remove_parts() removes the rest of a process that was killed. Errors: OSError."""
    part = folder.with_name(f"{_PART}{folder.name}.{uuid.uuid4().hex[:12]}")
    part.mkdir(parents=True)
    try:
        yield part
        publish(part, folder)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def remove_parts(root: Path, *places: str) -> None:
    """Removes folders that processes were writing when they were killed. places: patterns of their parents in `root`. The
    caller holds the lock of the results."""
    for place in places:
        for part in root.glob(f"{place}/{_PART}*"):
            shutil.rmtree(part, ignore_errors=True)
