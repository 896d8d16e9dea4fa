"""Arrays go to other libraries by DLPack and the buffer protocol without a copy, and outlive what they came from."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gloam

OUTPUTS = ("rgb", "depth", "segmentation", "normal", "motion")


def frame_of(model: Path) -> Any:
    sim = gloam.load(model)
    frame = sim.cameras["side"].render(OUTPUTS, width=32, height=24, spp=1)
    sim.close()
    return frame


def arrays_of(frame: Any) -> dict[str, Any]:
    return {name: getattr(frame, name) for name in ("rgb", "depth", "ids", "semantic", "part", "normal", "motion")}


def test_channels_of_a_frame_are_given_without_a_copy(pendulum: Path) -> None:
    frame = frame_of(pendulum)
    for name, array in arrays_of(frame).items():
        assert array is not None and not array.flags.owndata, name
        assert np.from_dlpack(array).ctypes.data == array.ctypes.data, name
        assert np.frombuffer(memoryview(array).cast("B"), np.uint8).ctypes.data == array.ctypes.data, name
        assert getattr(frame, "ids" if name == "ids" else name).ctypes.data == array.ctypes.data, (
            "the same memory each time"
        )


def test_arrays_outlive_their_frame_and_simulation(pendulum: Path) -> None:
    frame = frame_of(pendulum)
    kept = {name: (np.from_dlpack(array), array.copy()) for name, array in arrays_of(frame).items()}
    del frame
    gc.collect()
    again = [frame_of(pendulum) for _ in range(3)]  # what was freed would be written over
    for name, (view, copy) in kept.items():
        assert np.array_equal(view, copy, equal_nan=view.dtype.kind == "f"), name
    del again


def test_live_arrays_are_the_state(pendulum: Path) -> None:
    sim = gloam.load(pendulum)
    qpos = sim.memory.array("qpos")
    seen = np.from_dlpack(qpos)
    assert seen.ctypes.data == qpos.ctypes.data
    before = float(seen[0])
    sim.step(20)
    assert seen[0] != before and seen[0] == qpos[0] == sim.memory.array("qpos")[0]
    sim.close()
    gc.collect()
    assert seen[0] == qpos[0]


def test_state_written_between_steps_is_gone_on_from(pendulum: Path) -> None:
    with gloam.load(pendulum) as sim:
        sim.joints["hinge"].qpos[:] = 1.0
        sim.step(1)
        assert abs(sim.memory.array("qpos")[0] - 1.0) < 0.01


@pytest.mark.parametrize("name", ["no_such_field", "", "QPOS"])
def test_fields_that_are_not_there(pendulum: Path, name: str) -> None:
    with gloam.load(pendulum) as sim, pytest.raises(gloam.Error):
        sim.memory.array(name)


def test_fields_are_asked_for_by_name(pendulum: Path) -> None:
    with gloam.load(pendulum) as sim, pytest.raises(TypeError):
        sim.memory.array(None)


def test_the_model_is_not_for_writing(pendulum: Path) -> None:
    with gloam.load(pendulum) as sim:
        mass = sim.memory.array("body_mass")
        with pytest.raises(ValueError):
            mass[1] = 7.0
