"""The quadruped as the training steps it: the model of assets/ whose only colliders are its feet."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
MODEL_FILE = ROOT / "assets/robots/quadruped/quadruped.xml"

LEGS = ("FL", "FR", "RL", "RR")
JOINTS = tuple(f"{leg}_{part}_joint" for leg in LEGS for part in ("hip", "thigh", "calf"))
DEFAULT_POSITIONS = np.tile([0.0, 0.864, -1.728], 4)  # [rad]; the keyframe "home": hips 0.276 m above the feet's centres
STIFFNESS = 25.0  # kp [N m/rad]
DAMPING = 0.6  # kd [N m s/rad]
ACTION_SCALE = np.tile([0.2, 0.3, 0.3], 4)  # [rad]
ACTION_CLIP = 10.0
TORQUE_LIMIT = np.tile([23.7, 23.7, 35.55], 4)  # [N m]
JOINT_FRICTION = 0.2  # [N m]
FOOT_RADIUS = 0.022  # [m]
NOMINAL_HEIGHT = 0.29  # of the trunk's origin above the ground under the feet [m]
CONTROL_PERIOD = 0.02  # [s]

# World constants and contact state that the collision function of terrain.py reads from mjData.userdata.
USERDATA_SIZE = 12


def feet_only_spec(timestep: float) -> mujoco.MjSpec:
    """The model on a plane without drawn parts, sensors, joint limits and colliders other than the feet.

    Joint friction becomes part of the motor model (environment.py), because MJX would solve for it as constraints.
    """
    spec = mujoco.MjSpec.from_file(str(MODEL_FILE))
    for kind in (spec.sensors, spec.keys, spec.cameras, spec.sites):
        for element in list(kind):
            spec.delete(element)
    for geom in list(spec.geoms):
        if not geom.name.endswith("_foot"):
            spec.delete(geom)
    for asset in (*spec.meshes, *spec.materials, *spec.textures):
        spec.delete(asset)
    for joint in spec.joints:
        if joint.name in JOINTS:
            joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
            joint.frictionloss = 0.0
    for geom in spec.geoms:
        geom.contype, geom.conaffinity = 0, 1  # feet meet the ground, not each other
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=1, conaffinity=0)
    spec.option.timestep = timestep
    spec.option.iterations, spec.option.ls_iterations = 1, 5
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    spec.nuserdata = USERDATA_SIZE
    return spec
