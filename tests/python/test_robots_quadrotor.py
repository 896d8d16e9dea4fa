"""assets/robots/quadrotor: mass, inertia, balance of thrust, torque of each control."""
from __future__ import annotations

import numpy as np
import pytest
from robots import Bench, mujoco

FILE = "quadrotor/quadrotor.xml"


def bench(key: str = "hover") -> Bench:
    return Bench(FILE, key)


def test_mass_and_inertia() -> None:
    b = bench()
    assert b.model.body_subtreemass[1] == pytest.approx(1.325, abs=1e-12)
    com = b.data.subtree_com[1] - b.data.xpos[1]
    assert com[:2] == pytest.approx([0, 0], abs=1e-6)
    moments = np.linalg.eigvalsh(inertia_about_com(b))
    assert moments[2] < moments[0] + moments[1]  # of a real body
    assert (moments > 0.008).all() and (moments < 0.04).all()


def inertia_about_com(b: Bench) -> np.ndarray:
    total = np.zeros((3, 3))
    com = b.data.subtree_com[1]
    for body in range(1, b.model.nbody):
        R = b.data.ximat[body].reshape(3, 3)
        d = b.data.xipos[body] - com
        total += R @ np.diag(b.model.body_inertia[body]) @ R.T + b.model.body_mass[body] * (d @ d * np.eye(3) - np.outer(d, d))
    return total


def test_hover_thrust_balances() -> None:
    b = bench()
    assert np.abs(b.data.qacc).max() < 1e-4
    assert b.sensor("imu_accelerometer") == pytest.approx([0, 0, 9.81], abs=1e-4)
    b.run(2)
    assert b.data.qpos[:3] == pytest.approx([0, 0, 1], abs=1e-3)
    assert b.data.qpos[3] == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("axis, signs", [(0, [1, -1, 1, -1]), (1, [-1, -1, 1, 1]), (2, [-1, 1, 1, -1])])
def test_differences_of_thrust_turn_about_one_axis(axis: int, signs: list[int]) -> None:
    b = bench()
    b.data.ctrl[:] += 0.1 * np.array(signs)
    mujoco.mj_forward(b.model, b.data)
    arm = [0.18, 0.14, 0.0201][axis]
    torque = inertia_about_com(b) @ b.data.qacc[3:6]
    assert torque[axis] == pytest.approx(4 * 0.1 * arm, rel=1e-6)
    assert np.delete(torque, axis) == pytest.approx([0, 0], abs=1e-3)


def test_four_times_its_weight_of_thrust() -> None:
    b = bench()
    b.data.ctrl[:] = 100  # the range limits it
    mujoco.mj_forward(b.model, b.data)
    assert b.data.qacc[2] == pytest.approx(4 * 13 / 1.325 - 9.81, rel=1e-3)


def test_stands_on_its_feet() -> None:
    b = bench("ground")
    b.run(1)
    assert b.data.qpos[2] == pytest.approx(0.056, abs=0.002)
    assert np.abs(b.data.qvel).max() < 1e-3
    touching = {b.model.geom(g).name for c in b.data.contact for g in (c.geom1, c.geom2)} - {""}
    assert touching == {"leg_fl", "leg_fr", "leg_rl", "leg_rr"}


def test_cameras_look_where_they_should() -> None:
    b = bench()

    def view(name: str) -> np.ndarray:
        return -np.asarray(b.data.cam(name).xmat).reshape(3, 3)[:, 2]

    assert view("stereo_left") == pytest.approx([1, 0, 0], abs=1e-9)
    assert view("downward") == pytest.approx([0, 0, -1], abs=1e-9)
    baseline = b.data.cam("stereo_left").xpos - b.data.cam("stereo_right").xpos
    assert baseline == pytest.approx([0, 0.05, 0], abs=1e-9)
