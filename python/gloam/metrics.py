"""Present values of metrics, from the topic /metrics."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gloam import _core

if TYPE_CHECKING:
    from .simulation import Simulation


class PresentMetrics:
    """The last message of /metrics, decoded."""

    def __init__(self, sim: Simulation) -> None:
        self._stream = _core.open_topics(sim._core, ["/metrics"], True, None, every_sample=True)
        self._values: dict[str, float] = {}

    def values(self) -> dict[str, float]:
        self._stream.flush()
        last: Any = None
        while (message := self._stream.pop()) is not None:
            last = message
        if last is not None:
            self._values = _read(last.decode())
        return self._values

    def begin(self) -> None:
        """Discards values from before a reset; metrics restart."""
        self._values = {}

    def close(self) -> None:
        """Ends the stream."""
        self._stream.close()


def _read(message: dict[str, Any]) -> dict[str, float]:
    return {name: float(value) for name, value in zip(message["names"], message["values"], strict=True)}
