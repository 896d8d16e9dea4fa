"""PyTorch takes frames and live arrays without a copy: addresses are compared."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest
import torch_cpu

CODE = """
import gc, os, sys
sys.setdlopenflags(os.RTLD_LAZY | os.RTLD_GLOBAL)
import torch
sys.setdlopenflags(os.RTLD_NOW)
import gloam

sim = gloam.load("pendulum.xml")
frame = sim.cameras["side"].render(("rgb", "depth", "segmentation", "normal"), width=32, height=24, spp=1)
kept = []
for name in ("rgb", "depth", "ids", "normal"):
    array = getattr(frame, name)
    tensor = torch.from_dlpack(array)
    assert tensor.data_ptr() == array.ctypes.data and tuple(tensor.shape) == array.shape, name
    kept.append((tensor, tensor.clone()))
qpos = sim.memory.array("qpos")
live = torch.from_dlpack(qpos)
assert live.data_ptr() == qpos.ctypes.data and live.dtype == torch.float64
before = live.clone()
sim.step(20)
assert not torch.equal(live, before) and float(live[0]) == qpos[0]
end = live.clone()
sim.close()
del sim, frame, array, qpos
gc.collect()
for _ in range(3):
    with gloam.load("pendulum.xml") as other:
        other.cameras["side"].render(("rgb", "depth"), width=32, height=24, spp=1)
assert torch.equal(live, end)
assert all(torch.equal(tensor.nan_to_num() if tensor.is_floating_point() else tensor,
                       copy.nan_to_num() if copy.is_floating_point() else copy) for tensor, copy in kept)
print("without a copy", torch.__version__)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="PyTorch's wheel of 540 MB is pinned for Python 3.11 alone")
def test_pytorch_sees_the_same_memory(pendulum: Path, run_python: Any) -> None:
    packages, libraries = torch_cpu.torch_or_skip()
    path = os.pathsep.join([str(Path(__file__).resolve().parents[2] / "python"), str(packages)])
    told = run_python(CODE, PYTHONPATH=path, LD_LIBRARY_PATH=libraries, timeout=120)
    assert "without a copy 2." in told.stdout
