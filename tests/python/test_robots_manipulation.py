"""The arm of the mobile manipulator in plain MuJoCo: it reaches, holds its weight, measures forces, and grasps a cube."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from robot_servo import Servo, bench
from robots import mujoco


def add_cube(spec: Any, place: np.ndarray) -> None:
    """A cube of 40 mm and 300 g, on a stand that leaves room for the fingers."""
    stand = spec.worldbody.add_body(name="stand", pos=place - [0, 0, 0.07])
    stand.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.03, 0.03, 0.05])
    cube = spec.worldbody.add_body(name="cube", pos=place)
    cube.add_freejoint()
    cube.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.02] * 3, mass=0.3, friction=[0.8, 0.02, 0.001], condim=4)


def reach(model: Any, data: Any, point: np.ndarray, steps: int = 300) -> float:
    """Moves arm_joint1 … 6 of the state by damped least squares until the TCP is at `point`; the distance left [m]."""
    dofs = [int(model.joint(f"arm_joint{k}").dofadr[0]) for k in range(1, 7)]
    qpos = [int(model.joint(f"arm_joint{k}").qposadr[0]) for k in range(1, 7)]
    low, high = np.array([model.joint(f"arm_joint{k}").range for k in range(1, 7)]).T
    jacobian = np.zeros((3, model.nv))
    for _ in range(steps):
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        error = point - data.site("tcp").xpos
        mujoco.mj_jacSite(model, data, jacobian, None, model.site("tcp").id)
        j = jacobian[:, dofs]
        step = j.T @ np.linalg.solve(j @ j.T + 1e-3 * np.eye(3), error)
        data.qpos[qpos] = np.clip(data.qpos[qpos] + 0.5 * step, low, high)
    return float(np.linalg.norm(error))


def test_arm_reaches_from_a_low_table_to_a_shelf() -> None:
    """Points around the standing robot, in the frame of the world: on a low table, beside a leg, at the height of a door's
    handle, on a shelf. Joint 2 ends with the upper arm 10 degrees above the horizontal, so that points near the floor need
    bent legs."""
    robot = bench("mobile_manipulator")
    home = robot.data.qpos.copy()
    for point in ((0.6, 0.0, 0.35), (0.1, -0.6, 0.5), (0.85, 0.2, 1.0), (0.75, -0.3, 0.75), (0.5, 0.0, 1.45)):
        mujoco.mj_resetData(robot.model, robot.data)
        robot.data.qpos[:] = home
        assert reach(robot.model, robot.data, np.array(point)) < 0.003, point
    assert reach(robot.model, robot.data, np.array([1.6, 0.0, 0.7])) > 0.3, "a point beyond its reach"


def test_arm_moves_under_its_motors_limits() -> None:
    """From one pose to another in two seconds, stretched out: it arrives with its torques within the limits, and the
    legs keep the base up."""
    robot = bench("mobile_manipulator")
    model, data = robot.model, robot.data
    servo = Servo(robot, 400, 10)
    servo.run(0.5)
    first, last = servo.actuator("arm_joint1"), servo.actuator("arm_joint6") + 1
    start, goal = servo.target[first:last].copy(), np.array([0.5, 2.2, -1.0, -0.6, 0.3, 0.8])
    for k in range(100):
        servo.target[first:last] = start + (goal - start) * (k + 1) / 100
        servo.run(0.02)
    servo.run(0.5)
    np.testing.assert_allclose(data.qpos[servo.q_at[first:last]], goal, atol=0.06)
    assert np.all(np.abs(data.ctrl[first:last]) < 0.9 * model.actuator_ctrlrange[first:last, 1])
    assert data.body("trunk").xpos[2] > 0.5


def test_wrist_measures_the_weight_of_the_gripper() -> None:
    robot = bench("mobile_manipulator")
    model, data = robot.model, robot.data
    Servo(robot, 400, 10).run(2)
    weight = 9.81 * model.body_subtreemass[model.body("gripper").id]
    assert np.linalg.norm(data.sensor("wrist_force").data) == pytest.approx(weight, rel=0.02)


def test_fingers_move_together() -> None:
    robot = bench("mobile_manipulator")
    model, data = robot.model, robot.data
    servo = Servo(robot, 400, 10)
    for target in (0.045, 0.0, 0.03):
        servo.target[servo.actuator("gripper")] = target
        servo.run(1)
        both = [float(data.joint(j).qpos[0]) for j in ("gripper_joint", "gripper_coupled_joint")]
        np.testing.assert_allclose(both, target, atol=0.005)
        assert abs(both[0] - both[1]) < 5e-4


def test_gripper_lifts_a_cube() -> None:
    """A cube of 40 mm and 300 g between the fingers: they close on it, the arm lifts it by 0.1 m, and it stays in the
    gripper; when they open, it falls."""
    settled = bench("mobile_manipulator")
    servo = Servo(settled, 400, 10)
    servo.target[servo.actuator("gripper")] = 0.045
    servo.run(2)
    place = settled.data.site("tcp").xpos.copy()
    robot = bench("mobile_manipulator", add=lambda spec: add_cube(spec, place))
    model, data = robot.model, robot.data
    servo = Servo(robot, 400, 10)
    gripper = servo.actuator("gripper")
    data.qpos[: settled.model.nq] = settled.data.qpos
    servo.target[gripper] = -0.15  # 0.17 m at 400 N/m: 68 N
    servo.run(0.5)
    before = data.body("cube").xpos.copy()
    lift = data.site("tcp").xpos + [0, 0, 0.10]
    plan = mujoco.MjData(model)
    plan.qpos[:] = data.qpos
    assert reach(model, plan, lift) < 0.003
    first, last = servo.actuator("arm_joint1"), servo.actuator("arm_joint6") + 1
    turn = (plan.qpos - data.qpos)[servo.q_at[first:last]]
    for _ in range(50):
        servo.target[first:last] += turn / 50
        servo.run(0.02)
    servo.run(0.5)
    raised = data.body("cube").xpos - before
    assert raised[2] > 0.08, raised
    assert np.linalg.norm(data.body("cube").xpos - data.site("tcp").xpos) < 0.02
    servo.target[gripper] = 0.045
    servo.run(0.5)
    assert data.body("cube").xpos[2] < before[2] + 0.01
