"""Robots, joints, bodies, actuators and sensors of a simulation, by name."""
from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gloam import _core

from ._toml import key_text, to_text
from .dynamics import Dynamics
from .errors import InputError, NotFoundError, UsageError

if TYPE_CHECKING:
    from .simulation import Simulation

Doubles = NDArray[np.float64]
T = TypeVar("T")


class Named(Mapping[str, T], Generic[T]):
    """Elements by name; created on first access."""

    def __init__(self, what: str, names: Callable[[], Sequence[str]], make: Callable[[str], T], owner: str = "") -> None:
        self._what = what
        self._owner = owner  # " of robot 'go'"
        self._names = names
        self._make = make
        self._made: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        if name not in self._made:
            if not isinstance(name, str):
                raise TypeError(f"a {self._what} is looked up by name, got {name!r}")
            names = list(self._names())
            if name not in names:
                raise NotFoundError(f"there is no {self._what} '{name}'{self._owner}", hint=_core.suggest_name(name, names))
            self._made[name] = self._make(name)
        return self._made[name]

    def forget_world(self) -> None:
        """Releases arrays and handles of the previous World."""
        for element in self._made.values():
            if isinstance(element, Element):
                element.forget_world()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def __repr__(self) -> str:
        return f"<{len(self)} of {self._what}: {', '.join(self)}>"


@dataclass(frozen=True)
class Pose:
    """Pose of a frame B in a frame A: `p` position [m] (3,), `q` unit quaternion wxyz (4,)."""

    p: Doubles
    q: Doubles

    @property
    def R(self) -> Doubles:
        """Rotation matrix (3, 3)."""
        w, x, y, z = self.q
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])

    @property
    def matrix(self) -> Doubles:
        """Homogeneous matrix (4, 4)."""
        made = np.eye(4)
        made[:3, :3] = self.R
        made[:3, 3] = self.p
        return made

    @property
    def yaw(self) -> float:
        """Heading about z [rad]."""
        w, x, y, z = self.q
        return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def yaw_quaternion(yaw: float) -> Doubles:
    """Quaternion wxyz of a turn about z [rad]."""
    return np.array([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])


class Element:
    """A named element of the model. After a recompile it refers to the element of the same name, or raises
    NotFoundError."""

    _of_world: tuple[str, ...] = ()  # attributes that _changed() makes

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim = sim
        self.name = name
        self._generation = -1
        self._handle: Any = None

    def _find(self) -> Any:
        raise NotImplementedError

    def _now(self) -> Any:
        """The handle in the World that runs."""
        generation = self._sim._look()
        if generation != self._generation:
            try:
                self._handle = self._find()
            except InputError as error:  # of the old World, and gone
                raise NotFoundError(error.message, hint=error.hint) from None
            self._generation = generation
            self._changed()
        return self._handle

    def _changed(self) -> None:
        """Looks up the data that depends on the World."""

    def forget_world(self) -> None:
        """Releases arrays and handles; they are looked up again when needed."""
        self._generation = -1
        self._handle = None
        for name in self._of_world:
            self.__dict__.pop(name, None)

    def __repr__(self) -> str:
        return f"<gloam.{type(self).__name__} '{self.name}'>"


class Joint(Element):
    """A joint. `qpos` and `qvel` are live views of the state, writable while the simulation is paused."""

    _of_world = ("_qpos", "_qvel")

    def _find(self) -> Any:
        return self._sim._core_world.find_joint(self.name)

    def _changed(self) -> None:
        memory, i = self._sim.memory, self._handle.id
        kind = int(memory.array("jnt_type")[i])
        position, velocity = int(memory.array("jnt_qposadr")[i]), int(memory.array("jnt_dofadr")[i])
        nq, nv = ((7, 6), (4, 3), (1, 1), (1, 1))[kind]
        self._qpos: Doubles = memory.array("qpos")[position:position + nq]
        self._qvel: Doubles = memory.array("qvel")[velocity:velocity + nv]

    @property
    def qpos(self) -> Doubles:
        """(1,) of a hinge [rad] or slide [m], (4,) wxyz of a ball, (7,) xyz, wxyz of a free joint."""
        self._now()
        return self._qpos

    @property
    def qvel(self) -> Doubles:
        """(1,), (3,) or (6,) [rad/s, m/s]."""
        self._now()
        return self._qvel

    @property
    def position(self) -> float:
        """First number of qpos."""
        return float(self.qpos[0])

    @property
    def velocity(self) -> float:
        return float(self.qvel[0])

    def set(self, qpos: ArrayLike | None = None, qvel: ArrayLike | None = None) -> None:
        """Sets its position or velocity at the next step, with a Command."""
        self._sim._core.set_joint_state(self._now(), qpos, qvel)

    def set_goal(self, position: float) -> None:
        """Goal position [rad, m] for the robot's controller (used by "joint_position")."""
        self._sim._core.set_joint_goal(self._now(), float(position), lease=self._sim._lease_of_joint(self.name))


class Body(Element):
    """A body. Pose and velocities are of the present instant, in world axes."""

    def _find(self) -> Any:
        return self._sim._core_world.find_body(self.name)

    def _state(self) -> Any:
        return self._sim._solver.body(self._sim._core.latest, self._now())

    @property
    def pose(self) -> Pose:
        """X_WB"""
        return Pose(*(read_only(part) for part in self._state()[0]))

    @property
    def velocity(self) -> Doubles:
        """Velocity of its origin [m/s], (3,)."""
        return read_only(self._state()[1])

    @property
    def angular_velocity(self) -> Doubles:
        """[rad/s], (3,)"""
        return read_only(self._state()[2])

    def push(self, force: ArrayLike = (0, 0, 0), torque: ArrayLike = (0, 0, 0), duration: float | None = None) -> None:
        """Force [N] and torque [N m] at its centre of mass, world axes, until changed or for `duration` [s]."""
        sim, handle = self._sim, self._now()
        sim._core.set_wrench(handle, force, torque)
        if duration is not None:
            sim._core.set_wrench(handle, (0, 0, 0), (0, 0, 0), step=sim.step_count + max(1, round(duration / sim.timestep)))

    def add_velocity(self, velocity: ArrayLike) -> None:
        """Adds to the velocity of a free body [m/s], (3,)."""
        self._sim._core.add_velocity(self._now(), velocity)

    def set_mocap(self, pose: Pose | tuple[ArrayLike, ArrayLike]) -> None:
        """Pose X_WB of a mocap body."""
        self._sim._core.set_mocap(self._now(), pose)


class Actuator(Element):
    """An actuator, in its own unit."""

    def _find(self) -> Any:
        return self._sim._core_world.find_actuator(self.name)

    @property
    def control(self) -> float:
        memory = self._sim.memory
        return float(memory.array("ctrl")[memory.array("actuator_ctrladr")[self._now().id]])

    @control.setter
    def control(self, value: float) -> None:
        if value is None:
            raise TypeError("None is not a valid control")
        self._sim._core.set_control(self._now(), float(value), lease=self._sim._lease_of_actuator(self.name))

    @property
    def force(self) -> float:
        """[N, N m]"""
        return float(self._sim._solver.force(self._sim._core.latest, self._now()))


class Robot(Element):
    """A robot: its root, joints and actuators, and its control.

    `qpos`, `qvel` and `controls` are live if their elements are contiguous in MuJoCo's arrays, as in most models:
    values written while the simulation is paused are inputs of the next step. Otherwise they are read-only copies.
    """

    _of_world = ("_qpos", "_qvel", "_ctrl", "_info")

    def _find(self) -> Any:
        for robot in self._sim._core_world.robots():
            if robot.name == self.name:
                self._info = robot
                return robot.robot
        raise NotFoundError(f"there is no robot '{self.name}'", hint=_core.suggest_name(self.name, list(self._sim.robots)))

    def _changed(self) -> None:
        names = self._sim._world.info
        self._joint_names = [names.joints[j.id] for j in self._info.joints]
        self._actuator_names = [names.actuators[a.id] for a in self._info.actuators]
        memory = self._sim.memory
        kinds = memory.array("jnt_type")
        single = [j.id for j in self._info.joints if kinds[j.id] >= 2]
        self._qpos = _Picked(memory, "qpos", [int(memory.array("jnt_qposadr")[j]) for j in single])
        self._qvel = _Picked(memory, "qvel", [int(memory.array("jnt_dofadr")[j]) for j in single])
        self._single_names = [names.joints[j] for j in single]
        addresses = memory.array("actuator_ctrladr")
        self._ctrl = _Picked(memory, "ctrl", [int(addresses[a.id]) for a in self._info.actuators])

    @property
    def joint_names(self) -> list[str]:
        """Full names of its hinge and slide joints, in the order of `qpos`."""
        self._now()
        return list(self._single_names)

    @property
    def actuator_names(self) -> list[str]:
        """Full names, in the order of `controls`."""
        self._now()
        return list(self._actuator_names)

    @property
    def joints(self) -> Mapping[str, Joint]:
        """All its joints, also by their names without the robot's prefix."""
        self._now()
        return _short("joint", {n: self._sim.joints[n] for n in self._joint_names if n}, self.name)

    @property
    def actuators(self) -> Mapping[str, Actuator]:
        self._now()
        return _short("actuator", {n: self._sim.actuators[n] for n in self._actuator_names if n}, self.name)

    @property
    def root(self) -> Body:
        self._now()
        return self._sim.bodies[self._sim._world.info.bodies[self._info.root.id]]

    @property
    def pose(self) -> Pose:
        """X_WB of its root."""
        self._now()
        return Pose(*(read_only(part) for part in self._sim._solver.body(self._sim._core.latest, self._info.root)[0]))

    @property
    def velocity(self) -> Doubles:
        """Velocity of its root's origin, world axes [m/s], (3,)."""
        self._now()
        return read_only(self._sim._solver.body(self._sim._core.latest, self._info.root)[1])

    @property
    def angular_velocity(self) -> Doubles:
        """[rad/s], world axes, (3,)"""
        self._now()
        return read_only(self._sim._solver.body(self._sim._core.latest, self._info.root)[2])

    @property
    def qpos(self) -> Doubles:
        """Positions of its hinge and slide joints [rad, m], (n,)."""
        self._now()
        return self._qpos.array()

    @property
    def qvel(self) -> Doubles:
        """[rad/s, m/s], (n,)"""
        self._now()
        return self._qvel.array()

    @property
    def controls(self) -> Doubles:
        """Controls of its actuators, each in its own unit, (n,). Assigned controls apply from the next step, before
        its controller; values written into the array apply after it."""
        self._now()
        return self._ctrl.array()

    @controls.setter
    def controls(self, values: ArrayLike) -> None:
        self._sim._core.set_controls(self._now(), values, lease=self._sim._leases.get(self.name))

    @property
    def battery(self) -> dict[str, float]:
        """Battery and electrical power of its actuator models: `voltage` [V], `current` [A], `charge` (0 to 1), `power`
        [W], and `energy` since the reset [J]; NaN where it has no model of them. Error: it has no [[robot.actuator]]."""
        readings = self._readings()
        return {name: readings[name] for name in ("voltage", "current", "charge", "power", "energy")}

    @property
    def motor_temperatures(self) -> Doubles:
        """Temperatures of the windings of its actuators [°C], in the order of `controls`; NaN where an actuator has no
        thermal model, (n,). Error: it has no [[robot.actuator]]."""
        return self._of_motors("temperatures")

    @property
    def motor_speeds(self) -> Doubles:
        """Speeds of the motors of its actuators in the last step [rad/s], propellers' included, in the order of `controls`;
        NaN where an actuator has no model, (n,). Error: it has no [[robot.actuator]]."""
        return self._of_motors("speeds")

    def _of_motors(self, quantity: str) -> Doubles:
        values = self._readings()[quantity]
        return read_only(np.array([values.get(a.id, np.nan) for a in self._info.actuators]))

    def _readings(self) -> dict[str, Any]:
        readings = self._sim._core.actuator_readings(self._now())
        if readings is None:
            raise NotFoundError(f"robot '{self.name}' has no actuator models", hint="add [[robot.actuator]] to the scene")
        return cast(dict[str, Any], readings)

    def command(self, vx: float = 0.0, vy: float = 0.0, yaw_rate: float = 0.0, vz: float = 0.0) -> None:
        """Velocity goal of its controller in its heading frame [m/s, m/s, rad/s, m/s]; stays until changed. vz, up, is for
        flying robots."""
        self._sim._core.set_velocity_goal(self._now(), (vx, vy, yaw_rate, vz), lease=self._sim._leases.get(self.name))

    def set_pose_goal(self, pose: Pose | tuple[ArrayLike, ArrayLike]) -> None:
        """Goal of the frame that its controller ("ik", "osc") controls, in the world: a Pose, or position (3,) [m] and
        quaternion wxyz (4,); stays until changed."""
        self._sim._core.set_pose_goal(self._now(), pose, lease=self._sim._leases.get(self.name))

    def scale_dynamics(self, *, mass: ArrayLike | None = None, friction: ArrayLike | None = None, gains: ArrayLike | None = None,
                       armature: ArrayLike | None = None, damping: ArrayLike | None = None) -> None:
        """Like Simulation.scale_dynamics(), for the robot's own bodies, geoms, actuators and joints, in the model's
        order."""
        self._now()
        actuators = [actuator.id for actuator in self._info.actuators]
        Dynamics(self._sim, self._info.root.id, actuators).scale(mass=mass, friction=friction, gains=gains, armature=armature, damping=damping)

    def set_joint_goals(self, goals: Mapping[str, float]) -> None:
        """Positions [rad, m] by joint names, with or without the robot's prefix, for its controller."""
        joints = self.joints
        for joint, position in [(joints[name], position) for name, position in goals.items()]:
            joint.set_goal(position)

    def _some_joints(self, joints: Sequence[str] | None) -> list[Any]:
        return [] if joints is None else [self.joints[name]._now() for name in joints]

    def command_joints(self, position: ArrayLike | None = None, velocity: ArrayLike | None = None, effort: ArrayLike | None = None,
                       kp: ArrayLike | None = None, kd: ArrayLike | None = None, *, joints: Sequence[str] | None = None) -> None:
        """Targets of joints for its controller, one number per joint, which stay until changed (docs/controllers.md).

        Position [rad, m], velocity, feed-forward effort [N m, N], stiffness and damping. None = unchanged, NaN = no
        target. `joints`: names with or without the robot's prefix; None = all hinges and slides, as in `joint_names`.
        """
        handle = self._now()
        given = {"position": position, "velocity": velocity, "effort": effort, "kp": kp, "kd": kd}
        targets = {key: np.asarray(value, dtype=np.float64).reshape(-1) for key, value in given.items() if value is not None}
        self._sim._core.set_joint_command(handle, self._some_joints(joints), targets, lease=self._sim._leases.get(self.name))

    def set_controller(self, type: str, **options: Any) -> None:
        """Replaces its controller at the next step, until a reset: set_controller("joint_position", kp=80). It
        takes the options of [robot.controller]."""
        text = "\n".join(f"{key_text(key)} = {to_text(value, key)}" for key, value in {"type": type, **options}.items())
        self._sim._core.set_controller(self._now(), text, lease=self._sim._leases.get(self.name))

    def follow(self, positions: ArrayLike, times: ArrayLike | None = None, *, velocities: ArrayLike | None = None,
               accelerations: ArrayLike | None = None, joints: Sequence[str] | None = None, profile: str | None = None,
               max_velocity: ArrayLike = 1.0, max_acceleration: ArrayLike = 4.0) -> None:
        """Makes its controller follow a trajectory from the next step, which replaces the trajectories of the same joints.

        `positions` [rad, m], (points, joints) or (joints,). With `times` [s after the start], (points,): a spline
        through the points, with velocities and accelerations where they are given. Without: profile "trapezoidal"
        (default) or "quintic", at rest in each point, within the limits (one number or one per joint).
        """
        handle = self._now()
        rows = np.atleast_2d(np.asarray(positions, dtype=np.float64))
        empty: list[float] = []

        def part(values: ArrayLike | None) -> Sequence[Any]:
            if values is None:
                return [empty] * len(rows)
            array = np.atleast_2d(np.asarray(values, dtype=np.float64))
            if len(array) != len(rows):
                raise UsageError(f"expected {len(rows)} rows, one per point, got {len(array)}")
            return list(array)

        stamps = np.zeros(len(rows)) if times is None else _sized(times, len(rows), "times")
        kind = profile or ("trapezoidal" if times is None else "spline")
        speed, change = ([], []) if kind == "spline" else (list(np.atleast_1d(x)) for x in (max_velocity, max_acceleration))
        points = [(float(t), q, v, a) for t, q, v, a in zip(stamps, rows, part(velocities), part(accelerations))]
        self._sim._core.follow(handle, self._some_joints(joints), points, kind, speed, change, lease=self._sim._leases.get(self.name))

    def stop_trajectory(self) -> None:
        """Ends its trajectory at the next step; the joints hold their positions."""
        self._sim._core.stop_trajectory(self._now(), lease=self._sim._leases.get(self.name))

    def set_joints(self, qpos: ArrayLike | None = None, qvel: ArrayLike | None = None) -> None:
        """Sets its hinge and slide joints at the next step, (n,) each."""
        self._now()
        n = len(self._single_names)
        positions = None if qpos is None else _sized(qpos, n, "qpos")
        velocities = None if qvel is None else _sized(qvel, n, "qvel")
        for i, name in enumerate(self._single_names):
            self._sim.joints[name].set(None if positions is None else positions[i:i + 1],
                                       None if velocities is None else velocities[i:i + 1])

    def place(self, position: ArrayLike, yaw: float = 0.0, quat: ArrayLike | None = None) -> None:
        """Puts a robot with a free root at `position` [m] at the next step, turned by `yaw` [rad] or to `quat` (wxyz), at rest."""
        self._now()
        memory = self._sim.memory
        root = self._info.root.id
        joint = int(memory.array("body_jntadr")[root])
        if joint < 0 or memory.array("jnt_type")[joint] != 0:
            raise UsageError(f"robot '{self.name}' is fixed: its root has no free joint")
        turn = yaw_quaternion(yaw) if quat is None else _sized(quat, 4, "quat")
        handle = next(j for j in self._info.joints if j.id == joint)
        self._sim._core.set_joint_state(handle, np.concatenate([_sized(position, 3, "position"), turn]), np.zeros(6))

    @contextmanager
    def claim(self) -> Iterator[Robot]:
        """Gives this simulation object exclusive control of the robot while the context lasts."""
        lease = self._sim._core.claim(self._now())
        self._sim._leases[self.name] = lease
        try:
            yield self
        finally:
            del self._sim._leases[self.name]


class _Picked:
    """Elements of a live array: a view if they are contiguous, else a read-only copy."""

    def __init__(self, memory: Any, name: str, places: list[int]) -> None:
        self._array: Doubles = memory.array(name)
        self._places = np.array(places, dtype=np.intp)
        n = len(places)
        is_row = n > 0 and places == list(range(places[0], places[0] + n))
        self._view: Doubles | None = self._array[places[0]:places[0] + n] if is_row else None

    def array(self) -> Doubles:
        return read_only(self._array[self._places]) if self._view is None else self._view


def _sized(values: ArrayLike, n: int, what: str) -> Doubles:
    array = np.asarray(values, dtype=np.float64).reshape(-1)
    if len(array) != n:
        raise UsageError(f"{what}: expected {n} numbers, got {len(array)}")
    return array


def read_only(values: ArrayLike) -> Doubles:
    """A read-only array, because changes of it would have no effect."""
    array = np.asarray(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def _short(what: str, elements: dict[str, T], robot: str) -> Named[T]:
    short = {name.removeprefix(robot + "/"): element for name, element in elements.items()}
    both = {**short, **elements}
    return Named(what, lambda: list(both), both.__getitem__, f" of robot '{robot}'")
