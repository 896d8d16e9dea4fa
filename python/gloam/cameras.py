"""Cameras, LiDARs and sensors of a simulation."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from gloam import _core

from .elements import Doubles, Pose, read_only
from .errors import UsageError
from .frames import Frame
from .messages import Sample, Scan
from .snapshot import DEFAULT_OUTPUTS, image_options
from .streams import CameraStream, LidarStream, SensorStream

if TYPE_CHECKING:
    from .simulation import Simulation


class Source:
    """A camera, LiDAR or sensor. Each open() returns a stream of its own."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim = sim
        self.name = name

    def __repr__(self) -> str:
        return f"<gloam.{type(self).__name__} '{self.name}'>"


class Camera(Source):
    """A camera of the simulation, or "free"."""

    def open(self, outputs: Sequence[str] = DEFAULT_OUTPUTS, *, width: int = 0, height: int = 0, rate: float = 0, required: bool = True,
             pose: Pose | None = None, callback: Callable[[Frame], None] | None = None, **render: Any) -> CameraStream:
        """Opens a stream of frames.

        width, height [px], rate [Hz]: 0 = the camera's own. required: the simulation waits for it. pose: X_WC of the
        camera "free". callback: called on the camera's thread for each frame. render: tier, spp, error, max_depth,
        denoise, look, ev100, device (docs/light.md); others are as in the scene's [render] when the stream is opened.
        """
        sim = self._sim
        options = {**image_options(self.name, outputs, width, height, pose, render), "rate": rate, "required": required}
        return CameraStream(sim, self.name, lambda call: _core.open_camera(sim._core, options, call), Frame, callback)

    def render(self, outputs: Sequence[str] = DEFAULT_OUTPUTS, *, width: int = 0, height: int = 0, pose: Pose | None = None,
               qpos: ArrayLike | None = None, **render: Any) -> Frame:
        """Renders an image of the present instant, without motion blur and without a stream.

        qpos: (nq,), the scene at rest in that state instead, at the present time and with the mocap bodies (agents) of
        the present, but with effects that have not begun. render: as for open().
        """
        now = self._sim._core.latest
        options = image_options(self.name, outputs, width, height, pose, render)
        return Frame(self._sim._painter().paint(now if qpos is None else now.posed(qpos), options))


class Lidar(Source):
    """A LiDAR of the scene."""

    def open(self, *, required: bool = True, callback: Callable[[Scan], None] | None = None) -> LidarStream:
        """Opens a stream of scans, each delivered when it is complete. Parameters: as for Camera.open()."""
        sim = self._sim
        return LidarStream(sim, self.name, lambda call: _core.open_lidar(sim._core, self.name, required, call), Scan, callback)


class Sensor(Source):
    """A sensor of MuJoCo's model or a [[probe]] of the scene."""

    def open(self, *, required: bool = True, callback: Callable[[Sample], None] | None = None) -> SensorStream:
        """Opens a stream of samples, with the errors of the sensor's [[sensor]] table in the scene. Parameters: as for
        Camera.open()."""
        sim = self._sim
        return SensorStream(sim, self.name, lambda call: _core.open_sensor(sim._core, self.name, required, call), Sample, callback)

    @property
    def values(self) -> Doubles:
        """True values of the last step, as a live view of MuJoCo's data; read-only. Raises UsageError for a probe, whose
        values are computed for streams only."""
        sim = self._sim
        if self.name in sim.world.probes:
            raise UsageError(f"'{self.name}' is a probe, which is sampled by streams only", hint="open() one and read its latest()")
        index = sim._core_world.find_sensor(self.name).id
        memory = sim.memory
        start = int(memory.array("sensor_adr")[index])
        values = memory.array("sensordata")[start:start + int(memory.array("sensor_dim")[index])]
        return read_only(values)
