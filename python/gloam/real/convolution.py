"""Convolutions and pooling in NumPy with their derivatives (operators.py)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .operators import OPERATORS, Array, Attributes, Operator, Result
from .shapes import SHAPE_OPERATORS

_Window = tuple[slice, slice]


def _padding(attributes: Attributes, size: tuple[int, int], kernel: tuple[int, int]) -> list[int]:
    """Top, left, bottom, right [px]."""
    automatic = attributes.get("auto_pad", "NOTSET")
    if automatic == "NOTSET":
        return list(attributes.get("pads", [0, 0, 0, 0]))
    strides, dilations = attributes.get("strides", [1, 1]), attributes.get("dilations", [1, 1])
    before, after = [0, 0], [0, 0]
    if automatic != "VALID":
        for i in range(2):
            missing = max(0, (-(-size[i] // strides[i]) - 1) * strides[i] + (kernel[i] - 1) * dilations[i] + 1 - size[i])
            small, large = missing // 2, missing - missing // 2
            before[i], after[i] = (small, large) if automatic == "SAME_UPPER" else (large, small)
    return before + after


class _Windows:
    """Places of a kernel over padded images (n, c, h, w)."""

    def __init__(self, attributes: Attributes, x: Array, kernel: tuple[int, int], fill: float = 0.0) -> None:
        if x.ndim != 4:
            raise ValueError("only convolutions and pooling of images are supported")
        self.top, self.left, bottom, right = _padding(attributes, (x.shape[2], x.shape[3]), kernel)
        self.shape, self.kernel = x.shape, kernel
        self.strides, self.dilations = attributes.get("strides", [1, 1]), attributes.get("dilations", [1, 1])
        self.padded = np.pad(x, [(0, 0), (0, 0), (self.top, bottom), (self.left, right)], constant_values=fill)
        sides = [self.padded.shape[2 + i] - (kernel[i] - 1) * self.dilations[i] - 1 for i in range(2)]
        self.out = tuple(side // stride + 1 for side, stride in zip(sides, self.strides, strict=True))

    def __iter__(self) -> Iterator[tuple[int, int, _Window]]:
        """(row, column, pixels below them) for each place in the kernel."""
        for i in range(self.kernel[0]):
            for j in range(self.kernel[1]):
                first = (i * self.dilations[0], j * self.dilations[1])
                rows, columns = (slice(a, a + (n - 1) * s + 1, s) for a, n, s in zip(first, self.out, self.strides, strict=True))
                yield i, j, (rows, columns)

    def cropped(self, padded: Array) -> Array:
        """The part of the image itself."""
        return padded[:, :, self.top : self.top + self.shape[2], self.left : self.left + self.shape[3]]


def _conv(attributes: Attributes, x: list[Array]) -> Result:
    image, weight = x[0], x[1]
    groups = attributes.get("group", 1)
    windows = _Windows(attributes, image, (weight.shape[2], weight.shape[3]))
    grouped = weight.reshape(groups, -1, *weight.shape[1:])  # (g, out, in, kh, kw)
    count = image.shape[0]

    def split(array: Array) -> Array:
        return array.reshape(count, groups, -1, *array.shape[2:])

    y: Any = 0.0
    for i, j, (rows, columns) in windows:
        y = y + np.einsum("ngihw,goi->ngohw", split(windows.padded[:, :, rows, columns]), grouped[..., i, j], optimize=True)
    y = y.reshape(count, weight.shape[0], *windows.out)
    if len(x) > 2:
        y = y + x[2].reshape(1, -1, 1, 1)

    def pull(gradients: list[Array]) -> list[Array | None]:
        gradient, spread = split(gradients[0]), np.zeros_like(windows.padded)
        for i, j, (rows, columns) in windows:
            part = np.einsum("ngohw,goi->ngihw", gradient, grouped[..., i, j], optimize=True)
            spread[:, :, rows, columns] += part.reshape(count, -1, *windows.out)
        return [windows.cropped(spread), *[None] * (len(x) - 1)]

    return [y], pull


def _average_pool(attributes: Attributes, x: list[Array]) -> Result:
    windows = _Windows(attributes, x[0], tuple(attributes["kernel_shape"]))
    inside = _Windows(attributes, np.ones_like(x[0]), windows.kernel, float(attributes.get("count_include_pad", 0)))
    total: Any = sum(windows.padded[:, :, rows, columns] for _, _, (rows, columns) in windows)
    number: Any = sum(inside.padded[:, :, rows, columns] for _, _, (rows, columns) in inside)

    def pull(gradients: list[Array]) -> list[Array | None]:
        spread = np.zeros_like(windows.padded)
        for _, _, (rows, columns) in windows:
            spread[:, :, rows, columns] += gradients[0] / number
        return [windows.cropped(spread)]

    return [total / number], pull


def _max_pool(attributes: Attributes, x: list[Array]) -> Result:
    windows = _Windows(attributes, x[0], tuple(attributes["kernel_shape"]), -np.inf)
    places = [where for _, _, where in windows]
    values = np.stack([windows.padded[:, :, rows, columns] for rows, columns in places])
    best = values.argmax(axis=0)

    def pull(gradients: list[Array]) -> list[Array | None]:
        spread = np.zeros_like(windows.padded)
        for k, (rows, columns) in enumerate(places):
            spread[:, :, rows, columns] += gradients[0] * (best == k)
        return [windows.cropped(spread)]

    return [values.max(axis=0)], pull


def _global_max_pool(_: Attributes, x: list[Array]) -> Result:
    return _max_pool({"kernel_shape": x[0].shape[2:]}, x)


IMAGE_OPERATORS: dict[str, Operator] = {
    "Conv": _conv, "AveragePool": _average_pool, "MaxPool": _max_pool, "GlobalMaxPool": _global_max_pool,
}  # fmt: skip
ALL_OPERATORS: dict[str, Operator] = {**OPERATORS, **SHAPE_OPERATORS, **IMAGE_OPERATORS}
