"""Targets of joints, controllers that are switched, and trajectories."""
import numpy as np
import pytest

import gloam

ARM = """<mujoco><compiler angle="radian"/><option timestep="0.001"/><worldbody><body name="base"><geom size=".01"/>
<body><joint name="shoulder" axis="0 1 0" range="-2 2" limited="true"/><inertial pos=".3 0 0" mass="1" diaginertia=".01 .01 .01"/>
<body pos=".3 0 0"><joint name="elbow" axis="0 1 0"/><inertial pos=".2 0 0" mass=".5" diaginertia=".01 .01 .01"/></body></body>
</body></worldbody><actuator><motor name="shoulder" joint="shoulder"/><motor name="elbow" joint="elbow"/></actuator></mujoco>"""


@pytest.fixture
def sim(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    (tmp_path / "scene.toml").write_text('[[robot]]\nname = "arm"\nfile = "arm.xml"\n[robot.controller]\ntype = "joint_position"\nkp = 400\nkd = 10\n')
    with gloam.load(tmp_path / "scene.toml") as sim:
        yield sim


def test_effort_balances_gravity(sim):
    robot = sim.robots["arm"]
    robot.set_controller("joint_effort")
    # About y, horizontal: forearm at 0.2 m, and both seen from the shoulder.
    robot.command_joints(effort=[-9.81 * (0.3 + 0.5 * 0.5), -9.81 * 0.5 * 0.2])
    sim.step(500)
    assert np.abs(robot.qpos).max() < 1e-9


def test_trajectories_arrive_and_are_replaced(sim):
    robot = sim.robots["arm"]
    robot.follow([0.5, -0.5], max_velocity=1, max_acceleration=4)
    sim.step(200)
    robot.follow([[0.2, 0.0], [0.0, 0.3]], times=[0.5, 1.0], velocities=[[0, 0], [0, 0]])
    sim.step(3000)
    assert np.abs(robot.qpos - [0.0, 0.3]).max() < 0.05
    robot.follow([0.1], joints=["elbow"], profile="quintic")
    robot.stop_trajectory()
    sim.step(10)


def test_switched_runs_repeat(sim):
    robot = sim.robots["arm"]

    def play():
        sim.step(50)
        robot.set_controller("joint_velocity", kp=100, kd=10)
        robot.command_joints(velocity=[0.2, -0.3])
        sim.step(500)
        return sim.hash

    first = play()
    sim.reset()
    assert play() == first


def test_errors_name_the_remedy(sim):
    robot = sim.robots["arm"]
    for call, part in [(lambda: robot.set_controller("joint_efort"), "joint_effort"), (lambda: robot.set_controller("joint_effort", kq=1), "kp"),
                       (lambda: robot.command_joints(position=[1]), "1 values for 2 joints"), (lambda: robot.follow([5, 0]), "outside its range"),
                       (lambda: robot.follow([0, 0], times=[0.1], max_velocity=-1, profile="quintic"), "positive"),
                       (lambda: robot.follow([[0, 0], [0, 0]], times=[1, 1]), "do not increase"), (lambda: robot.follow([np.nan, 0]), "finite"),
                       (lambda: robot.follow([0, 0], profile="round"), "round")]:
        with pytest.raises(gloam.Error, match=part):
            call()
    with pytest.raises(gloam.Error, match="elbow"):
        robot.command_joints(position=[0], joints=["elbwo"])
