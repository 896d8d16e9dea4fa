"""Frames of cameras."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from gloam import _core

from .elements import Doubles, Pose

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float32]
Ids = NDArray[np.uint32]


class Event(NamedTuple):
    """A change of brightness that a pixel of an event camera has reported."""

    x: int  #: column [px]
    y: int  #: row [px]
    brighter: bool
    time: float  #: [s]


@dataclass(frozen=True)
class CameraInfo:
    """The lens of a camera, as in ROS's CameraInfo."""

    frame_id: str  #: "NAME_optical_frame": z forward, x right, y down
    distortion_model: str  #: name in ROS, or "equirectangular" or "orthographic"
    d: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class ObjectView:
    """An object in an image. Boxes: (u0, v0, u1, v1) [px]; without pixels u1 < u0."""

    instance: int  #: value of Frame.ids
    name: str
    semantic: int
    pixels: int  #: that show it
    box: tuple[int, int, int, int]  #: around these
    whole_box: tuple[int, int, int, int]  #: around all that would show it without occlusion
    visibility: float  #: fraction that is not hidden, 0 … 1
    pose: Pose  #: X_WO
    center: tuple[float, float, float]  #: of the box along O's axes around its visible parts [m]
    size: tuple[float, float, float]  #: of that box [m]


class Frame:
    """One frame of one camera. Arrays are views of its memory and keep it alive; channels that were not requested are
    None.

    Exact channels are of the ray through each pixel's centre. docs/cameras.md describes all of them.
    """

    def __init__(self, frame: _core.Frame) -> None:
        self._frame = frame

    @property
    def camera(self) -> str:
        return self._frame.camera

    @property
    def index(self) -> int:
        """Number of the frame since the reset."""
        return self._frame.index

    @property
    def step(self) -> int:
        return self._frame.step

    @property
    def stamp(self) -> float:
        """Simulation time at which the exposure began [s]."""
        return self._frame.stamp

    @property
    def delivery(self) -> float:
        """Simulation time at which it reaches readers [s]."""
        return self._frame.delivery

    @property
    def warmup(self) -> bool:
        return self._frame.warmup

    @property
    def width(self) -> int:
        return self._frame.width

    @property
    def height(self) -> int:
        return self._frame.height

    @property
    def ev100(self) -> float:
        """Exposure value of `rgb` and `raw`."""
        return self._frame.ev100

    @property
    def exposure_time(self) -> float:
        """Of each row [s]."""
        return self._frame.exposure_time

    @property
    def readout_time(self) -> float:
        """From the first row's exposure to the last one's [s]."""
        return self._frame.readout_time

    @property
    def rgb(self) -> Bytes:
        """(H, W, 3), sRGB."""
        return cast(Bytes, self._frame.rgb)

    @property
    def radiance(self) -> Floats:
        """(H, W, 3), linear Rec. 709 [cd/m²]."""
        return cast(Floats, self._frame.radiance)

    @property
    def depth(self) -> Floats:
        """(H, W), along the optical axis [m]; inf = nothing."""
        return cast(Floats, self._frame.depth)

    @property
    def distance(self) -> Floats:
        """(H, W), along the ray [m]; inf = nothing."""
        return cast(Floats, self._frame.distance)

    @property
    def ids(self) -> Ids:
        """(H, W), Label.instance; 0 = nothing."""
        return cast(Ids, self._frame.instance)

    @property
    def semantic(self) -> Ids:
        """(H, W), Label.semantic; 0 = nothing."""
        return cast(Ids, self._frame.semantic)

    @property
    def part(self) -> Ids:
        """(H, W), Label.part; 0 = nothing."""
        return cast(Ids, self._frame.part)

    @property
    def normal(self) -> Floats:
        """(H, W, 3), unit, world axes; 0 = nothing."""
        return cast(Floats, self._frame.normal)

    @property
    def albedo(self) -> Floats:
        """(H, W, 3), 0 … 1."""
        return cast(Floats, self._frame.albedo)

    @property
    def samples(self) -> Ids:
        """(H, W), number of light paths."""
        return cast(Ids, self._frame.samples)

    @property
    def motion(self) -> Floats:
        """(H, W, 2), optical flow since the previous frame [px]."""
        return cast(Floats, self._frame.motion)

    @property
    def scene_flow(self) -> Floats:
        """(H, W, 3), displacement of the visible point since the previous frame, world axes [m]."""
        return cast(Floats, self._frame.scene_flow)

    @property
    def raw(self) -> NDArray[np.uint16]:
        """Numbers of the imager, (H, W) with a mosaic, else (H, W, 3)."""
        return cast("NDArray[np.uint16]", self._frame.raw)

    @property
    def sensor_depth(self) -> Floats:
        """(H, W), as measured by the camera's stereo_depth model [m]; 0 = nothing."""
        return cast(Floats, self._frame.sensor_depth)

    @property
    def thermal(self) -> Floats:
        """(H, W), apparent temperature [K]."""
        return cast(Floats, self._frame.thermal)

    @property
    def events(self) -> list[Event]:
        """Since the previous frame, in order of time."""
        return [Event(*event) for event in self._frame.events]

    @property
    def objects(self) -> list[ObjectView]:
        """In the image, hidden ones included, by id."""
        return [ObjectView(**{**made, "pose": Pose(*made["pose"])}) for made in self._frame.objects]

    @property
    def info(self) -> CameraInfo:
        info = self._frame.info
        return CameraInfo(info["frame_id"], info["distortion_model"], tuple(info["d"]))

    @property
    def K(self) -> Doubles:
        """Intrinsic matrix (3, 3) [px]; pixel centres at integer + 0.5."""
        return np.asarray(self._frame.K)

    @property
    def D(self) -> list[float]:
        """Distortion as in ROS's CameraInfo."""
        return list(self.info.d)

    @property
    def pose(self) -> Pose:
        """X_WC; the camera looks along -z with +y up."""
        return Pose(*self._frame.pose)

    @property
    def X_WC(self) -> Doubles:
        """Pose as a matrix (4, 4)."""
        return self.pose.matrix

    def write(self, folder: str, name: str) -> list[Path]:
        """Writes its channels as files NAME.png, NAME_depth.png … Returns their paths."""
        return [Path(p) for p in self._frame.write(Path(folder), name)]

    def _repr_png_(self) -> bytes | None:
        from .notebook import png

        return None if self._frame.rgb is None else png(self.rgb)

    def __repr__(self) -> str:
        return f"<gloam.Frame {self.index} of '{self.camera}', {self.width} x {self.height}, {self.stamp:.4f} s>"
