"""Cameras, LiDARs and other streams of a simulation."""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gloam import _core

from .elements import Doubles, Pose, read_only

if TYPE_CHECKING:
    from .simulation import Simulation

_DEFAULT_OUTPUTS = ("rgb", "depth", "segmentation")
M = TypeVar("M")


class Frame:
    """One frame of one camera. Arrays are views of its memory and keep it alive; channels that were not requested are
    None.

    rgb (H, W, 3) uint8 sRGB; radiance (H, W, 3) [cd/m²]; depth, distance (H, W) [m], inf = nothing; ids, semantic,
    part (H, W) uint32, 0 = nothing; normal, albedo, scene_flow (H, W, 3); motion (H, W, 2) [px]; thermal (H, W) [K];
    raw, sensor_depth, samples: see docs/cameras.md.
    """

    def __init__(self, frame: Any) -> None:
        self._frame = frame

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._frame, name)

    @property
    def rgb(self) -> NDArray[np.uint8]:
        return cast("NDArray[np.uint8]", self._frame.rgb)

    @property
    def depth(self) -> NDArray[np.float32]:
        return cast("NDArray[np.float32]", self._frame.depth)

    @property
    def ids(self) -> NDArray[np.uint32]:
        """Object ids, as "instance" in sim.labels()."""
        return cast("NDArray[np.uint32]", self._frame.instance)

    @property
    def K(self) -> Doubles:
        """Intrinsic matrix (3, 3) [px]; pixel centres at integer + 0.5."""
        return np.asarray(self._frame.K)

    @property
    def D(self) -> list[float]:
        """Distortion as in ROS's CameraInfo."""
        return list(self._frame.info["d"])

    @property
    def pose(self) -> Pose:
        """X_WC; the camera looks along -z with +y up."""
        return Pose(*self._frame.pose)

    @property
    def X_WC(self) -> Doubles:
        """Pose as a matrix (4, 4)."""
        return self.pose.matrix

    @property
    def stamp(self) -> float:
        """Simulation time at which the exposure began [s]."""
        return float(self._frame.stamp)

    @property
    def step(self) -> int:
        return int(self._frame.step)

    @property
    def index(self) -> int:
        """Number of the frame since the reset."""
        return int(self._frame.index)

    def write(self, folder: str, name: str) -> list[Path]:
        """Writes its channels as files NAME.png, NAME_depth.png … Returns their paths."""
        return [Path(p) for p in self._frame.write(Path(folder), name)]

    def _repr_png_(self) -> bytes | None:
        from .notebook import png

        return None if self._frame.rgb is None else png(self.rgb)

    def __repr__(self) -> str:
        return f"<gloam.Frame {self._frame.index} of '{self._frame.camera}', {self._frame.width} x {self._frame.height}, {self.stamp:.4f} s>"


class Scan:
    """One scan of a LiDAR. Points are in the sensor's frame, x ahead, z up [m]."""

    def __init__(self, scan: Any) -> None:
        self._scan = scan

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._scan, name)

    @property
    def points(self) -> NDArray[np.float32]:
        """(n, 3) [m]"""
        return cast("NDArray[np.float32]", self._scan.points)

    @property
    def pose(self) -> Pose:
        """X_WL at the end of the scan."""
        return Pose(*self._scan.pose)

    @property
    def X_WL(self) -> Doubles:
        return self.pose.matrix

    @property
    def stamp(self) -> float:
        """End of the scan [s]."""
        return float(self._scan.stamp)

    def __len__(self) -> int:
        return len(self._scan)

    def __repr__(self) -> str:
        return f"<gloam.Scan of '{self._scan.lidar}', {len(self)} returns, {self.stamp:.4f} s>"


class Source:
    """A source that is opened as a stream: a camera, a LiDAR, a sensor."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim = sim
        self.name = name
        self._stream: Any = None
        self._last: Any = None

    def _open(self, options: dict[str, Any], callback: Callable[[Any], None] | None) -> Any:
        raise NotImplementedError

    def _wrap(self, message: Any) -> Any:
        return message

    @property
    def is_open(self) -> bool:
        return self._stream is not None and bool(self._stream.is_open)

    def _opened(self) -> Any:
        if not self.is_open:
            self._stream = self._open({}, None)
        return self._stream

    def _start(self, options: dict[str, Any], callback: Callable[[Any], None] | None) -> None:
        self.close()
        wrapped = None if callback is None else (lambda message: callback(self._wrap(message)))
        self._stream = self._open(options, wrapped)

    def close(self) -> None:
        """Closes the stream, if it is open."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    @property
    def dropped(self) -> int:
        """Messages lost because they were not read in time."""
        return int(self._opened().dropped)

    def _next(self) -> Any:
        self._last = self._wrap(self._sim._core.step_until(self._opened()))
        return self._last

    def _waiting(self) -> Iterator[Any]:
        """Messages received since the last call, without stepping."""
        stream = self._opened()
        stream.flush()
        while (message := stream.pop()) is not None:
            self._last = self._wrap(message)
            yield self._last

    def __repr__(self) -> str:
        return f"<gloam.{type(self).__name__} '{self.name}'>"


class Camera(Source):
    """A camera of the simulation, or "free"."""

    def _open(self, options: dict[str, Any], callback: Callable[[Any], None] | None) -> Any:
        options = {"outputs": list(_DEFAULT_OUTPUTS), "required": True, **options, "camera": self.name}
        return _core.open_camera(self._sim._core, options, callback)

    def _wrap(self, message: Any) -> Frame:
        return Frame(message)

    def open(self, outputs: Sequence[str] = _DEFAULT_OUTPUTS, *, width: int = 0, height: int = 0, rate: float = 0, required: bool = True,
             pose: Pose | None = None, callback: Callable[[Frame], None] | None = None, **render: Any) -> Camera:
        """Opens the stream, or reopens it. `width`, `height` [px] and `rate` [Hz]: 0 = the camera's own; `required`:
        the simulation waits for it; `callback`: called on the camera's thread for each frame, which is then not kept
        for next(); `render`: tier, spp, denoise, device …"""
        if isinstance(outputs, str):
            outputs = (outputs,)
        self._start({"outputs": list(outputs), "width": width, "height": height, "rate": rate, "required": required, "pose": pose,
                     **render}, callback)
        return self

    def next(self) -> Frame:
        """Steps until its next frame reaches a reader, and returns that."""
        return cast("Frame", self._next())

    def waiting(self) -> Iterator[Frame]:
        """Frames that were received but not yet read."""
        return self._waiting()

    @property
    def frame(self) -> Frame | None:
        """The last frame that was read."""
        return cast("Frame | None", self._last)

    def set_pose(self, pose: Pose | tuple[Any, Any]) -> None:
        """Moves the camera "free": X_WC."""
        self._opened().set_pose(pose)

    def render(self, outputs: Sequence[str] = _DEFAULT_OUTPUTS, *, width: int = 0, height: int = 0, pose: Pose | None = None,
               qpos: ArrayLike | None = None, **render: Any) -> Frame:
        """Renders an image of the present instant, without motion blur and without a stream; with `qpos`, (nq,), of
        the scene in that state."""
        options = {"camera": self.name, "outputs": list(outputs), "width": width, "height": height, "pose": pose, **render}
        core = self._sim._core if qpos is None else self._sim._posed(qpos)
        return Frame(self._sim._painter().paint(core, options))


class Lidar(Source):
    """A LiDAR of the scene."""

    def _open(self, options: dict[str, Any], callback: Callable[[Any], None] | None) -> Any:
        return _core.open_lidar(self._sim._core, self.name, options.get("required", True), callback)

    def _wrap(self, message: Any) -> Scan:
        return Scan(message)

    def open(self, *, required: bool = True, callback: Callable[[Scan], None] | None = None) -> Lidar:
        self._start({"required": required}, callback)
        return self

    def next(self) -> Scan:
        """Steps until its next scan is complete, and returns it."""
        return cast("Scan", self._next())

    def waiting(self) -> Iterator[Scan]:
        return self._waiting()


class Sensor(Source):
    """A sensor of MuJoCo's model or a [[probe]] of the scene, with the errors of its [[sensor]] table in the
    scene."""

    def _open(self, options: dict[str, Any], callback: Callable[[Any], None] | None) -> Any:
        return _core.open_sensor(self._sim._core, self.name, options.get("required", True), callback)

    def open(self, *, required: bool = True, callback: Callable[[Any], None] | None = None) -> Sensor:
        self._start({"required": required}, callback)
        return self

    @property
    def values(self) -> Doubles:
        """True values of the last step, as a live view of MuJoCo's data; for a probe, its last sample since it was
        opened. Read-only."""
        sim = self._sim
        if self.name in sim.world.probes:
            for _ in self._waiting():
                pass
            return read_only(np.array(self._last.values if self._last is not None else (), dtype=np.float64))
        index = sim._core_world.find_sensor(self.name).id
        memory = sim.memory
        start = int(memory.array("sensor_adr")[index])
        values = memory.array("sensordata")[start:start + int(memory.array("sensor_dim")[index])]
        return read_only(values)

    def next(self) -> Any:
        """Steps until its next sample reaches a reader: .values, .stamp, .delivery."""
        return self._next()

    def waiting(self) -> Iterator[Any]:
        return self._waiting()


class Subscription:
    """Open topics: iteration yields the received messages. Message: .topic .type .stamp .data (CDR), .decode() ->
    dict."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def __iter__(self) -> Iterator[Any]:
        self._stream.flush()
        while (message := self._stream.pop()) is not None:
            yield message

    @property
    def dropped(self) -> int:
        return int(self._stream.dropped)

    def close(self) -> None:
        self._stream.close()

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

