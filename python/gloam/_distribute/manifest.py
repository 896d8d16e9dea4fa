"""The list of a folder of tasks: the request and the finished tasks.

A finished task is a folder OUT/0007 with task.json, which was moved there by one atomic rename; this is the
authoritative state. OUT/manifest.json has the same information for readers and is rewritten at every change. A call
holds OUT/.lock while it works on a folder.
"""

from __future__ import annotations

import errno
import fcntl
import hashlib
import json
import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TextIO

from ..errors import InputError, IoError, UsageError

TASK_FILE = "task.json"
PART = ".part-"  # begins the names of folders that are being written


def write_json(path: Path, value: Any) -> None:
    """Writes a file atomically, even if the process is killed."""
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with part.open("w", encoding="utf-8") as stream:
            json.dump(value, stream, indent=1, allow_nan=False)
            stream.write("\n")
            stream.flush()
            os.fsync(stream.fileno())
        part.replace(path)
    except OSError as error:
        raise IoError(f"cannot be written: {error.strerror}", str(path)) from None


def read_task(folder: Path) -> dict[str, Any] | None:
    """Result of a finished task; None if it is not finished."""
    try:
        made: dict[str, Any] = json.loads((folder / TASK_FILE).read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        raise InputError(
            f"is damaged: {error}", str(folder / TASK_FILE), hint="remove its folder; the task is then run again"
        ) from None
    return made


def publish(part: Path, target: Path) -> bool:
    """Moves a finished folder to its place. False: another worker was faster; `part` is then not moved."""
    try:
        os.rename(part, target)
    except OSError as error:
        if error.errno in (errno.ENOTEMPTY, errno.EEXIST):
            return False
        raise
    return True


def lock(folder: Path) -> TextIO:
    """Makes a results folder if it is missing, and takes its lock, until the returned file is closed. Errors: UsageError if
    another process has it; IoError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / ".lock").open("w", encoding="utf-8")
    except OSError as error:
        raise IoError(f"cannot write into the folder: {error.strerror}", str(folder)) from None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        raise UsageError(f"{folder} is in use by another process") from None
    return file


class Manifest:
    """Tasks of one folder, by their seeds. Raises UsageError: the folder contains tasks of another request, or
    another call is working on it."""

    def __init__(self, out: Path, kind: str, request: Mapping[str, Any], seeds: Sequence[int], overwrite: bool) -> None:
        self.out = out
        self.kind = kind
        self.seeds = tuple(seeds)
        self.errors: dict[int, str] = {}
        self._request = dict(request)
        self._print = hashlib.sha256(json.dumps([kind, self._request], sort_keys=True).encode()).hexdigest()
        self._lock = lock(out)
        try:
            self._open(overwrite)
        except BaseException:
            self.close()
            raise

    def _open(self, overwrite: bool) -> None:
        known = self._read()
        if overwrite and known is not None:
            for task in known.get("tasks", []):
                shutil.rmtree(self.out / Path(str(task["folder"])).name, ignore_errors=True)
        elif known is not None and known.get("print") != self._print:
            raise UsageError(f"{self.out} contains tasks of another request", hint="choose another out, or pass overwrite=True")
        self.remove_parts()
        for index, seed in enumerate(self.seeds):
            task = read_task(self.folder(index))
            if task is not None and task.get("seed") != seed:
                raise UsageError(
                    f"{self.folder(index)} was created with seed {task.get('seed')}, not {seed}",
                    hint="choose another out, or pass overwrite=True",
                )
            if task is None and self.folder(index).exists():
                raise UsageError(f"{self.folder(index)} already exists and was not created by a task", hint="choose another out")
        self.write()

    def _read(self) -> dict[str, Any] | None:
        path = self.out / "manifest.json"
        try:
            made = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            raise InputError(f"is damaged: {error}", str(path), hint="choose another out") from None
        if not isinstance(made, dict) or not isinstance(made.get("tasks"), list):
            raise InputError("is not a list of tasks", str(path), hint="choose another out")
        return made

    def remove_parts(self) -> None:
        """Removes unfinished files of workers that died. Must not be called while tasks run in the folder."""
        for part in self.out.glob(f"{PART}*"):
            shutil.rmtree(part, ignore_errors=True)

    def folder(self, index: int) -> Path:
        return self.out / f"{index:04}"

    def missing(self) -> list[int]:
        """Places of the tasks that are not finished, in order."""
        return [index for index in range(len(self.seeds)) if read_task(self.folder(index)) is None]

    def write(self) -> None:
        """Writes OUT/manifest.json: request, and of each task seed, folder, state and error."""
        missing = set(self.missing())
        tasks = []
        for index, seed in enumerate(self.seeds):
            state = "done" if index not in missing else "failed" if index in self.errors else "waiting"
            task = {"seed": seed, "folder": self.folder(index).name, "state": state}
            tasks.append({**task, "error": self.errors[index]} if state == "failed" else task)
        write_json(
            self.out / "manifest.json",
            {"kind": self.kind, "print": self._print, "request": self._request, "tasks": tasks},
        )

    def close(self) -> None:
        self._lock.close()  # which unlocks
