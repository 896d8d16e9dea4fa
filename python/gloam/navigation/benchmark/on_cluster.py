"""Episodes on the machines of a Ray cluster (docs/distribute.md)."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from contextlib import ExitStack, closing
from typing import Any, TypeVar

import gloam
from gloam._distribute.cluster import as_they_finish, cluster, set_threads
from gloam._distribute.jobs import Failure

from .pool import Died, attempt

T = TypeVar("T")
R = TypeVar("R")
_CPUS = 1  # of a task


def cluster_results(do: Callable[[T], R], tasks: deque[T], address: str) -> Generator[tuple[T, R | Died], None, None]:
    """As local_results(), from the workers of a cluster. address: "auto", "ray://HOST:PORT"; an existing connection of this
    process is used first. Errors: gloam.UnsupportedError without the package ray; gloam.UsageError if the cluster cannot be
    reached."""
    with ExitStack() as stack:
        ray = _connected(stack, address)
        # A task that dies is reported, not repeated here: the caller counts.
        remote = ray.remote(num_cpus=_CPUS, max_retries=0)(_work)
        sent = ray.put(do)
        finished = as_they_finish(ray, lambda task: remote.remote(sent, task), tasks, _CPUS)
        for one in stack.enter_context(closing(finished)):
            if one is not None:
                yield one[0], _result(ray, one[1])


def _connected(stack: ExitStack, address: str) -> Any:
    try:
        return stack.enter_context(cluster(address, None))
    except ImportError as error:
        raise gloam.UnsupportedError(str(error)) from None
    except (ConnectionError, ValueError, RuntimeError) as error:
        raise gloam.UsageError(f"cannot connect to a Ray cluster at '{address}': {str(error).splitlines()[0]}") from None


def _work(do: Callable[[Any], Any], task: Any) -> Any:
    set_threads(_CPUS)
    return attempt(do, task)


def _result(ray: Any, reference: Any) -> Any:
    """Errors: gloam.Error with the text of an exception of the task."""
    try:
        made = ray.get(reference)
    except ray.exceptions.RayError:
        return Died()
    if isinstance(made, Failure):
        raise gloam.Error(made.error)
    return made
