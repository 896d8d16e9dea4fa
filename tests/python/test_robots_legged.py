"""The catalogue's legged robots in plain MuJoCo: published masses and limits, standing, sensors, and their files."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np
import pytest
from robot_servo import Servo, bench
from robots import ROBOTS, mujoco

LEGGED = ["quadruped", "mobile_manipulator", "humanoid"]
GAINS = {"quadruped": (60.0, 2.0), "mobile_manipulator": (400.0, 10.0), "humanoid": (300.0, 3.0)}  # N m/rad, N m s/rad
FEET = {"quadruped": 4, "mobile_manipulator": 4, "humanoid": 2}


def entry(name: str) -> dict[str, Any]:
    return tomllib.loads((ROBOTS / name / "robot.toml").read_text())


def assert_only_the_floor_is_touched(model: Any, data: Any) -> None:
    """Geoms of the floor belong to body 0."""
    for contact in data.contact[: data.ncon]:
        pair = [model.geom(g) for g in (contact.geom1, contact.geom2)]
        assert 0 in [int(geom.bodyid[0]) for geom in pair], [geom.name for geom in pair]


@pytest.mark.parametrize("name", LEGGED)
def test_stands_five_seconds(name: str) -> None:
    """At its keyframe, on stiff joints: it keeps its height and its place and comes to rest on its feet alone."""
    robot = bench(name)
    model, data = robot.model, robot.data
    start = data.qpos[:3].copy()
    assert_only_the_floor_is_touched(model, data)
    Servo(robot, *GAINS[name]).run(5)
    assert data.body(1).xmat[8] > 0.995, "tilted"
    assert abs(data.qpos[2] - start[2]) < 0.04 and np.linalg.norm(data.qpos[:2] - start[:2]) < 0.05
    assert np.abs(data.qvel).max() < 0.05
    assert_only_the_floor_is_touched(model, data)
    feet = [i for i in range(model.nsensor) if model.sensor_type[i] == mujoco.mjtSensor.mjSENS_TOUCH]
    forces = data.sensordata[model.sensor_adr[feet]]
    weight = 9.81 * model.body_subtreemass[1]
    assert len(feet) == FEET[name] and forces.min() > 0.1 * weight
    assert forces.sum() == pytest.approx(weight, rel=0.02)


@pytest.mark.parametrize("push", [20.0, -20.0])
def test_humanoid_withstands_a_small_push(push: float) -> None:
    """A force on the torso for 0.1 s [N], along x."""
    robot = bench("humanoid")
    servo = Servo(robot, *GAINS["humanoid"])
    servo.run(1)
    torso = robot.model.body("torso_link").id
    robot.data.xfrc_applied[torso, 0] = push
    servo.run(0.1)
    assert np.sign(robot.data.body("pelvis").cvel[3]) == np.sign(push)
    robot.data.xfrc_applied[:] = 0
    servo.run(2)
    assert robot.data.body("pelvis").xmat[8] > 0.99 and robot.data.qpos[2] > 0.73


@pytest.mark.parametrize("name", ["mobile_manipulator", "humanoid"])
def test_controller_of_the_entry_is_the_one_that_stands(name: str) -> None:
    controller = entry(name)["controller"]
    assert controller == {"type": "joint_position", "kp": GAINS[name][0], "kd": GAINS[name][1]}


@pytest.mark.parametrize("name", LEGGED)
def test_inertias_are_physical(name: str) -> None:
    """Principal moments obey the triangle inequality, and radii of gyration are at most the size of the robot's links."""
    model = bench(name).model
    for i in range(1, model.nbody):
        if model.body_mass[i] == 0:
            continue
        a, b, c = sorted(model.body_inertia[i])
        assert a > 0 and a + b >= 0.999 * c, model.body(i).name
        assert np.sqrt(c / model.body_mass[i]) < 0.2, model.body(i).name


@pytest.mark.parametrize("name", LEGGED)
def test_left_and_right_mirror_each_other(name: str) -> None:
    model = bench(name).model
    pairs = 0
    for i in range(1, model.nbody):
        left = model.body(i).name
        right = left.replace("left", "right") if "left" in left else "FR" + left[2:] if left[:2] == "FL" else "RR" + left[2:]
        if right == left or left[:2] not in ("FL", "RL", "le"):
            continue
        j = model.body(right).id
        mirror = np.array([1, -1, 1])
        assert model.body_mass[i] == model.body_mass[j]
        np.testing.assert_allclose(model.body_pos[i], mirror * model.body_pos[j], atol=1e-9)
        np.testing.assert_allclose(model.body_ipos[i], mirror * model.body_ipos[j], atol=1e-9)
        np.testing.assert_allclose(model.body_inertia[i], model.body_inertia[j], rtol=1e-6)
        pairs += 1
    assert pairs == (13 if name == "humanoid" else 6)


@pytest.mark.parametrize("name", LEGGED)
def test_camera_mounts_look_out(name: str) -> None:
    """Rays from the mounts of cameras along their axes leave the robot: nothing drawn is in front of a lens."""
    robot = bench(name)
    model, data = robot.model, robot.data
    hit = np.zeros(1, np.int32)
    mounts = [s["mount"] for s in entry(name)["sensor"] if s["kind"] in ("stereo", "rgbd", "camera")]
    assert mounts
    for mount in mounts:
        site = data.site(mount)
        drawn = np.array([0, 0, 1, 0, 0, 0], np.uint8)
        ahead = -site.xmat.reshape(3, 3)[:, 2]
        distance = mujoco.mj_ray(model, data, site.xpos, ahead, drawn, 1, -1, hit)
        assert distance < 0 or distance > 0.25, (mount, distance)


@pytest.mark.parametrize("name", ["mobile_manipulator", "humanoid"])
def test_meshes_are_small(name: str) -> None:
    """At most 150,000 drawn triangles and 4.2 MB, and all meshes are drawn."""
    assert sum(p.stat().st_size for p in (ROBOTS / name / "meshes").iterdir()) < 4.2e6
    model = bench(name).model
    drawn = model.geom_dataid[model.geom_type == mujoco.mjtGeom.mjGEOM_MESH]
    assert model.mesh_facenum[drawn].sum() < 150_000
    assert set(drawn) == set(range(model.nmesh))


def test_mobile_manipulator_has_the_published_masses_and_limits() -> None:
    """Unitree's b1_description and z1_description."""
    model = bench("mobile_manipulator").model
    arm = model.body_subtreemass[model.body("arm_base").id]
    assert model.body_subtreemass[1] - arm == pytest.approx(59.65, abs=0.01)
    gripper = model.body_subtreemass[model.body("gripper").id]
    assert arm - gripper == pytest.approx(4.42, abs=0.01) and gripper == pytest.approx(0.802 + 0.072, abs=0.01)
    limits = {a: model.actuator(a).ctrlrange[1] for a in ("FL_hip", "FL_thigh", "FL_calf", "arm_joint1", "arm_joint2")}
    assert limits == {"FL_hip": 91, "FL_thigh": 93.33, "FL_calf": 140, "arm_joint1": 30, "arm_joint2": 60}
    np.testing.assert_allclose(np.degrees(model.joint("arm_joint2").range), [0, 170], atol=0.1)


def test_humanoid_has_the_joints_of_the_g1() -> None:
    """Names in the order of Unitree's 29 motors, mass, height of the pelvis with straight legs."""
    model = bench("humanoid").model
    leg = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]
    arm = ["shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_roll", "wrist_pitch", "wrist_yaw"]
    waist = ["waist_yaw", "waist_roll", "waist_pitch"]
    wanted = [f"left_{j}" for j in leg] + [f"right_{j}" for j in leg] + waist
    wanted += [f"left_{j}" for j in arm] + [f"right_{j}" for j in arm]
    assert [model.actuator(i).name for i in range(model.nu)] == wanted
    assert [model.joint(model.actuator_trnid[i, 0]).name for i in range(model.nu)] == [f"{j}_joint" for j in wanted]
    assert model.body_subtreemass[1] == pytest.approx(33.34, abs=0.01)
    data = mujoco.MjData(model)
    data.qpos[2:4] = 0.793, 1
    mujoco.mj_forward(model, data)
    soles = [data.geom(f"left_sole_{side}").xpos[2] - 0.01 for side in ("inner", "outer", "middle")]
    np.testing.assert_allclose(soles, 0.0, atol=0.003)
