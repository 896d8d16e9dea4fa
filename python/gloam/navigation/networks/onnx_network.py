"""Evaluation of ONNX files on the CPU with results that repeat: one thread, float32, fixed settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import gloam

Backend = Literal["auto", "openvino", "onnxruntime"]
Arrays = dict[str, NDArray[Any]]
_Run = Callable[[Mapping[str, NDArray[Any]]], Sequence[NDArray[Any]]]
_MOST_BYTES = 1 << 30


@dataclass(frozen=True)
class Port:
    """An input or output of a network. shape: None = any size; dtype: "float32" or "int64"."""

    name: str
    shape: tuple[int | None, ...]
    dtype: str = "float32"

    def __str__(self) -> str:
        return f"{self.name}: {self.dtype} [{', '.join('?' if size is None else str(size) for size in self.shape)}]"

    def accepts(self, found: Port) -> bool:
        """Whether a port of a file fits: same name and type, and each size equal where both are known."""
        return (
            self.name == found.name
            and self.dtype == found.dtype
            and len(self.shape) == len(found.shape)
            and all(a is None or b is None or a == b for a, b in zip(self.shape, found.shape, strict=True))
        )


class OnnxNetwork:
    """A network of an ONNX file, whose ports are checked when it is loaded and whenever it runs."""

    def __init__(
        self,
        path: str | Path,
        inputs: Sequence[Port] | None,
        outputs: Sequence[Port] | None,
        backend: Backend = "auto",
    ) -> None:
        """inputs, outputs: the ports that the file must have, no more and no fewer, None = any; backend: "auto" = OpenVINO if it is
        installed, else ONNX Runtime.

        Errors: gloam.IoError if the file does not exist; gloam.InputError if it is not a network or its ports differ;
        gloam.UnsupportedError if neither package is installed.
        """
        self.path = Path(path)
        if not self.path.is_file():
            raise gloam.IoError("there is no such file", str(path), hint="docs/navigation_networks.md")
        if self.path.stat().st_size > _MOST_BYTES:
            raise gloam.InputError(f"a network must have at most {_MOST_BYTES >> 30} GiB", str(path))
        load = _loader(backend)
        try:
            found_inputs, found_outputs, self._run = load(self.path)
        except gloam.Error:
            raise
        except Exception as error:  # each package has exceptions of its own
            reason = (str(error).strip().splitlines() or [type(error).__name__])[-1]
            raise gloam.InputError(f"this is not a network in ONNX: {reason}", str(path)) from error
        self.inputs = self._matched("input", inputs, found_inputs)
        self.outputs = self._matched("output", outputs, found_outputs)
        self._order = [port.name for port in found_outputs]

    def _matched(self, what: str, expected: Sequence[Port] | None, found: Sequence[Port]) -> dict[str, Port]:
        by_name = {port.name: port for port in found}
        if expected is None:
            return by_name
        fits = len(found) == len(expected) and all(p.name in by_name and p.accepts(by_name[p.name]) for p in expected)
        if not fits:
            wanted, present = ("; ".join(str(port) for port in ports) or "none" for ports in (expected, found))
            raise gloam.InputError(f"{what}s must be {wanted}, got {present}", str(self.path))
        return by_name

    def run(self, **arrays: NDArray[Any]) -> Arrays:
        """Outputs by name. Errors: ValueError for inputs of other names, shapes or types, and for an output of another
        shape or with a number that is not finite."""
        if set(arrays) != set(self.inputs):
            raise ValueError(f"inputs must be {', '.join(self.inputs)}, got {', '.join(arrays)}")
        for name, array in arrays.items():
            self._check("input", self.inputs[name], array)
        results = self._run({name: np.ascontiguousarray(array) for name, array in arrays.items()})
        outputs = dict(zip(self._order, results, strict=True))
        for name, array in outputs.items():
            self._check("output", self.outputs[name], array)
            if not np.isfinite(array).all():
                raise ValueError(f"{self.path}: output '{name}' has numbers that are not finite")
        return outputs

    def _check(self, what: str, port: Port, array: NDArray[Any]) -> None:
        found = Port(port.name, tuple(array.shape), str(array.dtype))
        if not port.accepts(found):
            raise ValueError(f"{self.path}: {what} must be {port}, got {found}")


def _loader(backend: Backend) -> Callable[[Path], tuple[list[Port], list[Port], _Run]]:
    from importlib.util import find_spec

    if backend not in ("auto", "openvino", "onnxruntime"):
        raise ValueError(f"the backend must be auto, openvino or onnxruntime, got {backend!r}")
    if backend != "onnxruntime" and find_spec("openvino") is not None:
        return _load_openvino
    if backend != "openvino" and find_spec("onnxruntime") is not None:
        return _load_onnxruntime
    raise gloam.UnsupportedError("networks require OpenVINO or ONNX Runtime", hint="pip install openvino")


def _load_openvino(path: Path) -> tuple[list[Port], list[Port], _Run]:
    import openvino

    core = openvino.Core()
    model = core.read_model(str(path))
    settings = {
        "INFERENCE_NUM_THREADS": 1,
        "NUM_STREAMS": 1,
        "INFERENCE_PRECISION_HINT": "f32",
        "EXECUTION_MODE_HINT": "ACCURACY",
        "ENABLE_CPU_PINNING": False,
    }
    request = core.compile_model(model, "CPU", settings).create_infer_request()
    names = {"f32": "float32", "i64": "int64", "i32": "int32", "boolean": "bool"}

    def ports(of: Any) -> list[Port]:
        found = []
        for port in of:
            shape = tuple(None if size.is_dynamic else size.get_length() for size in port.partial_shape)
            kind = port.element_type.get_type_name()
            # A tensor may have several names; a node of a result has the file's name of that output.
            own = port.node.friendly_name.removesuffix("/sink_port_0")
            found.append(Port(own if own in port.names else port.any_name, shape, names.get(kind, kind)))
        return found

    def run(arrays: Mapping[str, NDArray[Any]]) -> Sequence[NDArray[Any]]:
        results = request.infer(dict(arrays))
        return [np.array(results[i]) for i in range(len(results))]

    return ports(model.inputs), ports(model.outputs), run


def _load_onnxruntime(path: Path) -> tuple[list[Port], list[Port], _Run]:
    from importlib import import_module

    onnxruntime: Any = import_module("onnxruntime")  # it has no type hints
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.inter_op_num_threads = 1
    options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
    options.use_deterministic_compute = True
    options.log_severity_level = 3
    session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    names = {"tensor(float)": "float32", "tensor(int64)": "int64", "tensor(int32)": "int32", "tensor(bool)": "bool"}

    def ports(of: Any) -> list[Port]:
        return [
            Port(p.name, tuple(s if isinstance(s, int) else None for s in p.shape), names.get(p.type, p.type)) for p in of
        ]

    def run(arrays: Mapping[str, NDArray[Any]]) -> Sequence[NDArray[Any]]:
        results: Sequence[NDArray[Any]] = session.run(None, dict(arrays))
        return results

    return ports(session.get_inputs()), ports(session.get_outputs()), run
