"""Builds an ONNX graph operator by operator."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

OPSET = 17


class Graph:
    """Operators in order; tensors are named by them, or by `name`."""

    def __init__(self) -> None:
        self._nodes: list[Any] = []
        self._constants: list[Any] = []

    def constant(self, value: Any) -> str:
        """Name of a constant tensor."""
        name = f"constant_{len(self._constants)}"
        self._constants.append(numpy_helper.from_array(np.asarray(value, order="C"), name))
        return name

    def floats(self, value: Any) -> str:
        """Name of a constant of float32."""
        return self.constant(np.asarray(value, np.float32))

    def add(self, kind: str, *inputs: str, name: str = "", **attributes: Any) -> str:
        """Adds an operator. Returns the name of its output."""
        output = name or f"{kind.lower()}_{len(self._nodes)}"
        self._nodes.append(helper.make_node(kind, list(inputs), [output], output, **attributes))
        return output

    def model(self, inputs: dict[str, tuple[int, ...]], outputs: dict[str, tuple[int, ...]]) -> Any:
        """The checked model of float32 inputs and outputs."""
        ports = [[helper.make_tensor_value_info(n, TensorProto.FLOAT, shape) for n, shape in of.items()] for of in (inputs, outputs)]
        graph = helper.make_graph(self._nodes, "gloam", *ports, self._constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8, producer_name="gloam")
        onnx.checker.check_model(model, full_check=True)
        return model


def save(model: Any, path: Path) -> None:
    """Writes a file that gets its name when it is complete."""
    part = path.with_name(f".{path.name}.part")
    part.write_bytes(model.SerializeToString())
    part.replace(path)
