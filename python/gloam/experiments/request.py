"""What the requests of all experiments have: checks of names, and the file request.json in the folder of the results."""

from __future__ import annotations

import os
import platform
import re
import time
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import gloam
from gloam._distribute.manifest import write_json

REQUEST_FILE = "request.json"
STAMP = frozenset({"machine", "version", "started"})  # text for the page, which may differ between calls


def check_known(kind: str, asked: Sequence[str], known: Collection[str]) -> None:
    """Errors: gloam.NotFoundError for an unknown name."""
    for name in asked:
        if name not in known:
            raise gloam.NotFoundError(f"there is no {kind} '{name}'; there are: {', '.join(known)}")


def check_once(kind: str, asked: Sequence[str]) -> None:
    """Errors: gloam.UsageError for no name, or a name twice."""
    if not asked or len(set(asked)) != len(asked):
        raise gloam.UsageError(f"name each {kind} once, got {', '.join(asked) or 'none'}")


def is_folder_name(name: object) -> bool:
    """Whether results can have a folder of this name: letters, digits, and _ + - . after the first character."""
    return isinstance(name, str) and re.fullmatch(r"[\w+-][\w.+-]*", name) is not None


def keep_request(folder: Path, request: Mapping[str, Any], different: Sequence[str], started: str) -> None:
    """Writes request.json with the machine, Gloam's version and the day of the first call.

    different: parts in which the request differs from the kept one; started: the kept day, "" = today. Errors:
    gloam.UsageError if any part differs; gloam.IoError.
    """
    if different:
        raise gloam.UsageError(f"{folder} holds another benchmark ({', '.join(different)} differ)", hint="choose another folder")
    stamp = {"machine": machine_name(), "version": gloam.__version__, "started": started or time.strftime("%Y-%m-%d")}
    write_json(folder / REQUEST_FILE, {**request, **stamp})


def machine_name() -> str:
    """Model and number of its processors."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        name = next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} processors"
