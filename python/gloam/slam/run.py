"""One run of a method on a sequence: its process, its log, and the measures of its output."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import gloam

from .estimate import NO_POSES, Estimate, Trajectory, frames_of_failure, read_estimate, read_tum
from .measures import Measures, measure
from .methods import Method
from .sequence import TRUTH, TRUTH_LIDAR

LOG = "log.txt"
_LONGEST_MESSAGE = 400  # characters
_PATIENCE = 3.0  # of a process that is asked to end, before it is killed [s]


@dataclass(frozen=True)
class Outcome:
    """state: ok, crashed, timed_out or malformed; message: of a failure; wall: [s]; measures: with the poses of a failed run left
    out, as a user has none."""

    state: str
    message: str
    wall: float
    measures: Measures

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def run_method(method: Method, case: Path, out: Path, values: dict[str, str], limit: float) -> Outcome:
    """Runs a method on the sequence of CASE (sequence.make_sequence), with its files and log.txt in `out`, a new or empty folder.

    values: for its command, beside sequence, out and truth; limit: after which it is stopped [s]. Errors: UsageError if it
    cannot start; OSError. A method that fails is an outcome.
    """
    out.mkdir(parents=True, exist_ok=True)
    truth = case / (TRUTH_LIDAR if method.has_lidar else TRUTH)
    words = method.words({**values, "sequence": str(case / "sequence"), "out": str(out), "truth": str(truth)})
    begin = time.monotonic()
    with (out / LOG).open("wb") as log:
        process = subprocess.Popen(words, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, cwd=out, start_new_session=True)
        try:
            code: int | None = process.wait(limit)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            _end(process)
    wall = time.monotonic() - begin
    poses = read_tum(truth)
    if code is None:
        return _failed("timed_out", f"it ran longer than {limit:.0f} s", wall, out, poses)
    if code != 0:
        return _failed("crashed", _described(code, out / LOG), wall, out, poses)
    try:
        return Outcome("ok", "", wall, measure(read_estimate(out), poses, method.is_metric))
    except gloam.InputError as error:
        return _failed("malformed", str(error)[:_LONGEST_MESSAGE], wall, out, poses)


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a process and its children, which may outlive it."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)


def _failed(state: str, message: str, wall: float, out: Path, truth: Trajectory) -> Outcome:
    return Outcome(state, message, wall, measure(Estimate(NO_POSES, frames_of_failure(out)), truth, True))


def _described(code: int, log: Path) -> str:
    """The last line of the log, and how the process ended."""
    how = f"ended by {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
    lines = [line.strip() for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    last = "".join(c if c.isprintable() else " " for c in lines[-1]) if lines else "no output"
    return f"{how}: {last}"[:_LONGEST_MESSAGE]
