"""Progress of long jobs, told in a terminal or notebook once they take over 2 s."""
from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

ProgressLike = Callable[[str, float, float, float], bool | None] | bool | None
_SILENCE = 2.0  # [s]


@contextmanager
def watch(progress: ProgressLike, what: str) -> Iterator[Any]:
    """The function that a job tells of itself: (task, share done 0 … 1, seconds so far, seconds left, < 0 = unknown) -> False to stop.

    `progress`: None = a line where people look, True = always, False = none, or such a function.
    """
    if callable(progress):
        yield progress
        return
    if progress is False or (progress is None and not sys.stderr.isatty()):
        yield None
        return
    shown = False
    last = 0.0

    def tell(task: str, done: float, seconds: float, left: float) -> bool:
        nonlocal shown, last
        now = time.monotonic()
        if seconds > _SILENCE and now - last > 0.2:
            rest = f", {left:.0f} s left" if left > 0 else ""
            print(f"\r\033[K{what}: {task} {100 * done:.0f} %{rest}", end="", file=sys.stderr, flush=True)
            shown, last = True, now
        return True

    try:
        yield tell
    finally:
        if shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
