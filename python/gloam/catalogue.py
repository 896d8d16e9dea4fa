"""The catalogue of robots, and settings for models from elsewhere (docs/robots.md)."""
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from gloam import _core

PathLike = str | os.PathLike[str]


@dataclass(frozen=True)
class RobotModel:
    """A robot that `[[robot]] model = "NAME"` adds to a scene."""

    name: str
    description: str
    file: Path  #: its robot.toml
    model: Path  #: MJCF or URDF
    keyframe: str  #: initial pose; "" = the model's default
    controller: str  #: type of its default controller
    sensors: dict[str, str]  #: names for `sensors`, and the kinds of the sections that they add
    joints: int  #: hinges, slides and balls
    actuators: int
    floating: bool  #: on a free joint
    mass: float  #: [kg]


def robots() -> dict[str, RobotModel]:
    """The robots of the catalogue by their names. Compiles each, from the cache after the first time."""
    found = (RobotModel(**robot) for robot in _core.robot_models())
    return {robot.name: robot for robot in found}


def robot_model(model: str, *, root: PathLike = "", strict: bool = False) -> RobotModel:
    """One robot: a name of the catalogue, or the path of a robot.toml or of its folder. Raises InputError."""
    return RobotModel(**_core.robot_model(model, root=os.fspath(root), strict=strict))


def guess_robot(file: PathLike, *, root: PathLike = "", strict: bool = False) -> tuple[str, str]:
    """Kind of a robot from elsewhere (quadruped, humanoid, quadrotor, diff_drive, arm or other) and a [[robot]] for it as
    TOML, with comments that give the reasons. Raises InputError for a file that does not compile.
    """
    kind, text = _core.guess_robot(Path(file), root=os.fspath(root), strict=strict)
    return str(kind), str(text)
