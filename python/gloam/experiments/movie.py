"""Videos (MP4, H.264) of images that a program has composed.

Gloam's encoder reads image topics of logs, so the images go through a log: an MCAP file without chunks and index
(https://mcap.dev/spec), which is removed afterwards.
"""

from __future__ import annotations

import io
import struct
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, BinaryIO

import gloam
from gloam import _core

_MAGIC = b"\x89MCAP0\r\n"
_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _DATA_END = 1, 2, 3, 4, 5, 15  # opcodes
_TYPE, _TOPIC = "sensor_msgs/msg/CompressedImage", "/images"
_JPEG_QUALITY = 95


def write_movie(path: Path, images: Iterable[Any], rate: float) -> int:
    """Writes images (PIL, RGB, of one size) as a video with `rate` images per second. Returns their number.

    Errors: gloam.IoError, gloam.InputError without an image; OSError if the log cannot be written. `path` must not exist.
    """
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".movie-") as folder:
        log = Path(folder) / "images.mcap"
        with log.open("wb") as file:
            _write_log(file, images, rate)
        return gloam.replay(log).export(_TOPIC, path, "mp4")


def _write_log(file: BinaryIO, images: Iterable[Any], rate: float) -> None:
    _, definition, _ = _core.message_info(_TYPE)
    file.write(_MAGIC)
    _record(file, _HEADER, _text("ros2"), _text("gloam"))
    _record(file, _SCHEMA, struct.pack("<H", 1), _text(_TYPE), _text("ros2msg"), _text(definition))
    _record(file, _CHANNEL, struct.pack("<HH", 1, 1), _text(_TOPIC), _text("cdr"), struct.pack("<I", 0))
    for k, image in enumerate(images):
        stamp = round(k / rate * 1e9)
        packed = io.BytesIO()
        image.save(packed, "JPEG", quality=_JPEG_QUALITY, subsampling=0)
        header = {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}}
        message = _core.encode_message(_TYPE, {"header": header, "format": "jpeg", "data": packed.getvalue()})
        _record(file, _MESSAGE, struct.pack("<HIQQ", 1, k, stamp, stamp), message)
    _record(file, _DATA_END, struct.pack("<I", 0))
    _record(file, _FOOTER, struct.pack("<QQI", 0, 0, 0))
    file.write(_MAGIC)


def _record(file: BinaryIO, opcode: int, *parts: bytes) -> None:
    content = b"".join(parts)
    file.write(struct.pack("<BQ", opcode, len(content)) + content)


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<I", len(data)) + data
