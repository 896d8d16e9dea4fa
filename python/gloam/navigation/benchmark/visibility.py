"""Visibility along the way of an episode, by a probe at the camera; planners do not see it."""

from __future__ import annotations

from typing import Any

import gloam

PROBE = "visibility"
KOSCHMIEDER = 3.912  # visibility times extinction: contrast of 2 % (docs/metrics.md)


def visibility_probe(body: str, position: tuple[float, float, float], rate: float = 2.0) -> dict[str, Any]:
    """The [[probe]] for a scene. position: in the body's frame [m]; rate: [Hz]."""
    return {"name": PROBE, "quantity": "visibility", "body": body, "position": list(position), "rate": rate}


class VisibilityMeter:
    """Koschmieder's visibility [m] from the extinction at the probe, at 550 nm. Clear air counts as 100 km, the probe's
    largest value (docs/sensors.md)."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self._probe = sim.sensors[PROBE].open()
        self._extinctions: list[float] = []  # [1/m]

    def sample(self) -> None:
        """Takes the values since the last call."""
        self._extinctions += [KOSCHMIEDER / float(sample.values[0]) for sample in self._probe]

    def mean(self) -> float | None:
        """The visibility of the mean extinction, as in docs/metrics.md; None without a sample."""
        extinctions = self._extinctions
        return KOSCHMIEDER * len(extinctions) / sum(extinctions) if extinctions else None

    def least(self) -> float | None:
        """The least visibility; None without a sample."""
        return KOSCHMIEDER / max(self._extinctions) if self._extinctions else None

    def close(self) -> None:
        """Closes the probe's stream."""
        self._probe.close()
