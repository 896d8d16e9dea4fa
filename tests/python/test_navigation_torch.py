"""Converted networks against PyTorch (navigation_torch.py)."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest
import torch_cpu

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="PyTorch's wheel of 540 MB is pinned for Python 3.11 alone")
def test_converted_networks_equal_pytorch(run_python: Any) -> None:
    pytest.importorskip("onnx")
    pytest.importorskip("openvino")
    packages, libraries = torch_cpu.torch_or_skip()
    folders = [ROOT / "python", packages, ROOT / "tools" / "navigation", ROOT / "tests" / "python", ROOT / "tests"]
    path = os.pathsep.join(str(folder) for folder in folders)
    code = (ROOT / "tests" / "python" / "navigation_torch.py").read_text(encoding="utf-8")
    told = run_python(code, PYTHONPATH=path, LD_LIBRARY_PATH=libraries, OMP_NUM_THREADS="1", timeout=600)
    if told.stdout.startswith("skip: "):
        pytest.skip(told.stdout.strip())
    assert "equal to PyTorch" in told.stdout
