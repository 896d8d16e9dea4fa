"""Gloam: a robotics simulator. Physics is MuJoCo's, light is path-traced, and every sensor sees the same instant.

    import gloam
    sim = gloam.load("house.toml", seed=7)
    dog, cam = sim.robots["go1"], sim.cameras["head"].open()
    while sim.time < 20:
        dog.command(vx=0.6)
        frame = cam.next()
"""
from __future__ import annotations

import os as _os

_built = _os.environ.get("GLOAM_BUILT")  # folder of the compiled module in a source tree
if _built:
    __path__.append(_built)

from gloam import _core  # noqa: E402

from .batch import check, convert, evaluate, generate, render, report, run  # noqa: E402
from .cameras import Camera, Lidar, Sensor  # noqa: E402
from .catalogue import RobotModel, guess_robot, robot_model, robots  # noqa: E402
from .elements import Actuator, Body, Joint, Pose, Robot, yaw_quaternion  # noqa: E402
from .errors import (  # noqa: E402
    ClosedError,
    DivergedError,
    Error,
    ForkedError,
    InputError,
    IoError,
    NotFoundError,
    PartialError,
    StoppedError,
    StuckError,
    UnsupportedError,
    UsageError,
)
from .frames import CameraInfo, Event, Frame, ObjectView  # noqa: E402
from .info import (  # noqa: E402
    Contact,
    InputInfo,
    Label,
    LoggedTopic,
    LogInfo,
    LogRecovery,
    MetricInfo,
    ReplayVariant,
    SensorCost,
    SimulationStats,
    StreamInfo,
    TopicInfo,
    WorldInfo,
)
from .logs import Log, RunReport, Verification, replay  # noqa: E402
from .messages import Message, Sample, Scan  # noqa: E402
from .policy import Policy  # noqa: E402
from .scene import Option, Scene, describe  # noqa: E402
from .simulation import Checkpoint, Simulation, load  # noqa: E402
from .snapshot import Snapshot  # noqa: E402
from .streams import CameraStream, LidarStream, MetricStream, SensorStream, Stream, Subscription  # noqa: E402
from .world import World  # noqa: E402
from . import distribute, ik  # noqa: E402

import importlib.util as _util  # noqa: E402

_openvino = _util.find_spec("openvino")
if _openvino is not None and _openvino.submodule_search_locations:  # controllers in C++ load the same library
    _os.environ.setdefault("GLOAM_OPENVINO", _openvino.submodule_search_locations[0])

if _util.find_spec("gymnasium") is not None:  # its environments are registered with the import
    from .envs import make_env, make_vec_env  # noqa: E402

__version__: str = _core.version()
home = _core.home
configuration = _core.configuration
set_thread_count = _core.set_thread_count
set_log_level = _core.set_log_level

__all__ = [
    "Actuator", "Body", "Camera", "CameraInfo", "CameraStream", "Checkpoint", "ClosedError", "Contact",
    "DivergedError", "Error", "Event", "ForkedError", "Frame", "InputError", "InputInfo", "IoError", "Joint",
    "Label", "Lidar", "LidarStream", "Log", "LogInfo", "LogRecovery", "LoggedTopic", "Message", "MetricInfo",
    "MetricStream", "NotFoundError", "ObjectView", "Option", "PartialError", "Policy", "Pose", "ReplayVariant",
    "Robot", "RobotModel", "RunReport", "Sample", "Scan", "Scene", "Sensor", "SensorCost", "SensorStream",
    "Simulation", "SimulationStats", "Snapshot", "StoppedError", "Stream", "StreamInfo", "StuckError",
    "Subscription", "TopicInfo", "UnsupportedError", "UsageError", "Verification", "World", "WorldInfo", "check",
    "configuration", "convert", "describe", "distribute", "evaluate", "generate", "guess_robot", "home", "ik",
    "load", "make_env", "make_vec_env", "render", "replay", "report", "robot_model", "robots", "run",
    "set_log_level", "set_thread_count", "yaw_quaternion",
]
