"""Gloam's scenes of the comparison: courses.py, and beds of soil."""

from __future__ import annotations

import shutil
from pathlib import Path

import mujoco

from . import courses
from .robot import ROBOT

SOIL_DEPTH = 0.15  # [m]
SOIL_SIZE = (13.0, 9.0)  # [m]

_SCENE = """
[scene]
name = "{course}"

[sim]
timestep = {timestep}

[environment]
file = "{course}.xml"
{soil}
[[robot]]
name = "go"
file = "quadruped/quadruped.xml"
keyframe = "home"
position = [{x}, 0, {z}]

[robot.controller]
type = "{controller}"
"""
_SOIL = """
[[soil]]
name = "bed"
kind = "{course}"
position = [0, 0, {depth}]
size = [{size[0]}, {size[1]}]
depth = {depth}
cell = 0.025
"""


def scene(course: str, controller: str, folder: Path, timestep: float) -> str:
    """The TOML of a scene whose files are written to `folder`. A course that courses.py lacks is a kind of soil."""
    if not (folder / "quadruped").exists():
        shutil.copytree(ROBOT.file.parent, folder / "quadruped")
    is_soil = course not in courses.KINDS
    environment = folder / f"{course}.xml"
    if not environment.exists():
        spec = mujoco.MjSpec()
        courses.add(spec, "flat" if is_soil else course)
        spec.compile()
        environment.write_text(spec.to_xml())
    soil = _SOIL.format(course=course, depth=SOIL_DEPTH, size=SOIL_SIZE) if is_soil else ""
    place = {"x": -1.0 if is_soil else 0.0, "z": SOIL_DEPTH if is_soil else 0.0}
    return _SCENE.format(course=course, controller=controller, timestep=timestep, soil=soil, **place)
