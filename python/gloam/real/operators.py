"""Operators of ONNX in NumPy with their derivatives, for the last part of a network (tail.py).

An operator maps (attributes, inputs) to its outputs and a function that maps their gradients to gradients of the inputs: a list with
None where an input has no gradient. Arrays are double precision.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Attributes = dict[str, Any]
Pull = Callable[[list[Array]], list[Array | None]]
Result = tuple[list[Array], Pull]
Operator = Callable[[Attributes, list[Array]], Result]


def reduced(gradient: Array, shape: tuple[int, ...]) -> Array:
    """The gradient of an operand that was broadcast."""
    extra = gradient.ndim - len(shape)
    axes = tuple(range(extra)) + tuple(i + extra for i, size in enumerate(shape) if size == 1 and gradient.shape[i + extra] != 1)
    return np.asarray(gradient.sum(axis=axes).reshape(shape)) if axes else gradient


def one(value: Array, pull: Callable[[Array], list[Array | None]]) -> Result:
    return [value], lambda gradients: pull(gradients[0])


def _binary(
    value: Callable[[Array, Array], Array], left: Callable[[Array, Array, Array], Array], right: Callable[[Array, Array, Array], Array]
) -> Operator:
    """left, right: gradients of the operands from (gradient, a, b), before broadcasting is undone."""

    def run(_: Attributes, x: list[Array]) -> Result:
        a, b = x
        return one(value(a, b), lambda g: [reduced(left(g, a, b), a.shape), reduced(right(g, a, b), b.shape)])

    return run


def _unary(value: Callable[[Array], Array], slope: Callable[[Array, Array], Array]) -> Operator:
    """slope: derivative from (input, output)."""

    def run(_: Attributes, x: list[Array]) -> Result:
        y = value(x[0])
        return one(y, lambda g: [g * slope(x[0], y)])

    return run


def _sigmoid(x: Array) -> Array:
    return np.asarray(0.5 * (1 + np.tanh(0.5 * x)))  # does not overflow


_erf = np.vectorize(math.erf, otypes=[float])


def _gelu(attributes: Attributes, x: list[Array]) -> Result:
    a = x[0]
    if attributes.get("approximate", "none") == "tanh":
        c = math.sqrt(2 / math.pi)
        t = np.tanh(c * (a + 0.044715 * a**3))
        slope = 0.5 * (1 + t) + 0.5 * a * (1 - t * t) * c * (1 + 3 * 0.044715 * a**2)
        return one(0.5 * a * (1 + t), lambda g: [g * slope])
    phi = 0.5 * (1 + _erf(a / math.sqrt(2)))
    slope = phi + a * np.exp(-0.5 * a * a) / math.sqrt(2 * math.pi)
    return one(a * phi, lambda g: [g * slope])


def _leaky_relu(attributes: Attributes, x: list[Array]) -> Result:
    slope = np.where(x[0] > 0, 1.0, attributes.get("alpha", 0.01))
    return one(x[0] * slope, lambda g: [g * slope])


def _clip(attributes: Attributes, x: list[Array]) -> Result:
    low = attributes.get("min", -np.inf) if len(x) < 2 or x[1].size == 0 else x[1]
    high = attributes.get("max", np.inf) if len(x) < 3 or x[2].size == 0 else x[2]
    inside = (x[0] > low) & (x[0] < high)
    return one(np.clip(x[0], low, high), lambda g: [g * inside, *[None] * (len(x) - 1)])


def _hard_sigmoid(attributes: Attributes, x: list[Array]) -> Result:
    alpha, beta = attributes.get("alpha", 0.2), attributes.get("beta", 0.5)
    y = np.clip(alpha * x[0] + beta, 0, 1)
    return one(y, lambda g: [g * alpha * ((y > 0) & (y < 1))])


def _hard_swish(_: Attributes, x: list[Array]) -> Result:
    a = x[0]
    gate = np.clip(a / 6 + 0.5, 0, 1)
    return one(a * gate, lambda g: [g * (gate + a / 6 * ((gate > 0) & (gate < 1)))])


def _softmax(attributes: Attributes, x: list[Array]) -> Result:
    axis = attributes.get("axis", -1)
    e = np.exp(x[0] - x[0].max(axis=axis, keepdims=True))
    y = e / e.sum(axis=axis, keepdims=True)
    return one(y, lambda g: [y * (g - (g * y).sum(axis=axis, keepdims=True))])


def _matmul(_: Attributes, x: list[Array]) -> Result:
    a, b = x
    if a.ndim < 2 or b.ndim < 2:
        raise ValueError("factors of MatMul must have two dimensions or more")
    return one(a @ b, lambda g: [reduced(g @ np.swapaxes(b, -1, -2), a.shape), reduced(np.swapaxes(a, -1, -2) @ g, b.shape)])


def _gemm(attributes: Attributes, x: list[Array]) -> Result:
    alpha, beta = attributes.get("alpha", 1.0), attributes.get("beta", 1.0)
    a = x[0].T if attributes.get("transA") else x[0]
    b = x[1].T if attributes.get("transB") else x[1]
    y = alpha * (a @ b) + (beta * x[2] if len(x) > 2 else 0.0)

    def pull(g: Array) -> list[Array | None]:
        da, db = alpha * (g @ b.T), alpha * (a.T @ g)
        gradients: list[Array | None] = [da.T if attributes.get("transA") else da, db.T if attributes.get("transB") else db]
        return gradients + ([reduced(beta * g, x[2].shape)] if len(x) > 2 else [])

    return one(y, pull)


def _batch_norm(attributes: Attributes, x: list[Array]) -> Result:
    wide = (1, -1, *[1] * (x[0].ndim - 2))
    scale = (x[1] / np.sqrt(x[4] + attributes.get("epsilon", 1e-5))).reshape(wide)
    return one((x[0] - x[3].reshape(wide)) * scale + x[2].reshape(wide), lambda g: [g * scale, *[None] * 4])


def _layer_norm(attributes: Attributes, x: list[Array]) -> Result:
    first = attributes.get("axis", -1) % x[0].ndim
    axes = tuple(range(first, x[0].ndim))
    centred = x[0] - x[0].mean(axis=axes, keepdims=True)
    inverse = 1 / np.sqrt((centred**2).mean(axis=axes, keepdims=True) + attributes.get("epsilon", 1e-5))
    normal = centred * inverse

    def pull(g: Array) -> list[Array | None]:
        s = g * x[1]
        mean, along = s.mean(axis=axes, keepdims=True), (s * normal).mean(axis=axes, keepdims=True)
        return [inverse * (s - mean - normal * along), *[None] * (len(x) - 1)]

    return one(normal * x[1] + (x[2] if len(x) > 2 else 0.0), pull)


def _axes(attributes: Attributes, x: list[Array], which: int = 1) -> tuple[int, ...] | None:
    """Axes of a reduction, which are an input since opset 18; None = all."""
    given = attributes.get("axes")
    if given is None and len(x) > which and x[which].size:
        given = x[which].ravel()
    if given is None:
        return tuple(range(x[0].ndim)) if not attributes.get("noop_with_empty_axes") else None
    return tuple(int(axis) % x[0].ndim for axis in given)


def _reduction(value: Callable[..., Array], slope: Callable[[Array, Array, int], Array]) -> Operator:
    """slope: derivative by each element from (input, kept output, number of elements)."""

    def run(attributes: Attributes, x: list[Array]) -> Result:
        axes = _axes(attributes, x)
        if axes is None:
            return one(x[0], lambda g: [g, *[None] * (len(x) - 1)])
        kept = value(x[0], axis=axes, keepdims=True)
        count = x[0].size // max(1, kept.size)
        y = kept if attributes.get("keepdims", 1) else np.squeeze(kept, axis=axes)
        return one(y, lambda g: [g.reshape(kept.shape) * slope(x[0], kept, count), *[None] * (len(x) - 1)])

    return run


def _norm(a: Array, axis: tuple[int, ...], keepdims: bool) -> Array:
    return np.asarray(np.sqrt((a * a).sum(axis=axis, keepdims=keepdims)))


_mean = _reduction(np.mean, lambda a, kept, count: np.full(a.shape, 1 / count))


def _global_pool(_: Attributes, x: list[Array]) -> Result:
    return _mean({"axes": list(range(2, x[0].ndim)), "keepdims": 1}, x)


def sum_of(parts: Sequence[Array]) -> Array:
    """Sum of gradients of one tensor."""
    return np.asarray(sum(parts[1:], parts[0]))


OPERATORS: dict[str, Operator] = {
    "Add": _binary(np.add, lambda g, a, b: g, lambda g, a, b: g),
    "Sub": _binary(np.subtract, lambda g, a, b: g, lambda g, a, b: -g),
    "Mul": _binary(np.multiply, lambda g, a, b: g * b, lambda g, a, b: g * a),
    "Div": _binary(np.divide, lambda g, a, b: g / b, lambda g, a, b: -g * a / (b * b)),
    "Pow": _binary(np.power, lambda g, a, b: g * b * a ** (b - 1), lambda g, a, b: np.zeros_like(g)),  # exponents are constants
    "Neg": _unary(np.negative, lambda x, y: np.full_like(x, -1.0)),
    "Sqrt": _unary(np.sqrt, lambda x, y: 0.5 / y),
    "Exp": _unary(np.exp, lambda x, y: y),
    "Log": _unary(np.log, lambda x, y: 1 / x),
    "Abs": _unary(np.abs, lambda x, y: np.sign(x)),
    "Erf": _unary(_erf, lambda x, y: 2 / math.sqrt(math.pi) * np.exp(-x * x)),
    "Tanh": _unary(np.tanh, lambda x, y: 1 - y * y),
    "Relu": _unary(lambda x: np.maximum(x, 0), lambda x, y: (x > 0).astype(float)),
    "Sigmoid": _unary(_sigmoid, lambda x, y: y * (1 - y)),
    "HardSigmoid": _hard_sigmoid, "HardSwish": _hard_swish, "LeakyRelu": _leaky_relu, "Clip": _clip, "Gelu": _gelu,
    "Softmax": _softmax, "MatMul": _matmul, "Gemm": _gemm,
    "BatchNormalization": _batch_norm, "LayerNormalization": _layer_norm,
    "ReduceMean": _mean,
    "ReduceSum": _reduction(np.sum, lambda a, kept, count: np.ones(a.shape)),
    "ReduceL2": _reduction(_norm, lambda a, kept, count: a / kept),
    "GlobalAveragePool": _global_pool,
}  # fmt: skip
