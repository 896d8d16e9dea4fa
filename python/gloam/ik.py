"""Differential inverse kinematics: joint velocities that bring frames of a model to their targets, within limits.

    hand = gloam.ik.FrameTask("site tool", target=((0.4, 0.1, 0.3), (0, 1, 0, 0)))
    rest = gloam.ik.PostureTask(cost=1e-2, target=qpos)
    solver = gloam.ik.Solver(sim.world, [hand, rest], [gloam.ik.ConfigurationLimit()])
    velocity = solver.solve(qpos, dt=0.01)

A quadratic program in the displacement dq = v dt, as in the package mink: min 1/2 dq' H dq + c' dq with
G dq <= h. docs/controllers.md lists the differences from mink.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gloam import _core

from .errors import UsageError
from .simulation import Simulation
from .world import World

Doubles = NDArray[np.float64]


def _three(cost: ArrayLike) -> Doubles:
    """One cost for all axes, or three."""
    return np.broadcast_to(np.asarray(cost, float), 3)


@dataclass
class FrameTask:
    """Regulates the pose of a frame of the model to a target in the world.

    frame: "site NAME", "body NAME" or "geom NAME".
    position_cost, orientation_cost: weights of the error along and about the frame's axes [1/m, 1/rad], one or (3,).
    gain: share of the error removed in one step, 0..1. lm_damping: Levenberg-Marquardt damping, >= 0.
    target: Pose, or position (3,) [m] and quaternion wxyz (4,).
    error: after solve(): log(X_BT), a twist in the frame's axes, translation first [m, rad], (6,).
    """

    frame: str
    position_cost: ArrayLike = 1.0
    orientation_cost: ArrayLike = 1.0
    gain: float = 1.0
    lm_damping: float = 0.0
    target: Any = None
    error: Doubles = field(default_factory=lambda: np.zeros(6), repr=False)
    _is_pose: ClassVar[bool] = True

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_frame(self.frame, _three(self.position_cost), _three(self.orientation_cost), self.gain, self.lm_damping)


@dataclass
class RelativeFrameTask:
    """Regulates the pose of `frame` in the frame `root` of the model; fields as of FrameTask.

    target: pose in `root`. error: log(X_TB), (6,).
    """

    frame: str
    root: str
    position_cost: ArrayLike = 1.0
    orientation_cost: ArrayLike = 1.0
    gain: float = 1.0
    lm_damping: float = 0.0
    target: Any = None
    error: Doubles = field(default_factory=lambda: np.zeros(6), repr=False)
    _is_pose: ClassVar[bool] = True

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_relative_frame(
            self.frame, self.root, _three(self.position_cost), _three(self.orientation_cost), self.gain, self.lm_damping
        )


@dataclass
class PostureTask:
    """Regulates all coordinates, except at free joints, to a configuration.

    cost: one for all degrees of freedom, or (nv,). target: qpos (nq,) [rad, m]. error: (nv,) [rad, m].
    """

    cost: ArrayLike = 1.0
    gain: float = 1.0
    lm_damping: float = 0.0
    target: Any = None
    error: Doubles = field(default_factory=lambda: np.zeros(0), repr=False)
    _is_pose: ClassVar[bool] = False

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_posture(np.atleast_1d(np.asarray(self.cost, float)), self.gain, self.lm_damping)


@dataclass
class ComTask:
    """Regulates the centre of mass of a body and its descendants to a point in the world.

    cost: weights along the world's axes [1/m], one or (3,). body: full name, "" = body 1, the whole robot of a bare
    model. target: (3,) [m]. error: (3,) [m].
    """

    cost: ArrayLike = 1.0
    gain: float = 1.0
    lm_damping: float = 0.0
    body: str = ""
    target: Any = None
    error: Doubles = field(default_factory=lambda: np.zeros(3), repr=False)
    _is_pose: ClassVar[bool] = False

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_com(self.body, _three(self.cost), self.gain, self.lm_damping)


@dataclass
class DampingTask:
    """Regulates the velocities of all joints except free joints to zero. cost: one for all degrees of freedom, or (nv,)."""

    cost: ArrayLike = 1.0

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_damping(np.atleast_1d(np.asarray(self.cost, float)))


@dataclass
class ConfigurationLimit:
    """Keeps hinges and slides within their ranges, and ball joints within their angle.

    gain: share of the remaining distance that one step may cover, (0, 1]. min_distance: kept from each end [rad, m].
    """

    gain: float = 0.95
    min_distance: float = 0.0

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_configuration_limit(self.gain, self.min_distance)


@dataclass
class VelocityLimit:
    """Bounds velocities of joints by their full names [rad/s, m/s]; of a ball joint (3,)."""

    velocities: Mapping[str, ArrayLike]

    def _add_to(self, problem: _core.IkProblem) -> None:
        problem.add_velocity_limit([(name, np.atleast_1d(np.asarray(v, float)).tolist()) for name, v in self.velocities.items()])


@dataclass
class CollisionLimit:
    """Keeps geoms apart: each geom of the first group of a pair from each of the second.

    gain: share of the remaining distance for one step, > 0. mink 1.3 divides its bound by dt: gain / dt here is equal
    to its gain. min_distance, detection_distance [m]. bound_relaxation: added to each bound [m].
    """

    groups: Sequence[tuple[Sequence[str], Sequence[str]]]
    gain: float = 0.85
    min_distance: float = 0.005
    detection_distance: float = 0.01
    bound_relaxation: float = 0.0

    def _add_to(self, problem: _core.IkProblem) -> None:
        groups = [(list(first), list(second)) for first, second in self.groups]
        problem.add_collision_limit(groups, self.gain, self.min_distance, self.detection_distance, self.bound_relaxation)


Task = FrameTask | RelativeFrameTask | PostureTask | ComTask | DampingTask
Limit = ConfigurationLimit | VelocityLimit | CollisionLimit


class Solver:
    """Solves a problem at one configuration after another.

    model: a World or a Simulation. damping: added to the diagonal of H. Costs, gains and limits are read here; targets
    of tasks are read by each solve().
    Raises InputError for unknown names, with the nearest one, for wrong sizes and values outside their ranges.
    """

    def __init__(self, model: World | Simulation, tasks: Sequence[Task], limits: Sequence[Limit] = (), damping: float = 1e-12) -> None:
        world = model.world if isinstance(model, Simulation) else model
        self.tasks = list(tasks)
        self.status = "solved"  #: of the last solution: "solved", "infeasible", "singular"
        problem = _core.IkProblem()
        problem.damping = damping
        for part in [*self.tasks, *limits]:
            part._add_to(problem)
        self._solver = _core.IkSolver.create(world._world, problem)

    def solve(self, qpos: ArrayLike, dt: float) -> Doubles:
        """Velocity (nv,) [rad/s, m/s] at the configuration qpos (nq,) for a step of dt [s].

        Zeros if there is no solution; `status` has the cause: "infeasible" (the limits contradict each other) or
        "singular" (the tasks leave a motion undetermined: add a DampingTask).
        """
        for i, task in enumerate(self.tasks):
            if isinstance(task, DampingTask):
                continue
            if task.target is None:
                raise UsageError(f"task {i}, {task!r}, has no target")
            (self._solver.set_pose_target if task._is_pose else self._solver.set_target)(i, task.target)
        self.status, velocity = self._solver.solve(qpos, dt)
        for i, task in enumerate(self.tasks):
            if not isinstance(task, DampingTask):
                task.error = np.asarray(self._solver.error(i), dtype=np.float64)
        return np.asarray(velocity)
