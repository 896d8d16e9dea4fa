"""Snapshots: instants of a World in a given configuration, without a simulation."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

from gloam import _core

from .elements import Doubles, Pose, read_only
from .errors import InputError, NotFoundError
from .frames import Frame
from .info import Contact, contact_of

if TYPE_CHECKING:
    from .world import World

DEFAULT_OUTPUTS = ("rgb", "depth", "segmentation")


class Snapshot:
    """One instant of a World, immutable: World.snapshot()."""

    def __init__(self, world: World, snapshot: _core.Snapshot) -> None:
        self._world = world
        self._snapshot = snapshot

    @property
    def world(self) -> World:
        return self._world

    @property
    def time(self) -> float:
        """Simulation time [s]."""
        return self._snapshot.time

    @property
    def step(self) -> int:
        """The first step at or after its time."""
        return self._snapshot.step

    @property
    def hash(self) -> int:
        """Hash of its state."""
        return self._snapshot.hash

    def pose(self, body: str) -> Pose:
        """X_WB of a body. Raises NotFoundError for an unknown name."""
        try:
            handle = self._world._world.find_body(body)
        except InputError as error:
            raise NotFoundError(error.message, hint=error.hint) from None
        return Pose(*(read_only(part) for part in self._world._solver.body(self._snapshot, handle)[0]))

    def contacts(self) -> list[Contact]:
        return [contact_of(row, self._world.info.geoms) for row in self._world._solver.contacts(self._snapshot)]

    def value(self, field: str, element: str = "") -> Doubles:
        """A field of mjData or mjModel after a forward pass: value("site_xpos", "arm/tool")."""
        return cast(Doubles, self._world._solver.value(self._snapshot, field, element))

    def render(self, camera: str = "free", outputs: Sequence[str] = DEFAULT_OUTPUTS, *, width: int = 0, height: int = 0,
               pose: Pose | None = None, **render: Any) -> Frame:
        """Renders an image, like Camera.render()."""
        return Frame(self._world._painter.paint(self._snapshot, image_options(camera, outputs, width, height, pose, render)))

    def __repr__(self) -> str:
        return f"<gloam.Snapshot at {self.time:.4f} s>"


def image_options(camera: str, outputs: Sequence[str], width: int, height: int, pose: Any, render: dict[str, Any]) -> dict[str, Any]:
    """A request of an image for the extension module."""
    names = [outputs] if isinstance(outputs, str) else list(outputs)
    return {"camera": camera, "outputs": names, "width": width, "height": height, "pose": pose, **render}
