"""Processes that do tasks one at a time: the death of one is the failure of one task, and none outlives the caller."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Generator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

import gloam
from gloam._distribute.jobs import Failure

T = TypeVar("T")
R = TypeVar("R")
_PATIENCE = 3.0  # of a process that is asked to end, before it is killed [s]


@dataclass(frozen=True)
class Died:
    """The process of a task ended without a result: killed, out of memory, or a crash."""


def local_results(do: Callable[[T], R], tasks: deque[T], workers: int) -> Generator[tuple[T, R | Died], None, None]:
    """Results of do(task) as they come, from `workers` new processes. do: a function that can be pickled.

    The caller may append tasks while it iterates. Closing the iterator ends the processes within seconds; so does the end of
    the calling process, even by SIGKILL. Errors: gloam.Error with the text of an exception of do().
    """
    idle: list[_Worker[T, R]] = []
    busy: dict[Connection, tuple[_Worker[T, R], T]] = {}
    try:
        while tasks or busy:
            while tasks and len(busy) < workers:
                worker = idle.pop() if idle else _Worker(do, max(1, (os.cpu_count() or 1) // workers))
                task = tasks.popleft()
                worker.send(task)
                busy[worker.connection] = worker, task
            ready = wait(list(busy))
            for connection in [c for c in busy if c in ready]:
                worker, task = busy.pop(connection)
                result = worker.result()
                if not isinstance(result, Died):
                    idle.append(worker)
                if isinstance(result, Failure):
                    raise gloam.Error(result.error)
                yield task, result
    finally:
        _end([*idle, *(worker for worker, _ in busy.values())])


class _Worker(Generic[T, R]):
    def __init__(self, do: Callable[[T], R], threads: int) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(do, theirs, threads))
        self.process.start()
        theirs.close()  # so that the end of the process closes the pipe

    def send(self, task: T) -> None:
        with contextlib.suppress(OSError):  # the process has died: result() finds out
            self.connection.send(task)

    def result(self) -> R | Failure | Died:
        try:
            result: R | Failure = self.connection.recv()
        except (EOFError, OSError):
            self.process.join()
            self.connection.close()
            return Died()
        return result


def _end(workers: list[_Worker[Any, Any]]) -> None:
    for worker in workers:
        worker.process.terminate()
    deadline = time.monotonic() + _PATIENCE
    for worker in workers:
        worker.process.join(max(0.0, deadline - time.monotonic()))
        worker.process.kill()
        worker.process.join()
        worker.connection.close()


def _serve(do: Callable[[Any], Any], connection: Connection, threads: int) -> None:
    """The life of a worker: until SIGTERM, or the end of its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the parent decides
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # an exception, so that planners close what they have started
    threading.Thread(target=_end_with_parent, daemon=True).start()
    gloam.set_thread_count(threads)
    with contextlib.suppress(EOFError, OSError):
        while True:
            connection.send(attempt(do, connection.recv()))


def attempt(do: Callable[[T], R], task: T) -> R | Failure:
    """do(task), or its exception in a form that can always be pickled."""
    try:
        return do(task)
    except Exception as error:  # its class need not exist in the parent
        return Failure(str(error) if isinstance(error, gloam.Error) else f"{type(error).__name__}: {error}")


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(_PATIENCE)
        os._exit(1)
