"""A World that a simulation has left is freed, whatever Python has looked at before."""
from __future__ import annotations

import ctypes
import gc
import os
from pathlib import Path

import gloam
import pytest
from scenes import ball_scene

MEGABYTE = 1 << 20


def resident() -> float:
    """Memory that this process uses [MB], without what the allocator keeps."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / MEGABYTE


def heavy_scene(folder: Path) -> gloam.Scene:
    """A World of 8 MB: a height field of a million samples."""
    scene = ball_scene(folder)
    (folder / "floor.xml").write_text("""<mujoco><asset><hfield name="hill" nrow="1000" ncol="1000" size="5 5 .1 .1"/></asset>
      <worldbody><geom type="hfield" hfield="hill"/></worldbody></mujoco>""")
    return scene.overlay({"environment": {"file": "floor.xml"}})


@pytest.mark.parametrize("recompiles", [20, pytest.param(200, marks=pytest.mark.slow)])
def test_recompiles_keep_no_world(tmp_path: Path, recompiles: int) -> None:
    with gloam.load(heavy_scene(tmp_path)) as sim:
        sim.on_step(lambda memory: None)

        def change(i: int) -> None:
            _ = sim.robots["go"].qpos, sim.joints["go/free"].qpos, sim.bodies["go/ball"].pose, sim.memory.array("hfield_data")
            sim.set("light.sun.illuminance", 20000.0 + i, progress=False)
            sim.step()

        for i in range(5):
            change(i)
        before = resident()
        for i in range(recompiles):
            change(i)
        assert resident() - before < 40, "less than five Worlds of 8 MB"


def test_recompiles_keep_no_renderer(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(("depth",), tier="direct", spp=1)

        def change(i: int) -> None:
            sim.set("light.sun.illuminance", 20000.0 + i, progress=False)
            camera.next()

        for i in range(5):
            change(i)
        before = resident()
        for i in range(20):
            change(i)
        assert resident() - before < 30
