"""A small map for videos: the floor plan around some points, on which paths and dots are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gloam.experiments.optional import require

from ..grid import Grid

Color = tuple[int, int, int]
_FREE, _BLOCKED = (255, 255, 255), (190, 196, 204)


class PlanView:
    """Pixels of the floor, north up. ground: the plan (PIL image), to be copied or drawn on."""

    def __init__(self, plan: Grid | None, points: ArrayLike, margin: float, size: tuple[int, int]) -> None:
        """plan: None = no obstacles; points: (n, 2) that must be visible, with a margin around them [m]; size: [px]."""
        inside = np.asarray(points, dtype=np.float64)
        low, high = inside.min(axis=0) - margin, inside.max(axis=0) + margin
        self.size = size
        self.scale = float(min(size[0] / (high[0] - low[0]), size[1] / (high[1] - low[1])))  # [px/m]
        self._middle = 0.5 * (low + high)
        self.ground = require("PIL.Image").fromarray(self._pixels(plan))

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """The pixel of a place [m]."""
        return (
            self.size[0] / 2 + self.scale * (x - float(self._middle[0])),
            self.size[1] / 2 - self.scale * (y - float(self._middle[1])),
        )

    def dot(self, draw: Any, place: Sequence[float], radius: int, color: Color) -> None:
        """Draws a filled circle at a place [m]. radius: [px]."""
        x, y = self.pixel(place[0], place[1])
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=color)

    def path(self, draw: Any, places: ArrayLike, color: Color, width: int = 2) -> None:
        """Draws a line along places (n, 2) [m]."""
        pixels = [self.pixel(x, y) for x, y in np.asarray(places, dtype=np.float64).reshape(-1, 2).tolist()]
        if len(pixels) > 1:
            draw.line(pixels, fill=color, width=width)

    def _pixels(self, plan: Grid | None) -> Any:
        width, height = self.size
        pixels = np.full((height, width, 3), _FREE, np.uint8)
        if plan is not None:
            x = self._middle[0] + (np.arange(width) + 0.5 - width / 2) / self.scale
            y = self._middle[1] - (np.arange(height) + 0.5 - height / 2) / self.scale
            free = plan.are_free(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2))
            pixels[~free.reshape(height, width)] = _BLOCKED
        return pixels
