"""Files of topological maps: map.json and 000000.png …"""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam.notebook import png

from .networks.preprocessing import Image
from .topological_map import MOST_NODES, MOST_SIDE, MapSource, Node, Spacing, TopologicalMap

_FORMAT = 1
_MOST_JSON = 8 << 20  # [bytes]
_MOST_PNG = 64 << 20  # [bytes]
_MOST_PIXELS = 1 << 30  # of all images of a map
_KEYS = {"format", "scene", "scene_hash", "camera", "size", "spacing", "nodes"}
_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def save(map: TopologicalMap, folder: Path) -> None:
    """See TopologicalMap.save."""
    contents = {
        "format": _FORMAT,
        "scene": map.source.scene,
        "scene_hash": map.source.scene_hash,
        "camera": map.source.camera,
        "size": list(map.image_size),
        "spacing": {"rule": map.spacing.rule, "value": float(map.spacing.value)},
        "nodes": [{"pose": [float(x) for x in node.pose], "time": float(node.time)} for node in map.nodes],
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if any(folder.iterdir()):
            raise gloam.IoError("the folder of a map must be empty", str(folder), hint="choose a new folder")
        for i, node in enumerate(map.nodes):
            (folder / f"{i:06d}.png").write_bytes(png(node.image))
        # Last, so that an interrupted save leaves no folder that loads.
        (folder / "map.json").write_text(json.dumps(contents, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    except OSError as error:
        if isinstance(error, gloam.IoError):
            raise
        raise gloam.IoError(f"cannot write the map: {error.strerror}", str(folder)) from error


def load(folder: Path) -> TopologicalMap:
    """See TopologicalMap.load."""
    file = folder / "map.json"
    try:
        contents = json.loads(_read(file, _MOST_JSON).decode("utf-8"), parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        if isinstance(error, gloam.Error):
            raise
        raise gloam.InputError(f"this is not JSON: {error}", str(file)) from error
    try:
        return _map_of(contents, folder)
    except gloam.Error:
        raise
    except ValueError as error:
        raise gloam.InputError(str(error), str(file)) from error


def _map_of(contents: Any, folder: Path) -> TopologicalMap:
    if not isinstance(contents, dict) or set(contents) != _KEYS:
        raise ValueError(f"a map must be an object with the keys {', '.join(sorted(_KEYS))}")
    if contents["format"] != _FORMAT or isinstance(contents["format"], bool):
        raise ValueError(f"the format must be {_FORMAT}, got {contents['format']!r}")
    names = [_text(contents[key], key) for key in ("scene", "scene_hash", "camera")]
    size, spacing, rows = contents["size"], contents["spacing"], contents["nodes"]
    if not isinstance(size, list) or len(size) != 2 or not all(type(x) is int and 1 <= x <= MOST_SIDE for x in size):
        raise ValueError(f"size must be [width, height] of 1 … {MOST_SIDE} pixels, got {size!r}")
    if not isinstance(spacing, dict) or set(spacing) != {"rule", "value"}:
        raise ValueError("spacing must have a rule and a value")
    if not isinstance(rows, list) or not 1 <= len(rows) <= MOST_NODES:
        raise ValueError(f"nodes must be a list of 1 … {MOST_NODES}")
    if len(rows) * size[0] * size[1] > _MOST_PIXELS:
        raise ValueError(f"the images of a map must have at most {_MOST_PIXELS} pixels in all")
    # Names of images come from their numbers, never from the file: no path can lead out of the folder.
    nodes = [_node(row, i, folder / f"{i:06d}.png", (size[0], size[1])) for i, row in enumerate(rows)]
    return TopologicalMap(nodes, MapSource(*names), Spacing(spacing["rule"], spacing["value"]))


def _node(row: Any, index: int, file: Path, size: tuple[int, int]) -> Node:
    if not isinstance(row, dict) or set(row) != {"pose", "time"}:
        raise ValueError(f"node {index} must have a pose and a time")
    pose = row["pose"]
    if not isinstance(pose, list) or len(pose) != 3:
        raise ValueError(f"the pose of node {index} must be [x, y, yaw]")
    for value in (*pose, row["time"]):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= 1e9:
            raise ValueError(f"a number of node {index} must be finite and within 1e9, got {value!r}")
    try:
        image = decode_png(_read(file, _MOST_PNG), size)
    except (ValueError, zlib.error) as error:
        if isinstance(error, gloam.Error):
            raise
        raise gloam.InputError(str(error), str(file)) from error
    return Node(image, (float(pose[0]), float(pose[1]), float(pose[2])), float(row["time"]))


def _text(value: Any, name: str) -> str:
    if not isinstance(value, str) or len(value) > 256:
        raise ValueError(f"{name} must be a text of at most 256 characters")
    return value


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant} is not a finite number")


def _read(file: Path, most: int) -> bytes:
    try:
        if file.is_symlink() or not file.is_file():
            raise gloam.IoError("this is not a regular file, or it does not exist", str(file))
        if file.stat().st_size > most:
            raise gloam.InputError(f"the file exceeds {most >> 20} MiB", str(file))
        return file.read_bytes()
    except OSError as error:
        if isinstance(error, gloam.Error):
            raise
        raise gloam.IoError(f"cannot read the file: {error.strerror}", str(file)) from error


def decode_png(data: bytes, size: tuple[int, int]) -> Image:
    """(H, W, 3) uint8 from a PNG file of 8-bit RGB without interlacing (W3C, PNG third edition). size: the (width,
    height) that it must have. Errors: ValueError or zlib.error for other or damaged files."""
    if data[:8] != _SIGNATURE:
        raise ValueError("this is not a PNG file")
    position, packed, header = 8, [], b""
    while True:
        if len(data) - position < 12:
            raise ValueError("the PNG file is damaged")
        length, kind = struct.unpack(">I4s", data[position : position + 8])
        body = data[position + 8 : position + 8 + length]
        if len(body) != length or data[position + 8 + length : position + 12 + length] != _checksum(kind + body):
            raise ValueError("the PNG file is damaged")
        position += 12 + length
        if kind == b"IHDR":
            header = body
        elif kind == b"IDAT":
            packed.append(body)
        elif kind == b"IEND":
            break
    if header != struct.pack(">IIBBBBB", *size, 8, 2, 0, 0, 0):
        raise ValueError(f"the image must be 8-bit RGB of {size[0]} x {size[1]} pixels without interlacing")
    stride = size[0] * 3 + 1
    decoder = zlib.decompressobj()
    raw = decoder.decompress(b"".join(packed), stride * size[1] + 1)  # bounded: a small file can decompress to gigabytes
    if len(raw) != stride * size[1]:
        raise ValueError("the PNG file has too few or too many pixels")
    return _unfilter(np.frombuffer(raw, np.uint8).reshape(size[1], stride)).reshape(size[1], size[0], 3)


def _checksum(data: bytes) -> bytes:
    return struct.pack(">I", zlib.crc32(data))


def _unfilter(rows: np.ndarray[Any, np.dtype[np.uint8]]) -> Image:
    """Pixels of the rows, (H, 3 W) uint8, from rows that begin with the number of their filter (PNG, section 9)."""
    out = np.zeros((rows.shape[0], rows.shape[1] - 1), np.uint8)
    above = np.zeros(rows.shape[1] - 1, np.uint8)
    for y, row in enumerate(rows):
        kind, values = int(row[0]), row[1:]
        if kind == 0:
            out[y] = values
        elif kind == 1:
            out[y] = np.cumsum(values.reshape(-1, 3), axis=0, dtype=np.uint8).reshape(-1)
        elif kind == 2:
            out[y] = values + above
        elif kind in (3, 4):
            out[y] = _unfilter_slowly(kind, values, above)
        else:
            raise ValueError(f"a PNG filter must be 0 … 4, got {kind}")
        above = out[y]
    return out


def _unfilter_slowly(kind: int, values: Image, above: Image) -> Image:
    """Filters Average (3) and Paeth (4), in which each pixel depends on its left neighbour."""
    row, up = values.tolist(), above.tolist()
    for i in range(len(row)):
        left, corner = (row[i - 3], up[i - 3]) if i >= 3 else (0, 0)
        if kind == 3:
            guess = (left + up[i]) // 2
        else:
            estimate = left + up[i] - corner
            guess = min((left, up[i], corner), key=lambda value: abs(estimate - value))
        row[i] = (row[i] + guess) & 255
    return np.array(row, np.uint8)
