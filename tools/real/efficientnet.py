"""EfficientNet-B0 and -Lite0 as ONNX from a state dict with the names of efficientnet_pytorch or of torchvision."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from checkpoint import CheckpointError, State
from graph import Graph

# (expansion, channels, repetitions, stride, kernel): Tan and Le 2019, table 1
_STAGES = ((1, 16, 1, 1, 3), (6, 24, 2, 2, 3), (6, 40, 2, 2, 5), (6, 80, 3, 2, 3), (6, 112, 3, 1, 5), (6, 192, 4, 2, 5), (6, 320, 1, 1, 3))
SIZE = 224
LAYER, FEATURES, SCORES = "layer", "features", "scores"
_MOST_SHOWN = 8


@dataclass(frozen=True)
class _Flavour:
    """is_lite: without squeeze and excitation, ReLU6 in place of swish; is_torchvision: equal padding on both sides and another
    constant in the normalisation."""

    is_lite: bool
    is_torchvision: bool

    def padding(self, kernel: int, stride: int) -> list[int]:
        """Top, left, bottom, right. efficientnet_pytorch pads for images of 224 px: the larger half to the right and below."""
        if self.is_torchvision:
            return [(kernel - 1) // 2] * 4
        missing = kernel - stride
        return [missing // 2] * 2 + [missing - missing // 2] * 2

    @property
    def epsilon(self) -> float:
        return 1e-5 if self.is_torchvision else 1e-3


class _Builder:
    def __init__(self, state: State, flavour: _Flavour) -> None:
        self.graph, self.state, self.flavour = Graph(), state, flavour
        self.used: set[str] = set()

    def tensor(self, name: str, *shape: int) -> np.ndarray:
        if name not in self.state:
            raise CheckpointError(f"the checkpoint has no tensor '{name}'")
        if self.state[name].shape != shape:
            raise CheckpointError(f"'{name}' must have the shape {shape}, got {self.state[name].shape}")
        self.used.add(name)
        return self.state[name].astype(np.float64)

    def conv_norm(self, x: str, conv: str, norm: str, shape: tuple[int, int, int], stride: int = 1, groups: int = 1) -> str:
        """A convolution with its normalisation folded in. shape: outputs, inputs of a group, kernel."""
        out, _, kernel = shape
        weight = self.tensor(f"{conv}.weight", *shape, kernel)
        gain, bias, mean, variance = (self.tensor(f"{norm}.{part}", out) for part in ("weight", "bias", "running_mean", "running_var"))
        self.used.add(f"{norm}.num_batches_tracked")
        scale = gain / np.sqrt(variance + self.flavour.epsilon)
        names = self.graph.floats(weight * scale[:, None, None, None]), self.graph.floats(bias - mean * scale)
        return self.graph.add("Conv", x, *names, strides=[stride] * 2, pads=self.flavour.padding(kernel, stride), group=groups)

    def act(self, x: str, name: str = "") -> str:
        if self.flavour.is_lite:
            return self.graph.add("Clip", x, self.graph.floats(0), self.graph.floats(6), name=name)
        return self.graph.add("Mul", x, self.graph.add("Sigmoid", x), name=name)

    def excited(self, x: str, block: str, wide: int, narrow: int) -> str:
        """Squeeze and excitation."""
        y = self.graph.add("GlobalAveragePool", x)
        for part, shape in (("_se_reduce", (narrow, wide)), ("_se_expand", (wide, narrow))):
            weight = self.graph.floats(self.tensor(f"{block}.{part}.weight", *shape, 1, 1))
            y = self.graph.add("Conv", y, weight, self.graph.floats(self.tensor(f"{block}.{part}.bias", shape[0])))
            y = self.act(y) if part == "_se_reduce" else self.graph.add("Sigmoid", y)
        return self.graph.add("Mul", x, y)

    def block(self, x: str, number: int, inputs: int, row: tuple[int, int, int, int]) -> str:
        """An inverted residual. row: expansion, outputs, stride, kernel."""
        expansion, outputs, stride, kernel = row
        name, wide, y = f"_blocks.{number}", inputs * expansion, x
        if expansion != 1:
            y = self.act(self.conv_norm(y, f"{name}._expand_conv", f"{name}._bn0", (wide, inputs, 1)))
        y = self.act(self.conv_norm(y, f"{name}._depthwise_conv", f"{name}._bn1", (wide, 1, kernel), stride, wide))
        if not self.flavour.is_lite:
            y = self.excited(y, name, wide, max(1, inputs // 4))
        y = self.conv_norm(y, f"{name}._project_conv", f"{name}._bn2", (outputs, wide, 1))
        return self.graph.add("Add", x, y) if stride == 1 and inputs == outputs else y


def build(state: State, prefix: str = "", size: tuple[int, int] = (SIZE, SIZE)) -> tuple[Any, bool]:
    """The model with outputs LAYER, FEATURES and, if the checkpoint has a classifier that fits, SCORES. Returns it and whether it
    has scores.

    prefix: of the names, such as "obs_encoder." in a checkpoint of ViNT; size: width, height. Errors: CheckpointError.
    """
    mine = {name.removeprefix(prefix): value for name, value in state.items() if name.startswith(prefix)}
    if not mine:
        raise CheckpointError(f"no tensor's name begins with '{prefix}'")
    is_torchvision = "features.0.0.weight" in mine
    if is_torchvision:
        mine = {_renamed(name): value for name, value in mine.items()}
    builder = _Builder(mine, _Flavour("_blocks.0._se_reduce.weight" not in mine, is_torchvision))
    x = builder.act(builder.conv_norm("image", "_conv_stem", "_bn0", (32, 3, 3), 2))
    inputs, number = 32, 0
    for expansion, outputs, count, stride, kernel in _STAGES:
        for i in range(count):
            x = builder.block(x, number, inputs, (expansion, outputs, stride if i == 0 else 1, kernel))
            inputs, number = outputs, number + 1
    x = builder.act(builder.conv_norm(x, "_conv_head", "_bn1", (1280, inputs, 1)), LAYER)
    x = builder.graph.add("Flatten", builder.graph.add("GlobalAveragePool", x), name=FEATURES)
    outputs_of: dict[str, tuple[int, ...]] = {LAYER: (1, 1280, -(-size[1] // 32), -(-size[0] // 32)), FEATURES: (1, 1280)}
    # The encoder of ViNT keeps an unused classifier of 1000 classes that was never trained with it.
    has_scores = "_fc.weight" in mine and not prefix
    if has_scores:
        classes = mine["_fc.weight"].shape[0]
        weight, bias = builder.tensor("_fc.weight", classes, 1280), builder.tensor("_fc.bias", classes)
        builder.graph.add("Gemm", x, builder.graph.floats(weight), builder.graph.floats(bias), name=SCORES, transB=1)
        outputs_of[SCORES] = (1, classes)
    unused = [name for name in mine if name not in builder.used and not name.startswith("_fc.")]
    if unused:
        raise CheckpointError(f"the checkpoint has {len(unused)} further tensors, such as {', '.join(unused[:_MOST_SHOWN])}")
    return builder.graph.model({"image": (1, 3, size[1], size[0])}, outputs_of), has_scores


def _renamed(name: str) -> str:
    """A name of torchvision as efficientnet_pytorch has it; others unchanged."""
    heads = {
        "features.0.0": "_conv_stem",
        "features.0.1": "_bn0",
        "features.8.0": "_conv_head",
        "features.8.1": "_bn1",
        "classifier.1": "_fc",
    }
    for theirs, ours in heads.items():
        if name.startswith(theirs + "."):
            return ours + name.removeprefix(theirs)
    match = re.fullmatch(r"features\.([1-7])\.(\d)\.block\.(\d)\.(0|1|fc1|fc2)\.(\w+)", name)
    if not match:
        return name
    stage, place, step = int(match[1]) - 1, int(match[2]), int(match[3])
    step += _STAGES[stage][0] == 1  # the first stage has no expansion
    parts = (("_expand_conv", "_bn0"), ("_depthwise_conv", "_bn1"), ("_se_reduce", "_se_expand"), ("_project_conv", "_bn2"))
    number = sum(row[2] for row in _STAGES[:stage]) + place
    return f"_blocks.{number}.{parts[step][match[4] in ('1', 'fc2')]}.{match[5]}"
