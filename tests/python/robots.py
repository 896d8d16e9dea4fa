"""Models of assets/robots on a floor, stepped by stock MuJoCo."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

mujoco: Any = pytest.importorskip("mujoco")

ROBOTS = Path(__file__).resolve().parents[2] / "assets/robots"


class Bench:
    """A robot on an endless floor, at a keyframe of its model."""

    def __init__(self, file: str, key: str, friction: float = 1.0, add: Any = None) -> None:
        """`add(spec)` adds further bodies; those with joints must come after the robot's."""
        spec = mujoco.MjSpec.from_file(str(ROBOTS / file))
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[friction, 0.005, 0.0001])
        keys = {k.name: (list(k.qpos), list(k.ctrl)) for k in spec.keys}
        for k in list(spec.keys):  # their sizes no longer fit if bodies are added
            spec.delete(k)
        if add is not None:
            add(spec)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        qpos, ctrl = keys[key]
        self.data.qpos[:len(qpos)] = qpos
        self.data.ctrl[:len(ctrl)] = ctrl
        mujoco.mj_forward(self.model, self.data)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)

    def sensor(self, name: str) -> Any:
        return self.data.sensor(name).data
