"""Sources of raw values: cameras, LiDARs, sensors, joints, topics and metrics of one simulation."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import gloam
from gloam.envs.noise import Array


class Source:
    """A quantity of one simulation."""

    def begin(self) -> None:
        """Clears the previous episode; call it after a reset."""

    def read(self) -> Array:
        """Its value at the present instant; a new array."""
        raise NotImplementedError

    def close(self) -> None:
        """Ends its stream, if it has one."""


class FunctionSource(Source):
    """The result of a function of the simulation: a number, or an array of constant shape."""

    def __init__(self, sim: gloam.Simulation, function: Callable[[gloam.Simulation], Any]) -> None:
        self._sim, self._function = sim, function

    def read(self) -> Array:
        return np.atleast_1d(np.array(self._function(self._sim), dtype=np.float64))


class CameraSource(Source):
    """A channel of a camera's image of the present instant; the first image already shows the state after a reset.

    output: "rgb" (height, width, 3) uint8, "depth" (height, width) [m], "ids", "semantic", or another channel of a
    frame. far: depth where nothing is visible [m]. render: "tier", "spp" and the like.
    """

    def __init__(
        self,
        sim: gloam.Simulation,
        camera: str,
        output: str,
        size: tuple[int, int] = (0, 0),
        far: float = 100.0,
        render: Mapping[str, Any] | None = None,
    ) -> None:
        self._camera = sim.cameras[camera]
        self._output, self._far = output, far
        asked = "segmentation" if output in ("ids", "semantic", "part") else output
        self._request: dict[str, Any] = {"outputs": (asked,), "width": size[0], "height": size[1], **(render or {})}

    def read(self) -> Array:
        value = np.array(getattr(self._camera.render(**self._request), self._output))
        if self._output == "depth":
            return np.where(np.isfinite(value) & (value > 0), value, np.float32(self._far))
        return value


class LidarSource(Source):
    """Ranges of the scan that ended last, (rings, columns), or (columns,) of one ring [m]; no return: far.

    Errors: UsageError if no scan has ended yet: a scan takes its time.
    """

    def __init__(self, sim: gloam.Simulation, lidar: str, rings: int, columns: int, far: float) -> None:
        self._lidar = sim.lidars[lidar].open(required=True)
        self._shape, self._far = (rings, columns), far

    def read(self) -> Array:
        scan = self._lidar.latest()
        if scan is None:
            raise gloam.UsageError(
                f"no scan of '{self._lidar.name}' has ended yet", hint="settle for at least 1 / rate"
            )
        ranges = np.full(self._shape, self._far, dtype=np.float32)
        np.minimum.at(ranges, (np.asarray(scan.ring), np.asarray(scan.column)), np.asarray(scan.range))
        return ranges[0] if self._shape[0] == 1 else ranges

    def close(self) -> None:
        self._lidar.close()


class SensorSource(Source):
    """Numbers of a MuJoCo sensor, without the errors of a [[sensor]] table, or of the last sample of a probe.

    Errors: UsageError if a probe has not been sampled yet.
    """

    def __init__(self, sim: gloam.Simulation, sensor: str) -> None:
        self._sensor = sim.sensors[sensor]
        self._probe = self._sensor.open() if sensor in sim.world.probes else None

    def read(self) -> Array:
        if self._probe is None:
            return np.array(self._sensor.values)
        sample = self._probe.latest()
        if sample is None:
            raise gloam.UsageError(f"probe '{self._sensor.name}' has not been sampled yet", hint="increase its rate, or settle for longer")
        return np.array(sample.values)

    def close(self) -> None:
        if self._probe is not None:
            self._probe.close()


class JointSource(Source):
    """Positions or velocities of a robot's hinges and slides [rad, m], [rad/s, m/s]."""

    def __init__(self, sim: gloam.Simulation, robot: str, is_velocity: bool) -> None:
        self._robot, self._is_velocity = sim.robots[robot], is_velocity

    def read(self) -> Array:
        return np.array(self._robot.qvel if self._is_velocity else self._robot.qpos)


class TopicSource(Source):
    """Numbers of the newest message of a topic that ROS subscribers would have received by now.

    field: place in the message, parts with dots between: "twist.twist.linear"; a table gives its numbers in order.
    Errors: UsageError if no message has come yet; NotFoundError for an unknown field.
    """

    def __init__(self, sim: gloam.Simulation, topic: str, field: str) -> None:
        self._topic, self._field = topic, field
        self._stream = sim.subscribe([topic])

    def read(self) -> Array:
        message = self._stream.latest()
        if message is None:
            raise gloam.UsageError(
                f"topic '{self._topic}' has not published a message yet", hint="increase its rate, or settle for longer"
            )
        value: Any = message.decode()
        for part in self._field.split(".") if self._field else []:
            if not isinstance(value, Mapping) or part not in value:
                raise gloam.NotFoundError(f"a message of '{self._topic}' has no field '{self._field}'")
            value = value[part]
        return np.array(_numbers(value), dtype=np.float64)

    def close(self) -> None:
        self._stream.close()


class Metrics:
    """Metrics of one simulation, sampled at record.metrics_rate."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self._sim = sim
        self._step = -1
        self._stream: gloam.MetricStream | None = None
        self._values: dict[str, float] = {}

    def begin(self) -> None:
        """Begins an episode: they count from the first call and from each reset."""
        if self._stream is None:
            self._stream = self._sim.open_metrics()
        self._values = self._stream.latest()
        self._step = self._sim.step_count

    def value(self, name: str) -> float:
        """Present value; NaN if it has none now. Errors: NotFoundError for an unknown name."""
        step = self._sim.step_count
        if step != self._step:
            self.begin()
        if name not in self._values:
            names = [metric.name for metric in self._sim.world.metrics()]
            if name not in names:
                raise gloam.NotFoundError(f"there is no metric '{name}'", hint=f"one of: {', '.join(names)}")
        return float(self._values.get(name, math.nan))

    def close(self) -> None:
        """Ends the stream."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None


class MetricSource(Source):
    """A metric, (1,); 0 where it has no value."""

    def __init__(self, metrics: Metrics, name: str) -> None:
        self._metrics, self._name = metrics, name

    def read(self) -> Array:
        value = self._metrics.value(self._name)
        return np.array([value if math.isfinite(value) else 0.0])


def _numbers(value: Any) -> list[float]:
    """All numbers of a decoded message, in order."""
    if isinstance(value, Mapping):
        return [number for part in value.values() for number in _numbers(part)]
    if isinstance(value, (list, tuple, np.ndarray)):
        return [number for part in value for number in _numbers(part)]
    if isinstance(value, (int, float, np.number)):
        return [float(value)]
    return []
