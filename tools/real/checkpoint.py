"""Reads tensors of checkpoints without PyTorch: its files (also old ones, and TorchScript archives) and safetensors.

Nothing in a checkpoint is executed: only the few names that tensors consist of are known, and classes of TorchScript become plain
objects.
"""

from __future__ import annotations

import collections
import io
import json
import pickle
import struct
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

State = dict[str, np.ndarray]
_TYPES = {
    "FloatStorage": "<f4",
    "DoubleStorage": "<f8",
    "HalfStorage": "<f2",
    "BFloat16Storage": "<u2",
    "LongStorage": "<i8",
    "IntStorage": "<i4",
    "ShortStorage": "<i2",
    "CharStorage": "|i1",
    "ByteStorage": "|u1",
    "BoolStorage": "|b1",
}
_SAFE_TYPES = {
    "F32": "<f4",
    "F64": "<f8",
    "F16": "<f2",
    "BF16": "<u2",
    "I64": "<i8",
    "I32": "<i4",
    "I16": "<i2",
    "I8": "|i1",
    "U8": "|u1",
    "BOOL": "|b1",
}
_MAGIC = 0x1950A86A20F9469CFC6C  # of files before PyTorch 1.6
_DEEPEST = 64


class CheckpointError(Exception):
    """A checkpoint that cannot be read or converted."""


@dataclass
class _Storage:
    kind: str
    key: str
    count: int
    data: np.ndarray | None = None


@dataclass
class _Tensor:
    storage: _Storage
    offset: int
    size: tuple[int, ...]
    stride: tuple[int, ...]

    def array(self) -> np.ndarray:
        data = self.storage.data
        if data is None:
            raise CheckpointError(f"storage {self.storage.key} is missing")
        last = self.offset + sum((n - 1) * s for n, s in zip(self.size, self.stride, strict=True))
        if min((self.offset, *self.size, *self.stride), default=0) < 0 or (np.prod(self.size) and last >= len(data)):
            raise CheckpointError("a tensor exceeds its storage")
        strides = [s * data.itemsize for s in self.stride]
        found = np.lib.stride_tricks.as_strided(data[self.offset :], self.size, strides, writeable=False)
        return _widened(np.array(found), self.storage.kind == "BFloat16Storage")


def _widened(values: np.ndarray, is_brain: bool) -> np.ndarray:
    """Numbers of 16 bits as float32."""
    if is_brain:
        return (values.astype(np.uint32) << 16).view(np.float32)
    return values.astype(np.float32) if values.dtype == np.float16 else values


class _Module:
    """An object of TorchScript."""


class _Reader(pickle.Unpickler):
    """Knows tensors and containers only."""

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file, encoding="utf-8")
        self.storages: dict[str, _Storage] = {}

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == ("collections", "OrderedDict"):
            return collections.OrderedDict
        if module == "torch._utils" and name in ("_rebuild_tensor", "_rebuild_tensor_v2"):
            return lambda storage, offset, size, stride, *_: _Tensor(storage, offset, tuple(size), tuple(stride))
        if module == "torch._utils" and name == "_rebuild_parameter":
            return lambda data, *_: data
        if module == "torch" and name in _TYPES:
            return name
        if (module, name) == ("torch", "Size"):
            return tuple
        if module.startswith("__torch__"):
            return _Module
        if module == "torch.jit._pickle":
            return lambda values, *_: list(values)
        raise CheckpointError(f"the checkpoint contains an object of {module}.{name}, which may execute code; save a state dict instead")

    def persistent_load(self, pid: Any) -> _Storage:
        _, kind, key, _, count = pid[:5]
        return self.storages.setdefault(str(key), _Storage(kind, str(key), int(count)))


def read_state(path: Path) -> State:
    """Tensors by name. Errors: CheckpointError."""
    try:
        with path.open("rb") as file:
            head = file.read(9)
            file.seek(0)
            if head[:4] == b"PK\x03\x04":
                found = _read_archive(file)
            elif head[8:9] == b"{" and path.suffix == ".safetensors":
                found = _read_safetensors(file)
            else:
                found = _read_old(file)
    except CheckpointError as error:
        raise CheckpointError(f"{path}: {error}") from error
    except OSError as error:
        raise CheckpointError(f"{path}: cannot read the checkpoint: {error.strerror}") from error
    except Exception as error:  # damaged files end in exceptions of many kinds
        raise CheckpointError(f"{path}: this is not a checkpoint of PyTorch or safetensors") from error
    if not found:
        raise CheckpointError(f"{path}: the checkpoint has no tensors")
    for name, values in found.items():
        if values.dtype.kind == "f" and not np.isfinite(values).all():
            raise CheckpointError(f"{path}: '{name}' has numbers that are not finite")
    return found


def _read_archive(file: BinaryIO) -> State:
    with zipfile.ZipFile(file) as archive:
        index = next(name for name in archive.namelist() if name.endswith("/data.pkl"))
        root = index.removesuffix("data.pkl")
        reader = _Reader(io.BytesIO(archive.read(index)))
        contents = reader.load()
        for key, storage in reader.storages.items():
            storage.data = np.frombuffer(archive.read(f"{root}data/{key}"), _TYPES[storage.kind])
    return _tensors(contents)


def _read_old(file: BinaryIO) -> State:
    if _Reader(file).load() != _MAGIC:
        raise CheckpointError("this is not a checkpoint of PyTorch")
    _Reader(file).load()  # version of the protocol
    if not _Reader(file).load()["little_endian"]:
        raise CheckpointError("the checkpoint was written by a big-endian machine")
    reader = _Reader(file)
    contents = reader.load()
    for key in _Reader(file).load():
        storage = reader.storages[str(key)]
        (count,) = struct.unpack("<q", file.read(8))
        if count != storage.count:
            raise CheckpointError(f"storage {key} has another size")
        kind = np.dtype(_TYPES[storage.kind])
        storage.data = np.frombuffer(file.read(count * kind.itemsize), kind)
    return _tensors(contents)


def _read_safetensors(file: BinaryIO) -> State:
    (size,) = struct.unpack("<Q", file.read(8))
    if size > 100 << 20:
        raise CheckpointError("the header is too large")
    header = json.loads(file.read(size))
    data, found = file.read(), {}
    for name, entry in header.items():
        if name != "__metadata__":
            begin, end = entry["data_offsets"]
            values = np.frombuffer(data[begin:end], _SAFE_TYPES[entry["dtype"]]).reshape(entry["shape"])
            found[name] = _widened(values, entry["dtype"] == "BF16")
    return found


def _tensors(contents: Any) -> State:
    """Tensors of nested containers by their joined names, without the names of wrappers around all of them."""
    found: State = {}

    def collect(value: Any, name: str, depth: int) -> None:
        if isinstance(value, _Tensor):
            found[name] = value.array()
        elif depth < _DEEPEST and isinstance(value, dict | _Module):
            for key, inner in (value if isinstance(value, dict) else vars(value)).items():
                collect(inner, f"{name}.{key}" if name else str(key), depth + 1)

    collect(contents, "", 0)
    for wrapper in ("state_dict.", "model_state_dict.", "model.", "module."):
        inner = {name.removeprefix(wrapper): value for name, value in found.items() if name.startswith(wrapper)}
        # Checkpoints of training hold the state of an optimizer beside the model.
        if inner and (len(inner) == len(found) or wrapper != "module."):
            found = inner
    return found
