"""Writes a policy as ONNX and as arrays."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import torch

from .model import Policy

OPSET = 17


def write(policy: Policy, folder: Path) -> dict[str, Any]:
    """Writes weights.npz and policy.onnx (batch 1, opset 17) of a policy on the CPU.

    The answer has the file's size [bytes], and the largest difference of onnxruntime from PyTorch on random images, or
    the reason why there is none.
    """
    policy = policy.eval().to(memory_format=torch.contiguous_format)
    np.savez(folder / "weights.npz", **{name: value.numpy() for name, value in policy.state_dict().items()})
    generator = torch.Generator().manual_seed(0)
    example = tuple(torch.randn(1, 3, 64, 85, generator=generator) for _ in range(2))
    file = folder / "policy.onnx"
    names = {"input_names": ["obs_img", "goal_img"], "output_names": ["dist", "action"]}
    try:
        torch.onnx.export(policy, example, str(file), opset_version=OPSET, dynamo=False, **names)
    except Exception as error:  # noqa: BLE001 - a training is not lost for want of an exporter; weights.npz is written
        return {"bytes": 0, "error": f"{type(error).__name__}: {error}"[:400]}
    answer: dict[str, Any] = {"bytes": file.stat().st_size}
    try:
        import onnxruntime
    except ImportError:
        return {**answer, "unverified": "onnxruntime is missing"}
    session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    found = session.run(None, dict(zip(names["input_names"], (part.numpy() for part in example), strict=True)))
    with torch.no_grad():
        wanted = policy(*example)
    difference = max(float(np.abs(a - b.numpy()).max()) for a, b in zip(found, wanted, strict=True))
    return {**answer, "largest_difference": difference}


def load(file: Path) -> Policy:
    """The policy of a weights.npz. Errors: OSError; RuntimeError if names or shapes differ."""
    policy = Policy()
    with np.load(file) as arrays:
        policy.load_state_dict({name: torch.from_numpy(arrays[name]) for name in arrays.files})
    policy.eval()
    return policy
