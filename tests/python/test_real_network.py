"""Networks by their TOML, and images at their size."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.real.images import UnusableImage, decode, fitted, list_images, pair_names, read_bytes, shown
from gloam.real.network import Network, load_settings
from onnx import helper
from onnx.reference import ReferenceEvaluator
from PIL import Image
from real_fixtures import CHANNELS, SIDE, picture, write_network


def network(folder: Path, text: str = "", **changed: Any) -> Network:
    """The small network with changed lines of its TOML."""
    path = write_network(folder, **changed)
    lines = path.read_text()
    for line in filter(None, text.splitlines()):
        key = line.split("=")[0].strip()
        lines = "\n".join(line if old.split("=")[0].strip() == key else old for old in lines.splitlines()) + "\n"
    path.write_text(lines)
    return Network(load_settings(path))


def test_answers_equal_the_reference(tmp_path: Path) -> None:
    found = network(tmp_path)
    image = picture(1)
    answer = found.run(image)
    resized = Image.fromarray(image).resize((SIDE, SIDE), Image.Resampling.BICUBIC)
    x = ((np.asarray(resized) / 255 - [0.5, 0.4, 0.3]) / [0.2, 0.25, 0.3]).transpose(2, 0, 1)[None].astype(np.float32)
    scores, features = ReferenceEvaluator(str(tmp_path / "small.onnx")).run(None, {"image": x})
    assert np.allclose(answer.scores, scores[0], atol=1e-5) and np.allclose(answer.features, features[0], atol=1e-5)
    assert answer.layer.shape == (CHANNELS, 6, 6) and np.allclose(answer.layer.mean((1, 2)), features[0], atol=1e-5)
    assert found.class_name(0) == "cone" and found.class_name(400) == "class 400"
    swapped = network(tmp_path / "bgr", 'size = [24, 24]\nfit = "stretch"').prepare(image)
    assert np.allclose(swapped, x)


def test_gradients_through_a_head_that_reads_earlier_tensors(tmp_path: Path) -> None:
    """scores = W · mean(layer * sigmoid(c1)), where c1 comes from before the layer."""
    node = helper.make_node
    head = [
        node("Sigmoid", ["c1"], ["gate"]),
        node("Mul", ["layer", "gate"], ["gated"]),
        node("ReduceMean", ["gated"], ["m"], axes=[2, 3], keepdims=0),
        node("Gemm", ["m", "w2", "b2"], ["scores"], transB=1),
    ]
    found = network(tmp_path, head=head)
    answer = found.run(picture(4))
    gate = answer.raw["gate"] if "gate" in answer.raw else 1 / (1 + np.exp(-answer.raw["c1"]))
    import onnx

    weights = {one.name: onnx.numpy_helper.to_array(one) for one in onnx.load(tmp_path / "small.onnx").graph.initializer}["w2"]
    assert np.allclose(found.gradient(answer, 2), weights[2][:, None, None] * gate[0] / 36, atol=1e-6)


def test_tokens_become_a_grid(tmp_path: Path) -> None:
    node = helper.make_node
    rows = np.array([1, CHANNELS, 36], np.int64)
    head = [
        node("Reshape", ["layer", "rows"], ["r"]),
        node("Transpose", ["r"], ["t"], perm=[0, 2, 1]),
        node("Concat", ["first", "t"], ["tokens"], axis=1),
        node("ReduceMean", ["tokens"], ["m"], axes=[1], keepdims=0),
        node("Gemm", ["m", "w2", "b2"], ["scores"], transB=1),
    ]
    first = np.zeros((1, 1, CHANNELS), np.float32)
    path = write_network(tmp_path, head=head, rows=rows, first=first)
    path.write_text(path.read_text().replace('layer = "layer"', 'layer = "tokens"\ntokens = 1'))
    found = Network(load_settings(path))
    answer = found.run(picture(3))
    assert answer.layer.shape == (CHANNELS, 6, 6) and found.gradient(answer, 1).shape == (CHANNELS, 6, 6)
    assert np.allclose(answer.layer.mean((1, 2)), answer.features, atol=1e-5), "in the order of rows"
    path.write_text(path.read_text().replace("tokens = 1", "tokens = 2"))
    with pytest.raises(gloam.InputError, match="2 tokens and a grid"):
        Network(load_settings(path)).run(picture(3))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("size = [32, 24]", "needs images of 24 x 24, but 'size' is 32 x 24"),
        ('layer = "nothing"', "no tensor 'nothing' for 'layer'"),
        ('fit = "squeeze"', "'fit' must be one of crop, stretch, pad"),
        ("mean = [0.5, 0.5]", "'mean' needs three numbers"),
        ("deviation = [1, 0, 1]", "'deviation' must be positive"),
        ("size = [0, 24]", "'size' needs a width"),
        ('file = "none.onnx"', "cannot read the network"),
        ('file = "small.toml"', "not a network in ONNX"),
        ('scores = "c1"', "does not depend"),
        ("name = 3", "'name' has a value of another type"),
        ('classes = "none.txt"', "cannot read the names"),
    ],
)
def test_wrong_settings(tmp_path: Path, line: str, words: str) -> None:
    with pytest.raises((gloam.InputError, gloam.IoError), match=words):
        network(tmp_path, line)


def test_wrong_files(tmp_path: Path) -> None:
    path = write_network(tmp_path)
    path.write_text(path.read_text() + "colour = 1\n")
    with pytest.raises(gloam.InputError, match="unknown key 'colour'"):
        load_settings(path)
    path.write_text("name = ")
    with pytest.raises(gloam.InputError, match="not valid TOML"):
        load_settings(path)
    path.write_text("name = 'a'")
    with pytest.raises(gloam.InputError, match=r"\[output\] needs 'layer'"):
        load_settings(path)
    with pytest.raises(gloam.IoError, match="cannot read"):
        load_settings(tmp_path / "none.toml")


def test_images_at_the_size_of_a_network() -> None:
    image = picture(1, (80, 40))
    assert np.array_equal(fitted(image, (40, 40), "crop"), image[:, 20:60]), "the middle at its own scale"
    padded = fitted(image, (80, 80), "pad")
    assert np.array_equal(padded[20:60], image) and not padded[:20].any() and not padded[60:].any()
    assert fitted(image, (33, 21), "stretch").shape == (21, 33, 3)
    assert fitted(picture(1, (16, 400)), (24, 24), "crop").shape == (24, 24, 3)


def encoded(image: Any, kind: str = "PNG", **options: Any) -> bytes:
    memory = io.BytesIO()
    image.save(memory, kind, **options)
    return memory.getvalue()


def test_kinds_of_image_files() -> None:
    grey = Image.fromarray(np.arange(400, dtype=np.uint8).reshape(20, 20))
    assert np.array_equal(decode(encoded(grey))[..., 1], np.asarray(grey))
    deep = Image.fromarray((np.arange(400).reshape(20, 20) * 150).astype(np.uint16))
    assert np.array_equal(decode(encoded(deep))[..., 0], (np.arange(400).reshape(20, 20) * 150) >> 8)
    clear = Image.new("RGBA", (20, 20), (200, 100, 50, 128))
    assert decode(encoded(clear))[0, 0].tolist() == pytest.approx([100, 50, 25], abs=1)
    turned = Image.new("RGB", (40, 20))
    exif = turned.getexif()
    exif[0x0112] = 6
    assert decode(encoded(turned, "JPEG", exif=exif)).shape == (40, 20, 3), "upright"
    with pytest.raises(UnusableImage, match="floating-point"):
        decode(encoded(Image.fromarray(np.ones((20, 20), np.float32)), "TIFF"))
    with pytest.raises(UnusableImage, match="not an image"):
        decode(encoded(Image.new("RGB", (20, 20)), "GIF")[:50])


def test_names_of_files(tmp_path: Path) -> None:
    assert shown("a\nb\x1b[31m\udcff") == "a\ufffdb\ufffd[31m\ufffd"
    (tmp_path / "deep" / "er").mkdir(parents=True)
    for name in ("deep/er/a.PNG", "b.jpeg", ".hidden.png", "c.txt"):
        (tmp_path / name).write_bytes(b"")
    assert list_images(tmp_path).names == ("b.jpeg", "deep/er/a.PNG")
    assert pair_names(["x/1.png", "2.png"], ["x/1.jpg", "3.png"]) == {"x/1.png": "x/1.jpg"}
    with pytest.raises(UnusableImage, match="cannot be read"):
        read_bytes(tmp_path / "none.png")
