"""Examples of a comparison for the page: images side by side with their maps."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gloam.experiments.optional import require

from .cam import enlarged, normalised
from .compare import REAL, Comparison, class_of, features_file, response
from .images import Image, fitted, shown
from .likeness import compare
from .network import Network
from .sets import load_image

_WIDTH = 240  # of images on the page [px]
_BLOCK = 4096  # rows at a time


@dataclass(frozen=True)
class Cell:
    """An image of the page as a data URI, "" = none, with a caption."""

    image: str
    caption: str = ""


@dataclass(frozen=True)
class Example:
    """A real image with its partners or nearest neighbours. rows: (title, a cell for each set, real first)."""

    title: str
    rows: tuple[tuple[str, tuple[Cell, ...]], ...]


def make_examples(found: Comparison, pair_rows: list[dict[str, Any]]) -> list[Example]:
    """Up to `examples` of the request: of pairs from the least to the most similar one, else spread over the real images."""
    return [_example(found, place) for place in _places(found, pair_rows)]


def _places(found: Comparison, pair_rows: list[dict[str, Any]]) -> list[int]:
    """Places of real images. Pairs are ordered by the first network's cosine similarity, else by SSIM."""
    real = found.sets[REAL].pictures
    first = next(iter(found.request.others))
    if found.pairs:
        mine = [row for row in pair_rows if row["set"] == first and row["network"] == pair_rows[0]["network"]]
        key = "cosine" if found.networks else "ssim"
        score = {row[REAL]: row[key] if row[key] is not None else 0.0 for row in mine}
        order = sorted((pair.real for pair in found.pairs[first]), key=lambda k: (score.get(real[k].name, 0.0), real[k].hash))
    else:
        order = sorted(range(len(real)), key=lambda k: real[k].hash)
    count = min(found.request.examples, len(order))
    return [order[k] for k in dict.fromkeys(np.linspace(0, len(order) - 1, count).round().astype(int).tolist())]


def _example(found: Comparison, place: int) -> Example:
    columns: list[tuple[str, int | None]] = [(REAL, place), *((name, _partner(found, name, place)) for name in found.request.others)]
    images = [None if k is None else load_image(found.sets[name], found.sets[name].pictures[k]) for name, k in columns]
    cells = []
    for (name, k), image in zip(columns, images, strict=True):
        cells.append(Cell("") if image is None or k is None else Cell(_data(_small(image)), shown(found.sets[name].pictures[k].name)))
    rows: list[tuple[str, tuple[Cell, ...]]] = [("image", tuple(cells))]
    for network in found.networks:
        rows += _map_rows(found, network, columns, images)
    if found.pairs and images[0] is not None:
        rows.append(("FLIP", (Cell(""), *(_flip_cell(images[0], image) for image in images[1:]))))
    return Example(shown(found.sets[REAL].pictures[place].name), tuple(rows))


def _partner(found: Comparison, name: str, place: int) -> int | None:
    """The other image of the pair, or the nearest neighbour by the first network's features; None if there is none."""
    if found.pairs:
        return next((pair.other for pair in found.pairs[name] if pair.real == place), None)
    if not found.networks:
        return None
    mine, theirs = (np.load(features_file(found, found.networks[0], one, "features"), mmap_mode="r") for one in (REAL, name))
    wanted = np.asarray(mine[place], np.float64)
    best, nearest = -np.inf, None
    for begin in range(0, len(theirs), _BLOCK):
        rows = np.asarray(theirs[begin : begin + _BLOCK], np.float64)
        cosines = rows @ wanted / np.maximum(np.linalg.norm(rows, axis=1), 1e-300)
        if cosines.max() > best:
            best, nearest = float(cosines.max()), begin + int(cosines.argmax())
    return nearest


def _map_rows(
    found: Comparison, network: Network, columns: list[tuple[str, int | None]], images: list[Image | None]
) -> list[tuple[str, tuple[Cell, ...]]]:
    """Grad-CAM of the real image's class, and EigenCAM, over what the network sees."""
    place = columns[0][1] or 0
    number = class_of(found, response(found, network, REAL, place)["scores"]) if network.tail else None
    grad, eigen = [], []
    for (name, k), image in zip(columns, images, strict=True):
        if k is None or image is None:
            grad.append(Cell(""))
            eigen.append(Cell(""))
            continue
        record = response(found, network, name, k, number)
        seen = fitted(image, network.size, network.settings.fit)
        eigen.append(Cell(_data(_over(seen, record["eigen"]))))
        if number is not None:
            best = int(record["scores"].argmax())
            caption = f"first class: {network.class_name(best)}"
            grad.append(Cell(_data(_over(seen, record[f"grad_{number}"])), caption))
    rows = [(f"EigenCAM, {network.settings.name}", tuple(eigen))]
    if number is not None:
        rows.insert(0, (f"Grad-CAM of “{network.class_name(number)}”, {network.settings.name}", tuple(grad)))
    return rows


def _over(seen: Image, map_: NDArray[Any]) -> Image:
    """A map in colours over a grey image, opaque where it is high."""
    colours = require("matplotlib").colormaps["inferno"]
    share = enlarged(normalised(map_.astype(np.float64)), (seen.shape[1], seen.shape[0]))
    grey = np.repeat(seen.astype(np.float64).mean(axis=2, keepdims=True), 3, axis=2)
    alpha = 0.25 + 0.55 * share[:, :, None]
    return np.asarray((1 - alpha) * grey + alpha * 255 * colours(share)[:, :, :3], np.uint8)


def _flip_cell(reference: Image, image: Image | None) -> Cell:
    if image is None:
        return Cell("")
    answer, difference = compare(reference, image)
    if difference is None:
        return Cell("", answer.reason)
    colours = require("matplotlib").colormaps["magma"]
    return Cell(_data(_small(np.asarray(255 * colours(difference)[:, :, :3], np.uint8))), f"mean {answer.flip:.3f}")


def _small(image: Image) -> Image:
    height, width = image.shape[:2]
    if width <= _WIDTH and height <= 2 * _WIDTH:
        return image
    scale = min(_WIDTH / width, 2 * _WIDTH / height)
    pillow = require("PIL.Image")
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return np.asarray(pillow.fromarray(image).resize(size, pillow.Resampling.LANCZOS))


def _data(image: Image) -> str:
    memory = io.BytesIO()
    require("PIL.Image").fromarray(image).save(memory, "JPEG", quality=85)
    return "data:image/jpeg;base64," + base64.b64encode(memory.getvalue()).decode()
