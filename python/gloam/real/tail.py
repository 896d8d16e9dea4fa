"""The tail of a network, from a layer to its scores: exact gradients for Grad-CAM without a framework for learning.

The network runs as usual and returns the layer; the tail, which is short, is evaluated again in double precision in NumPy, forwards
and backwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import gloam

from .convolution import ALL_OPERATORS
from .operators import Array, Attributes, Pull, sum_of


class Tail:
    """Operators of an ONNX graph between two of its tensors.

    boundary: names of other tensors that it reads, which come from before the layer.
    """

    def __init__(self, model: Any, layer: str, scores: str) -> None:
        """model: onnx.ModelProto. Errors: InputError if the scores do not depend on the layer; UnsupportedError for an
        operator without a derivative, with its name."""
        from onnx import numpy_helper

        self.layer, self.scores = layer, scores
        graph = model.graph
        self._constants: dict[str, Array] = {one.name: numpy_helper.to_array(one) for one in graph.initializer}
        for node in graph.node:
            if node.op_type == "Constant":
                self._constants[node.output[0]] = np.asarray(next(iter(_attributes(node).values())))
        self._nodes = self._between(graph.node)
        if not self._nodes:
            raise gloam.InputError(f"output '{scores}' does not depend on the layer '{layer}'")
        made = {name for node in self._nodes for name in node.output}
        read = dict.fromkeys(name for node in self._nodes for name in node.input if name)
        self.boundary = [name for name in read if name not in made and name not in self._constants and name != layer]
        for node in self._nodes:
            if node.op_type not in ALL_OPERATORS or node.domain not in ("", "ai.onnx"):
                raise gloam.UnsupportedError(
                    f"Grad-CAM has no derivative of the operator {node.op_type} (node '{node.name}') between '{layer}' and '{scores}'",
                    hint="choose a layer closer to the output",
                )

    def _between(self, nodes: Any) -> list[Any]:
        """Nodes that depend on the layer and on which the scores depend, in order."""
        after, below = {self.layer}, []
        for node in nodes:
            if after & set(node.input) and self.layer not in node.output:
                below.append(node)
                after |= set(node.output)
        needed, chosen = {self.scores}, []
        for node in reversed(below):
            if needed & set(node.output):
                chosen.append(node)
                needed |= set(node.input)
        return chosen[::-1]

    def gradient(self, layer: Array, boundary: dict[str, Array], number: int) -> tuple[Array, Array]:
        """The scores, (classes,), and the derivative of the score of class `number` by the layer, in its shape.

        layer, boundary: values of one image. Errors: ValueError if a shape does not fit.
        """
        values: dict[str, Array] = {**self._constants, **boundary, self.layer: layer}
        values = {name: value.astype(np.float64) if value.dtype.kind == "f" else value for name, value in values.items()}
        pulls: list[tuple[Any, Pull]] = []
        for node in self._nodes:
            inputs = [values[name] if name else np.zeros(0) for name in node.input]
            outputs, pull = ALL_OPERATORS[node.op_type](_attributes(node) | {"outputs": len(node.output)}, inputs)
            values |= zip(node.output, outputs, strict=False)  # optional outputs of layers for training are not computed
            pulls.append((node, pull))
        scores = values[self.scores]
        seed = np.zeros(scores.shape)
        seed.reshape(-1)[number] = 1.0
        collected: dict[str, list[Array]] = {self.scores: [seed]}
        for node, pull in reversed(pulls):
            present = [name for name in node.output if name in values]
            if not any(name in collected for name in present):
                continue
            gradients = [sum_of(collected[name]) if name in collected else np.zeros(values[name].shape) for name in present]
            for name, gradient in zip(node.input, pull(gradients), strict=True):
                if gradient is not None and name:
                    collected.setdefault(name, []).append(gradient)
        found = collected.get(self.layer)
        return scores.reshape(-1), np.zeros(layer.shape) if found is None else sum_of(found)


def _attributes(node: Any) -> Attributes:
    from onnx import helper, numpy_helper

    found: Attributes = {}
    for one in node.attribute:
        value = helper.get_attribute_value(one)
        if one.type == 4:  # a tensor
            value = numpy_helper.to_array(value)
        found[one.name] = value.decode() if isinstance(value, bytes) else value
    return found
