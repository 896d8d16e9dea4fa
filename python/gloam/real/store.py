"""Results of single images on disk, by the content of the image, so that a comparison continues after any interruption."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.experiments.files import replace_file

Arrays = dict[str, NDArray[Any]]


class Store:
    """Arrays by kind and key in files ROOT/KIND/KE/KEY.npz, which get their names when they are complete."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def file(self, kind: str, key: str) -> Path:
        """The file of a record."""
        return self._root / kind / key[:2] / f"{key}.npz"

    def load(self, kind: str, key: str) -> Arrays | None:
        """The record, or None if it is missing or damaged."""
        try:
            with np.load(self.file(kind, key), allow_pickle=False) as file:
                return {name: file[name] for name in file.files}
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None

    def save(self, kind: str, key: str, arrays: Mapping[str, Any]) -> Arrays:
        """The arrays, after they are stored. Errors: gloam.IoError, such as a full disk."""
        path = self.file(kind, key)
        made = {name: np.asarray(value) for name, value in arrays.items()}
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise gloam.IoError(f"cannot create the folder: {error.strerror}", str(path.parent)) from error

        def write(part: Path) -> None:
            with part.open("wb") as file:  # a name would get a suffix
                np.savez(file, allow_pickle=False, **made)

        replace_file(path, write)
        return made
