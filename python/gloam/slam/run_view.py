"""Images of a video of one run: the input of the method, its features, the state of tracking, and its path on the floor plan."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gloam.experiments.charts import label_font, short
from gloam.experiments.optional import require
from gloam.navigation.benchmark.plan_view import PlanView
from gloam.navigation.grid import Grid

from .adapters.contract import INITIALIZING, LOST, TRACKED
from .charts import STATE_COLORS
from .estimate import Array, Frame, Trajectory
from .measures import returns

RELOCALISED, NO_STATE = "relocalised", "no state"
_NAMES = {INITIALIZING: "not started", TRACKED: "tracking"}  # of the others: as they are
_COLORS = STATE_COLORS | {RELOCALISED: "#0072b2", NO_STATE: "#e4e7eb"}
_SEEN, _MAP, _TITLE, _BAND = (480, 360), (360, 360), 26, 34  # the sensor's panel, the map, and the heights of title and band [px]
_INK, _PAPER, _TRUTH, _ESTIMATE, _FEATURE = (34, 34, 34), (255, 255, 255), (120, 126, 136), (0, 114, 178), (255, 214, 10)
_SHOWN = 1.0  # time for which a relocalisation is shown [s]
_MARGIN = 1.0  # of the map around the paths [m]
_LEAST_REACH = 4.0  # of scans, from the sensor to the upper edge of the panel [m]
_LOW, _HIGH = (49, 104, 142), (253, 187, 45)  # colours of points at -1 and +1.5 m from the sensor


@dataclass(frozen=True)
class Shown:
    """The content of a video. title: of the run; times: (n,) of the sensor's frames [s]; files: their images or scans; frames: of the
    method; features: (m, 2) pixels by time; truth; estimate: (k, 2) places in the world of the truth, at estimate_times;
    extinction: (m, 2) time [s] and extinction [1/m]; plan: None = not drawn."""

    title: str
    times: Array
    files: tuple[Path, ...]
    frames: tuple[Frame, ...]
    features: dict[float, Array]
    truth: Trajectory
    estimate_times: Array
    estimate: Array
    extinction: Array
    plan: Grid | None


class RunView:
    """Draws the images of one run."""

    def __init__(self, shown: Shown) -> None:
        self._shown = shown
        self._half = float(np.median(np.diff(shown.times))) / 2 if len(shown.times) > 1 else 0.5
        self._states = states_at(shown.times, shown.frames, self._half)
        self._features = _by_frame(shown.features, shown.times, self._half)
        points = np.vstack([shown.truth.poses[:, :2], shown.estimate[_near(shown.estimate, shown.truth)]])
        self._view = PlanView(shown.plan, points, _MARGIN, _MAP)
        # Between poses [s]; some methods have poses of keyframes only.
        self._gap = 2.5 * float(np.median(np.diff(shown.estimate_times))) if len(shown.estimate_times) > 1 else 0.0
        self._draw = require("PIL.ImageDraw").Draw
        self._view.path(self._draw(self._view.ground), shown.truth.poses[:, :2], _TRUTH, 2)
        self._band = self._whole_band()
        self._reach = _reach_of(shown.files[0])
        self._font, self._bold = label_font(13), label_font(15)

    def images(self, step: int) -> Iterator[Any]:
        """Images (PIL) of every `step`-th frame."""
        for k in range(0, len(self._shown.times), step):
            canvas = require("PIL.Image").new("RGB", (_SEEN[0] + _MAP[0], _TITLE + _SEEN[1] + _BAND), _PAPER)
            canvas.paste(self._seen(k), (0, _TITLE))
            canvas.paste(self._map(k), (_SEEN[0], _TITLE))
            canvas.paste(self._band_at(k), (0, _TITLE + _SEEN[1]))
            self._write(canvas, k)
            yield canvas

    def _write(self, canvas: Any, k: int) -> None:
        """The title, and the state in a corner of the sensor's panel."""
        draw, now = self._draw(canvas), self._shown.times[k]
        extinction = float(np.interp(now, self._shown.extinction[:, 0], self._shown.extinction[:, 1]))
        air = "clear air" if extinction < 1e-3 else f"extinction {extinction:.2f} /m"
        draw.text((6, _TITLE / 2), short(self._shown.title, 70), fill=_INK, font=self._font, anchor="lm")
        right = f"{now - self._shown.times[0]:.1f} s · {air}"
        draw.text((canvas.width - 6, _TITLE / 2), right, fill=_INK, font=self._font, anchor="rm")
        state = self._states[k]
        text = _NAMES.get(state, state)
        if self._features is not None:
            text += f" · {len(self._features[k])} features"
        width = draw.textlength(text, font=self._bold)
        draw.rectangle((0, _TITLE, width + 16, _TITLE + 24), fill=_COLORS[state])
        draw.text((8, _TITLE + 12), text, fill=_INK if state == NO_STATE else _PAPER, font=self._bold, anchor="lm")

    def _seen(self, k: int) -> Any:
        file = self._shown.files[k]
        return self._scan(file) if file.suffix == ".bin" else self._image(file, k)

    def _image(self, file: Path, k: int) -> Any:
        """The camera's image in the middle of the panel, with the features."""
        panel = require("PIL.Image").new("RGB", _SEEN, _INK)
        with require("PIL.Image").open(file) as own:
            scale = min(_SEEN[0] / own.width, _SEEN[1] / own.height)
            size = max(1, round(own.width * scale)), max(1, round(own.height * scale))
            image = own.convert("RGB").resize(size)
        draw = self._draw(image)
        for x, y in () if self._features is None else ((self._features[k] + 0.5) * scale).tolist():
            draw.ellipse((x - 2.5, y - 2.5, x + 2.5, y + 2.5), outline=_FEATURE)
        panel.paste(image, ((_SEEN[0] - size[0]) // 2, (_SEEN[1] - size[1]) // 2))
        return panel

    def _scan(self, file: Path) -> Any:
        """The scan from above, forward up."""
        points = _points(file)
        width, height = _SEEN
        scale = height / (2 * self._reach)
        column, row = np.rint(width / 2 - points[:, 1] * scale).astype(int), np.rint(height / 2 - points[:, 0] * scale).astype(int)
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        share = np.clip((points[inside, 2] + 1.0) / 2.5, 0, 1)[:, None]
        pixels = np.full((height, width, 3), _INK, np.uint8)
        pixels[row[inside], column[inside]] = (1 - share) * np.array(_LOW) + share * np.array(_HIGH)
        image = require("PIL.Image").fromarray(pixels)
        draw = self._draw(image)
        x, y = width / 2, height / 2
        draw.polygon([(x, y - 8), (x - 5, y + 5), (x + 5, y + 5)], fill=_PAPER)
        draw.text((8, height - 12), f"{len(points)} returns, from above", fill=_PAPER, font=self._font, anchor="lm")
        return image

    def _map(self, k: int) -> Any:
        """The floor plan with the true path, the estimate until this frame, and both places."""
        image, now = self._view.ground.copy(), self._shown.times[k]
        draw = self._draw(image)
        until = self._shown.estimate_times <= now + self._half
        times, places = self._shown.estimate_times[until], self._shown.estimate[until]
        for part in np.split(places, np.flatnonzero(np.diff(times) > self._gap) + 1):
            self._view.path(draw, part, _ESTIMATE, 3)
        here = self._shown.truth.poses[int(np.argmin(np.abs(self._shown.truth.times - now)))]
        self._view.dot(draw, (here[0], here[1]), 5, _INK)
        if len(times) and now - times[-1] <= 2 * self._half:
            self._view.dot(draw, (places[-1][0], places[-1][1]), 4, _ESTIMATE)
        for line, (name, color) in enumerate((("truth", _TRUTH), ("estimate", _ESTIMATE))):
            y = _MAP[1] - 12 - 18 * (1 - line)
            draw.rectangle((6, y - 8, 84, y + 8), fill=_PAPER)
            draw.line((8, y, 24, y), fill=color, width=3)
            draw.text((30, y), name, fill=_INK, font=self._font, anchor="lm")
        return image

    def _whole_band(self) -> Any:
        """The states of all frames as a coloured strip, (1, n, 3)."""
        return np.array([require("PIL.ImageColor").getrgb(_COLORS[state]) for state in self._states], np.uint8)[None]

    def _band_at(self, k: int) -> Any:
        """The strip over the width of the video: past states in full colours, later ones pale, the instant as a line."""
        width = _SEEN[0] + _MAP[0]
        count = len(self._states)
        chosen = (np.arange(width) * count // width).clip(0, count - 1)
        strip = self._band[:, chosen].astype(np.float64)
        late = chosen > k
        strip[:, late] = 255 - 0.35 * (255 - strip[:, late])
        image = require("PIL.Image").fromarray(np.repeat(strip, _BAND, 0).astype(np.uint8))
        x = (k + 0.5) / count * width
        self._draw(image).rectangle((x - 1, 0, x + 1, _BAND), fill=_INK)
        return image


def states_at(times: Array, frames: tuple[Frame, ...], half: float) -> list[str]:
    """The state of each frame of a sequence; for a second after a return to tracking RELOCALISED, and NO_STATE for frames that
    the method does not report."""
    answer = [NO_STATE] * len(times)
    if not frames:
        return answer
    shown_until = -np.inf
    stamps = np.array([frame.time for frame in frames])
    back = set(returns([frame.state for frame in frames]))
    for k, now in enumerate(times):
        nearest = int(np.argmin(np.abs(stamps - now)))
        if abs(stamps[nearest] - now) > half + 1e-9:
            continue
        answer[k] = frames[nearest].state
        if nearest in back:
            shown_until = now + _SHOWN
        if answer[k] == TRACKED and now < shown_until:
            answer[k] = RELOCALISED
    return answer


def _by_frame(features: dict[float, Array], times: Array, half: float) -> list[Array] | None:
    """Features of each frame of a sequence, or None if the method has none at all."""
    if not features:
        return None
    stamps = np.array(sorted(features))
    nearest = [int(np.argmin(np.abs(stamps - now))) for now in times]
    none = np.zeros((0, 2))
    return [features[float(stamps[i])] if abs(stamps[i] - now) <= half + 1e-9 else none for i, now in zip(nearest, times, strict=True)]


def _points(file: Path) -> Any:
    """x, y, z [m], intensity and time [s] of each point of a scan, (n, 5)."""
    return np.fromfile(file, np.float32).reshape(-1, 5)


def _reach_of(file: Path) -> float:
    """Distance from the sensor that a video shows [m]: of most points of its first scan."""
    points = _points(file)[:, :2] if file.suffix == ".bin" else np.zeros((0, 2))
    return max(_LEAST_REACH, float(np.percentile(np.abs(points).max(1), 95))) if len(points) else _LEAST_REACH


def _near(places: Array, truth: Trajectory) -> Any:
    """(k,): places that are at most one length of the true path's box outside of it; others would shrink the map."""
    low, high = truth.poses[:, :2].min(0), truth.poses[:, :2].max(0)
    reach = max(float((high - low).max()), 2.0)
    return ((places > low - 0.5 * reach) & (places < high + 0.5 * reach)).all(1)
