"""The small map of a video: the floor plan around an episode with the route up to an instant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gloam.experiments.charts import label_font
from gloam.experiments.optional import require

from ..grid import Grid
from .episode import BEGIN
from .places import RADIUS
from .plan_view import PlanView
from .results import Episode

_ROUTE, _GOAL, _TOUCH, _INK, _PAPER = (0, 114, 178), (0, 158, 115), (213, 94, 0), (34, 34, 34), (255, 255, 255)
_MARGIN = 1.2  # around start, goal and route [m]


class RouteView:
    """Draws the map and the title of one episode (PIL images)."""

    def __init__(self, episode: Episode, plan: Grid | None, size: tuple[int, int]) -> None:
        """size: of the map [px]."""
        self._episode, self._start = episode, episode.start[:2]
        self._view = PlanView(plan, [self._start, episode.goal, *(row[1:] for row in episode.track)], _MARGIN, size)
        draw = require("PIL.ImageDraw").Draw(self._view.ground)
        self._view.dot(draw, self._start, 4, _INK)
        reach = max(4, round(RADIUS * self._view.scale))
        x, y = self._view.pixel(*episode.goal)
        draw.ellipse((x - reach, y - reach, x + reach, y + reach), outline=_GOAL, width=2)

    def at(self, time: float) -> Any:
        """The map at a simulation time [s]: start, goal, route and collisions until then."""
        image = self._view.ground.copy()
        draw = require("PIL.ImageDraw").Draw(image)
        passed: list[Sequence[float]] = [(x, y) for t, x, y in self._episode.track if t <= time] or [self._start]
        self._view.path(draw, passed, _ROUTE)
        for t, x, y, _ in self._episode.touches:
            if t <= time:
                self._view.dot(draw, (x, y), 3, _TOUCH)
        self._view.dot(draw, passed[-1], 4, _ROUTE)
        return image

    def title(self, time: float, touches: int, size: tuple[int, int]) -> Any:
        """A line with the episode's name, and time and number of collisions so far."""
        image = require("PIL.Image").new("RGB", size, _PAPER)
        draw = require("PIL.ImageDraw").Draw(image)
        key, now = self._episode.key, max(0.0, time - BEGIN)
        left = f"{key.planner} · {key.scene} · {key.level} · episode {key.episode}: {self._episode.outcome.replace('_', ' ')}"
        right = f"{now:4.1f} s, {touches} {'collision' if touches == 1 else 'collisions'}"
        font = label_font(13)
        draw.text((6, size[1] / 2), left, fill=_INK, font=font, anchor="lm")
        draw.text((size[0] - 6, size[1] / 2), right, fill=_INK, font=font, anchor="rm")
        return image
