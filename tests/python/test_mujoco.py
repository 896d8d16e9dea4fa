"""sim.model and sim.data: the memory that is stepped, as the package mujoco sees it."""
from __future__ import annotations

import gc
import subprocess
import sys
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file

mujoco: Any = pytest.importorskip("mujoco")


def test_data_is_the_memory_that_is_stepped(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        data, model = sim.data, sim.model
        assert isinstance(data, mujoco.MjData) and isinstance(model, mujoco.MjModel) and sim.data is data and sim.model is model
        addresses = [a.__array_interface__["data"][0] for a in (data.qpos, sim.memory.array("qpos"), sim.joints["free"].qpos)]
        assert len(set(addresses)) == 1
        assert np.array_equal(model.geom_size, sim.memory.array("geom_size"))
        sim.step(100)
        assert data.time == pytest.approx(0.2) and data.body("ball").xpos[2] < 1
        data.qpos[0] = 0.7
        data.ctrl[0] = 0.01
        sim.step()
        assert sim.joints["free"].qpos[0] == pytest.approx(0.7)
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacBody(model, data, jacobian, None, model.body("ball").id)
        assert jacobian[:, :3] == pytest.approx(np.eye(3))


def test_a_run_is_that_of_stock_mujoco() -> None:
    stock = mujoco.MjModel.from_xml_path(str(QUADRUPED))
    data = mujoco.MjData(stock)
    with gloam.load(QUADRUPED) as sim:
        for _ in range(50):
            mujoco.mj_step(stock, data)
        sim.step(50)
        assert np.array_equal(sim.data.qpos, data.qpos) and np.array_equal(sim.data.qvel, data.qvel)


def test_views_outlive_recompiles_and_the_simulation(tmp_path: Path) -> None:
    sim = gloam.load(ball_file(tmp_path))
    data, model = sim.data, sim.model
    mass = model.body_mass
    sim.step(10)
    qpos, seen = data.qpos, data.qpos.copy()
    sim.recompile(sim.world)
    assert sim.data is not data
    sim.step(10)
    assert np.array_equal(qpos, seen) and sim.data.time == pytest.approx(0.04)
    sim.close()
    del sim, data, model
    gc.collect()
    assert np.array_equal(qpos, seen) and mass[1] == 1


def test_without_the_package_the_error_says_what_to_install(tmp_path: Path) -> None:
    code = f"""
import sys
sys.modules["mujoco"] = None
import gloam
sim = gloam.load({str(ball_file(tmp_path))!r})
sim.step(3)
try:
    sim.data
except ImportError as error:
    print("pip install" in str(error), sim.memory.array("qpos")[2] < 1)
"""
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert told.split() == ["True", "True"]
