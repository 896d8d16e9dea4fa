"""Derivatives of the operators after a layer, against differences of ONNX's own reference implementation."""

from __future__ import annotations

from typing import Any

import gloam
import numpy as np
import pytest
from gloam.real.convolution import ALL_OPERATORS
from gloam.real.tail import Tail
from onnx import helper
from onnx.reference import ReferenceEvaluator
from real_fixtures import model_of

RANDOM = np.random.default_rng(12)
node = helper.make_node


def normal(*shape: int) -> Any:
    return RANDOM.standard_normal(shape).astype(np.float32)


IMAGE, TOKENS = (1, 4, 6, 5), (1, 7, 6)
ints = lambda *values: np.array(values, np.int64)  # noqa: E731
# (operator, shape of the layer, attributes, further inputs)
CASES: list[tuple[str, tuple[int, ...], dict[str, Any], list[Any]]] = [
    ("Add", IMAGE, {}, [normal(4, 1, 1)]), ("Sub", IMAGE, {}, [normal(1, 4, 6, 1)]), ("Mul", IMAGE, {}, [normal(6, 5)]),
    ("Div", IMAGE, {}, [normal(4, 1, 1) + 4]), ("Pow", IMAGE, {}, [np.float32(2)]), ("Neg", IMAGE, {}, []),
    ("Sqrt", IMAGE, {}, []), ("Exp", IMAGE, {}, []), ("Log", IMAGE, {}, []), ("Abs", IMAGE, {}, []), ("Erf", IMAGE, {}, []),
    ("Tanh", IMAGE, {}, []), ("Relu", IMAGE, {}, []), ("Sigmoid", IMAGE, {}, []), ("HardSigmoid", IMAGE, {"alpha": 0.3}, []),
    ("HardSwish", IMAGE, {}, []), ("LeakyRelu", IMAGE, {"alpha": 0.2}, []), ("Clip", IMAGE, {}, [np.float32(0.7), np.float32(1.6)]),
    ("Gelu", IMAGE, {}, []), ("Gelu", IMAGE, {"approximate": "tanh"}, []), ("Softmax", TOKENS, {"axis": 1}, []),
    ("MatMul", TOKENS, {}, [normal(6, 3)]), ("Gemm", (3, 4), {"transB": 1, "alpha": 0.5, "beta": 2.0}, [normal(5, 4), normal(5)]),
    ("Gemm", (3, 4), {"transA": 1}, [normal(3, 5)]),
    ("BatchNormalization", IMAGE, {}, [normal(4), normal(4), normal(4), normal(4) ** 2 + 0.5]),
    ("LayerNormalization", TOKENS, {"axis": -1}, [normal(6), normal(6)]), ("LayerNormalization", TOKENS, {"axis": 1}, [normal(7, 6)]),
    ("ReduceMean", IMAGE, {"keepdims": 0}, [ints(2, 3)]), ("ReduceSum", IMAGE, {"keepdims": 1}, [ints(1)]),
    ("ReduceL2", TOKENS, {"keepdims": 1}, [ints(-1)]), ("GlobalAveragePool", IMAGE, {}, []), ("GlobalMaxPool", IMAGE, {}, []),
    ("Reshape", IMAGE, {}, [ints(0, -1)]), ("Flatten", IMAGE, {"axis": 2}, []), ("Squeeze", TOKENS, {}, [ints(0)]),
    ("Unsqueeze", TOKENS, {}, [ints(0, 3)]), ("Transpose", TOKENS, {"perm": [2, 0, 1]}, []), ("Expand", TOKENS, {}, [ints(3, 7, 6)]),
    ("Concat", TOKENS, {"axis": 2}, [normal(1, 7, 2)]), ("Slice", TOKENS, {}, [ints(5), ints(-8), ints(1), ints(-2)]),
    ("Gather", TOKENS, {"axis": 1}, [ints(0, 3, 3)]), ("Identity", TOKENS, {}, []), ("Dropout", TOKENS, {}, []),
    ("Cast", TOKENS, {"to": 11}, []),
    ("Conv", IMAGE, {"strides": [2, 1], "pads": [1, 0, 2, 1], "dilations": [1, 2]}, [normal(3, 4, 3, 2), normal(3)]),
    ("Conv", IMAGE, {"group": 2, "auto_pad": "SAME_UPPER", "strides": [2, 2]}, [normal(6, 2, 3, 3)]),
    ("AveragePool", IMAGE, {"kernel_shape": [3, 2], "strides": [2, 2], "pads": [1, 0, 1, 1]}, []),
    ("AveragePool", IMAGE, {"kernel_shape": [2, 2], "pads": [1, 1, 0, 0], "count_include_pad": 1}, []),
    ("MaxPool", IMAGE, {"kernel_shape": [3, 3], "strides": [2, 1], "pads": [1, 1, 1, 1]}, []),
]  # fmt: skip


def check(nodes: list[Any], constants: dict[str, Any], shape: tuple[int, ...], out: tuple[int, ...]) -> None:
    """Compares scores, and the derivative of a random sum of them, with central differences."""
    model = model_of(nodes, constants, shape, out)
    # Double precision in the reference: differences of float32 would hide errors of the derivative.
    run = ReferenceEvaluator(model)
    x = RANDOM.uniform(0.3, 2.2, shape)
    wide = {name: value.astype(np.float64) if value.dtype == np.float32 else value for name, value in constants.items()}
    number = int(RANDOM.integers(np.prod(out)))
    # The reference computes the error function in single precision.
    is_rough = any(one.op_type in ("Erf", "Gelu") for one in nodes)
    step_size, tolerance = (5e-3, 2e-3) if is_rough else (1e-5, 2e-5)
    scores, gradient = Tail(model, "x", "scores").gradient(x, {}, number)

    def score(values: Any) -> Any:
        return np.asarray(run.run(None, {"x": values, **wide})[0], np.float64).ravel()

    assert np.allclose(scores, score(x), atol=1e-5 if is_rough else 1e-6)
    for place in RANDOM.permutation(x.size)[:40]:
        step = np.zeros(x.size)
        step[place] = step_size
        slope = (score(x + step.reshape(shape))[number] - score(x - step.reshape(shape))[number]) / (2 * step_size)
        assert gradient.ravel()[place] == pytest.approx(slope, abs=tolerance, rel=10 * tolerance)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case[0])
def test_derivatives(case: Any) -> None:
    kind, shape, attributes, more = case
    constants = {f"k{i}": np.asarray(value) for i, value in enumerate(more)}
    first = node(kind, ["x", *constants], ["y"], **attributes)
    y = ReferenceEvaluator(model_of([first, node("Identity", ["y"], ["scores"])], constants, shape, ("n",))).run(
        None, {"x": np.ones(shape, np.float32)}
    )[0]
    # A quadratic form after the operator: the gradient that it receives differs from place to place.
    constants |= {"weight": RANDOM.standard_normal((y.size, 3)), "row": ints(1, -1)}
    nodes = [
        first,
        node("Mul", ["y", "y"], ["square"]),
        node("Reshape", ["square", "row"], ["flat"]),
        node("MatMul", ["flat", "weight"], ["scores"]),
    ]
    check(nodes, constants, shape, (1, 3))


def test_every_operator_has_a_case() -> None:
    assert set(ALL_OPERATORS) - {kind for kind, *_ in CASES} == {"Split", "Shape"}, "these two are below"


def test_branches_add_and_shapes_are_constants() -> None:
    constants = {"parts": ints(2, 5), "row": ints(1, -1), "first": ints(0), "weight": RANDOM.standard_normal((30, 3))}
    nodes = [
        node("Split", ["x", "parts"], ["a", "b"], axis=1),
        node("Mul", ["b", "b"], ["b2"]),
        node("ReduceMean", ["b2"], ["mean"], keepdims=1),
        node("Mul", ["a", "mean"], ["scaled"]),
        node("Add", ["b", "b2"], ["sum"]),
        node("Concat", ["scaled", "sum"], ["both"], axis=1),
        node("Shape", ["x"], ["shape"]),
        node("Gather", ["shape", "first"], ["rows"]),
        node("Reshape", ["both", "row"], ["flat"]),
        node("Slice", ["flat", "zero", "thirty", "one"], ["cut"]),
        node("MatMul", ["cut", "weight"], ["scores"]),
    ]
    constants |= {"zero": ints(0), "thirty": ints(30), "one": ints(1)}
    check(nodes, constants, (1, 7, 6), (1, 3))


def test_tensors_from_before_the_layer_are_constants() -> None:
    nodes = [node("Relu", ["x"], ["layer"]), node("Neg", ["x"], ["skip"]), node("Mul", ["layer", "skip"], ["scores"])]
    tail = Tail(model_of(nodes, {}, (1, 4), (1, 4)), "layer", "scores")
    assert tail.boundary == ["skip"]
    x = np.array([[1.0, 2, 3, 4]])
    scores, gradient = tail.gradient(x, {"skip": -x}, 2)
    assert scores.tolist() == [-1, -4, -9, -16] and gradient.tolist() == [[0, 0, -3, 0]]


def test_unknown_operators_are_named() -> None:
    nodes = [node("Relu", ["x"], ["layer"]), node("Softplus", ["layer"], ["scores"], "odd")]
    with pytest.raises(gloam.UnsupportedError, match=r"operator Softplus \(node 'odd'\)"):
        Tail(model_of(nodes, {}, (1, 4), (1, 4)), "layer", "scores")
    Tail(model_of(nodes[::-1][1:] + [node("Neg", ["layer"], ["scores"])], {}, (1, 4), (1, 4)), "layer", "scores")
    with pytest.raises(gloam.InputError, match="does not depend on the layer"):
        Tail(model_of([node("Relu", ["x"], ["layer"]), node("Neg", ["x"], ["scores"])], {}, (1, 4), (1, 4)), "layer", "scores")
