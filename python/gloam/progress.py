"""Progress of long jobs, displayed in a terminal or notebook after 2 s."""

from __future__ import annotations

import html
import importlib
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TextIO

Tell = Callable[[str, float, float, float], bool | None]
"""Progress of a job: (task, share done 0 … 1, seconds so far, seconds left or < 0 = unknown) -> False to cancel."""

ProgressLike = Tell | bool | None
_SILENCE = 2.0  # [s] before anything is shown
_INTERVAL = 0.2  # [s] between two drawings
_WIDTH = 24  # [columns] of a bar in a terminal


def time_text(seconds: float) -> str:
    """A readable duration [s]: "8 s", "2 min 05 s", "1 h 03 min"."""
    whole = max(0, round(seconds))
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole // 60 % 60:02d} min"


class Bar:
    """A progress bar; subclasses draw it. Called as jobs report progress; silent for the first 2 s."""

    def __init__(self, what: str, silence: float = _SILENCE) -> None:
        """what: the job, for display; silence [s]: time without display at the start."""
        self.what = what
        self.shown = False
        self._silence = silence
        self._start = time.monotonic()
        self._last = -_INTERVAL

    def __call__(self, task: str, done: float, seconds: float = -1.0, left: float = -1.0) -> bool:
        """Draws if an update is due. seconds < 0: time since the bar was made; left < 0: estimate from the fraction
        done. Returns True."""
        now = time.monotonic()
        if seconds < 0:
            seconds = now - self._start
        if seconds < self._silence or now - self._last < _INTERVAL:
            return True
        share = min(max(done, 0.0), 1.0)
        if left < 0 and share > 0.02:
            left = seconds * (1 - share) / share
        self.draw(task, share, f"{time_text(left)} left" if left >= 0 else "")
        self.shown, self._last = True, now
        return True

    def draw(self, task: str, share: float, rest: str) -> None:
        raise NotImplementedError

    def close(self) -> None:
        """Removes the bar."""


class TerminalBar(Bar):
    """One line of a terminal that is drawn over itself."""

    def __init__(self, what: str, stream: TextIO | None = None, silence: float = _SILENCE) -> None:
        super().__init__(what, silence)
        self._stream = sys.stderr if stream is None else stream

    def draw(self, task: str, share: float, rest: str) -> None:
        bar = "#" * round(share * _WIDTH)
        text = f"{self.what}: [{bar:<{_WIDTH}}] {100 * share:3.0f} %"
        print("\r\033[K" + ", ".join(filter(None, [text, task, rest])), end="", file=self._stream, flush=True)

    def close(self) -> None:
        if self.shown:
            print("\r\033[K", end="", file=self._stream, flush=True)


class NotebookBar(Bar):
    """A bar below the running cell, updated in place."""

    def __init__(self, what: str, display: Callable[..., Any], silence: float = _SILENCE) -> None:
        """display: IPython.display.display."""
        super().__init__(what, silence)
        self._display = display
        self._handle: Any = None

    def draw(self, task: str, share: float, rest: str) -> None:
        text = ", ".join(filter(None, [f"{100 * share:.0f} %", task, rest]))
        self._put(f'<progress max="1" value="{share:.3f}"></progress> {html.escape(f"{self.what}: {text}")}')

    def close(self) -> None:
        if self._handle is not None:
            self._put("")

    def _put(self, markup: str) -> None:
        data = {"text/html": markup, "text/plain": ""}
        if self._handle is None:
            self._handle = self._display(data, raw=True, display_id=True)
        else:
            self._handle.update(data, raw=True)


def notebook_display() -> Callable[..., Any] | None:
    """IPython.display.display if this Python is a notebook's kernel, else None."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    display: Callable[..., Any] = importlib.import_module("IPython.display").display
    return display


def bar(what: str, always: bool = False) -> Bar | None:
    """The bar for a notebook or a terminal; None without either.

    always: write a line even if stderr is not a terminal.
    """
    display = notebook_display()
    if display is not None:
        return NotebookBar(what, display)
    return TerminalBar(what) if always or sys.stderr.isatty() else None


@contextmanager
def watch(progress: ProgressLike, what: str) -> Iterator[Tell | None]:
    """The function to which a job reports its progress, or None without reports.

    progress: None = a bar in notebooks and terminals, True = always, False = never, or a function of the user.
    """
    if callable(progress):
        yield progress
        return
    if progress not in (None, True, False):
        raise TypeError(f"progress must be None, True, False or a function, got {progress!r}")
    drawn = None if progress is False else bar(what, always=progress is True)
    try:
        yield drawn
    finally:
        if drawn is not None:
            drawn.close()
