"""The small map of a video: the floor plan around an episode with the route up to an instant."""

from __future__ import annotations

from typing import Any

import numpy as np

from gloam.experiments.charts import label_font
from gloam.experiments.optional import require

from ..grid import Grid
from .episode import BEGIN
from .places import RADIUS
from .results import Episode

_FREE, _BLOCKED, _ROUTE, _GOAL, _TOUCH, _INK = (255, 255, 255), (190, 196, 204), (0, 114, 178), (0, 158, 115), (213, 94, 0), (34, 34, 34)
_MARGIN = 1.2  # around start, goal and route [m]


class RouteView:
    """Draws the map and the title of one episode (PIL images)."""

    def __init__(self, episode: Episode, plan: Grid | None, size: tuple[int, int]) -> None:
        """size: of the map [px]."""
        self._episode, self._size = episode, size
        points = np.array([episode.start[:2], episode.goal, *(row[1:] for row in episode.track)])
        low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
        self._scale = float(min(size[0] / (high[0] - low[0]), size[1] / (high[1] - low[1])))  # [px/m]
        self._middle = 0.5 * (low + high)
        self._ground = self._drawn(plan)

    def at(self, time: float) -> Any:
        """The map at a simulation time [s]: start, goal, route and collisions until then."""
        image = self._ground.copy()
        draw = require("PIL.ImageDraw").Draw(image)
        passed = [self._pixel(x, y) for t, x, y in self._episode.track if t <= time] or [self._pixel(*self._episode.start[:2])]
        if len(passed) > 1:
            draw.line(passed, fill=_ROUTE, width=2)
        for t, x, y, _ in self._episode.touches:
            if t <= time:
                self._dot(draw, self._pixel(x, y), 3, _TOUCH)
        self._dot(draw, passed[-1], 4, _ROUTE)
        return image

    def title(self, time: float, touches: int, size: tuple[int, int]) -> Any:
        """A line with the episode's name, and time and number of collisions so far."""
        image = require("PIL.Image").new("RGB", size, _FREE)
        draw = require("PIL.ImageDraw").Draw(image)
        key, now = self._episode.key, max(0.0, time - BEGIN)
        left = f"{key.planner} · {key.scene} · {key.level} · episode {key.episode}: {self._episode.outcome.replace('_', ' ')}"
        right = f"{now:4.1f} s, {touches} {'collision' if touches == 1 else 'collisions'}"
        font = label_font(13)
        draw.text((6, size[1] / 2), left, fill=_INK, font=font, anchor="lm")
        draw.text((size[0] - 6, size[1] / 2), right, fill=_INK, font=font, anchor="rm")
        return image

    def _drawn(self, plan: Grid | None) -> Any:
        width, height = self._size
        pixels = np.full((height, width, 3), _FREE, np.uint8)
        if plan is not None:
            x = self._middle[0] + (np.arange(width) + 0.5 - width / 2) / self._scale
            y = self._middle[1] - (np.arange(height) + 0.5 - height / 2) / self._scale
            free = plan.are_free(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2))
            pixels[~free.reshape(height, width)] = _BLOCKED
        image = require("PIL.Image").fromarray(pixels)
        draw = require("PIL.ImageDraw").Draw(image)
        self._dot(draw, self._pixel(*self._episode.start[:2]), 4, _INK)
        reach = max(4, round(RADIUS * self._scale))
        x0, y0 = self._pixel(*self._episode.goal)
        draw.ellipse((x0 - reach, y0 - reach, x0 + reach, y0 + reach), outline=_GOAL, width=2)
        return image

    def _pixel(self, x: float, y: float) -> tuple[float, float]:
        return (
            self._size[0] / 2 + self._scale * (x - float(self._middle[0])),
            self._size[1] / 2 - self._scale * (y - float(self._middle[1])),
        )

    @staticmethod
    def _dot(draw: Any, at: tuple[float, float], radius: int, color: tuple[int, int, int]) -> None:
        draw.ellipse((at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius), fill=color)
