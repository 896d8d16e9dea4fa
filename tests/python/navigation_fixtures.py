"""Small networks with the signatures of GNM and NoMaD, and maps, for tests of navigation."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from gloam.navigation import Node, TopologicalMap
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

SIZE = (85, 64)  # width, height
STEPS = np.array([[1, 0, 1, 0], [2, 0.1, 1, 0], [3, 0.3, 1, 0], [4, 0.6, 1, 0], [5, 1, 0.6, 0.8]], np.float32)


def grey_map(levels: Sequence[int]) -> TopologicalMap:
    """A map of even grey images."""
    return TopologicalMap(Node(flat(level), (0.1 * i, 0.0, 0.0), float(i)) for i, level in enumerate(levels))


def flat(level: int) -> NDArray[np.uint8]:
    """An even grey image, (64, 85, 3)."""
    return np.full((SIZE[1], SIZE[0], 3), level, np.uint8)


def write_direct(path: Path, context_size: int = 5, gain: float = 57.1, spoil: float = 1.0, outputs: int = 4) -> Path:
    """A network with the signature of gnm.onnx: dist = gain * mean |present image - goal image| (57.1 makes that the
    difference of grey levels), action = STEPS * (1 + dist) * spoil."""
    channels = 3 * (context_size + 1)
    nodes = [
        helper.make_node("Slice", ["obs_img", "start", "end", "axis"], ["present"]),
        helper.make_node("Sub", ["present", "goal_img"], ["difference"]),
        helper.make_node("Abs", ["difference"], ["size"]),
        helper.make_node("ReduceMean", ["size"], ["mean"], axes=[1, 2, 3], keepdims=0),
        helper.make_node("Mul", ["mean", "gain"], ["scaled"]),
        helper.make_node("Reshape", ["scaled", "pair"], ["dist"]),
        helper.make_node("Add", ["dist", "one"], ["more"]),
        helper.make_node("Mul", ["steps", "more"], ["moved"]),
        helper.make_node("Mul", ["moved", "spoil"], ["action"]),
    ]
    constants = {
        "start": np.array([channels - 3], np.int64),
        "end": np.array([channels], np.int64),
        "axis": np.array([1], np.int64),
        "gain": np.array(gain, np.float32),
        "pair": np.array([1, 1], np.int64),
        "one": np.array(1, np.float32),
        "steps": STEPS[None, :, :outputs],
        "spoil": np.array(spoil, np.float32),
    }
    inputs = [port("obs_img", 1, channels, 64, 85), port("goal_img", 1, 3, 64, 85)]
    return write(path, nodes, constants, inputs, [port("dist", 1, 1), port("action", 1, 5, outputs)])


def write_nomad(folder: Path) -> Path:
    """The three networks of `nomad`: embedding = mean grey of the goal less that of the present image, and the mask;
    dist = |the first|; noise = 0.9 * sample + 0.01 * timestep + 0.002 * the first."""
    images = [port("obs_img", 1, 12, 96, 96), port("goal_img", 1, 3, 96, 96), port("goal_mask", 1, kind=TensorProto.INT64)]
    axes = {"axes": [1, 2, 3], "keepdims": 0}
    nodes = [
        helper.make_node("Slice", ["obs_img", "start", "end", "axis"], ["present"]),
        helper.make_node("Sub", ["goal_img", "present"], ["difference"]),
        helper.make_node("ReduceMean", ["difference"], ["mean"], **axes),
        helper.make_node("Mul", ["mean", "gain"], ["scaled"]),
        helper.make_node("Cast", ["goal_mask"], ["mask"], to=TensorProto.FLOAT),
        helper.make_node("Concat", ["scaled", "mask"], ["both"], axis=0),
        helper.make_node("Reshape", ["both", "pair"], ["embedding"]),
    ]
    constants = {"start": np.array([9]), "end": np.array([12]), "axis": np.array([1]), "pair": np.array([1, 2])}
    write(folder / "nomad_encoder.onnx", nodes, constants | {"gain": np.float32(57.1)}, images, [port("embedding", 1, 2)])
    nodes = [
        helper.make_node("MatMul", ["embedding", "first"], ["signed"]),
        helper.make_node("Abs", ["signed"], ["dist"]),
    ]
    first = {"first": np.array([[1], [0]], np.float32)}
    write(folder / "nomad_distance.onnx", nodes, first, [port("embedding", 1, 2)], [port("dist", 1, 1)])
    nodes = [
        helper.make_node("Mul", ["sample", "share"], ["scaled"]),
        helper.make_node("Cast", ["timestep"], ["step"], to=TensorProto.FLOAT),
        helper.make_node("Mul", ["step", "rate"], ["shift"]),
        helper.make_node("Add", ["scaled", "shift"], ["shifted"]),
        helper.make_node("MatMul", ["embedding", "weight"], ["flat"]),
        helper.make_node("Reshape", ["flat", "rows"], ["row"]),
        helper.make_node("Add", ["shifted", "row"], ["noise"]),
    ]
    constants = {"share": np.float32(0.9), "rate": np.float32(0.01), "weight": np.array([[0.002], [0]], np.float32)}
    constants |= {"rows": np.array([-1, 1, 1])}
    inputs = [port("sample", "n", 8, 2), port("timestep", 1, kind=TensorProto.INT64), port("embedding", "n", 2)]
    write(folder / "nomad_noise.onnx", nodes, constants, inputs, [port("noise", "n", 8, 2)])
    return folder


def port(name: str, *shape: int | str, kind: int = TensorProto.FLOAT) -> Any:
    """An input or output."""
    return helper.make_tensor_value_info(name, kind, list(shape))


def write(path: Path, nodes: Sequence[Any], constants: dict[str, Any], inputs: list[Any], outputs: list[Any]) -> Path:
    """Writes a network."""
    initial = [numpy_helper.from_array(np.asarray(value), name) for name, value in constants.items()]
    graph = helper.make_graph(nodes, "test", inputs, outputs, initial)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model, full_check=True)
    path.write_bytes(model.SerializeToString())
    return path
