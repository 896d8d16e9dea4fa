"""Operators of ONNX that give numbers another place or shape, in NumPy with their derivatives (operators.py)."""

from __future__ import annotations

from typing import Any

import numpy as np

from .operators import Array, Attributes, Operator, Result, one, reduced


def _shaped(value: Array, x: list[Array]) -> Result:
    """For operators that only give the numbers another shape."""
    return one(value, lambda g: [g.reshape(x[0].shape), *[None] * (len(x) - 1)])


def _reshape(attributes: Attributes, x: list[Array]) -> Result:
    wanted = [int(size) for size in x[1]]
    sizes = [x[0].shape[i] if size == 0 and not attributes.get("allowzero") else size for i, size in enumerate(wanted)]
    return _shaped(x[0].reshape(sizes), x)


def _flatten(attributes: Attributes, x: list[Array]) -> Result:
    axis = attributes.get("axis", 1)
    return _shaped(x[0].reshape(int(np.prod(x[0].shape[:axis])), -1), x)


def _squeeze(attributes: Attributes, x: list[Array]) -> Result:
    given = attributes.get("axes") or ([int(axis) for axis in x[1]] if len(x) > 1 else None)
    return _shaped(np.squeeze(x[0], axis=None if given is None else tuple(given)), x)


def _unsqueeze(attributes: Attributes, x: list[Array]) -> Result:
    given = attributes.get("axes") or [int(axis) for axis in x[1]]
    return _shaped(np.expand_dims(x[0], tuple(given)), x)


def _transpose(attributes: Attributes, x: list[Array]) -> Result:
    order = attributes.get("perm") or list(range(x[0].ndim))[::-1]
    return one(x[0].transpose(order), lambda g: [g.transpose(np.argsort(order))])


def _expand(_: Attributes, x: list[Array]) -> Result:
    shape = np.broadcast_shapes(x[0].shape, tuple(int(size) for size in x[1]))
    return one(np.broadcast_to(x[0], shape), lambda g: [reduced(g, x[0].shape), None])


def _concat(attributes: Attributes, x: list[Array]) -> Result:
    axis = attributes["axis"]
    ends = np.cumsum([part.shape[axis] for part in x])[:-1]
    return one(np.concatenate(x, axis), lambda g: list(np.split(g, ends, axis)))


def _picked(x: list[Array], where: Any) -> Result:
    """Elements of the first input. where: index."""

    def pull(g: Array) -> list[Array | None]:
        gradient = np.zeros_like(x[0])
        np.add.at(gradient, where, g)
        return [gradient, *[None] * (len(x) - 1)]

    return one(x[0][where], pull)


def _slice(attributes: Attributes, x: list[Array]) -> Result:
    if "starts" in attributes:
        starts, ends = attributes["starts"], attributes["ends"]
        axes, steps = attributes.get("axes", range(len(starts))), [1] * len(starts)
    else:
        starts, ends = x[1].tolist(), x[2].tolist()
        axes = x[3].tolist() if len(x) > 3 and x[3].size else range(len(starts))
        steps = x[4].tolist() if len(x) > 4 else [1] * len(starts)
    where = [slice(None)] * x[0].ndim
    for axis, start, end, step in zip(axes, starts, ends, steps, strict=True):
        size = x[0].shape[int(axis)]
        stop = None if step < 0 and end < -size else int(end)
        where[int(axis)] = slice(int(start), stop, int(step))
    return _picked(x, tuple(where))


def _gather(attributes: Attributes, x: list[Array]) -> Result:
    where: list[Any] = [slice(None)] * x[0].ndim
    where[attributes.get("axis", 0)] = x[1].astype(np.int64)
    return _picked(x, tuple(where))


def _split(attributes: Attributes, x: list[Array]) -> Result:
    axis = attributes.get("axis", 0)
    sizes = attributes.get("split") or (x[1].tolist() if len(x) > 1 else None)
    parts = int(attributes["outputs"])
    if sizes is None:
        size = -(-x[0].shape[axis] // parts)
        sizes = [size] * (parts - 1) + [x[0].shape[axis] - size * (parts - 1)]
    ends = np.cumsum(np.asarray(sizes, int))[:-1]
    return np.split(x[0], ends, axis), lambda gradients: [np.concatenate(gradients, axis), *[None] * (len(x) - 1)]


def _same(_: Attributes, x: list[Array]) -> Result:
    return one(x[0], lambda g: [g, *[None] * (len(x) - 1)])


def _shape(_: Attributes, x: list[Array]) -> Result:
    return one(np.array(x[0].shape, np.int64), lambda g: [None])


SHAPE_OPERATORS: dict[str, Operator] = {
    "Reshape": _reshape, "Flatten": _flatten, "Squeeze": _squeeze, "Unsqueeze": _unsqueeze, "Transpose": _transpose,
    "Expand": _expand, "Concat": _concat, "Slice": _slice, "Gather": _gather, "Split": _split,
    "Identity": _same, "Dropout": _same, "Cast": _same, "Shape": _shape,
}  # fmt: skip
