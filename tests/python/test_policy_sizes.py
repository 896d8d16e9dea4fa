"""ONNX files that ask for more memory than a policy needs are refused before any is taken."""

from __future__ import annotations

import resource
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("openvino")
onnx = pytest.importorskip("onnx")
from gloam.errors import Error, InputError, UnsupportedError  # noqa: E402
from gloam.policy import Policy  # noqa: E402
from onnx import TensorProto, helper, numpy_helper  # noqa: E402

from policy_fixtures import POLICY, write_settings  # noqa: E402

HUGE = 1 << 40


def save(path: Path, nodes: Sequence[Any], tensors: Sequence[Any] = (), width: int = 4) -> Path:
    """A network obs (1, width) -> actions (1, 2) of these operations; serialized as it is, without onnx's checks."""
    ports = [helper.make_tensor_value_info("obs", TensorProto.FLOAT, ["batch", width])]
    result = helper.make_tensor_value_info("actions", TensorProto.FLOAT, ["batch", 2])
    graph = helper.make_graph(list(nodes), "g", ports, [result], list(tensors))
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
    model.ir_version = 8
    path.write_bytes(model.SerializeToString())
    return path


def load(path: Path) -> Policy:
    term = '[[observation]]\nterm = "last_action"\nhistory = 2\n'
    return Policy(path, write_settings(path.parent, POLICY + term))


def weights() -> Any:
    return numpy_helper.from_array(np.ones((4, 2), np.float32), "w")


def claimed(name: str, dims: Sequence[int]) -> Any:
    """A tensor that says how large it is and holds nothing."""
    tensor = TensorProto()
    tensor.name, tensor.data_type = name, TensorProto.FLOAT
    tensor.dims.extend(dims)
    return tensor


LAST = helper.make_node("MatMul", ["obs", "w"], ["actions"])


def declared(path: Path) -> Path:
    return save(path, [LAST], [weights(), claimed("big", [HUGE, 4])])


def many(path: Path) -> Path:
    return save(path, [LAST], [weights(), *(claimed(f"part{i}", [1 << 22]) for i in range(40))])


def overflow(path: Path) -> Path:
    return save(path, [LAST], [weights(), claimed("big", [1 << 32, 1 << 32])])


def negative(path: Path) -> Path:
    return save(path, [LAST], [weights(), claimed("odd", [-5, 3])])


def wide_input(path: Path) -> Path:
    return save(path, [LAST], [weights()], width=HUGE)


def constant_of_shape(path: Path) -> Path:
    nodes = [
        helper.make_node("ConstantOfShape", ["size"], ["zeros"]),
        helper.make_node("ReduceSum", ["zeros"], ["sum"], keepdims=0),
        helper.make_node("MatMul", ["obs", "w"], ["y"]),
        helper.make_node("Add", ["y", "sum"], ["actions"]),
    ]
    size = numpy_helper.from_array(np.array([1 << 20, 1 << 14], np.int64), "size")
    return save(path, nodes, [weights(), size])


def expand(path: Path) -> Path:
    nodes = [
        helper.make_node("MatMul", ["obs", "w"], ["y"]),
        helper.make_node("Expand", ["y", "size"], ["many"]),
        helper.make_node("ReduceMax", ["many"], ["actions"], axes=[0], keepdims=0),
    ]
    size = numpy_helper.from_array(np.array([1 << 30, 1, 2], np.int64), "size")
    return save(path, nodes, [weights(), size])


def constant_node(path: Path) -> Path:
    nodes = [helper.make_node("Constant", [], ["big"], value=claimed("big", [HUGE])), LAST]
    return save(path, nodes, [weights()])


def inner_graph(path: Path) -> Path:
    out = helper.make_tensor_value_info("z", TensorProto.FLOAT, [1])
    inner = helper.make_graph(
        [helper.make_node("Identity", ["big"], ["z"])], "inner", [], [out], [claimed("big", [HUGE])]
    )
    nodes = [helper.make_node("If", ["c"], ["q"], then_branch=inner, else_branch=inner), LAST]
    return save(path, nodes, [weights(), numpy_helper.from_array(np.array(True), "c")])


@pytest.mark.parametrize(
    "write, says",
    [
        (declared, "tensor 'big' of size .* MiB"),
        (many, "the tensors before it would take"),
        (overflow, "tensor 'big' of size"),
        (negative, "negative size"),
        (wide_input, "tensor 'obs' of size"),
        (constant_of_shape, "operations would take over 256 MiB"),
        (expand, "operations would take over 256 MiB"),
        (constant_node, "tensor 'big' of size"),
        (inner_graph, "tensor 'big' of size"),
    ],
)
def test_bombs_are_refused_before_memory_is_taken(tmp_path: Path, write: Callable[[Path], Path], says: str) -> None:
    path = write(tmp_path / "p.onnx")
    assert path.stat().st_size < 1 << 16
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(InputError, match=says) as caught:
        load(path)
    assert str(path) in str(caught.value)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before  # [KiB]
    assert grown < 200 << 10


def test_loops_are_refused(tmp_path: Path) -> None:
    out = helper.make_tensor_value_info("keep", TensorProto.BOOL, [])
    body = helper.make_graph([], "body", [], [out])
    path = save(tmp_path / "p.onnx", [helper.make_node("Loop", ["n", "c"], ["z"], body=body), LAST], [weights()])
    with pytest.raises(UnsupportedError, match="has a Loop"):
        load(path)


def test_weights_outside_of_the_folder_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "policy"
    folder.mkdir()
    (tmp_path / "secret.bin").write_bytes(bytes(32))
    for location in ("../secret.bin", str(tmp_path / "secret.bin"), "missing.bin"):
        tensor = claimed("w", [4, 2])
        tensor.data_location = TensorProto.EXTERNAL
        entry = tensor.external_data.add()
        entry.key, entry.value = "location", location
        with pytest.raises(InputError, match="outside the network's folder"):
            load(save(folder / "p.onnx", [LAST], [tensor]))


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    whole = save(tmp_path / "p.onnx", [LAST], [weights()]).read_bytes()
    for cut in range(1, len(whole), 7):
        path = tmp_path / "cut.onnx"
        path.write_bytes(whole[:cut])
        with pytest.raises(Error):
            load(path)


def test_networks_of_a_usual_size_are_taken(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    sizes = [4, 512, 256, 128, 2]
    nodes, tensors, last = [], [], "obs"
    for i, (rows, columns) in enumerate(zip(sizes, sizes[1:], strict=False)):
        tensors.append(numpy_helper.from_array(rng.normal(size=(rows, columns)).astype(np.float32) / 16, f"w{i}"))
        out = "actions" if i == len(sizes) - 2 else f"h{i}"
        nodes.append(helper.make_node("MatMul", [last, f"w{i}"], [out]))
        last = out
    policy = load(save(tmp_path / "p.onnx", nodes, tensors))
    assert policy.spec.networks[0].inputs == {"obs": 4} and policy.spec.networks[0].outputs == {"actions": 2}
    expected = np.ones(4, np.float32)
    for tensor in tensors:
        expected = expected @ numpy_helper.to_array(tensor)
    assert policy.infer(np.ones(4, np.float32)) == pytest.approx(expected, rel=1e-4)
