"""gloam.ik against the package mink: equal joint velocities for the same states, targets and limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gloam
import ik_models
import mink
import mujoco
import numpy as np
import pytest
from gloam import ik

STATES = 60  # random states for each case
DT = 0.01  # [s]
TOLERANCE = 1e-6  # [rad/s, m/s]


@dataclass
class Robot:
    make: Callable[[Path], Path]
    hand: tuple[str, str]  # kind and name of the frame to move
    foot: tuple[str, str]  # of another
    root: tuple[str, str]  # of the relative frame task's root
    collisions: list[tuple[list[str], list[str]]]
    distance: float  # [m] that some states violate and some keep


ROBOTS = {
    "arm": Robot(ik_models.arm, ("site", "tool"), ("geom", "link4"), ("body", "link2"),
                 [(["link6", "link5", "link4"], ["post", "floor", "link0", "link1"])], 0.05),
    "quadruped": Robot(ik_models.quadruped, ("site", "FL_touch"), ("geom", "RR_foot"), ("body", "trunk"),
                       [(["FL_foot", "FL_calf_collision"], ["FR_foot", "FR_calf_collision", "RL_foot"])], 0.2),
    "humanoid": Robot(ik_models.humanoid, ("site", "left_palm"), ("site", "right_sole"), ("body", "torso"),
                      [(["left_hand", "right_hand"], ["torso", "pelvis", "left_thigh", "right_thigh", "left_hand"]),
                       (["left_foot", "left_shin"], ["right_foot", "right_shin", "floor"])], 0.1),
    "balls": Robot(ik_models.chain_of_balls, ("site", "tip"), ("body", "c"), ("body", "a"), [(["d", "c"], ["a"])], 0.3),
}  # fmt: skip


class Case:
    """A robot in both programs, and pairs of equal tasks and limits."""

    def __init__(self, robot: Robot, folder: Path, rng: np.random.Generator) -> None:
        path = robot.make(folder)
        self.robot = robot
        self.rng = rng
        self.world = gloam.load(path).world
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.configuration = mink.Configuration(self.model)
        self.targets: list[Callable[[], None]] = []  # draw new targets

    def random_qpos(self) -> np.ndarray:
        """A state within the ranges of all joints, with the base anywhere near its place."""
        q = self.model.qpos0.copy()
        mujoco.mj_integratePos(self.model, q, self.rng.uniform(-0.5, 0.5, self.model.nv), 1.0)
        for j in range(self.model.njnt):
            if self.model.jnt_limited[j] and self.model.jnt_type[j] in (2, 3):
                low, high = self.model.jnt_range[j]
                q[self.model.jnt_qposadr[j]] = self.rng.uniform(low, high)
        return q

    def random_pose(self, near: mink.SE3, turn: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        twist = np.concatenate([self.rng.uniform(-0.3, 0.3, 3), self.rng.uniform(-turn, turn, 3)])
        pose = near @ mink.SE3.exp(twist)
        return pose.wxyz_xyz[4:].copy(), pose.wxyz_xyz[:4].copy()

    def frame(self, kind_name: tuple[str, str], lm: float = 0.0, cost: Any = 1.0, gain: float = 1.0, turn: float = 1.0) -> tuple[Any, Any]:
        kind, name = kind_name
        ours = ik.FrameTask(f"{kind} {name}", position_cost=cost, orientation_cost=0.7, gain=gain, lm_damping=lm)
        theirs = mink.FrameTask(name, kind, cost, 0.7, gain, lm)

        def draw() -> None:
            ours.target = self.random_pose(self.configuration.get_transform_frame_to_world(name, kind), turn)
            theirs.set_target(mink.SE3(np.concatenate([ours.target[1], ours.target[0]])))

        self.targets.append(draw)
        return ours, theirs

    def relative(self) -> tuple[Any, Any]:
        (kind, name), (root_kind, root) = self.robot.hand, self.robot.root
        ours = ik.RelativeFrameTask(f"{kind} {name}", f"{root_kind} {root}", (1, 2, 0.5), 0.3, 0.8, 0.1)
        theirs = mink.RelativeFrameTask(name, kind, root, root_kind, (1, 2, 0.5), 0.3, 0.8, 0.1)

        def draw() -> None:
            ours.target = self.random_pose(self.configuration.get_transform(name, kind, root, root_kind))
            theirs.set_target(mink.SE3(np.concatenate([ours.target[1], ours.target[0]])))

        self.targets.append(draw)
        return ours, theirs

    def posture(self, cost: Any = 0.1, gain: float = 1.0, lm: float = 0.0) -> tuple[Any, Any]:
        ours = ik.PostureTask(cost, gain, lm)
        theirs = mink.PostureTask(self.model, cost, gain, lm)

        def draw() -> None:
            ours.target = self.random_qpos()
            theirs.set_target(ours.target)

        self.targets.append(draw)
        return ours, theirs

    def com(self) -> tuple[Any, Any]:
        ours, theirs = ik.ComTask((1, 0.5, 2), 0.6, 0.01), mink.ComTask((1, 0.5, 2), 0.6, 0.01)

        def draw() -> None:
            ours.target = self.configuration.data.subtree_com[1] + self.rng.uniform(-0.2, 0.2, 3)
            theirs.set_target(ours.target)

        self.targets.append(draw)
        return ours, theirs

    def damping(self) -> tuple[Any, Any]:
        cost = self.rng.uniform(0.05, 0.5, self.model.nv)
        return ik.DampingTask(cost), mink.DampingTask(self.model, cost)

    def range(self) -> tuple[Any, Any]:
        return ik.ConfigurationLimit(0.8, 0.02), mink.ConfigurationLimit(self.model, 0.8, 0.02)

    def speed(self) -> tuple[Any, Any]:
        bounds: dict[str, Any] = {}
        for j in range(self.model.njnt):
            if self.model.jnt_type[j] != 0:
                width = 3 if self.model.jnt_type[j] == 1 else 1
                bounds[self.model.joint(j).name] = self.rng.uniform(0.5, 4, width)
        return ik.VelocityLimit(bounds), mink.VelocityLimit(self.model, bounds)

    def apart(self) -> tuple[Any, Any]:
        return (
            ik.CollisionLimit(self.robot.collisions, 0.85 / DT, self.robot.distance, self.robot.distance + 0.2, 0.001),
            mink.CollisionAvoidanceLimit(self.model, self.robot.collisions, 0.85, self.robot.distance, self.robot.distance + 0.2, 0.001),
        )

    def compare(self, tasks: list[tuple[Any, Any]], limits: list[tuple[Any, Any]], damping: float) -> tuple[int, int]:
        """Solves both in random states. Returns how many had a solution, and how many reached a limit."""
        solver = ik.Solver(self.world, [t[0] for t in tasks], [limit[0] for limit in limits], damping)
        free = ik.Solver(self.world, [t[0] for t in tasks], [], damping)
        solved = limited = 0
        for _ in range(STATES):
            q = self.random_qpos()
            self.configuration.update(q)
            for draw in self.targets:
                draw()
            v = solver.solve(q, DT)
            try:
                w = mink.solve_ik(self.configuration, [t[1] for t in tasks], DT, "quadprog", damping, limits=[limit[1] for limit in limits])
            except mink.NoSolutionFound:
                assert solver.status == "infeasible"
                assert not v.any()
                continue
            assert solver.status == "solved"
            np.testing.assert_allclose(v, w, rtol=0, atol=TOLERANCE * max(1.0, np.abs(w).max()))
            for ours, theirs in tasks:
                if not isinstance(ours, ik.DampingTask):
                    np.testing.assert_allclose(ours.error, theirs.compute_error(self.configuration), rtol=0, atol=1e-9)
            solved += 1
            limited += bool(np.abs(v - free.solve(q, DT)).max() > 1e-3)
        return solved, limited


@pytest.fixture
def case(request: pytest.FixtureRequest, tmp_path: Path) -> Case:
    return Case(ROBOTS[request.param], tmp_path, np.random.default_rng(7))


every_robot = pytest.mark.parametrize("case", list(ROBOTS), indirect=True)

TASKS: dict[str, Callable[[Case], list[tuple[Any, Any]]]] = {
    "frame": lambda c: [c.frame(c.robot.hand)],
    "frame, weights of each axis": lambda c: [c.frame(c.robot.hand, cost=(1, 0, 3), gain=0.5)],
    "frame, nearly turned": lambda c: [c.frame(c.robot.hand, turn=1e-6)],
    "frame, half a turn": lambda c: [c.frame(c.robot.hand, turn=3.0)],
    "frame, damped by its error": lambda c: [c.frame(c.robot.foot, lm=0.5)],
    "relative frame": lambda c: [c.relative()],
    "posture": lambda c: [c.posture(1.0, 0.7, 0.2)],
    "centre of mass": lambda c: [c.com()],
    "damping": lambda c: [c.frame(c.robot.hand), c.damping()],
    "all": lambda c: [c.frame(c.robot.hand), c.frame(c.robot.foot, lm=0.1), c.relative(), c.posture(0.05), c.com(), c.damping()],
}


@every_robot
@pytest.mark.parametrize("tasks", list(TASKS))
def test_each_task(case: Case, tasks: str) -> None:
    solved, _ = case.compare(TASKS[tasks](case), [], damping=1e-3)
    assert solved == STATES


LIMITS: dict[str, Callable[[Case], list[tuple[Any, Any]]]] = {
    "configuration": lambda c: [c.range()],
    "velocity": lambda c: [c.speed()],
    "collision": lambda c: [c.apart()],
    "configuration, velocity": lambda c: [c.range(), c.speed()],
    "all": lambda c: [c.range(), c.speed(), c.apart()],
}


@every_robot
@pytest.mark.parametrize("limits", list(LIMITS))
def test_each_limit(case: Case, limits: str) -> None:
    tasks = [case.frame(case.robot.hand), case.frame(case.robot.foot), case.posture(0.1)]
    solved, limited = case.compare(tasks, LIMITS[limits](case), damping=1e-6)
    assert solved > STATES // 2
    assert limited > 0, "no state tests the limit"


@every_robot
def test_everything_at_once(case: Case) -> None:
    solved, limited = case.compare(TASKS["all"](case), LIMITS["all"](case), damping=1e-9)
    assert solved > STATES // 2
    assert limited > STATES // 2


def test_weak_damping_of_a_redundant_arm(tmp_path: Path) -> None:
    """H is nearly singular with mink's default damping; bounds are active all the same."""
    case = Case(ROBOTS["arm"], tmp_path, np.random.default_rng(3))
    solved, limited = case.compare([case.frame(case.robot.hand), case.posture(1e-3)], [case.range(), case.speed()], damping=1e-12)
    assert solved > STATES // 2
    assert limited > 0
