"""A robot in MuJoCo's memory: its state and its actuators, in the order of a policy's joints.

Source of the formulas: MuJoCo's documentation, "Computation": force = gain * control + b0 + b1 * length + b2 *
velocity.
"""

from __future__ import annotations

import difflib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import NotFoundError, UnsupportedError
from .spec import PolicySpec
from .terms import Array, RobotState, term_info

_FREE, _SLIDE, _HINGE = 0, 2, 3  # mjtJoint
_TRANSMISSION_JOINT = (0, 1)  # mjtTrn: joint, jointinparent
_FIXED_GAIN = 0  # mjtGain
_AFFINE_BIAS = (0, 1)  # mjtBias: none, affine
_SAME_GAIN = 2e-3  # relative: mjlab rounds gains to three decimals


def _names(memory: Any, addresses: str) -> list[str]:
    text = np.asarray(memory.array("names")).astype(np.uint8).tobytes()
    return [
        text[start : text.index(b"\0", start)].decode()
        for start in np.asarray(memory.array(addresses)).ravel().tolist()
    ]


def _find(wanted: list[str], names: list[str], what: str, robot: str) -> NDArray[np.intp]:
    missing = [name for name in wanted if name not in names]
    if missing:
        near = difflib.get_close_matches(missing[0], names, n=1)
        hint = (
            (f"did you mean '{near[0]}'? " if near else "")
            + f"{what}s of the robot: "
            + (", ".join(name for name in names if name.startswith(f"{robot}/") or not robot) or "none")
        )
        raise NotFoundError(f"robot '{robot}' has no {what} {', '.join(missing)}, which the policy requires", hint=hint)
    return np.array([names.index(name) for name in wanted], dtype=np.intp)


def _model_names(spec: PolicySpec, robot: str) -> list[str]:
    """Full names in the model: the robot's prefix before the policy's name without its own prefix."""
    short = [spec.model_joints.get(name, name).rsplit("/", 1)[-1] for name in spec.joints]
    return [f"{robot}/{name}" if robot else name for name in short]


class RobotIo:
    """Reads and controls one robot through the arrays of a simulation's memory, which it keeps.

    Raises NotFoundError: a joint, a sensor or a joint's actuator is missing; UnsupportedError: joints other than
    hinges or slides, a missing floating base if a term needs it, actuators whose torque is not an immediate function
    of their control.
    """

    def __init__(self, memory: Any, spec: PolicySpec, robot: str) -> None:
        self.memory = memory
        self._spec = spec
        names = _names(memory, "name_jntadr")
        joints = _find(_model_names(spec, robot), names, "joint", robot)
        kinds = memory.array("jnt_type")[joints]
        for name, kind in zip(spec.joints, kinds, strict=True):
            if kind not in (_SLIDE, _HINGE):
                raise UnsupportedError(f"joint '{name}' of the policy is neither a hinge nor a slide")
        self._qpos, self._qvel, self._ctrl = (memory.array(name) for name in ("qpos", "qvel", "ctrl"))
        self.joint_names = [names[joint] for joint in joints]
        self._q_at = memory.array("jnt_qposadr")[joints]
        self._v_at = memory.array("jnt_dofadr")[joints]
        self._find_base(joints)
        self._find_actuators(joints, names)
        self._find_sensors(robot)

    def _find_base(self, joints: NDArray[np.intp]) -> None:
        root = self.memory.array("body_rootid")[self.memory.array("jnt_bodyid")[joints[0]]]
        first = int(self.memory.array("body_jntadr")[root])
        self._base: tuple[int, int] | None = None
        if first >= 0 and self.memory.array("jnt_type")[first] == _FREE:
            self._base = int(self.memory.array("jnt_qposadr")[first]), int(self.memory.array("jnt_dofadr")[first])
            return
        for term in self._spec.terms:
            if term.name in ("base_lin_vel", "base_ang_vel", "projected_gravity") and not term.sensor:
                raise UnsupportedError(
                    f"the policy observes '{term.name}', but the robot has no floating base",
                    hint='set base = "free" in its [[robot]], or give the term a sensor',
                )

    def _find_actuators(self, joints: NDArray[np.intp], names: list[str]) -> None:
        memory = self.memory
        target = memory.array("actuator_trnid").reshape(-1, 2)[:, 0]
        is_joint = np.isin(memory.array("actuator_trntype"), _TRANSMISSION_JOINT)
        at = []
        for joint in joints:
            found = np.flatnonzero((target == joint) & is_joint)
            if len(found) != 1:
                raise NotFoundError(
                    f"joint '{names[joint]}' has {'no actuator' if not len(found) else 'several actuators'}",
                    hint="a policy drives each joint with one motor or position servo; docs/policies.md shows how to add them",
                )
            at.append(int(found[0]))
        self._actuators = np.array(at, dtype=np.intp)
        gains = memory.array("actuator_gainprm").reshape(len(target), -1)[at]
        biases = memory.array("actuator_biasprm").reshape(len(target), -1)[at]
        self._gear = memory.array("actuator_gear").reshape(len(target), -1)[at, 0]
        for i, actuator in enumerate(at):
            if (
                memory.array("actuator_gaintype")[actuator] != _FIXED_GAIN
                or memory.array("actuator_dyntype")[actuator] != 0
                or memory.array("actuator_biastype")[actuator] not in _AFFINE_BIAS
                or gains[i, 0] * self._gear[i] == 0
            ):
                raise UnsupportedError(
                    f"the actuator of '{self._spec.joints[i]}' is neither a motor nor a position servo",
                    hint="policies cannot drive filters, muscles and other actuator dynamics",
                )
        self._gain, self._bias = gains[:, 0], biases[:, :3] * (memory.array("actuator_biastype")[at] == 1)[:, None]
        self._has_bias, self._has_limit = bool(self._bias.any()), bool(np.isfinite(self._spec.torque_limit).any())
        square = self._gear**2
        # A servo of the policy's own gains takes its targets as controls.
        self.is_servo = bool(
            np.allclose(self._gain * square, self._spec.kp, rtol=_SAME_GAIN)
            and np.allclose(-self._bias[:, 1] * square, self._spec.kp, rtol=_SAME_GAIN)
            and np.allclose(-self._bias[:, 2] * square, self._spec.kd, rtol=_SAME_GAIN)
            and np.isinf(self._spec.torque_limit).all()
            and (self._bias[:, 0] == 0).all()
        )

    def _find_sensors(self, robot: str) -> None:
        wanted = {term.sensor: term for term in self._spec.terms if term.sensor}
        self._sensors: dict[str, Array] = {}
        if not wanted:
            return
        names = _names(self.memory, "name_sensoradr")
        full = [name if "/" in name or not robot else f"{robot}/{name}" for name in wanted]
        data = self.memory.array("sensordata")
        for (name, term), at in zip(wanted.items(), _find(full, names, "sensor", robot), strict=True):
            start, size = int(self.memory.array("sensor_adr")[at]), int(self.memory.array("sensor_dim")[at])
            if size != term_info(term.name).size(len(self._spec.joints)):
                raise UnsupportedError(f"sensor '{name}' has {size} numbers, which does not match the size of '{term.name}'")
            self._sensors[name] = data[start : start + size]

    def state(self) -> RobotState:
        zero = np.zeros(3)
        linear, angular, gravity = zero, zero, np.array([0.0, 0.0, -1.0])
        if self._base is not None:
            q, v = self._base
            w, x, y, z = self._qpos[q + 3 : q + 7]
            R_WB = np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            )
            # Velocities of a free joint: the linear one is in world axes, the angular one in the body's.
            linear = R_WB.T @ self._qvel[v : v + 3]
            angular, gravity = self._qvel[v + 3 : v + 6].copy(), -R_WB[2]
        return RobotState(
            linear,
            angular,
            gravity,
            self._qpos[self._q_at],
            self._qvel[self._v_at],
            {name: values.copy() for name, values in self._sensors.items()},
        )

    def drive(self, targets: Array) -> None:
        """Writes controls that give the torques kp (target - q) - kd v, within the torque limits; (n,) targets
        [rad]."""
        if self.is_servo:
            self._ctrl[self._actuators] = targets * self._gear
            return
        q, v = self._qpos[self._q_at], self._qvel[self._v_at]
        torque = self._spec.kp * (targets - q) - self._spec.kd * v
        if self._has_limit:
            torque = np.minimum(np.maximum(torque, -self._spec.torque_limit), self._spec.torque_limit)
        force = torque / self._gear
        if self._has_bias:
            force = force - self._bias[:, 0] - self._gear * (self._bias[:, 1] * q + self._bias[:, 2] * v)
        self._ctrl[self._actuators] = force / self._gain
