"""Open streams of a simulation: messages of cameras, LiDARs, sensors and topics, and values of metrics."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

from gloam import _core

from .elements import Pose
from .frames import Frame
from .messages import Message, Sample, Scan

if TYPE_CHECKING:
    from .simulation import Simulation

M = TypeVar("M")
Start = Callable[[Callable[[Any], None] | None], _core.Stream]


class Stream(Generic[M]):
    """An open stream. Iteration yields the messages that were received and not yet read, without stepping.

    It ends with close(), at the end of a `with` block, with its simulation, or when nothing refers to it any more. A
    stream with a callback stays open until one of the first three, because its messages go to the callback only.
    """

    def __init__(self, sim: Simulation, name: str, start: Start, wrap: Callable[[Any], M],
                 callback: Callable[[M], None] | None = None) -> None:
        self._sim = sim
        self.name = name  #: of the camera, LiDAR or sensor; the topics
        self._wrap = wrap
        self._stream = start(None if callback is None else (lambda message: callback(wrap(message))))
        self._last: M | None = None
        self._restarts = self._stream.restarts
        if callback is not None:
            sim._streams.add(self)

    def next(self, timeout: float | None = None) -> M:
        """The next message. Steps a paused simulation until the message reaches a reader; the first one may be of
        this instant. While the simulation runs, waits for it, up to `timeout` [s of wall time].

        Raises TimeoutError. UsageError: the stream has a callback, or the topics of a paused simulation are to be
        read by iteration.
        """
        if self._sim.paused:
            return self._read(self._sim._core.step_until(self._stream))
        message = self._stream.wait(timeout)
        if message is None:
            raise TimeoutError(f"{self!r}: no message within {timeout} s")
        return self._read(message)

    def latest(self) -> M | None:
        """The newest message that was received, without stepping; None = none since the stream was opened or the
        simulation was reset. Older messages that were not read are discarded."""
        for _ in self:
            pass
        return self._last if self._restarts == self._stream.restarts else None

    def flush(self) -> None:
        """Waits until every message that is complete by now has been received, or its callback has returned."""
        self._stream.flush()

    def __iter__(self) -> Iterator[M]:
        self.flush()
        while (message := self._stream.pop()) is not None:
            yield self._read(message)

    def _read(self, message: Any) -> M:
        self._last = self._wrap(message)
        self._restarts = self._stream.restarts
        return self._last

    @property
    def is_open(self) -> bool:
        return self._stream.is_open

    @property
    def dropped(self) -> int:
        """Messages lost because they were not read in time."""
        return self._stream.dropped

    def close(self) -> None:
        """Ends the stream, after its last callback; a second call does nothing. Raises StuckError if a callback has
        not returned after 5 s."""
        self._sim._streams.discard(self)
        self._stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<gloam.{type(self).__name__} '{self.name}'{'' if self.is_open else ', closed'}>"


class CameraStream(Stream[Frame]):
    """Frames of a camera."""

    def set_pose(self, pose: Pose | tuple[Any, Any]) -> None:
        """Moves the camera "free" of this stream: X_WC."""
        self._stream.set_pose(pose)


class LidarStream(Stream[Scan]):
    """Scans of a LiDAR."""


class SensorStream(Stream[Sample]):
    """Samples of a sensor or probe."""


class Subscription(Stream[Message]):
    """Messages of topics."""


class MetricStream(Stream[dict[str, float]]):
    """Values of all metrics of the scene (docs/metrics.md) by their names, sampled at record.metrics_rate.

    Metrics that accumulate, such as a path length, begin when the stream is opened, and again at a reset and in
    another World.
    """

    def latest(self) -> dict[str, float]:
        """Present values; {} = no sample yet."""
        return super().latest() or {}
