"""A planner in another process, over ZeroMQ: the simulation waits for each answer, so that runs repeat.

`gloam.navigation.planners.messages` describes the messages. `serve()` is the other side for planners in Python, and
examples/ros2/planner_relay.py for ROS 2.
"""

from __future__ import annotations

import json
import shlex
import subprocess
import time
from collections.abc import Callable
from typing import Any, ClassVar

import gloam

from ..planner import Answer, Observation, Planner, Task, register_planner
from . import messages

_START = 60.0  # wall time for a program to start: some load networks [s]
_MOST_SILENCES = 3  # calls without an answer, in sequence


def _zmq() -> Any:
    try:
        import zmq
    except ImportError:
        raise gloam.UnsupportedError("planners in other processes need the package pyzmq", hint="pip install pyzmq") from None
    return zmq


class _Channel:
    """A socket for requests, and the process that answers them if this object has started it."""

    def __init__(self, address: str, command: str) -> None:
        self._address = address
        self._context = _zmq().Context()
        self._socket: Any = None
        self._process = _started(command) if command else None

    def call(self, request: list[Any], timeout: float) -> dict[str, Any]:
        """The reply to a request. Errors: TimeoutError; ConnectionError if the process has ended; as parsed_reply()."""
        zmq = _zmq()
        if self._socket is None:
            self._socket = self._context.socket(zmq.REQ)
            self._socket.setsockopt(zmq.LINGER, 0)
            self._socket.setsockopt(zmq.MAXMSGSIZE, messages.LONGEST_REPLY)
            self._socket.connect(self._address)
        try:
            self._check_process()
            self._socket.send_multipart(request)
            self._wait(timeout)
            data = self._socket.recv()
            if self._socket.getsockopt(zmq.RCVMORE):
                raise ValueError("a reply must have one part")
        except BaseException:
            self._drop()  # a REQ socket takes no other request before the whole reply to this one
            raise
        return messages.parsed_reply(data)

    def _wait(self, timeout: float) -> None:
        end = time.monotonic() + timeout
        while not self._socket.poll(max(0, min(100, 1000 * (end - time.monotonic())))):
            self._check_process()
            if time.monotonic() >= end:
                raise TimeoutError(f"the planner at {self._address} has not answered within {timeout:g} s")

    def _check_process(self) -> None:
        if self._process is not None and self._process.poll() is not None:
            raise ConnectionError(f"the planner's process ended with exit code {self._process.returncode}")

    def _drop(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def close(self) -> None:
        self._drop()
        self._context.term()
        if self._process is not None:
            self._process.terminate()
            try:
                self._process.wait(5)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()


def _started(command: str) -> subprocess.Popen[bytes]:
    try:
        return subprocess.Popen(shlex.split(command))
    except (OSError, ValueError, IndexError) as error:
        raise gloam.UsageError(f"the planner's program '{command}' cannot be started: {error}") from None


class ExternalPlanner(Planner):
    """address: of the other process's socket, such as "tcp://127.0.0.1:7801" or "ipc:///tmp/planner"; command: program
    to start for the run, "" = it is running; timeout: wall time after which an answer is given up [s]. After three calls
    in sequence without an answer the planner is not called again before the next reset().

    The other process declares rate, latency, needs and the size of images. Errors: UsageError for an address or a
    command that is wrong; IoError if nobody describes a planner; UnsupportedError without pyzmq.
    """

    uses_map: ClassVar[bool] = False
    serves_one: ClassVar[bool] = True

    def __init__(self, address: str, command: str = "", timeout: float = 10.0) -> None:
        if not address.startswith(("tcp://", "ipc://")):
            raise gloam.UsageError(f"the address of a planner must begin with tcp:// or ipc://, got '{address}'")
        self._address, self._timeout, self._silences = address, timeout, 0
        self._channel = _Channel(address, command)
        try:
            self._describe(max(timeout, _START) if command else timeout)
        except BaseException:
            self._channel.close()
            raise

    def _describe(self, timeout: float) -> None:
        try:
            request = [json.dumps({"call": "describe"}).encode()]
            description = messages.description_of(self._channel.call(request, timeout))
        except (OSError, ValueError) as error:
            hint = "start it before, or name its program in 'command'" if isinstance(error, TimeoutError) else ""
            raise gloam.IoError(str(error), self._address, hint=hint) from None
        except _zmq().ZMQError as error:
            raise gloam.UsageError(f"cannot connect to '{self._address}': {error}") from None
        self.rate, self.latency, self.image_size = description.rate, description.latency, description.image_size
        self.needs = description.needs  # type: ignore[misc]

    def reset(self, task: Task) -> None:
        """Errors: UsageError with the other side's error; IoError if it does not answer."""
        self._silences = 0
        try:
            self._channel.call(messages.reset_request(task), self._timeout)
        except messages.RefusedError as error:
            raise gloam.UsageError(f"the planner rejects the task: {error}", self._address) from None
        except (OSError, ValueError) as error:
            raise gloam.IoError(str(error), self._address) from None

    def plan(self, observation: Observation) -> Answer:
        """Errors: TimeoutError; ConnectionError; ValueError for an invalid answer."""
        if self._silences >= _MOST_SILENCES:
            raise TimeoutError(f"the planner at {self._address} is not called any more: {_MOST_SILENCES} calls had no answer")
        try:
            reply = self._channel.call(messages.plan_request(observation, self.needs), self._timeout)
        except TimeoutError:
            self._silences += 1
            raise
        self._silences = 0
        return messages.answer_of(reply)

    def close(self) -> None:
        """Closes the socket, and ends the process if this object has started it."""
        self._channel.close()


def serve(planner: Planner, address: str, watch: Callable[[], bool] = lambda: True) -> None:
    """Answers requests with a planner until watch(), called every second, returns False. The planner gets neither the
    World nor the map of the task. Its exceptions are answers."""
    zmq = _zmq()
    context = zmq.Context()
    socket = context.socket(zmq.REP)
    socket.setsockopt(zmq.LINGER, 0)
    try:
        socket.bind(address)
        while watch():
            if socket.poll(1000):
                socket.send(json.dumps(_reply(planner, socket.recv_multipart())).encode())
    finally:
        socket.close()
        context.term()


def _reply(planner: Planner, message: list[bytes]) -> dict[str, Any]:
    try:
        header = json.loads(message[0])
        if header["call"] == "describe":
            size = list(planner.image_size)
            return {"rate": planner.rate, "latency": planner.latency, "needs": sorted(planner.needs), "image_size": size}
        if header["call"] == "reset":
            planner.reset(messages.task_from(header))
            return {}
        return messages.encoded(planner.plan(messages.observation_from(header, message[1:])))
    except Exception as error:  # any planner, by anybody
        return {"error": str(error) if isinstance(error, gloam.Error) else f"{type(error).__name__}: {error}"}


register_planner("external", ExternalPlanner)
