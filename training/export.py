"""Writes a network's layers as ONNX, and evaluates them in NumPy."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

Layers = Sequence[tuple[np.ndarray, np.ndarray]]  # weight (inputs, outputs), bias (outputs,)


def layers_of(checkpoint: Path, part: str = "actor") -> list[tuple[np.ndarray, np.ndarray]]:
    """The actor's or the critic's layers in a checkpoint of ppo.Learner, whose first leaves are bias and weight of each
    layer of the actor, then of the critic."""
    with np.load(checkpoint, allow_pickle=False) as file:
        leaves = [file[name] for name in sorted(name for name in file.files if name.startswith("leaf"))]
    layers, count = [], 0
    while leaves[2 * count].ndim == 1 and leaves[2 * count + 1].ndim == 2:
        layers.append((leaves[2 * count + 1], leaves[2 * count]))
        count += 1
    half = count // 2
    return layers[:half] if part == "actor" else layers[half:count]


def evaluate(layers: Layers, observation: np.ndarray) -> np.ndarray:
    """The network's output for (…, inputs), in f32."""
    x = observation.astype(np.float32)
    for weight, bias in layers[:-1]:
        x = x @ weight + bias
        x = np.where(x > 0, x, np.expm1(np.minimum(x, 0)))
    return x @ layers[-1][0] + layers[-1][1]


def write_onnx(layers: Layers, path: Path) -> None:
    """Input "observation" (1, n), output "action" (1, m), of Gemm and Elu. Requires the package onnx."""
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    nodes, constants, value = [], [], "observation"
    for number, (weight, bias) in enumerate(layers):
        last = number == len(layers) - 1
        constants += [numpy_helper.from_array(np.ascontiguousarray(weight, np.float32), f"weight{number}"),
                      numpy_helper.from_array(np.asarray(bias, np.float32), f"bias{number}")]  # fmt: skip
        output = "action" if last else f"linear{number}"
        nodes.append(helper.make_node("Gemm", [value, f"weight{number}", f"bias{number}"], [output]))
        value = output
        if not last:
            value = f"hidden{number}"
            nodes.append(helper.make_node("Elu", [output], [value], alpha=1.0))
    inputs = helper.make_tensor_value_info("observation", TensorProto.FLOAT, [1, layers[0][0].shape[0]])
    outputs = helper.make_tensor_value_info("action", TensorProto.FLOAT, [1, layers[-1][0].shape[1]])
    graph = helper.make_graph(nodes, "policy", [inputs], [outputs], constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], producer_name="gloam training")
    model.ir_version = 8
    onnx.checker.check_model(model)
    onnx.save(model, path)
