"""Small networks and images for the tests of gloam.real. No photograph is stored: real and simulated images are synthetic."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from navigation_fixtures import port, write
from onnx import helper
from PIL import Image

CLASSES, CHANNELS, SIDE = 5, 8, 24
TOML = """name = "{name}"
file = "{name}.onnx"
classes = "classes.txt"
[input]
size = [{side}, {side}]
fit = "stretch"
mean = [0.5, 0.4, 0.3]
deviation = [0.2, 0.25, 0.3]
[output]
layer = "layer"
features = "features"
scores = "scores"
"""


def write_network(folder: Path, seed: int = 3, name: str = "small", head: Sequence[Any] | None = None, **constants: Any) -> Path:
    """A convolutional classifier of five classes with its TOML: convolution, ReLU ("layer"), then global mean ("features") and a
    linear layer, or the operators of `head` from "layer" to "scores"."""
    random = np.random.default_rng(seed)
    values: dict[str, Any] = {
        "w1": random.standard_normal((CHANNELS, 3, 3, 3)).astype(np.float32) * 0.4,
        "b1": random.standard_normal(CHANNELS).astype(np.float32) * 0.1,
        "w2": random.standard_normal((CLASSES, CHANNELS)).astype(np.float32),
        "b2": random.standard_normal(CLASSES).astype(np.float32),
    }
    nodes = [
        helper.make_node("Conv", ["image", "w1", "b1"], ["c1"], strides=[4, 4], pads=[1, 1, 1, 1]),
        helper.make_node("Relu", ["c1"], ["layer"]),
        helper.make_node("GlobalAveragePool", ["layer"], ["pooled"]),
        helper.make_node("Flatten", ["pooled"], ["features"]),
    ]
    nodes += head or [helper.make_node("Gemm", ["features", "w2", "b2"], ["scores"], transB=1)]
    values |= constants
    outputs = [port("scores", 1, CLASSES), port("features", 1, CHANNELS)]
    folder.mkdir(parents=True, exist_ok=True)
    used = {one for node in nodes for one in node.input}
    kept = {key: value for key, value in values.items() if key in used}
    write(folder / f"{name}.onnx", nodes, kept, [port("image", 1, 3, SIDE, SIDE)], outputs)
    (folder / "classes.txt").write_text("cone\nbed\ndoor\nwindow\n<b>plant</b>\n")
    path = folder / f"{name}.toml"
    path.write_text(TOML.format(name=name, side=SIDE))
    return path


def picture(seed: int, size: tuple[int, int] = (64, 48), noise: float = 4.0, brightness: float = 0.0) -> np.ndarray:
    """Coloured blobs on a gradient with noise, (h, w, 3) uint8. size: width, height; noise, brightness: grey levels."""
    random = np.random.default_rng(seed)
    width, height = size
    rough = random.uniform(0, 255, (4, 4, 3))
    image = np.asarray(Image.fromarray(rough.astype(np.uint8)).resize(size, Image.Resampling.BICUBIC), float)
    x = np.linspace(-20, 20, width)[None, :, None]
    image = 0.7 * image + x + 30 + brightness + noise * random.standard_normal((height, width, 3))
    return np.clip(image, 0, 255).round().astype(np.uint8)


def write_set(folder: Path, count: int, seed: int = 0, **options: Any) -> Path:
    """A folder of PNG images 000.png … from consecutive seeds."""
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(count):
        Image.fromarray(picture(seed + k, **options)).save(folder / f"{k:03}.png")
    return folder


def model_of(nodes: Sequence[Any], constants: dict[str, Any], shape: tuple[int, ...], out: tuple[int, ...]) -> Any:
    """An ONNX model from "x" to "scores"."""
    initial = [onnx.numpy_helper.from_array(np.asarray(value), name) for name, value in constants.items()]
    graph = helper.make_graph(nodes, "test", [port("x", *shape)], [port("scores", *out)], initial)
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 20)], ir_version=9)
