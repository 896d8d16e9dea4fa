"""Worlds: compiled scenes."""
from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from gloam import _core

from .elements import Pose
from .info import InputInfo, MetricInfo, StreamInfo, TopicInfo, WorldInfo, of
from .snapshot import Snapshot

if TYPE_CHECKING:
    from .scene import Scene


class World:
    """A compiled Scene: immutable, and shared by all its simulations."""

    def __init__(self, world: _core.World) -> None:
        self._world = world

    @cached_property
    def info(self) -> WorldInfo:
        """Names of all elements, numbers of the model, values drawn by [[randomize]]."""
        return of(WorldInfo, self._world.info())

    @cached_property
    def _solver(self) -> _core.Solver:
        return _core.Solver()

    @cached_property
    def _painter(self) -> _core.Painter:
        return _core.Painter(self._world)

    @cached_property
    def _robots(self) -> list[_core.RobotInfo]:
        return list(self._world.robots())

    @property
    def robots(self) -> list[str]:
        return [robot.name for robot in self._robots]

    @property
    def bodies(self) -> list[str]:
        return list(self.info.bodies)

    @property
    def joints(self) -> list[str]:
        return list(self.info.joints)

    @property
    def actuators(self) -> list[str]:
        return list(self.info.actuators)

    @property
    def cameras(self) -> list[str]:
        return list(self.info.cameras)

    @property
    def sensors(self) -> list[str]:
        """Sensors of MuJoCo's model, then the scene's probes."""
        return list(self.info.sensors)

    @property
    def probes(self) -> list[str]:
        return list(self.info.probes)

    @property
    def lidars(self) -> list[str]:
        return [stream.name for stream in self.streams() if stream.kind == "lidar"]

    @property
    def timestep(self) -> float:
        """[s]"""
        return self.info.timestep

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

    def topics(self) -> list[TopicInfo]:
        """Topics of a simulation of it."""
        return [of(TopicInfo, row) for row in self._world.topics()]

    def metrics(self) -> list[MetricInfo]:
        """Metrics of a simulation of it."""
        return [of(MetricInfo, row) for row in self._world.metrics()]

    def inputs(self) -> list[InputInfo]:
        """Inputs of a simulation of it."""
        return [of(InputInfo, row) for row in self._world.inputs()]

    def streams(self) -> list[StreamInfo]:
        """Outputs of a simulation of it."""
        return [of(StreamInfo, row) for row in self._world.streams()]

    def snapshot(self, qpos: ArrayLike, time: float = 0.0, *, mocap: Sequence[Pose] | None = None) -> Snapshot:
        """An instant at rest in the configuration `qpos`, (nq,) [m, rad], without a simulation.

        Quaternions are normalised. The rest of the state is initial, and effects have not begun. time [s]: at least 0.
        mocap: poses X_WB of all mocap bodies in MuJoCo's order; None = as compiled, before a simulation moves agents
        to their places. Raises UsageError: a wrong size, a number that is not finite.
        """
        return Snapshot(self, _core.snapshot_at_rest(self._world, qpos, time, mocap))

    def export_mjcf(self, folder: str | os.PathLike[str]) -> list[str]:
        """Writes the whole scene as one MJCF with its assets into FOLDER/scene.xml. Returns the elements that MJCF
        cannot represent."""
        return list(self._world.export_mjcf(Path(folder)))

    def __reduce__(self) -> Any:
        raise TypeError("a World cannot be pickled or copied: send its scene (world.scene) and compile() it where it is needed; "
                        "threads may share one World")

    def __repr__(self) -> str:
        return f"<gloam.World: {len(self.robots)} robots, {len(self.bodies)} bodies>"
