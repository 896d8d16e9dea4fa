"""assets/robots/manipulator: published kinematics and masses, limits, the force-torque sensor, and a grasp."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from robots import Bench, mujoco

FILE = "manipulator/manipulator.xml"
# Universal Robots, "Parameters for calculations of kinematics and dynamics", UR5e: a, d, alpha, mass, centre of mass.
LINKS = {
    "shoulder": (0, 0.1625, np.pi / 2, 3.761, (0, -0.02561, 0.00193)),
    "upper_arm": (-0.425, 0, 0, 8.058, (0.2125, 0, 0.11336)),
    "forearm": (-0.3922, 0, 0, 2.846, (0.15, 0, 0.0265)),
    "wrist_1": (0, 0.1333, np.pi / 2, 1.37, (0, -0.0018, 0.01634)),
    "wrist_2": (0, 0.0997, -np.pi / 2, 1.3, (0, 0.0018, 0.01634)),
    "wrist_3": (0, 0.0996, 0, 0.365, (0, 0, -0.001159)),
}
GRIPPER_MASS = 0.997  # with the camera's 0.072 kg


def denavit_hartenberg(angle: float, a: float, d: float, alpha: float) -> np.ndarray:
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])


@pytest.mark.parametrize("seed", range(5))
def test_kinematics_and_masses_are_the_published_ones(seed: int) -> None:
    b = Bench(FILE, "home")
    q = np.random.default_rng(seed).uniform(-3, 3, 6)
    b.data.qpos[:6] = q
    mujoco.mj_forward(b.model, b.data)
    pose = denavit_hartenberg(np.pi, 0, 0, 0)  # their base frame
    for angle, (name, (a, d, alpha, mass, center)) in zip(q, LINKS.items()):
        pose = pose @ denavit_hartenberg(angle, a, d, alpha)
        body = b.model.body(f"{name}_link").id
        assert b.model.body_mass[body] == pytest.approx(mass)
        assert b.data.xipos[body] == pytest.approx((pose @ [*center, 1])[:3], abs=1e-7)
    flange = b.data.site("flange")
    assert flange.xpos == pytest.approx(pose[:3, 3], abs=1e-7)
    assert flange.xmat.reshape(3, 3)[:, 2] == pytest.approx(pose[:3, 2], abs=1e-7)


def test_holds_its_keyframe_against_gravity() -> None:
    b = Bench(FILE, "home")
    start, tip = b.data.qpos.copy(), b.sensor("tcp_position").copy()
    assert b.data.ncon == 0
    b.run(2)
    assert np.abs(b.data.qpos - start).max() < 0.005
    assert np.linalg.norm(b.sensor("tcp_position") - tip) < 0.005
    assert np.abs(b.data.qvel).max() < 1e-3


def test_carries_its_payload_stretched_out() -> None:
    def payload(spec: Any) -> None:
        spec.body("gripper").add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.02, 0, 0], pos=[0, 0, 0.143], mass=5, contype=0, conaffinity=0)

    b = Bench(FILE, "home", add=payload)
    b.data.ctrl[:6] = [0, -0.2, 0.1, 0, 0, 0]
    b.run(3)
    assert b.data.qpos[:6] == pytest.approx(b.data.ctrl[:6], abs=0.02)
    assert np.abs(b.data.actuator_force[:3]).max() < 150


def test_force_torque_sensor_weighs_the_gripper() -> None:
    b = Bench(FILE, "home")
    b.run(1)
    weight = GRIPPER_MASS * 9.81
    assert np.linalg.norm(b.sensor("wrist_force")) == pytest.approx(weight, rel=0.01)
    assert b.sensor("wrist_force")[2] == pytest.approx(-weight, rel=0.01)  # along the tool: it pulls


def test_gripper_closes_both_fingers_at_its_speed() -> None:
    b = Bench(FILE, "home")
    assert b.sensor("gripper_opening")[0] == pytest.approx(0.085)
    b.data.ctrl[6] = 0
    fastest = 0.0
    for _ in range(100):
        b.run(0.01)
        fastest = max(fastest, -b.data.qvel[6])
        assert b.data.qpos[6] == pytest.approx(b.data.qpos[7], abs=1e-4)
    assert 0.1 < fastest < 0.151
    assert b.sensor("gripper_opening")[0] == pytest.approx(0, abs=1e-3)


def test_grasps_a_cube_and_lifts_it() -> None:
    tip = Bench(FILE, "home").sensor("tcp_position").copy()

    def cube_on_a_stand(spec: Any) -> None:
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=[tip[0], tip[1], tip[2] / 2 - 0.0155], size=[0.1, 0.1, tip[2] / 2 - 0.0155])
        cube = spec.worldbody.add_body(name="cube", pos=[tip[0], tip[1] + 0.004, tip[2] - 0.006])
        cube.add_freejoint()
        cube.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.025] * 3, mass=0.3)

    b = Bench(FILE, "home", add=cube_on_a_stand)
    cube = b.data.body("cube")
    b.data.qpos[8:15] = [tip[0], tip[1] + 0.004, tip[2] - 0.006, 1, 0, 0, 0]
    b.run(0.3)
    b.data.ctrl[6] = 0.03
    b.run(1)
    assert b.sensor("gripper_opening")[0] == pytest.approx(0.05, abs=0.002)
    assert b.sensor("left_pad_force")[0] == pytest.approx(4000 * (b.sensor("gripper_opening")[0] - 0.03), rel=0.1)
    held = cube.xpos - b.sensor("tcp_position")
    height = cube.xpos[2]
    b.data.ctrl[1] -= 0.25
    b.data.ctrl[3] += 0.25  # the gripper keeps its tilt
    b.run(2)
    assert cube.xpos[2] > height + 0.08
    assert cube.xpos - b.sensor("tcp_position") == pytest.approx(held, abs=0.004)
    b.data.ctrl[6] = 0.085
    b.run(0.6)
    assert cube.xpos[2] < height + 0.05  # let go
