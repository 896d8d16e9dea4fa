"""Display in notebooks: images as PNG, animations, videos, scenes. Requires no other package."""

from __future__ import annotations

import base64
import html
import os
import struct
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOUR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}  # by channels: grey, grey + alpha, RGB, RGBA
_MOST_EMBEDDED = 64 << 20  # [bytes] of a video within a notebook


def png(picture: ArrayLike) -> bytes:
    """An image as a PNG file.

    picture: (H, W) or (H, W, 1 … 4), uint8 or uint16, rows from the top. Raises ValueError for other shapes and types.
    """
    array = _picture(picture)
    return b"".join(
        [_SIGNATURE, _chunk(b"IHDR", _header(array)), _chunk(b"IDAT", _packed(array)), _chunk(b"IEND", b"")]
    )


def animated_png(pictures: Iterable[ArrayLike], rate: float = 10.0) -> bytes:
    """Images of one size as an animated PNG that repeats forever (PNG, third edition, W3C 2025, section 11.3.6).

    pictures: at least one, as for png(); rate [Hz]: 0 < rate. Raises ValueError.
    """
    if not 0 < rate < 65536:
        raise ValueError(f"rate must be above 0 and below 65536 Hz, got {rate}")
    arrays = [_picture(picture) for picture in pictures]
    if not arrays:
        raise ValueError("there are no images")
    first = arrays[0]
    if any(a.shape != first.shape or a.dtype != first.dtype for a in arrays):
        raise ValueError("the images differ in size or type")
    height, width, _ = first.shape
    parts = [_SIGNATURE, _chunk(b"IHDR", _header(first)), _chunk(b"acTL", struct.pack(">II", len(arrays), 0))]
    number = 0
    for i, array in enumerate(arrays):
        delay = struct.pack(">HH", *_fraction(1 / rate))
        parts.append(_chunk(b"fcTL", struct.pack(">IIIII", number, width, height, 0, 0) + delay + b"\0\0"))
        number += 1
        if i == 0:
            parts.append(_chunk(b"IDAT", _packed(array)))
        else:
            parts.append(_chunk(b"fdAT", struct.pack(">I", number) + _packed(array)))
            number += 1
    return b"".join([*parts, _chunk(b"IEND", b"")])


class Animation:
    """An animation for a notebook: Animation([frame.rgb for frame in frames], rate=10)."""

    def __init__(self, pictures: Iterable[Any], rate: float = 10.0) -> None:
        """pictures: arrays as for png(), or frames with an `rgb`; rate [Hz]. Raises ValueError."""
        self.data = animated_png([getattr(p, "rgb", p) for p in pictures], rate)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the animated PNG. Raises OSError."""
        Path(path).write_bytes(self.data)

    def _repr_html_(self) -> str:
        return f'<img src="{_data_uri("image/png", self.data)}">'


class Video:
    """An MP4 file that a notebook plays. It is embedded, so that the notebook can be shared.

    Videos of Gloam are H.264, which all browsers play: Video(log.render("night.mp4", …)).
    """

    def __init__(self, path: str | os.PathLike[str], width: int | None = None) -> None:
        """width [px]: displayed width; None = the video's own. Raises OSError, ValueError for over 64 MiB."""
        self.path, self.width = Path(path), width
        size = self.path.stat().st_size
        if size > _MOST_EMBEDDED:
            raise ValueError(f"{path}: {size >> 20} MiB are too large for a notebook; the limit is {_MOST_EMBEDDED >> 20} MiB")

    def _repr_html_(self) -> str:
        size = "" if self.width is None else f' width="{self.width}"'
        return f'<video controls loop{size} src="{_data_uri("video/mp4", self.path.read_bytes())}"></video>'

    def __repr__(self) -> str:
        return f"<gloam.notebook.Video {self.path}>"


def depth_picture(depth: ArrayLike, near: float | None = None, far: float | None = None) -> NDArray[np.uint8]:
    """Depth [m] as grey: near is white, far and nothing (inf, NaN) black.

    depth: (H, W); near, far [m]: None = the minimum and maximum of the image. Returns (H, W) uint8.
    """
    array = np.asarray(depth, dtype=np.float64)
    seen = array[np.isfinite(array)]
    if seen.size == 0:
        return np.zeros(array.shape, np.uint8)
    low = float(seen.min()) if near is None else near
    high = float(seen.max()) if far is None else far
    share = (high - np.where(np.isfinite(array), array, high)) / max(high - low, 1e-12)
    return np.round(255 * np.clip(share, 0, 1)).astype(np.uint8)


def scene_html(title: str, toml: str) -> str:
    """A scene for a notebook: its title and its text, which opens with a click."""
    return f"<details><summary>{html.escape(title)}</summary><pre>{html.escape(toml)}</pre></details>"


def _picture(picture: ArrayLike) -> NDArray[Any]:
    array = np.asarray(picture)
    if array.ndim == 2:
        array = array[:, :, np.newaxis]
    if array.ndim != 3 or array.shape[2] not in _COLOUR_TYPE or 0 in array.shape:
        raise ValueError(f"an image must have the shape (H, W) or (H, W, 1 … 4), got {np.shape(picture)}")
    if array.dtype not in (np.uint8, np.uint16):
        raise ValueError(
            f"an image must be uint8 or uint16, got {array.dtype}; notebook.depth_picture() converts depth"
        )
    return array


def _header(array: NDArray[Any]) -> bytes:
    height, width, channels = array.shape
    return struct.pack(">IIBBBBB", width, height, 8 * array.dtype.itemsize, _COLOUR_TYPE[channels], 0, 0, 0)


def _packed(array: NDArray[Any]) -> bytes:
    """Rows, each behind the number of its filter: 2, the difference to the row above, which packs renderings well."""
    rows = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder(">")).view(np.uint8).reshape(array.shape[0], -1)
    filtered = np.empty((rows.shape[0], rows.shape[1] + 1), np.uint8)
    filtered[:, 0] = 2
    filtered[0, 1:] = rows[0]
    filtered[1:, 1:] = rows[1:] - rows[:-1]
    return zlib.compress(filtered.tobytes(), 4)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _fraction(seconds: float) -> tuple[int, int]:
    """A delay as numerator and denominator of 16 bits."""
    return (round(seconds * 1000), 1000) if seconds < 65 else (round(seconds), 1)


def _data_uri(kind: str, data: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
