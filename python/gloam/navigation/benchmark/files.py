"""Files of a results folder: replaced when they are complete, by one process at a time."""

from __future__ import annotations

import fcntl
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from gloam.errors import IoError, UsageError


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
        raise IoError(f"cannot write the file: {error.strerror}", str(path)) from error
    return path


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Holds the lock of a results folder. Errors: UsageError if another process has it; gloam.IoError."""
    try:
        lock = (folder / ".lock").open("w")
    except OSError as error:
        raise IoError(f"cannot write into the folder: {error.strerror}", str(folder)) from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(f"{folder} is in use by another process") from None
        yield
