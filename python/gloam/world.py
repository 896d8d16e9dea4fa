"""Worlds: compiled scenes."""
from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gloam import _core

if TYPE_CHECKING:
    from .scene import Scene


class World:
    """A compiled Scene: immutable, and shared by all its simulations."""

    def __init__(self, world: _core.World) -> None:
        self._world = world

    @cached_property
    def info(self) -> dict[str, Any]:
        """Names of all elements, numbers of the model, values drawn by [[randomize]] ("drawn")."""
        return dict(self._world.info())

    @cached_property
    def _robots(self) -> list[dict[str, Any]]:
        return list(self._world.robots())

    @property
    def robots(self) -> list[str]:
        return [robot["name"] for robot in self._robots]

    @property
    def bodies(self) -> list[str]:
        return list(self.info["bodies"])

    @property
    def joints(self) -> list[str]:
        return list(self.info["joints"])

    @property
    def actuators(self) -> list[str]:
        return list(self.info["actuators"])

    @property
    def cameras(self) -> list[str]:
        return list(self.info["cameras"])

    @property
    def sensors(self) -> list[str]:
        """Sensors of MuJoCo's model, then the scene's probes."""
        return list(self.info["sensors"])

    @property
    def probes(self) -> list[str]:
        return list(self.info["probes"])

    @property
    def lidars(self) -> list[str]:
        return [stream["name"] for stream in self.streams() if stream["kind"] == "lidar"]

    @property
    def timestep(self) -> float:
        """[s]"""
        return float(self.info["timestep"])

    @property
    def notes(self) -> list[str]:
        """Suspicious but accepted properties of the scene, with their locations."""
        return list(self._world.notes())

    @property
    def unsupported(self) -> list[str]:
        """Elements of the files that are not simulated or rendered, with their locations."""
        return list(self._world.unsupported())

    @property
    def scene(self) -> Scene:
        """The original Scene, which can be changed and compiled again."""
        from .scene import Scene

        return Scene._of(self._world.written_scene())

    def topics(self) -> list[dict[str, Any]]:
        """Topics of a simulation of it: name, type, rate [Hz], …"""
        return list(self._world.topics())

    def metrics(self) -> list[dict[str, Any]]:
        return list(self._world.metrics())

    def inputs(self) -> list[dict[str, Any]]:
        return list(self._world.inputs())

    def streams(self) -> list[dict[str, Any]]:
        return list(self._world.streams())

    def export_mjcf(self, folder: str | os.PathLike[str]) -> list[str]:
        """Writes the whole scene as one MJCF with its assets into FOLDER/scene.xml. Returns the elements that MJCF
        cannot represent."""
        return list(self._world.export_mjcf(Path(folder)))

    def __reduce__(self) -> Any:
        raise TypeError("a World cannot be pickled or copied: send its scene (world.scene) and compile() it where it is needed; threads may "
                        "share one World")

    def __repr__(self) -> str:
        return f"<gloam.World: {len(self.robots)} robots, {len(self.bodies)} bodies>"
