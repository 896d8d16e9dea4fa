"""Networks by their TOML, images at their size, and converters of checkpoints."""

from __future__ import annotations

import gzip
import io
import json
import struct
import sys
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
from real_fixtures import CHANNELS, CLASSES, SIDE, picture, write_network

sys.path.append(str(Path(__file__).resolve().parents[2] / "tools" / "real"))
import checkpoint  # noqa: E402
import clip  # noqa: E402
import convert  # noqa: E402
import efficientnet  # noqa: E402

RANDOM = np.random.default_rng(2)


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
        node("Sigmoid", ["c1"], ["gate"]), node("Mul", ["layer", "gate"], ["gated"]), node("ReduceMean", ["gated"], ["m"], axes=[2, 3], keepdims=0),
        node("Gemm", ["m", "w2", "b2"], ["scores"], transB=1),
    ]  # fmt: skip
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
        node("Reshape", ["layer", "rows"], ["r"]), node("Transpose", ["r"], ["t"], perm=[0, 2, 1]), node("Concat", ["first", "t"], ["tokens"], axis=1),
        node("ReduceMean", ["tokens"], ["m"], axes=[1], keepdims=0), node("Gemm", ["m", "w2", "b2"], ["scores"], transB=1),
    ]  # fmt: skip
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
        ("size = [32, 24]", "needs images of 24 x 24, but 'size' is 32 x 24"), ('layer = "nothing"', "no tensor 'nothing' for 'layer'"),
        ('fit = "squeeze"', "'fit' must be one of crop, stretch, pad"), ("mean = [0.5, 0.5]", "'mean' needs three numbers"),
        ("deviation = [1, 0, 1]", "'deviation' must be positive"), ("size = [0, 24]", "'size' needs a width"),
        ('file = "none.onnx"', "cannot read the network"), ('file = "small.toml"', "not a network in ONNX"), ('scores = "c1"', "does not depend"),
        ('name = 3', "'name' has a value of another type"), ('classes = "none.txt"', "cannot read the names"),
    ],
)  # fmt: skip
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


def b0_state(is_lite: bool) -> dict[str, np.ndarray]:
    """Random parameters with the names of efficientnet_pytorch."""
    state: dict[str, np.ndarray] = {}

    def conv(name: str, norm: str, *shape: int) -> None:
        state[f"{name}.weight"] = RANDOM.standard_normal(shape).astype(np.float32) * (2 / np.prod(shape[1:])) ** 0.5
        for part in ("weight", "bias", "running_mean", "running_var"):
            state[f"{norm}.{part}"] = RANDOM.uniform(0.5, 1.5, shape[0]).astype(np.float32)

    conv("_conv_stem", "_bn0", 32, 3, 3, 3)
    inputs, number = 32, 0
    for expansion, outputs, count, _, kernel in efficientnet._STAGES:
        for _ in range(count):
            name, wide = f"_blocks.{number}", inputs * expansion
            if expansion > 1:
                conv(f"{name}._expand_conv", f"{name}._bn0", wide, inputs, 1, 1)
            conv(f"{name}._depthwise_conv", f"{name}._bn1", wide, 1, kernel, kernel)
            if not is_lite:
                narrow = max(1, inputs // 4)
                for part, rows, columns in (("_se_reduce", narrow, wide), ("_se_expand", wide, narrow)):
                    state[f"{name}.{part}.weight"] = RANDOM.standard_normal((rows, columns, 1, 1)).astype(np.float32) * 0.1
                    state[f"{name}.{part}.bias"] = RANDOM.standard_normal(rows).astype(np.float32) * 0.1
            conv(f"{name}._project_conv", f"{name}._bn2", outputs, wide, 1, 1)
            inputs, number = outputs, number + 1
    conv("_conv_head", "_bn1", 1280, 320, 1, 1)
    state |= {"_fc.weight": RANDOM.standard_normal((7, 1280)).astype(np.float32), "_fc.bias": np.zeros(7, np.float32)}
    return state


def safetensors(path: Path, state: dict[str, np.ndarray]) -> Path:
    header, blobs, at = {}, [], 0
    for name, value in state.items():
        data = np.ascontiguousarray(value, np.float32).tobytes()
        header[name] = {"dtype": "F32", "shape": list(value.shape), "data_offsets": [at, at + len(data)]}
        blobs.append(data)
        at += len(data)
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + b"".join(blobs))
    return path


@pytest.mark.parametrize("kind", ["efficientnet_lite0", "efficientnet_b0"])
def test_efficientnet_converts_and_runs(tmp_path: Path, kind: str) -> None:
    state = b0_state(kind == "efficientnet_lite0")
    file = safetensors(tmp_path / "a.safetensors", state)
    path = convert.convert(kind, file, tmp_path / "out", convert.Options())
    found = Network(load_settings(path))
    answer = found.run(picture(1))
    assert answer.layer.shape == (1280, 7, 7) and len(answer.features) == 1280 and answer.scores is not None and len(answer.scores) == 7
    assert np.allclose(found.gradient(answer, 3).mean((1, 2)), state["_fc.weight"][3] / 49, rtol=1e-5)
    assert "a.safetensors, SHA-256" in found.settings.note
    encoder = safetensors(tmp_path / "b.safetensors", {f"obs_encoder.{name}": value for name, value in state.items()})
    if kind == "efficientnet_b0":
        part = Network(load_settings(convert.convert(kind, encoder, tmp_path / "vint", convert.Options(prefix="obs_encoder."))))
        assert part.tail is None and np.allclose(part.run(picture(1)).features, answer.features, rtol=1e-4)
    other = "efficientnet_b0" if kind == "efficientnet_lite0" else "efficientnet_lite0"
    with pytest.raises(checkpoint.CheckpointError, match=f"not a checkpoint of {other}"):
        convert.convert(other, file, tmp_path / "no", convert.Options())
    for broken, words in (({"extra.weight": np.zeros(3)}, "1 further tensors"), ({"_bn1.bias": np.zeros(3)}, r"shape \(1280,\), got \(3,\)")):
        with pytest.raises(checkpoint.CheckpointError, match=words):
            efficientnet.build(state | broken)


def vocabulary(path: Path) -> Path:
    """A vocabulary of CLIP's layout in which "co" and "cone" are merged."""
    lines = ["#version", "n e</w>", "c o", "co ne</w>"] + [f"x{k} y" for k in range(49152 - 256 - 2 - 3)]
    with gzip.open(path, "wt", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


def test_tokens_of_labels(tmp_path: Path) -> None:
    tokenizer = clip.Tokenizer(vocabulary(tmp_path / "bpe.txt.gz"))
    start, *words, end = tokenizer.encode(" A  Cone!")
    assert (start, end) == (49406, 49407), "CLIP's numbers of its start and end"
    letter = {chr(byte): k for k, byte in enumerate([*range(33, 127)])}
    assert words == [256 + letter["a"], 512 + 2, 256 + letter["!"]]
    with pytest.raises(checkpoint.CheckpointError, match="too long"):
        tokenizer.encode("cone " * 80)
    with pytest.raises(checkpoint.CheckpointError, match="not CLIP's vocabulary"):
        clip.Tokenizer(tmp_path / "none")


def test_checkpoints_execute_nothing(tmp_path: Path) -> None:
    import pickle
    import zipfile

    class Evil:
        def __reduce__(self) -> Any:
            return (print, ("executed",))

    with zipfile.ZipFile(tmp_path / "evil.pt", "w") as archive:
        archive.writestr("a/data.pkl", pickle.dumps({"w": Evil()}, 2))
    with pytest.raises(checkpoint.CheckpointError, match="may execute code"):
        checkpoint.read_state(tmp_path / "evil.pt")
    (tmp_path / "old.pth").write_bytes(pickle.dumps(Evil(), 2))
    with pytest.raises(checkpoint.CheckpointError, match="may execute code"):
        checkpoint.read_state(tmp_path / "old.pth")
    for name, data in (("junk.pth", b"junk"), ("empty.pth", b""), ("half.safetensors", struct.pack("<Q", 90) + b'{"a"')):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(checkpoint.CheckpointError, match="not a checkpoint"):
            checkpoint.read_state(tmp_path / name)
    spoilt = safetensors(tmp_path / "nan.safetensors", {"a": np.array([np.nan])})
    with pytest.raises(checkpoint.CheckpointError, match="not finite"):
        checkpoint.read_state(spoilt)
