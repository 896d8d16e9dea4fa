"""A planner in a shared library, with the C interface of include/gloam/planner/abi.h, whose structures are repeated here.

A library runs in the process of the simulation: it can crash it, and a call that does not return blocks it. A planner that
is not trusted so far runs as a process of its own (`external`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, Structure, c_char, c_char_p, c_double, c_int32, c_int64, c_uint32, c_uint64, c_void_p
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gloam

from ..planner import Answer, Arrived, Need, Observation, Planner, Task, Velocity, Waypoints, register_planner

ABI = 1
MOST_WAYPOINTS = 64
ERROR_SIZE = 256  # [bytes]
_MOST_SIDE = 8192  # of images [px]
_MAP = 8
_NEEDS: dict[int, Need] = {1: "image", 2: "depth", 4: "scan"}
_VELOCITY, _WAYPOINTS, _ARRIVED = 1, 2, 3


class Info(Structure):
    _fields_ = [("rate", c_double), ("latency", c_double), ("needs", c_uint32), ("image_width", c_int32), ("image_height", c_int32)]


class ImageView(Structure):
    _fields_ = [("pixels", c_void_p), ("width", c_int32), ("height", c_int32)]


class TaskView(Structure):
    _fields_ = [
        ("robot", c_char_p),
        ("seed", c_uint64),
        ("goal", c_double * 2),
        ("has_goal", c_int32),
        ("map_size", c_int32),
        ("goal_radius", c_double),
        ("top_speed", c_double),
        ("map", POINTER(ImageView)),
    ]


class ObservationView(Structure):
    _fields_ = [
        ("time", c_double),
        ("pose", c_double * 3),
        ("velocity", c_double * 3),
        ("image", ImageView),
        ("depth", c_void_p),
        ("depth_width", c_int32),
        ("depth_height", c_int32),
        ("scan", c_void_p),
        ("scan_size", c_int64),
    ]


class AnswerBuffer(Structure):
    _fields_ = [
        ("kind", c_int32),
        ("waypoint_count", c_int32),
        ("waypoint_values", c_int32),
        ("chosen", c_int32),
        ("velocity", c_double * 3),
        ("waypoints", c_double * 4 * MOST_WAYPOINTS),
        ("error", c_char * ERROR_SIZE),
    ]


_Create = ctypes.CFUNCTYPE(c_void_p, c_char_p)
_Reset = ctypes.CFUNCTYPE(None, c_void_p, POINTER(TaskView), c_char_p)
_Plan = ctypes.CFUNCTYPE(None, c_void_p, POINTER(ObservationView), POINTER(AnswerBuffer))
_Destroy = ctypes.CFUNCTYPE(None, c_void_p)


class Api(Structure):
    _fields_ = [("abi", c_uint32), ("info", Info), ("create", _Create), ("reset", _Reset), ("plan", _Plan), ("destroy", _Destroy)]


class LibraryPlanner(Planner):
    """library: file of the shared library. Rate, latency, needs and the size of images are the library's.

    Errors: InputError for a library that cannot be loaded or has another interface; UsageError if it makes no planner.
    """

    def __init__(self, library: str | Path) -> None:
        self._file = str(Path(library).absolute())
        self._planner: int | None = None
        self._api = _load(self._file)
        self._declare(self._api.info)
        error = ctypes.create_string_buffer(ERROR_SIZE)
        self._planner = self._api.create(error)
        if error.value or not self._planner:
            raise gloam.UsageError(f"the library makes no planner: {_text(error.value) or 'no reason given'}", self._file)

    def _declare(self, info: Info) -> None:
        if info.needs & ~(sum(_NEEDS) | _MAP):
            raise gloam.InputError(f"the planner needs inputs that do not exist: {info.needs:#x}", self._file)
        self.rate, self.latency = info.rate, info.latency
        self.needs = frozenset(need for bit, need in _NEEDS.items() if info.needs & bit)  # type: ignore[misc]
        self.uses_map = bool(info.needs & _MAP)  # type: ignore[misc]
        if self.needs & {"image", "depth"}:
            self.image_size = (info.image_width, info.image_height)
            if not all(1 <= side <= _MOST_SIDE for side in self.image_size):
                raise gloam.InputError(f"images have 1 … {_MOST_SIDE} pixels in each direction, got {self.image_size}", self._file)

    def reset(self, task: Task) -> None:
        """Errors: UsageError with the library's text, or without the map that it needs."""
        images: list[NDArray[np.uint8]] = []
        if self.uses_map:
            if task.map is None:
                raise gloam.UsageError("the planner needs a topological map", self._file)
            images = [np.ascontiguousarray(node.image) for node in task.map.nodes]
        views = (ImageView * len(images))(*map(_image, images))
        goal = task.goal or (0.0, 0.0)
        has_goal = int(task.goal is not None)
        seed = task.seed % (1 << 64)
        view = TaskView(task.robot.encode(), seed, goal, has_goal, len(views), task.radius, task.top_speed, views if images else None)
        error = ctypes.create_string_buffer(ERROR_SIZE)
        self._api.reset(self._alive(), view, error)
        if error.value:
            raise gloam.UsageError(f"the planner rejects the task: {_text(error.value)}", self._file)

    def plan(self, observation: Observation) -> Answer:
        """Errors: ValueError with the library's text, or for an answer that is none."""
        image = None if observation.image is None else np.ascontiguousarray(observation.image)
        depth = None if observation.depth is None else np.ascontiguousarray(observation.depth, np.float32)
        scan = None if observation.scan is None else np.ascontiguousarray(observation.scan, np.float32)
        height, width = (0, 0) if depth is None else depth.shape
        view = ObservationView(observation.time, observation.pose, observation.velocity, _image(image))
        view.depth, view.depth_width, view.depth_height = _address(depth), width, height
        view.scan, view.scan_size = _address(scan), 0 if scan is None else len(scan)
        answer = AnswerBuffer()
        self._api.plan(self._alive(), view, answer)
        return _answer(answer)

    def _alive(self) -> int:
        if self._planner is None:
            raise gloam.ClosedError("the planner is closed", self._file)
        return self._planner

    def close(self) -> None:
        """Destroys the planner. The library stays loaded, because threads of it may still run."""
        planner, self._planner = self._planner, None
        if planner is not None:
            self._api.destroy(planner)


def _load(file: str) -> Api:
    try:
        with _same_arithmetic():
            library = ctypes.CDLL(file, ctypes.RTLD_LOCAL)
            entry = library.gloam_planner
    except OSError as error:
        raise gloam.InputError(f"the library cannot be loaded: {error}", file) from None
    except AttributeError:
        hint = "C++ planners export it by GLOAM_PLANNER(Class)"
        raise gloam.InputError("the library does not define gloam_planner()", file, hint=hint) from None
    entry.restype = c_void_p
    address: int | None = entry()
    if not address:
        raise gloam.InputError("gloam_planner() returns no interface", file)
    version = c_uint32.from_address(address).value
    if version != ABI:  # the size and the other members of the structure depend on it
        hint = "build the library again with the headers of this Gloam"
        raise gloam.InputError(f"the library has version {version} of the planner interface, but Gloam has version {ABI}", file, hint=hint)
    api = Api.from_address(address)
    api.keep = library
    if not (api.create and api.reset and api.plan and api.destroy):
        raise gloam.InputError("the planner interface of the library lacks a function", file)
    return api


@contextmanager
def _same_arithmetic() -> Iterator[None]:
    """Restores the modes of floating-point arithmetic: loading a library built with -ffast-math would otherwise replace
    subnormal numbers by zero in this thread, and so change the simulation."""
    libm, modes = ctypes.CDLL("libm.so.6"), ctypes.create_string_buffer(256)  # larger than any fenv_t
    libm.fegetenv(modes)
    try:
        yield
    finally:
        libm.fesetenv(modes)


def _address(array: NDArray[Any] | None) -> int | None:
    return None if array is None else array.ctypes.data


def _image(image: NDArray[np.uint8] | None) -> ImageView:
    return ImageView() if image is None else ImageView(image.ctypes.data, image.shape[1], image.shape[0])


def _text(error: bytes) -> str:
    return error.decode(errors="replace")


def _answer(answer: AnswerBuffer) -> Answer:
    if answer.error:
        raise ValueError(_text(answer.error))
    if answer.kind == _VELOCITY:
        return Velocity(*answer.velocity)
    if answer.kind == _WAYPOINTS:
        count, values = answer.waypoint_count, answer.waypoint_values
        if not 1 <= count <= MOST_WAYPOINTS or values not in (2, 4):
            raise ValueError(f"an answer has 1 … {MOST_WAYPOINTS} waypoints of 2 or 4 numbers, got {count} of {values}")
        return Waypoints(np.array(answer.waypoints)[:count, :values], answer.chosen)
    if answer.kind == _ARRIVED:
        return Arrived()
    raise ValueError(f"the kind of an answer is 1 … 3, got {answer.kind}")


register_planner("library", LibraryPlanner)
