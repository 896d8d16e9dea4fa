"""Edges of a render from its exact channels, and pictures that compare the render with a photograph."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

import gloam

from .camera import Array

Picture = NDArray[np.uint8]

_CREASE = 0.9  # cosine of the angle between normals
_STEP = 0.02  # jump in depth beyond the local slope, as part of the depth
_COLOUR = 0.12  # step of the albedo, the largest of the three channels
EDGE, GOOD, WRONG = (0, 229, 255), (60, 220, 60), (255, 70, 50)


def edges_of(frame: gloam.Frame) -> NDArray[np.bool_]:
    """Pixels (h, w) where the part, the normal, the depth or the colour of the surface changes.

    The frame needs the outputs segmentation, normal, depth and albedo. Noise does not matter: none of them depends on light.
    """
    part, normal, albedo = (np.asarray(getattr(frame, name)) for name in ("part", "normal", "albedo"))
    inverse = 1 / np.asarray(frame.depth, dtype=np.float64)  # linear in the image on planes; 0 = nothing
    made = np.zeros(part.shape, dtype=bool)
    for axis in (0, 1):
        a, b = _slices(axis, 0, -1), _slices(axis, 1, None)
        differs = part[a] != part[b]
        differs |= np.sum(normal[a] * normal[b], axis=2) < _CREASE
        differs |= np.abs(albedo[a] - albedo[b]).max(axis=2) > _COLOUR
        made[b] |= differs
        bend = np.abs(np.diff(inverse, 2, axis=axis))
        made[_slices(axis, 1, -1)] |= bend > _STEP * np.maximum(inverse[_slices(axis, 1, -1)], 1e-12)
    return made


def _slices(axis: int, begin: int, end: int | None) -> tuple[slice, ...]:
    return (slice(None),) * axis + (slice(begin, end),)


def draw_edges(photo: Picture, edges: NDArray[np.bool_]) -> Picture:
    """The photograph, darkened a little, with the edges over it."""
    made = (photo * 0.75).astype(np.uint8)
    made[edges] = EDGE
    return made


def blend(photo: Picture, render: Picture) -> Picture:
    """The mean of both images."""
    return np.asarray((photo.astype(np.uint16) + render + 1) // 2, dtype=np.uint8)


def checkerboard(photo: Picture, render: Picture, fields: int = 8) -> Picture:
    """Fields of both images in turn, so that edges continue across them if the camera fits."""
    height, width = photo.shape[:2]
    side = max(1, max(height, width) // fields)
    odd = (np.arange(height)[:, None] // side + np.arange(width)[None, :] // side) % 2 == 1
    return np.where(odd[:, :, None], render, photo)


def draw_pairs(picture: Picture, pixels: Array, projected: Array, used: Sequence[bool]) -> Picture:
    """Picked pixels as circles with their numbers, and crosses where the camera projects their points; wrong pairs in red."""
    image = Image.fromarray(picture)
    canvas = ImageDraw.Draw(image)
    size = max(3, round(max(image.size) / 160))
    for i, ((u, v), (x, y)) in enumerate(zip(pixels, projected, strict=True)):
        colour = GOOD if used[i] else WRONG
        canvas.line([(u, v), (x, y)], fill=WRONG, width=2)
        canvas.ellipse([u - size, v - size, u + size, v + size], outline=colour, width=2)
        canvas.line([(x - size, y), (x + size, y)], fill=colour)
        canvas.line([(x, y - size), (x, y + size)], fill=colour)
        label = (u + size + 2, v - size - 2)
        canvas.text(label, str(i + 1), fill=colour, stroke_width=2, stroke_fill=(0, 0, 0), font_size=max(11, 2 * size))
    return np.asarray(image)
