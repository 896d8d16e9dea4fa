"""Ray as gloam.distribute uses it: a cluster that is there, or one on this machine for the time of a call."""

from __future__ import annotations

import importlib
import os
import time
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from ..errors import PartialError, UsageError
from .jobs import Failure, Job, work
from .manifest import Manifest

T = TypeVar("T")
Tell = Callable[[str, float, float, float], Any] | None  # task, share done, seconds, seconds left; False stops
_LOOK = 0.2  # [s] between looks at signals and progress
_ONE_MACHINE = "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"  # 0: all its processes listen on loopback
_STORE = 100 << 20  # [bytes] of shared memory: results travel by files


def _ray() -> Any:
    try:
        return importlib.import_module("ray")
    except ImportError as error:
        raise ImportError(
            "gloam.distribute runs tasks through the package 'ray', which is not installed: pip install ray"
        ) from error


@contextmanager
def _loopback_only() -> Iterator[None]:
    """Makes Ray's processes that are started in the block listen on loopback, which Ray does when it assumes that
    there are no other machines."""
    constants: Any = importlib.import_module("ray._private.ray_constants")
    before = os.environ.get(_ONE_MACHINE), getattr(constants, "ENABLE_RAY_CLUSTER", None)
    os.environ[_ONE_MACHINE] = "0"  # for the processes that it starts
    constants.ENABLE_RAY_CLUSTER = False  # for this one, which has read the variable when it imported ray
    try:
        yield
    finally:
        constants.ENABLE_RAY_CLUSTER = before[1]
        if before[0] is None:
            del os.environ[_ONE_MACHINE]
        else:
            os.environ[_ONE_MACHINE] = before[0]


@contextmanager
def cluster(address: str | None, workers: int | None) -> Iterator[Any]:
    """Connects Ray: keeps an existing connection, else connects to `address`, else starts a new cluster with
    `workers` CPUs that ends with the block.

    The new one listens on loopback only, has no dashboard and reports nothing.
    """
    ray = _ray()
    if ray.is_initialized():
        yield ray
        return
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    if address is not None:
        ray.init(address=address, log_to_driver=False)
    else:
        with _loopback_only():
            ray.init(
                address="local",
                num_cpus=workers or os.cpu_count() or 1,
                num_gpus=0,
                include_dashboard=False,
                log_to_driver=False,
                configure_logging=False,
                object_store_memory=_STORE,
            )
        if any(not node["NodeManagerAddress"].startswith("127.") for node in ray.nodes()):
            warnings.warn("this version of ray listens on all network interfaces", stacklevel=4)
    try:
        yield ray
    finally:
        ray.shutdown()


def set_threads(count: int) -> None:
    """gloam.set_thread_count, for workers: it is imported there."""
    import gloam

    gloam.set_thread_count(count)


class _Progress:
    """Reports the progress of the tasks and the estimated remaining time, from the mean of the tasks done in this
    call."""

    def __init__(self, tell: Tell, total: int, done: int) -> None:
        self._tell, self._total, self._before = tell, total, done
        self.done = done
        self._start = time.monotonic()

    def tell(self) -> None:
        if self._tell is None:
            return
        seconds = time.monotonic() - self._start
        here = self.done - self._before
        left = seconds / here * (self._total - self.done) if here else -1.0
        if self._tell(f"{self.done} of {self._total} tasks", self.done / max(self._total, 1), seconds, left) is False:
            raise PartialError("stopped by the progress function", hint="repeat the same call to resume")


def run_tasks(ray: Any, manifest: Manifest, job: Job, cpus: int, retries: int, tell: Tell) -> None:
    """Runs all unfinished tasks of the list. Failures are collected in manifest.errors; the other tasks continue.

    The task of a worker that dies (killed, out of memory) is repeated up to `retries` times.
    """
    missing = manifest.missing()
    progress = _Progress(tell, len(manifest.seeds), len(manifest.seeds) - len(missing))
    remote = ray.remote(num_cpus=cpus, max_retries=retries)(work)
    sent = _send(ray, job)

    def submit(index: int) -> Any:
        return remote.remote(
            sent, str(manifest.out), manifest.folder(index).name, manifest.seeds[index], cpus, set_threads
        )

    try:
        for finished in as_they_finish(ray, submit, deque(missing), cpus):
            if finished is not None:
                index, reference = finished
                failure = _outcome(ray, reference)
                if failure is not None:
                    manifest.errors[index] = failure.error
                manifest.write()
                progress.done += 1
            progress.tell()
    finally:
        manifest.write()


def as_they_finish(
    ray: Any, submit: Callable[[T], Any], waiting: deque[T], cpus: int
) -> Generator[tuple[T, Any] | None, None, None]:
    """(task, reference to its result) of each task as it finishes, or None when nothing has finished for a while, so that
    callers can look after signals and progress.

    submit: sends a task that uses `cpus` processors; the caller may append tasks to `waiting` meanwhile. Few tasks are
    queued in the cluster at once; closing the iterator cancels them.
    """
    running: dict[Any, T] = {}
    try:
        while waiting or running:
            slots = max(1, int(ray.cluster_resources().get("CPU", 1)) // cpus) + 1
            while waiting and len(running) < slots:
                task = waiting.popleft()
                running[submit(task)] = task
            ready, _ = ray.wait(list(running), num_returns=1, timeout=_LOOK)
            for one in ready:
                yield running.pop(one), one
            if not ready:
                yield None
    finally:
        for one in running:
            ray.cancel(one, force=True)


def _send(ray: Any, job: Job) -> Any:
    try:
        ray.cloudpickle.dumps(job)
    except Exception as error:  # of any object's own making
        raise UsageError(
            f"the function cannot be sent to workers: {str(error).splitlines()[0]}",
            hint="it must not hold open files, simulations or locks",
        ) from None
    return ray.put(job)


def _outcome(ray: Any, reference: Any) -> Failure | None:
    try:
        made: Failure | None = ray.get(reference)
        return made
    except ray.exceptions.WorkerCrashedError:
        return Failure("its worker died each time: killed, out of memory, or a crash")
    except ray.exceptions.RayError as error:
        lines = [line for line in str(error).splitlines() if line.strip()]
        return Failure(lines[-1] if lines else type(error).__name__)
