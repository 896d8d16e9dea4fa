"""A planner in another process, over ZeroMQ: the simulation waits for each answer, so that runs repeat.

Gloam sends requests of several parts and expects one part in reply:

1. JSON: {"call": "reset", "robot", "seed", "goal", "top_speed", "radius"} or {"call": "plan", "time", "pose",
   "velocity", "parts": [{"name": "image", "dtype": "uint8", "shape": [64, 85, 3]}, …]};
2. … the arrays of `parts`, in C order.

Replies are JSON: {} to reset, which may contain "error"; {"velocity": [vx, vy, yaw rate]}, {"waypoints": [[x, y], …],
"chosen": 2} or {"arrived": true} to plan. `serve()` is the other side for planners in Python.
"""

from __future__ import annotations

import json
import shlex
import subprocess
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import numpy as np

import gloam

from ..planner import Answer, Arrived, Need, Observation, Planner, Task, Velocity, Waypoints, register_planner

_PARTS: tuple[Need, ...] = ("image", "depth", "scan")
_LONGEST_REPLY = 1 << 20  # [bytes]


def _zmq() -> Any:
    try:
        import zmq
    except ImportError:
        raise gloam.UnsupportedError("planners in other processes need the package pyzmq", hint="pip install pyzmq") from None
    return zmq


class ExternalPlanner(Planner):
    """address: of the other process's socket, such as "tcp://127.0.0.1:7801" or "ipc:///tmp/planner"; command: program
    to start for the run, "" = it is running; needs: of "image", "depth", "scan"; timeout: wall time after which an
    answer is given up [s]. Errors: UsageError; UnsupportedError without pyzmq."""

    uses_map: ClassVar[bool] = False

    def __init__(
        self,
        address: str,
        command: str = "",
        needs: Sequence[Need] = ("image",),
        timeout: float = 10.0,
        image_size: tuple[int, int] = (85, 64),
    ) -> None:
        if not address.startswith(("tcp://", "ipc://")):
            raise gloam.UsageError(f"the address of a planner must begin with tcp:// or ipc://, got '{address}'")
        if unknown := set(needs) - set(_PARTS):
            raise gloam.UsageError(f"a planner can need {', '.join(_PARTS)}, not {', '.join(sorted(unknown))}")
        self.needs = frozenset(needs)  # type: ignore[misc]
        self.image_size = image_size
        self._address, self._timeout = address, timeout
        self._context = _zmq().Context()
        self._socket: Any = None
        self._process = subprocess.Popen(shlex.split(command)) if command else None

    def reset(self, task: Task) -> None:
        """Errors: UsageError with the other side's error; TimeoutError if nobody answers."""
        header = {"call": "reset", "robot": task.robot, "seed": task.seed, "goal": task.goal}
        reply = self._call([header | {"top_speed": task.top_speed, "radius": task.radius}])
        if "error" in reply:
            raise gloam.UsageError(f"the planner at {self._address} rejects the task: {reply['error']}")

    def plan(self, observation: Observation) -> Answer:
        """Errors: TimeoutError; ValueError for a reply that is none."""
        arrays = [(name, np.ascontiguousarray(getattr(observation, name))) for name in _PARTS if name in self.needs]
        parts = [{"name": name, "dtype": str(array.dtype), "shape": array.shape} for name, array in arrays]
        header = {"call": "plan", "time": observation.time, "pose": observation.pose, "velocity": observation.velocity}
        reply = self._call([header | {"parts": parts}, *(array for _, array in arrays)])
        if reply.get("arrived") is True:
            return Arrived()
        if "velocity" in reply:
            return Velocity(*(float(v) for v in reply["velocity"]))
        if "waypoints" in reply:
            return Waypoints(np.array(reply["waypoints"], dtype=np.float64), int(reply.get("chosen", 2)))
        raise ValueError(f"a reply needs 'velocity', 'waypoints' or 'arrived', got {sorted(reply)}")

    def _call(self, message: list[Any]) -> dict[str, Any]:
        zmq = _zmq()
        if self._process is not None and self._process.poll() is not None:
            raise ConnectionError(f"the planner's process ended with exit code {self._process.returncode}")
        if self._socket is None:
            self._socket = self._context.socket(zmq.REQ)
            self._socket.setsockopt(zmq.LINGER, 0)
            self._socket.setsockopt(zmq.MAXMSGSIZE, _LONGEST_REPLY)
            self._socket.connect(self._address)
        self._socket.send_multipart([json.dumps(message[0]).encode(), *(array.data for array in message[1:])])
        if not self._socket.poll(1000 * self._timeout):
            self._drop()  # a REQ socket takes no second request before the reply to the first
            raise TimeoutError(f"the planner at {self._address} has not answered within {self._timeout} s")
        reply = json.loads(self._socket.recv())
        if not isinstance(reply, dict):
            raise ValueError("a reply must be a JSON object")
        return reply

    def _drop(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def close(self) -> None:
        """Closes the socket, and ends the process if this object has started it."""
        self._drop()
        self._context.term()
        if self._process is not None:
            self._process.terminate()
            try:
                self._process.wait(5)
            except subprocess.TimeoutExpired:
                self._process.kill()


def serve(planner: Planner, address: str, watch: Callable[[], bool] = lambda: True) -> None:
    """Answers requests with a planner until watch(), called every second, returns False. The planner gets neither the
    World nor the map of the task."""
    zmq = _zmq()
    context = zmq.Context()
    socket = context.socket(zmq.REP)
    socket.setsockopt(zmq.LINGER, 0)
    socket.bind(address)
    try:
        while watch():
            if socket.poll(1000):
                socket.send(json.dumps(_reply(planner, socket.recv_multipart())).encode())
    finally:
        socket.close()
        context.term()


def _reply(planner: Planner, message: list[bytes]) -> dict[str, Any]:
    header = json.loads(message[0])
    if header["call"] == "reset":
        goal = None if header["goal"] is None else (float(header["goal"][0]), float(header["goal"][1]))
        try:
            planner.reset(Task(header["robot"], header["seed"], goal, top_speed=header["top_speed"], radius=header["radius"]))
        except gloam.Error as error:
            return {"error": str(error)}
        return {}
    arrays = {
        part["name"]: np.frombuffer(data, part["dtype"]).reshape(part["shape"])
        for part, data in zip(header["parts"], message[1:], strict=True)
    }
    pose, velocity = header["pose"], header["velocity"]
    answer = planner.plan(
        Observation(header["time"], (pose[0], pose[1], pose[2]), (velocity[0], velocity[1], velocity[2]), **arrays)
    )
    if isinstance(answer, Velocity):
        return {"velocity": [answer.vx, answer.vy, answer.yaw_rate]}
    if isinstance(answer, Waypoints):
        return {"waypoints": np.asarray(answer.points).tolist(), "chosen": answer.chosen}
    return {"arrived": True}


register_planner("external", ExternalPlanner)
