"""Sizes declared by an ONNX file, read without creating any tensor: files may be untrusted, and a file of a hundred
bytes can request terabytes.

Only the parts of the format (onnx.proto3) that declare sizes of tensors are read, from the wire format of Protocol
Buffers. Declared sizes are checked before OpenVINO sees the file; check_operations() checks the sizes that follow
from its operations on OpenVINO's graph, before any is computed.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any

from ..errors import InputError, IoError, UnsupportedError

MOST_FILE_BYTES = 512 << 20
MOST_TENSOR_BYTES = 256 << 20  # of one tensor, and of all that a file declares
MOST_NODES = 100_000
_MOST_DEPTH = 16  # graphs within graphs

# onnx.TensorProto.DataType -> bytes of an element; others count as the largest
_ELEMENT_BYTES = {1: 4, 2: 1, 3: 1, 4: 2, 5: 2, 6: 4, 7: 8, 9: 1, 10: 2, 11: 8, 12: 4, 13: 8, 14: 8, 15: 16, 16: 2}
_LARGEST_ELEMENT = 16
_REPEATING = {"Loop", "Scan", "SequenceMap"}  # how often is told by values, not by sizes

Fields = Iterator[tuple[int, int | memoryview]]


class _Damaged(Exception):
    pass


def _varint(data: memoryview, at: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 70, 7):
        if at >= len(data):
            raise _Damaged
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value & (1 << 64) - 1, at
    raise _Damaged


def _fields(data: memoryview) -> Fields:
    """Number and value of each field of a message: an integer, or the bytes of a text or message."""
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        kind = key & 7
        if kind == 0:
            value, at = _varint(data, at)
            yield key >> 3, value
            continue
        if kind == 2:
            size, at = _varint(data, at)
        elif kind in (1, 5):
            size = 8 if kind == 1 else 4
        else:
            raise _Damaged
        if size > len(data) - at:
            raise _Damaged
        yield key >> 3, data[at : at + size]
        at += size


def _text(value: int | memoryview) -> str:
    return "" if isinstance(value, int) else bytes(value).decode("utf-8", "replace")


def _integers(value: int | memoryview) -> Iterator[int]:
    """One, or a packed list of them; negative ones as they are."""
    if isinstance(value, int):
        yield value - (1 << 64) if value >> 63 else value
        return
    at = 0
    while at < len(value):
        number, at = _varint(value, at)
        yield number - (1 << 64) if number >> 63 else number


class _Model:
    """Adds up what a file declares. Raises InputError, UnsupportedError."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.bytes = 0
        self.nodes = 0

    def refuse(self, name: str, what: str) -> InputError:
        return InputError(
            f"tensor '{name[:80]}' {what}",
            str(self.path),
            hint=f"all tensors of a policy together can have at most {MOST_TENSOR_BYTES >> 20} MiB",
        )

    def add(self, name: str, dims: list[int], data_type: int, counts: bool) -> None:
        size = _ELEMENT_BYTES.get(data_type, _LARGEST_ELEMENT)
        for dim in dims:
            if dim < 0:
                raise self.refuse(name, f"has a negative size: {dims}")
            size *= dim
        if size > MOST_TENSOR_BYTES:
            raise self.refuse(name, f"of size {dims} would take {size >> 20} MiB")
        if counts:
            self.bytes += size
            if self.bytes > MOST_TENSOR_BYTES:
                raise self.refuse(name, f"and the tensors before it would take {self.bytes >> 20} MiB")

    def tensor(self, data: memoryview) -> None:
        dims: list[int] = []
        name, data_type = "", 0
        external: dict[str, str] = {}
        for number, value in _fields(data):
            if number == 1:
                dims.extend(_integers(value))
            elif number == 2 and isinstance(value, int):
                data_type = value
            elif number == 8:
                name = _text(value)
            elif number == 13 and not isinstance(value, int):
                entry = {key: _text(text) for key, text in _fields(value)}
                external[entry.get(1, "")] = entry.get(2, "")
        self.add(name, dims, data_type, counts=True)
        if external:
            self.external(name, external.get("location", ""))

    def external(self, name: str, location: str) -> None:
        """Checks that external weights are in the network's folder, or below it."""
        parts = PurePosixPath(location)
        inside = location and not parts.is_absolute() and ".." not in parts.parts
        file = self.path.parent / location
        if not inside or not file.is_file() or not file.resolve().is_relative_to(self.path.parent.resolve()):
            raise self.refuse(name, f"is in the file {location[:80]!r}, outside the network's folder")
        if file.stat().st_size > MOST_FILE_BYTES:
            raise self.refuse(name, f"is in a file that has {file.stat().st_size >> 20} MiB")

    def value_info(self, data: memoryview) -> None:
        name, dims, data_type = "", list[int](), 1
        for number, value in _fields(data):
            if number == 1:
                name = _text(value)
            if number != 2 or isinstance(value, int):
                continue
            for _, tensor in (field for field in _fields(value) if field[0] == 1):
                for part, shape in _fields(memoryview(b"") if isinstance(tensor, int) else tensor):
                    if part == 1 and isinstance(shape, int):
                        data_type = shape
                    elif part == 2 and not isinstance(shape, int):
                        dims = list(self.shape(shape))
        self.add(name, dims, data_type, counts=False)

    @staticmethod
    def shape(data: memoryview) -> Iterator[int]:
        """Sizes of fixed dimensions; a negative or named size is open."""
        for number, dim in _fields(data):
            if number != 1 or isinstance(dim, int):
                continue
            for part, value in _fields(dim):
                if part == 1 and isinstance(value, int) and not value >> 63:
                    yield value

    def attribute(self, data: memoryview, depth: int) -> None:
        for number, value in _fields(data):
            if isinstance(value, int):
                continue
            if number in (5, 10):
                self.tensor(value)
            elif number in (6, 11):
                self.graph(value, depth + 1)
            elif number in (22, 23):
                self.sparse(value)

    def sparse(self, data: memoryview) -> None:
        dims: list[int] = []
        for number, value in _fields(data):
            if number in (1, 2) and not isinstance(value, int):
                self.tensor(value)
            elif number == 3:
                dims.extend(_integers(value))
        self.add("", dims, 0, counts=True)  # dense, as it is used

    def node(self, data: memoryview, depth: int) -> None:
        self.nodes += 1
        if self.nodes > MOST_NODES:
            raise InputError(f"the network has more than {MOST_NODES} operations", str(self.path))
        for number, value in _fields(data):
            if number == 4 and _text(value) in _REPEATING:
                raise UnsupportedError(
                    f"the network has a {_text(value)}: its memory and run time would depend on values",
                    str(self.path),
                    hint="export the policy for one observation, without loops",
                )
            if number == 5 and not isinstance(value, int):
                self.attribute(value, depth)

    def graph(self, data: memoryview, depth: int = 0) -> None:
        if depth > _MOST_DEPTH:
            raise InputError(f"the network nests graphs more than {_MOST_DEPTH} deep", str(self.path))
        for number, value in _fields(data):
            if isinstance(value, int):
                continue
            if number == 1:
                self.node(value, depth)
            elif number == 5:
                self.tensor(value)
            elif number == 15:
                self.sparse(value)
            elif number in (11, 12, 13):
                self.value_info(value)


def check_declared(path: Path) -> None:
    """Raises InputError: a tensor, or all together, larger than MOST_TENSOR_BYTES; a damaged file; UnsupportedError:
    the network repeats parts of itself; IoError."""
    try:
        size = path.stat().st_size
        if size > MOST_FILE_BYTES:
            raise InputError(f"has {size >> 20} MiB; a policy can have at most {MOST_FILE_BYTES >> 20} MiB", str(path))
        data = memoryview(path.read_bytes())
    except OSError as error:
        raise IoError(f"cannot be read: {error.strerror}", str(path)) from None
    model = _Model(path)
    try:
        for number, value in _fields(data):
            if isinstance(value, int):
                continue
            if number == 7:
                model.graph(value)
            elif number == 25:  # a function of the model's own
                for part, node in _fields(value):
                    if part == 7 and not isinstance(node, int):
                        model.node(node, 0)
    except _Damaged:
        raise InputError("OpenVINO cannot read the network: the file is damaged or not an ONNX file", str(path)) from None


def check_operations(model: Any, path: Path) -> None:
    """Sizes of all results of an openvino.Model, before it is compiled: a constant of two numbers can be made a
    million times as large by an Expand. Raises InputError."""
    total = 0
    for operation in model.get_ops():
        for output in operation.outputs():
            shape = output.get_partial_shape()
            if shape.is_dynamic:
                raise InputError(
                    f"operation '{operation.get_friendly_name()[:80]}' has no fixed size: {shape}",
                    str(path),
                    hint="export the policy for one observation: all sizes except the batch must be fixed",
                )
            count = 1
            for dim in shape:
                count *= dim.get_length()
            total += count * max(1, output.get_element_type().size)
            if total > MOST_TENSOR_BYTES:
                raise InputError(
                    f"its operations would take over {MOST_TENSOR_BYTES >> 20} MiB, "
                    f"'{operation.get_friendly_name()[:80]}' with shape {shape}",
                    str(path),
                )
