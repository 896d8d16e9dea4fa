"""Topological maps: builders, files, and hostile files."""

from __future__ import annotations

import io
import json
import math
import struct
import zlib
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.navigation import MapSource, Node, Spacing, TopologicalMap, build_map
from gloam.navigation.topological_map import visual_change
from gloam.navigation.topological_map_files import decode_png
from numpy.typing import NDArray

RANDOM = np.random.default_rng(7)


def frame(i: int, level: int | None = None) -> Node:
    """A frame each 0.25 s and 0.1 m, of noise or of one level."""
    image = RANDOM.integers(0, 256, (6, 8, 3), np.uint8) if level is None else np.full((6, 8, 3), level, np.uint8)
    return Node(image, (0.1 * i, -0.5, 0.25), 0.25 * i)


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """The folder of a map of 3 nodes."""
    source = MapSource("house", "ab" * 32, "front")
    TopologicalMap([frame(0), frame(4), frame(9)], source, Spacing("distance", 0.4)).save(tmp_path / "map")
    return tmp_path / "map"


def test_builders() -> None:
    frames = [frame(i, level) for i, level in enumerate([0, 0, 30, 33, 36, 80, 80, 80, 80, 81])]
    indices = {id(f): i for i, f in enumerate(frames)}

    def built(rule: Any, value: float) -> list[int]:
        return [indices[id(node)] for node in build_map(frames, None, Spacing(rule, value)).nodes]

    assert built("time", 1.0) == [0, 4, 8, 9]
    assert built("distance", 0.3) == [0, 3, 6, 9]
    assert built("change", 5.0) == [0, 2, 4, 5, 9]
    assert built("time", 100.0) == [0, 9]


def test_visual_change_is_the_mean_difference() -> None:
    first, second = np.zeros((48, 64, 3), np.uint8), np.zeros((48, 64, 3), np.uint8)
    second[:24] = 100
    assert visual_change(first, second) == pytest.approx(50.0)
    small = np.full((5, 7, 3), 10, np.uint8)  # smaller than the grey image
    assert visual_change(small, small + 3) == pytest.approx(3.0)


def test_round_trip(saved: Path) -> None:
    assert sorted(p.name for p in saved.iterdir()) == ["000000.png", "000001.png", "000002.png", "map.json"]
    map = TopologicalMap.load(saved)
    assert map.source == MapSource("house", "ab" * 32, "front") and map.spacing == Spacing("distance", 0.4)
    assert map.image_size == (8, 6) and [node.time for node in map.nodes] == [0.0, 1.0, 2.25]
    map.save(saved.parent / "again")
    again = TopologicalMap.load(saved.parent / "again")
    assert all(np.array_equal(a.image, b.image) and a.pose == b.pose for a, b in zip(map.nodes, again.nodes, strict=True))
    with pytest.raises(gloam.IoError, match="must be empty"):
        map.save(saved)


def test_reads_every_png_filter() -> None:
    pillow = pytest.importorskip("PIL.Image")
    image = np.cumsum(RANDOM.integers(0, 4, (40, 50, 3)), axis=1).astype(np.uint8)
    data = io.BytesIO()
    pillow.fromarray(image).save(data, "png")
    assert np.array_equal(decode_png(data.getvalue(), (50, 40)), image)
    rows = b"".join(bytes([kind]) + bytes(RANDOM.integers(0, 256, 24, np.uint8)) for kind in (4, 3, 2, 1, 0, 3))
    made = png_of(rows, (8, 6))
    expected: NDArray[np.uint8] = np.asarray(pillow.open(io.BytesIO(made)))
    assert np.array_equal(decode_png(made, (8, 6)), expected)


def png_of(rows: bytes, size: tuple[int, int], depth: int = 8, colour: int = 2) -> bytes:
    """A PNG file of filtered rows."""
    header = struct.pack(">IIBBBBB", *size, depth, colour, 0, 0, 0)
    parts = [(b"IHDR", header), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    chunks = [struct.pack(">I", len(b)) + k + b + struct.pack(">I", zlib.crc32(k + b)) for k, b in parts]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


@pytest.mark.parametrize(
    ("key", "value", "match"),
    [
        ("format", 2, "format"),
        ("format", True, "format"),
        ("size", [8, 0], "size"),
        ("size", [8, 10**9], "size"),
        ("size", [8.0, 6], "size"),
        ("size", "8x6", "size"),
        ("size", [9, 6], "8-bit RGB of 9 x 6"),
        ("spacing", {"rule": "magic", "value": 1}, "rule"),
        ("spacing", {"rule": "time", "value": -1}, "above 0"),
        ("spacing", {"rule": "time", "value": "1"}, "finite number"),
        ("spacing", {"rule": "time", "value": 1, "more": 1}, "spacing"),
        ("nodes", [], "nodes"),
        ("nodes", {}, "nodes"),
        ("nodes", [{}] * 10_001, "nodes"),
        ("nodes", [{"pose": [0, 0, 0], "time": 0, "file": "../../secret.png"}], "must have a pose and a time"),
        ("nodes", [{"pose": [0, 0], "time": 0}], "pose"),
        ("nodes", [{"pose": [0, 0, "0"], "time": 0}], "finite"),
        ("nodes", [{"pose": [0, 0, 10**400], "time": 0}], "within 1e9"),
        ("nodes", [{"pose": [0, 0, True], "time": 0}], "finite"),
        ("scene", 5, "text"),
        ("scene", "x" * 300, "text"),
        ("surprise", 1, "keys"),
    ],
)
def test_hostile_values(saved: Path, key: str, value: Any, match: str) -> None:
    file = saved / "map.json"
    contents = json.loads(file.read_text())
    contents[key] = value
    file.write_text(json.dumps(contents))
    with pytest.raises(gloam.InputError, match=match):
        TopologicalMap.load(saved)


@pytest.mark.parametrize("text", ["", "[]", "{", "null", "[" * 100_000, '{"format": NaN}', "\udcff"])
def test_hostile_json(saved: Path, text: str) -> None:
    (saved / "map.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(gloam.InputError):
        TopologicalMap.load(saved)


def test_infinite_number(saved: Path) -> None:
    text = (saved / "map.json").read_text().replace("2.25", "1e999")
    (saved / "map.json").write_text(text)
    with pytest.raises(gloam.InputError, match="finite"):
        TopologicalMap.load(saved)


@pytest.mark.parametrize(
    ("data", "match"),
    [
        (b"", "not a PNG"),
        (b"GIF89a", "not a PNG"),
        (png_of(b"\0" * 150, (8, 6))[:-6], "damaged"),
        (png_of(b"\0" * 150, (8, 6))[:40], "damaged"),
        (png_of(b"\0" * 149, (8, 6)), "too few or too many"),
        (png_of(b"\0" * 10_000_000, (8, 6)), "too few or too many"),
        (png_of(b"\5" * 150, (8, 6)), "filter"),
        (png_of(b"\0" * 54, (8, 6), 8, 0), "8-bit RGB"),
        (png_of(b"\0" * 150, (60_000, 60_000)), "8-bit RGB"),
        (png_of(b"\0" * 150, (8, 6)).replace(zlib.compress(b"\0" * 150), b"rubbish"), "damaged"),
    ],
)
def test_hostile_image(saved: Path, data: bytes, match: str) -> None:
    (saved / "000001.png").write_bytes(data)
    with pytest.raises(gloam.InputError, match=match) as raised:
        TopologicalMap.load(saved)
    assert raised.value.file.endswith("000001.png")


def test_missing_files_and_links(saved: Path, tmp_path: Path) -> None:
    (tmp_path / "other.png").write_bytes((saved / "000001.png").read_bytes())
    (saved / "000001.png").unlink()
    with pytest.raises(gloam.IoError, match="000001"):
        TopologicalMap.load(saved)
    (saved / "000001.png").symlink_to(tmp_path / "other.png")
    with pytest.raises(gloam.IoError, match="regular file"):
        TopologicalMap.load(saved)
    with pytest.raises(gloam.IoError, match="regular file"):
        TopologicalMap.load(tmp_path / "nowhere")


def test_refuses_nodes() -> None:
    with pytest.raises(ValueError, match="1 … 10000 nodes"):
        TopologicalMap([])
    with pytest.raises(ValueError, match="one size"):
        TopologicalMap([frame(0), Node(np.zeros((6, 9, 3), np.uint8), (0, 0, 0), 1)])
    with pytest.raises(ValueError, match="finite"):
        TopologicalMap([Node(frame(0).image, (0, math.nan, 0), 0)])
    with pytest.raises(ValueError, match="uint8"):
        TopologicalMap([Node(np.zeros((6, 8, 3)), (0, 0, 0), 0)])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="must not decrease"):
        build_map([frame(3), frame(2)])
    with pytest.raises(ValueError, match="nodes"):
        build_map([])
    for rule, value in (("magic", 1.0), ("time", 0.0), ("time", math.inf)):
        with pytest.raises(ValueError, match="spacing"):
            Spacing(rule, value)  # type: ignore[arg-type]
