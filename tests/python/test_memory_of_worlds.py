"""A World that a simulation has left is freed, whatever Python has looked at before."""
from __future__ import annotations

import ctypes
import gc
import os
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import gloam
import pytest
from scenes import ball_scene

MEGABYTE = 1 << 20
LIMIT = 40  # [MB]


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


def growth(change: Callable[[int], None], warm_up: int, rounds: int) -> float:
    """Memory that `rounds` of `change` have added [MB]. Worlds wait up to 2 s for their entries in the cache, so it
    waits for less than LIMIT."""
    for i in range(warm_up):
        change(i)
    before = resident()
    for i in range(rounds):
        change(warm_up + i)
    end = time.monotonic() + 20
    while resident() - before >= LIMIT and time.monotonic() < end:
        time.sleep(0.2)
    return resident() - before


def alone(measure: Callable[..., float], *arguments: Any) -> float:
    """Result of `measure` in a process of its own, whose allocator holds nothing of other tests."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as process:
        return process.submit(measure, *arguments).result()


def growth_by_worlds(folder: Path, rounds: int) -> float:
    with gloam.load(heavy_scene(folder)) as sim:
        sim.on_step(lambda memory: None)

        def change(i: int) -> None:
            _ = sim.robots["go"].qpos, sim.joints["go/free"].qpos, sim.bodies["go/ball"].pose, sim.memory.array("hfield_data")
            sim.set("light.sun.illuminance", 20000.0 + i, progress=False)
            sim.step()

        return growth(change, 5, rounds)


def growth_by_renderers(folder: Path, rounds: int) -> float:
    with gloam.load(ball_scene(folder)) as sim:
        camera = sim.cameras["small"].open(("depth",), tier="direct", spp=1)

        def change(i: int) -> None:
            sim.set("light.sun.illuminance", 20000.0 + i, progress=False)
            camera.next()

        return growth(change, 10, rounds)


@pytest.mark.parametrize("recompiles", [20, pytest.param(200, marks=pytest.mark.slow)])
def test_recompiles_keep_no_world(tmp_path: Path, recompiles: int) -> None:
    assert alone(growth_by_worlds, tmp_path, recompiles) < LIMIT, "less than five Worlds of 8 MB"


def test_recompiles_keep_no_renderer(tmp_path: Path) -> None:
    assert alone(growth_by_renderers, tmp_path, 20) < LIMIT
