"""assets/robots/diff_drive: straight and turning drives after the kinematics of two wheels, encoders, bumper, limits."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from robots import Bench, mujoco

FILE = "diff_drive/diff_drive.xml"
RADIUS, TRACK = 0.035, 0.23  # [m]


def yaw(b: Bench) -> float:
    return float(np.arctan2(*b.data.xmat[1].reshape(3, 3)[[1, 0], 0]))


def test_mass() -> None:
    assert Bench(FILE, "home").model.body_subtreemass[1] == pytest.approx(3.492, abs=1e-9)


def test_stands_still() -> None:
    b = Bench(FILE, "home")
    b.run(1)
    assert b.data.qpos[:2] == pytest.approx([0, 0], abs=1e-4)
    assert abs(b.data.qpos[2]) < 1e-3 and b.data.qpos[3] > 0.9999


@pytest.mark.parametrize("speed", [0.2, -0.3, 0.6])
def test_drives_straight(speed: float) -> None:
    b = Bench(FILE, "home")
    b.data.ctrl[:] = speed / RADIUS
    b.run(1)  # until the speed is steady
    start = b.data.qpos[:2].copy()
    b.run(2)
    way = b.data.qpos[:2] - start
    assert way[0] == pytest.approx(2 * speed, rel=0.04)
    assert abs(way[1]) < 2e-3 and abs(yaw(b)) < 2e-3


@pytest.mark.parametrize("rate", [1.0, -2.0])
def test_turns_on_the_spot(rate: float) -> None:
    b = Bench(FILE, "home")
    wheel = rate * TRACK / 2 / RADIUS
    b.data.ctrl[:] = [-wheel, wheel]
    b.run(0.5)
    start = yaw(b)
    b.run(0.5)
    assert yaw(b) - start == pytest.approx(0.5 * rate, rel=0.06)
    assert np.hypot(*b.data.qpos[:2]) < 0.01


def test_encoders_measure_the_way() -> None:
    b = Bench(FILE, "home")
    b.data.ctrl[:] = 0.4 / RADIUS
    b.run(2)
    for side in ("left", "right"):
        assert b.sensor(f"wheel_{side}_position")[0] * RADIUS == pytest.approx(b.data.qpos[0], rel=0.02)
        assert b.sensor(f"wheel_{side}_velocity")[0] == pytest.approx(b.data.qvel[0] / RADIUS, rel=0.02)


def test_limits_of_the_motors() -> None:
    b = Bench(FILE, "home")
    b.data.ctrl[:] = 1000
    mujoco.mj_step(b.model, b.data)
    assert b.data.actuator_force == pytest.approx([1.64, 1.64])
    b.run(3)
    assert b.data.qvel[0] == pytest.approx(0.7, rel=0.02)


def wall(x: float, y: float, width: float) -> Any:
    def add(spec: Any) -> None:
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=[x, y, 0.1], size=[0.02, width, 0.1])

    return add


@pytest.mark.parametrize("side, y", [("left", 0.13), ("center", 0.0), ("right", -0.13)])
def test_bumper_feels_the_side_of_an_obstacle(side: str, y: float) -> None:
    b = Bench(FILE, "home", add=wall(0.25, y, 0.02))
    most = {name: 0.0 for name in ("left", "center", "right")}
    b.data.ctrl[:] = 0.2 / RADIUS
    for _ in range(60):
        b.run(0.02)
        for name in most:
            most[name] = max(most[name], b.sensor(f"bumper_{name}")[0])
        if most[side] > 0:
            break
    assert most.pop(side) > 1
    assert max(most.values()) == 0


def test_bumper_ignores_the_floor() -> None:
    b = Bench(FILE, "home")
    b.data.ctrl[:] = 10
    b.run(1)
    assert all(b.sensor(f"bumper_{name}")[0] == 0 for name in ("left", "center", "right"))
