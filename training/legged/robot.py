"""A robot as the training steps it: the model of assets/ whose only colliders are spheres under its feet."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CONTROL_PERIOD = 0.02  # [s]
ACTION_CLIP = 10.0
Point = tuple[float, float, float]


@dataclass(frozen=True)
class GaitChoice:
    """In the order of terms.GAIT_PARAMETERS; units as in gait.Gait. These numbers become the defaults of policy.toml."""

    frequency: float = 2.0
    phase: float = 0.5
    offset: float = 0.0
    bound: float = 0.0
    duration: float = 0.5
    swing_height: float = 0.08
    body_height: float = 0.0

    def clock(self, index: float) -> np.ndarray:
        """(4,) of FL, FR, RL, RR."""
        delays = np.array([self.phase + self.offset + self.bound, self.bound, self.offset, self.phase])
        f = np.mod(index + delays, 1.0)
        swing = 0.5 + 0.5 * (f - self.duration) / (1 - self.duration)
        return np.sin(2 * np.pi * np.where(f < self.duration, 0.5 * f / self.duration, swing))


@dataclass(frozen=True, eq=False)
class Arm:
    """Joints that another controller moves. The training moves them at random, with a random load in the hand."""

    joints: tuple[str, ...]
    low: np.ndarray  # of random postures [rad]
    high: np.ndarray
    stiffness: np.ndarray  # [N m/rad]
    damping: np.ndarray  # [N m s/rad]
    torque_limit: np.ndarray  # [N m]
    hand: str  # body that carries the load
    grip: Point  # place of the load, in the frame of the hand [m]
    mirrored_signs: np.ndarray
    load: tuple[float, float] = (0.0, 2.0)  # [kg]
    speed: tuple[float, float] = (0.3, 2.0)  # largest speed of the joints during one motion [rad/s]
    interval: tuple[float, float] = (0.5, 4.0)  # between new postures [s]


@dataclass(frozen=True, eq=False)
class Robot:
    """`joints` are the policy's. They, then the arm's, are the model's first joints after the free joint."""

    name: str  # of the folder in assets/robots
    joints: tuple[str, ...]
    default_positions: np.ndarray  # [rad]
    stiffness: np.ndarray  # kp [N m/rad]
    damping: np.ndarray  # kd [N m s/rad]
    action_scale: np.ndarray  # [rad]
    torque_limit: np.ndarray  # [N m]
    friction: float  # of each of the policy's joints [N m]
    mirrored_joints: np.ndarray  # joint i of the mirrored robot is mirrored_signs[i] times joint mirrored_joints[i]
    mirrored_signs: np.ndarray
    feet: tuple[str, ...]  # bodies: front left, front right, rear left, rear right; or left, right
    shins: tuple[str, ...]  # bodies whose origins are the knees, in the order of the feet
    sole: tuple[Point, ...]  # centres of the spheres under a foot, in the frame of its body [m]
    sole_radius: float  # [m]; less than half of terrain.CELL
    nominal_height: float  # of the free body's origin above the ground under the feet [m]
    weight: float  # [N]
    abduction: tuple[int, ...]  # joints that move legs sideways or twist them
    nearby: tuple[tuple[float, float], ...]  # ground that the critic sees, pairs of left and right, heading frame [m]
    belly: tuple[Point, ...] = ()  # points of the trunk that must not touch the ground, base frame [m]
    arm: Arm | None = None
    welded: dict[str, float] = field(default_factory=dict)  # other joints, at these positions [rad, m]
    observes_velocity: bool = False  # whether the network observes the velocity of its base
    solver_iterations: int = 1
    gait: GaitChoice = field(default_factory=GaitChoice)

    @property
    def file(self) -> Path:
        return ROOT / "assets/robots" / self.name / f"{self.name}.xml"

    @property
    def spheres(self) -> int:
        return len(self.feet) * len(self.sole)

    @property
    def arm_joints(self) -> int:
        return len(self.arm.joints) if self.arm else 0

    @property
    def userdata_size(self) -> int:
        """Of the ground's state, which the collision function of terrain.py reads from mjData.userdata."""
        return 4 + self.spheres


def _weld(spec: mujoco.MjSpec, name: str, position: float) -> None:
    """Removes a joint whose axis passes through its body's origin."""
    joint = spec.joint(name)
    body = joint.parent
    rotation = np.zeros(9)
    if joint.type == mujoco.mjtJoint.mjJNT_SLIDE:
        mujoco.mju_quat2Mat(rotation, body.quat)
        body.pos = np.asarray(body.pos) + rotation.reshape(3, 3) @ np.asarray(joint.axis) * position
    else:
        turn, turned = np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(turn, np.asarray(joint.axis, float), position)
        mujoco.mju_mulQuat(turned, np.asarray(body.quat, float), turn)
        body.quat = turned
    spec.delete(joint)


def training_spec(robot: Robot, timestep: float) -> mujoco.MjSpec:
    """The model on a plane without drawn parts, sensors, motors, joint limits, and with soles as its only colliders.

    Joint friction becomes part of the motor model (physics.py), because MJX would solve for it as constraints.
    """
    spec = mujoco.MjSpec.from_file(str(robot.file))
    for kind in (spec.sensors, spec.keys, spec.cameras, spec.sites, spec.actuators, spec.equalities, spec.excludes, spec.geoms):
        for element in list(kind):
            spec.delete(element)
    for asset in (*spec.meshes, *spec.materials, *spec.textures):
        spec.delete(asset)
    for name, position in robot.welded.items():
        _weld(spec, name, position)
    for joint in spec.joints:
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        joint.frictionloss = 0.0
    sphere, plane = mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_PLANE
    for name in robot.feet:
        for centre in robot.sole:  # soles meet the ground, not each other
            spec.body(name).add_geom(type=sphere, size=[robot.sole_radius, 0, 0], pos=centre, contype=0, conaffinity=1,
                                     condim=3, mass=0)  # fmt: skip
    spec.worldbody.add_geom(name="ground", type=plane, size=[0, 0, 1], contype=1, conaffinity=0)
    spec.option.timestep = timestep
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    spec.option.iterations, spec.option.ls_iterations = robot.solver_iterations, 5
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    spec.nuserdata = robot.userdata_size
    return spec
