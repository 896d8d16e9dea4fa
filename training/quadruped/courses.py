"""Ground for evaluations, as boxes on a plane: no map of the training is among them."""

from __future__ import annotations

import mujoco
import numpy as np

ROUGH_HEIGHT = 0.08  # [m]
STEP_HEIGHT, TREAD = 0.10, 0.30  # [m]
KINDS = ("flat", "rough", "stairs")


def _box(spec: mujoco.MjSpec, centre: tuple[float, float], half: tuple[float, float], height: float) -> None:
    body = spec.worldbody
    if height > 0:
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=[*centre, height / 2], size=[*half, height / 2])


def _rough(spec: mujoco.MjSpec, highest: float) -> None:
    """Boxes of 15 to 30 cm edge and random height, from 0.8 m around the start, 12 m in each direction."""
    rng = np.random.default_rng(20)
    edge = 0.24
    for i in range(-26, 27):
        for j in range(-26, 27):
            centre = (i * edge, j * edge)
            height = rng.uniform(0, highest)
            if np.hypot(*centre) > 0.8:
                _box(spec, centre, (edge / 2, edge / 2), height)


def _stairs(spec: mujoco.MjSpec) -> None:
    """Flights on a ring around the start: five steps up from 1 m on, a landing, five steps down, repeated."""
    heights = [*range(1, 6), 5, 5, 5, *range(4, -1, -1), 0, 0]
    for side in range(4):
        axis, sign = side // 2, (1, -1)[side % 2]
        for number, steps in enumerate(heights * 2):
            near = 1.0 + TREAD * number
            centre, half = [0.0, 0.0], [0.0, 0.0]
            centre[axis], half[axis] = sign * (near + TREAD / 2), TREAD / 2
            half[1 - axis] = near + TREAD if axis == 0 else near
            _box(spec, (centre[0], centre[1]), (half[0], half[1]), STEP_HEIGHT * steps)


def add(spec: mujoco.MjSpec, kind: str, rough_height: float = ROUGH_HEIGHT) -> None:
    """Adds a course to a model; `rough_height`: of the highest boxes of rough ground [m]. Raises ValueError: no such course."""
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.05])
    if kind == "rough":
        _rough(spec, rough_height)
    elif kind == "stairs":
        _stairs(spec)
    elif kind != "flat":
        raise ValueError(f"there is no course '{kind}'; one of: {', '.join(KINDS)}")
