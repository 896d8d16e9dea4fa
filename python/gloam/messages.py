"""Scans of LiDARs, samples of sensors, messages of topics."""
from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from gloam import _core

from .elements import Doubles, Pose
from .frames import Floats, Ids


class Scan:
    """One scan of a LiDAR. Points are in the sensor's frame, x ahead, z up [m]; returns, (n,), are in firing order."""

    def __init__(self, scan: _core.Scan) -> None:
        self._scan = scan

    @property
    def lidar(self) -> str:
        return self._scan.lidar

    @property
    def index(self) -> int:
        """Number of the scan since the reset."""
        return self._scan.index

    @property
    def step(self) -> int:
        return self._scan.step

    @property
    def start(self) -> float:
        """Start of the scan [s]."""
        return self._scan.start

    @property
    def stamp(self) -> float:
        """End of the scan [s]."""
        return self._scan.stamp

    @property
    def rings(self) -> int:
        return self._scan.rings

    @property
    def columns(self) -> int:
        return self._scan.columns

    @property
    def beams(self) -> int:
        return self._scan.beams

    @property
    def deskewed(self) -> bool:
        return self._scan.deskewed

    @property
    def points(self) -> Floats:
        """(n, 3) [m]"""
        return cast(Floats, self._scan.points)

    @property
    def x(self) -> Floats:
        """[m]"""
        return cast(Floats, self._scan.x)

    @property
    def y(self) -> Floats:
        """[m]"""
        return cast(Floats, self._scan.y)

    @property
    def z(self) -> Floats:
        """[m]"""
        return cast(Floats, self._scan.z)

    @property
    def intensity(self) -> Floats:
        return cast(Floats, self._scan.intensity)

    @property
    def range(self) -> Floats:
        """[m]"""
        return cast(Floats, self._scan.range)

    @property
    def time(self) -> Floats:
        """Since the start of the scan [s]."""
        return cast(Floats, self._scan.time)

    @property
    def ring(self) -> NDArray[np.uint16]:
        return cast("NDArray[np.uint16]", self._scan.ring)

    @property
    def column(self) -> NDArray[np.uint16]:
        return cast("NDArray[np.uint16]", self._scan.column)

    @property
    def return_number(self) -> NDArray[np.uint8]:
        """0 = the first return of its beam."""
        return cast("NDArray[np.uint8]", self._scan.return_number)

    @property
    def part(self) -> Ids:
        """Label.part."""
        return cast(Ids, self._scan.part)

    @property
    def instance(self) -> Ids:
        """Label.instance."""
        return cast(Ids, self._scan.instance)

    @property
    def semantic(self) -> Ids:
        """Label.semantic."""
        return cast(Ids, self._scan.semantic)

    @property
    def pose_start(self) -> Pose:
        """X_WL at the start of the scan."""
        return Pose(*self._scan.pose_start)

    @property
    def pose(self) -> Pose:
        """X_WL at the end of the scan."""
        return Pose(*self._scan.pose)

    @property
    def X_WL(self) -> Doubles:
        """Pose as a matrix (4, 4)."""
        return self.pose.matrix

    def __len__(self) -> int:
        return len(self._scan)

    def __repr__(self) -> str:
        return f"<gloam.Scan of '{self.lidar}', {len(self)} returns, {self.stamp:.4f} s>"


class Sample:
    """One sample of one sensor or probe."""

    def __init__(self, sample: _core.Sample) -> None:
        self._sample = sample

    @property
    def sensor(self) -> str:
        return self._sample.sensor

    @property
    def index(self) -> int:
        """Number of the sample since the reset."""
        return self._sample.index

    @property
    def step(self) -> int:
        return self._sample.step

    @property
    def stamp(self) -> float:
        """[s]"""
        return self._sample.stamp

    @property
    def delivery(self) -> float:
        """Simulation time at which it reaches readers [s]."""
        return self._sample.delivery

    @property
    def values(self) -> Doubles:
        """Its numbers in the sensor's unit, (n,)."""
        return cast(Doubles, self._sample.values)

    def __repr__(self) -> str:
        return f"<gloam.Sample of '{self.sensor}', {self.values}, {self.stamp:.4f} s>"


class Message:
    """One message of a topic."""

    def __init__(self, message: _core.Message) -> None:
        self._message = message

    @property
    def topic(self) -> str:
        return self._message.topic

    @property
    def type(self) -> str:
        """"sensor_msgs/msg/Image"."""
        return self._message.type

    @property
    def step(self) -> int:
        return self._message.step

    @property
    def stamp(self) -> float:
        """[s]"""
        return self._message.stamp

    @property
    def delivery(self) -> float:
        """Simulation time at which it reaches readers [s]."""
        return self._message.delivery

    @property
    def data(self) -> bytes:
        """CDR, with its header of four bytes."""
        return self._message.data

    def decode(self) -> dict[str, Any]:
        """Its fields by their names in ROS; messages in messages are dicts, numbers of arrays NumPy's."""
        return cast("dict[str, Any]", self._message.decode())

    def __repr__(self) -> str:
        return repr(self._message)
