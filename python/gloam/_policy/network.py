"""A network of an ONNX file, run by OpenVINO: f32, one thread, so that the same input gives the same output."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, IoError, UnsupportedError
from .onnx_sizes import check_declared, check_operations

_ACTIONS = ("actions", "action", "mean")  # outputs of these names are preferred to the first


def _openvino() -> Any:
    try:
        return importlib.import_module("openvino")
    except ImportError as error:
        raise ImportError(
            "gloam.Policy runs networks with the package 'openvino', which is not installed: pip install openvino"
        ) from error


class Network:
    """One input of (1, inputs) and one output of (1, outputs) that are used, both f32.

    Raises ImportError: no openvino; IoError: no such file; InputError: not an ONNX file, tensors that are too large
    or have no fixed size; UnsupportedError: several inputs, or loops.
    """

    def __init__(self, path: Path) -> None:
        openvino = _openvino()
        if not path.is_file():
            raise IoError("no such file", str(path))
        check_declared(path)
        core = openvino.Core()
        try:
            model = core.read_model(path)
        except RuntimeError as error:
            lines = [line for line in str(error).splitlines() if line.strip()]
            raise InputError(
                f"OpenVINO cannot read the network: {lines[-1] if lines else error}", str(path)
            ) from None
        self.metadata = self._metadata(model)
        if len(model.inputs) != 1:
            listed = ", ".join(port.get_any_name() for port in model.inputs)
            raise UnsupportedError(
                f"the network takes {len(model.inputs)} inputs ({listed}), but a policy has the observation as its only input",
                str(path),
                hint="policies that track a motion by its time are not supported",
            )
        names = [port.get_any_name() for port in model.outputs]
        self._output = next((names.index(name) for name in _ACTIONS if name in names), 0)
        self.inputs = self._fix_batch(model, path)
        check_operations(model, path)
        config = {"INFERENCE_PRECISION_HINT": "f32", "INFERENCE_NUM_THREADS": 1, "NUM_STREAMS": 1}
        self._request = core.compile_model(model, "CPU", config).create_infer_request()
        result = model.outputs[self._output].partial_shape
        if not result.is_static or len(result) != 2 or result.to_shape()[0] != 1:
            raise InputError(f"output '{names[self._output]}' has the shape {result}, not (1, joints)", str(path))
        self.outputs = int(result.to_shape()[1])

    @staticmethod
    def _metadata(model: Any) -> dict[str, str]:
        if not model.has_rt_info(["framework"]):
            return {}
        framework = model.get_rt_info()["framework"]
        entries = getattr(framework, "value", framework)  # a dict, of values that are wrapped or not
        return {str(key): str(getattr(entry, "value", entry)) for key, entry in entries.items()}

    @staticmethod
    def _fix_batch(model: Any, path: Path) -> int:
        shape = model.inputs[0].partial_shape
        if shape.rank.is_dynamic or len(shape) != 2 or shape[1].is_dynamic:
            raise InputError(f"the network's input has the shape {shape}, not (1, observation)", str(path))
        if str(model.inputs[0].element_type.to_string()) != "f32":
            raise InputError(
                f"the network's input has the type {model.inputs[0].element_type.to_string()}, not f32", str(path)
            )
        model.reshape([1, shape[1].get_length()])
        return int(shape[1].get_length())

    def run(self, observation: NDArray[np.float32]) -> NDArray[np.float64]:
        """Output (outputs,) of an input (inputs,)."""
        self._request.get_input_tensor(0).data[0] = observation
        self._request.infer()
        result: NDArray[np.float64] = self._request.get_output_tensor(self._output).data[0].astype(np.float64)
        return result
