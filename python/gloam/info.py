"""Descriptions of worlds, simulations and logs, as frozen dataclasses; dataclasses.asdict() makes dicts of them."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

from .elements import Doubles

T = TypeVar("T")


@dataclass(frozen=True)
class TopicInfo:
    """A topic that a simulation publishes or accepts (docs/topics.md)."""

    name: str  #: "/front/image_raw"
    type: str  #: "sensor_msgs/msg/Image"
    frame_id: str  #: frame in the header; "" = the type has none
    rate: float  #: messages per second of simulation time [Hz]; 0 = every step
    is_input: bool  #: accepted by Simulation.publish()
    is_logged: bool  #: recorded by logs that do not name topics
    is_latched: bool  #: late subscribers receive the last message
    is_large: bool  #: messages of kilobytes to megabytes, such as images and point clouds
    source_kind: str  #: element that it describes: "simulation", "robot", "camera", "lidar", "sensor", "gas", "body"
    source_name: str  #: name of the element; of the simulation: its part, such as "contacts"


@dataclass(frozen=True)
class StreamInfo:
    """An output of a simulation."""

    kind: str  #: "camera", "lidar", "sensor", "joints", "poses"
    name: str  #: name of the camera, LiDAR, sensor or robot; "world"
    frame_id: str  #: frame of its data
    rate: float  #: own rate in simulation time [Hz]; 0 = every step
    outputs: tuple[str, ...]  #: channels, or names of joints and bodies
    unit: str  #: of a sensor's numbers; "" = unknown


@dataclass(frozen=True)
class InputInfo:
    """An input of a simulation."""

    kind: str  #: "velocity", "controls", "mocap", "live_field"
    name: str  #: of the robot, body or field
    elements: tuple[str, ...]  #: actuators in order, or axes; empty for live fields
    count: int  #: number of values
    low: tuple[float, ...]  #: limits for each element, or one for all, in `unit`
    high: tuple[float, ...]
    unit: str


@dataclass(frozen=True)
class MetricInfo:
    """A number that is computed for each instant of a run (docs/metrics.md)."""

    name: str  #: column of metrics.csv: "ada.path_length_m"
    unit: str  #: "m", "m/s" …; "" = none
    robot: str  #: "" = the scene, or the only robot
    declared: bool  #: by a [[metric]]; False = built in


@dataclass(frozen=True)
class WorldInfo:
    """Contents of a compiled model. Names are full names in MuJoCo's order; "" = the model gives none."""

    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    actuators: tuple[str, ...]
    sensors: tuple[str, ...]  #: of MuJoCo's model, then the probes
    probes: tuple[str, ...]  #: [[probe]]s of the scene
    cameras: tuple[str, ...]  #: without a name: "camera_ID"
    geoms: tuple[str, ...]
    sites: tuple[str, ...]
    tendons: tuple[str, ...]
    lights: tuple[str, ...]
    materials: tuple[str, ...]
    keyframes: tuple[str, ...]
    nq: int
    nv: int
    nu: int
    timestep: float  #: of the model [s]
    mass: float  #: of all bodies [kg]
    model_bytes: int  #: size of mjModel
    triangles: int  #: rendered triangles
    drawn: Mapping[str, str]  #: values that [[randomize]] drew, as in a scene file, by the options' paths


@dataclass(frozen=True)
class Label:
    """A rendered geom. 0 in an image of ids = nothing."""

    part: int  #: value of Frame.part
    geom: str
    body: str
    material: str
    instance: int  #: value of Frame.ids: the robot, or the body whose parent is the world
    instance_name: str
    semantic: int  #: value of Frame.semantic
    semantic_name: str  #: class: "floor", "wall", name of the object without trailing digits


@dataclass(frozen=True, eq=False)
class Contact:
    """Two geoms in contact; world axes."""

    geoms: tuple[str, str]  #: names; "" = unnamed, or a flex
    position: Doubles  #: between the surfaces [m], (3,)
    normal: Doubles  #: unit, from the first geom to the second, (3,)
    distance: float  #: between the surfaces [m]; negative = they overlap
    force: Doubles  #: on the second geom [N], (3,)
    torque: Doubles  #: on the second geom [N m], (3,)


@dataclass(frozen=True)
class SensorCost:
    """Cost and rate of an open stream."""

    name: str  #: "camera 'front'"
    rate: float  #: messages that were requested [Hz of simulation time]
    achieved: float  #: messages that were produced [Hz of simulation time]; 0 = fewer than two
    messages: int
    dropped: int  #: instants lost because the stream was late
    wall_ms: float  #: mean wall time to produce and deliver a message [ms]
    waited_ms: float  #: mean wall time spent waiting for other sensors' rendering [ms]


@dataclass(frozen=True)
class SimulationStats:
    """Progress of a simulation and its costs."""

    step: int
    time: float  #: [s]
    hash: int
    realtime_factor: float  #: simulated seconds per wall second since the last resume
    dropped_snapshots: int
    commands_applied: int  #: posted Commands, over all runs
    warnings: int  #: of MuJoCo
    pace: Literal["lockstep", "fast", "realtime", "sensors"]
    sensors: tuple[SensorCost, ...]


@dataclass(frozen=True)
class LoggedTopic:
    """A topic of a log."""

    name: str
    type: str
    messages: int
    rate: float  #: mean over the log [Hz]


@dataclass(frozen=True)
class LogInfo:
    """Summary of a log of any writer."""

    profile: str
    library: str
    bytes: int
    messages: int
    start: float  #: [s]
    duration: float  #: [s]
    topics: tuple[LoggedTopic, ...]
    has_run: bool  #: Gloam wrote the log and can step the run again
    scene: str  #: scene file, if has_run
    damage: str  #: first damage found; "" = none


@dataclass(frozen=True)
class LogRecovery:
    """Result of recovering a damaged log."""

    is_whole: bool  #: the log is not damaged
    messages: int
    messages_lost: int
    damage: tuple[str, ...]  #: "byte N: cause"


@dataclass(frozen=True)
class ReplayVariant:
    """One of the replays that Log.variants() records."""

    seed: int
    out: Path
    was_done: bool  #: by an earlier call that was cancelled


def of(kind: type[T], row: Mapping[str, Any]) -> T:
    """A dataclass of a dict of the extension module, whose lists become tuples."""
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in row.items()})


def contact_of(row: Mapping[str, Any], geoms: tuple[str, ...]) -> Contact:
    """A contact whose geoms are numbers, with their names."""
    first, second = (geoms[g] if 0 <= g < len(geoms) else "" for g in row["geoms"])
    return Contact(**{**row, "geoms": (first, second)})


def stats_of(row: Mapping[str, Any]) -> SimulationStats:
    return of(SimulationStats, {**row, "sensors": [of(SensorCost, sensor) for sensor in row["sensors"]]})


def log_info_of(row: Mapping[str, Any]) -> LogInfo:
    return of(LogInfo, {**row, "topics": [of(LoggedTopic, topic) for topic in row["topics"]]})
