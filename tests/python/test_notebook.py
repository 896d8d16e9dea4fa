"""Pictures, animations, videos and progress as notebooks show them, judged by others' decoders where there are any."""

from __future__ import annotations

import base64
import io
import re
import struct
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from gloam import notebook, progress


def chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    """Kinds and contents of a PNG's chunks; checks the signature and each check sum."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    found, at = [], 8
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + body)
        found.append((kind, body))
        at += 12 + size
    return found


def decoded(header: bytes, packed: bytes) -> NDArray[Any]:
    """The picture in a PNG whose rows all have filter 2."""
    width, height, bits, colour, *_ = struct.unpack(">IIBBBBB", header)
    channels = {0: 1, 4: 2, 2: 3, 6: 4}[colour]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels * bits // 8)
    assert (rows[:, 0] == 2).all()
    values = np.add.accumulate(rows[:, 1:], axis=0, dtype=np.uint8)
    return values.reshape(-1).view(f">u{bits // 8}").reshape(height, width, channels)


@settings(deadline=None, max_examples=50)
@given(st.integers(1, 9), st.integers(1, 9), st.integers(1, 4), st.sampled_from([np.uint8, np.uint16]), st.randoms())
def test_png_holds_the_picture(height: int, width: int, channels: int, kind: Any, random: Any) -> None:
    picture = np.random.default_rng(random.getrandbits(32)).integers(
        0, np.iinfo(kind).max, (height, width, channels), kind
    )
    found = dict(chunks(notebook.png(picture)))
    assert np.array_equal(decoded(found[b"IHDR"], found[b"IDAT"]), picture)


def test_png_of_a_strided_view_is_that_of_its_copy() -> None:
    picture = np.random.default_rng(1).integers(0, 255, (20, 30, 3), np.uint8)[::2, ::-3]
    assert notebook.png(picture) == notebook.png(picture.copy())


@pytest.mark.parametrize(
    "bad",
    [
        np.zeros((4, 4, 5), np.uint8),
        np.zeros((4, 4), np.float32),
        np.zeros(4, np.uint8),
        None,
        np.zeros((0, 4, 3), np.uint8),
    ],
)
def test_png_refuses_what_is_no_picture(bad: Any) -> None:
    with pytest.raises(ValueError):
        notebook.png(bad)


def test_animation_holds_every_picture() -> None:
    pictures = [np.full((3, 5, 3), shade, np.uint8) for shade in (0, 90, 255)]
    found = chunks(notebook.animated_png(pictures, rate=4))
    header = dict(found)[b"IHDR"]
    assert struct.unpack(">II", dict(found)[b"acTL"]) == (3, 0)
    packed = [body if kind == b"IDAT" else body[4:] for kind, body in found if kind in (b"IDAT", b"fdAT")]
    assert [int(decoded(header, part)[0, 0, 0]) for part in packed] == [0, 90, 255]
    numbers = [struct.unpack(">I", body[:4])[0] for kind, body in found if kind in (b"fcTL", b"fdAT")]
    assert numbers == list(range(5))
    delays = [struct.unpack(">HH", body[20:24]) for kind, body in found if kind == b"fcTL"]
    assert all(over / under == 0.25 for over, under in delays)


@pytest.mark.parametrize(
    "pictures, rate",
    [
        ([], 10),
        ([np.zeros((2, 2), np.uint8)], 0),
        ([np.zeros((2, 2), np.uint8)], float("nan")),
        ([np.zeros((2, 2), np.uint8), np.zeros((2, 3), np.uint8)], 1),
    ],
)
def test_animation_refuses(pictures: list[Any], rate: float) -> None:
    with pytest.raises(ValueError):
        notebook.Animation(pictures, rate)


def test_video_embeds_its_file(tmp_path: Path) -> None:
    (tmp_path / "v.mp4").write_bytes(b"some video")
    shown = notebook.Video(tmp_path / "v.mp4", width=320)._repr_html_()
    match = re.search(r"base64,([^\"]*)", shown)
    assert match and base64.b64decode(match.group(1)) == b"some video" and 'width="320"' in shown
    with pytest.raises(OSError):
        notebook.Video(tmp_path / "missing.mp4")


def test_depth_is_white_where_it_is_near() -> None:
    grey = notebook.depth_picture([[1, 2], [3, np.inf]])
    assert grey.tolist() == [[255, 128], [0, 0]]
    assert notebook.depth_picture([[np.nan, np.inf]]).tolist() == [[0, 0]]


def test_text_of_a_scene_cannot_be_markup() -> None:
    assert "<script>" not in notebook.scene_html("<script>", "name = '<script>'")


def test_bar_is_silent_at_first_then_tells_what_is_left() -> None:
    stream = io.StringIO()
    shown = progress.TerminalBar("compile", stream)
    assert shown("meshes", 0.1, 1.9) and stream.getvalue() == ""
    assert shown("meshes", 0.25, 10.0)
    assert "25 %, meshes, 30 s left" in stream.getvalue()
    shown("meshes", 0.3, 10.1)
    assert "30 %" not in stream.getvalue()  # too soon after the last
    shown.close()
    assert stream.getvalue().endswith("\r\033[K")


def test_watch_gives_no_bar_where_nobody_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with progress.watch(None, "job") as tell:
        assert tell is None
    with progress.watch(True, "job") as tell:
        assert isinstance(tell, progress.TerminalBar)
    with progress.watch(print, "job") as tell:
        assert tell is print
    with pytest.raises(TypeError), progress.watch("yes", "job"):  # type: ignore[arg-type]
        pass


def test_time_is_told_as_people_say_it() -> None:
    assert [progress.time_text(s) for s in (-1, 8.4, 125, 3780)] == ["0 s", "8 s", "2 min 05 s", "1 h 03 min"]


class FakeDisplay:
    """IPython.display.display and the handle that it gives."""

    def __init__(self) -> None:
        self.shown: list[str] = []

    def __call__(self, data: dict[str, str], **_: object) -> FakeDisplay:
        self.update(data)
        return self

    def update(self, data: dict[str, str], **_: object) -> None:
        self.shown.append(data["text/html"])


def test_bar_of_a_notebook_is_one_that_is_updated_and_taken_away() -> None:
    display = FakeDisplay()
    shown = progress.NotebookBar("compile <house>", display)
    shown("meshes", 0.0, 1.0)
    assert display.shown == []
    shown("meshes", 0.5, 4.0)
    assert 'value="0.500"' in display.shown[0] and "compile &lt;house&gt;: 50 %, meshes, 4 s left" in display.shown[0]
    shown.close()
    assert display.shown[-1] == "" and len(display.shown) == 2


def test_no_notebook_is_seen_where_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    assert progress.notebook_display() is None
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert progress.bar("job") is None
