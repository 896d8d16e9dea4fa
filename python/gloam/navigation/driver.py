"""Drives a robot by a planner in a simulation that waits for both: the same run gives the same result."""

from __future__ import annotations

import math
import operator
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

import gloam

from .follower import WaypointFollower
from .planner import Answer, Arrived, Observation, Planner, Task, Velocity, Waypoints

T = TypeVar("T")
WATCH_PERIOD = 0.05  # between two calls of a run's watch [s]
_STOP = Velocity()
_LONGEST_ERROR = 300  # characters


@dataclass(frozen=True)
class Rig:
    """Parts of the robot that a planner uses: names of its camera and LiDAR in the scene, and the options of images
    (tier, spp, device …). A planner that needs a part that is "" is rejected."""

    robot: str
    camera: str = ""
    lidar: str = ""
    render: dict[str, Any] = field(default_factory=lambda: {"tier": "interactive"})

    @classmethod
    def of(cls, world: gloam.World, robot: str = "", camera: str = "", lidar: str = "") -> Rig:
        """The named parts. "": the first robot, its first camera, the first LiDAR of the scene, or "" if there is none.

        Errors: NotFoundError for an unknown name, or if the World has no robot.
        """
        robot = robot or next(iter(world.robots), "")
        camera = camera or next((name for name in world.cameras if name.startswith(f"{robot}/")), "")
        lidar = lidar or next(iter(world.lidars), "")
        for kind, name, known in (("robot", robot, world.robots), ("camera", camera, world.cameras), ("LiDAR", lidar, world.lidars)):
            if name not in known and (name or kind == "robot"):
                raise gloam.NotFoundError(f"there is no {kind} '{name}'; there are: {', '.join(known) or 'none'}")
        return cls(robot, camera, lidar)


@dataclass
class PlannerStats:
    """Calls of a planner: `late` answers took longer than the latency by the wall clock, `invalid` ones were
    exceptions or not finite; `error` describes the first of them. wall: time of all calls [s]."""

    plans: int = 0
    late: int = 0
    invalid: int = 0
    wall: float = 0.0
    error: str = ""


class Driver:
    """Calls a planner at its rate and commands its answers to the robot after its latency, in simulation time.

    Waypoints are followed by a WaypointFollower. A velocity is held until the next answer; after `timeout` [s] without
    a valid one the robot stops, as it does for the rest of the run when the planner has arrived.
    """

    def __init__(self, sim: gloam.Simulation, rig: Rig, planner: Planner, timeout: float = 1.0) -> None:
        self.planner, self.rig, self.timeout = planner, rig, timeout
        self.stats = PlannerStats()
        self.has_arrived = False
        self._sim = sim
        self._robot = sim.robots[rig.robot]
        if not (0 < planner.rate < math.inf and 0 <= planner.latency < math.inf):
            raise gloam.UsageError(f"a planner needs a rate above 0 and a latency of at least 0 s, got {planner.rate} Hz and {planner.latency} s")
        self._period = 1.0 / planner.rate
        self._camera = self._open_camera() if planner.needs & {"image", "depth"} else None
        self._lidar = self._open_lidar() if "scan" in planner.needs else None

    def _open_camera(self) -> gloam.CameraStream:
        if not self.rig.camera:
            raise gloam.UsageError(f"planner {type(self.planner).__name__} needs a camera, and the robot has none")
        outputs = [output for need, output in (("image", "rgb"), ("depth", "depth")) if need in self.planner.needs]
        width, height = self.planner.image_size
        return self._sim.cameras[self.rig.camera].open(
            outputs, width=width, height=height, rate=self.planner.rate, **self.rig.render
        )

    def _open_lidar(self) -> gloam.LidarStream:
        if not self.rig.lidar:
            raise gloam.UsageError(f"planner {type(self.planner).__name__} needs a LiDAR, and the robot has none")
        return self._sim.lidars[self.rig.lidar].open()

    def run(self, task: Task, until: float, watch: Callable[[gloam.Simulation], bool] | None = None) -> None:
        """Drives until the time [s], or until watch(sim) returns True, which is called every 50 ms after the start,
        independently of the planner's rate: measurements of planners with different rates can be compared.

        Errors: UsageError if the planner rejects the task. Exceptions of plan() are counted (stats).
        """
        follower = WaypointFollower(rate=self.planner.rate, top_speed=task.top_speed)
        self.planner.reset(task)
        self.stats, self.has_arrived = PlannerStats(), False
        waiting: list[tuple[float, Velocity]] = []
        next_plan, valid_until = self._sim.time, math.inf
        begin, watched = self._sim.time, 0
        while self._sim.time < until - 1e-9:
            if not self.has_arrived and self._sim.time >= next_plan - 1e-9:
                command = self._command_of(self._ask(self._observe()), follower)
                if command is not None:
                    waiting.append((self._sim.time + self.planner.latency, command))
                next_plan += self._period
            while waiting and self._sim.time >= waiting[0][0] - 1e-9:
                self._send(waiting.pop(0)[1])
                valid_until = self._sim.time + self.timeout
            if self._sim.time > valid_until:
                self._send(_STOP)
                valid_until = math.inf
            next_watch = begin + (watched + 1) * WATCH_PERIOD
            events = [until, next_watch, *([next_plan] if not self.has_arrived else []), *(t for t, _ in waiting[:1])]
            self._sim.run_until(min(event for event in events if event > self._sim.time + 1e-9))
            if self._sim.time >= next_watch - 1e-9:
                watched += 1
                if watch is not None and watch(self._sim):
                    break
        self._send(_STOP)

    def _observe(self) -> Observation:
        pose = self._robot.pose
        turn = np.asarray(pose.R).T
        vx, vy, _ = turn @ np.asarray(self._robot.velocity)
        rate = float(np.asarray(self._robot.angular_velocity)[2])
        image = depth = scan = None
        if self._camera is not None:
            frame = self._newest(self._camera)
            image = frame.rgb if "image" in self.planner.needs else None
            depth = frame.depth if "depth" in self.planner.needs else None
        if self._lidar is not None:
            scan = self._in_robot_frame(self._newest(self._lidar), pose)
        return Observation(
            self._sim.time, (float(pose.p[0]), float(pose.p[1]), float(pose.yaw)), (float(vx), float(vy), rate), image, depth, scan
        )

    @staticmethod
    def _newest(stream: gloam.Stream[T]) -> T:
        """The last message that is complete at this instant; steps on to the first one if there is none yet."""
        newest = stream.latest()
        return stream.next() if newest is None else newest

    @staticmethod
    def _in_robot_frame(scan: gloam.Scan, pose: gloam.Pose) -> Any:
        points = np.asarray(scan.points, dtype=np.float64)
        world = points @ np.asarray(scan.pose.R).T + np.asarray(scan.pose.p)
        cosine, sine = math.cos(pose.yaw), math.sin(pose.yaw)
        level = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        return ((world - np.asarray(pose.p)) @ level).astype(np.float32)

    def _ask(self, observation: Observation) -> Answer | None:
        """The planner's answer, or None if it is invalid."""
        start = time.perf_counter()
        self.stats.plans += 1
        try:
            answer = _checked(self.planner.plan(observation))
        except Exception as error:  # any planner, by anybody
            self.stats.invalid += 1
            self.stats.error = self.stats.error or _described(error)
            answer = None
        seconds = time.perf_counter() - start
        self.stats.wall += seconds
        self.stats.late += seconds > max(self.planner.latency, 1e-3)
        return answer

    def _command_of(self, answer: Answer | None, follower: WaypointFollower) -> Velocity | None:
        if isinstance(answer, Arrived):
            self.has_arrived = True
            return _STOP
        if isinstance(answer, Waypoints):
            return follower.drive(answer)
        return answer

    def _send(self, command: Velocity) -> None:
        self._robot.command(vx=command.vx, vy=command.vy, yaw_rate=command.yaw_rate)

    def close(self) -> None:
        """Closes the streams and the planner."""
        for stream in (self._camera, self._lidar):
            if stream is not None:
                stream.close()
        self.planner.close()


def _checked(answer: Any) -> Answer:
    """The answer with its numbers as float64 and int. Errors: TypeError, ValueError or OverflowError if it is none."""
    if isinstance(answer, Arrived):
        return answer
    if isinstance(answer, Velocity):
        values = np.array([answer.vx, answer.vy, answer.yaw_rate], dtype=np.float64)
        if values.shape != (3,):
            raise ValueError(f"a velocity must be three numbers, got {values.shape}")
        checked: Answer = Velocity(*values.tolist())
    elif isinstance(answer, Waypoints):
        values = np.array(answer.points, dtype=np.float64)
        chosen = operator.index(answer.chosen)
        if values.ndim != 2 or values.shape[1] not in (2, 4) or not 0 <= chosen < len(values):
            raise ValueError(f"waypoints must be (n, 2) or (n, 4) and contain the chosen one, got {values.shape} and {chosen}")
        checked = Waypoints(values, chosen)
    else:
        raise TypeError(f"a planner answers with a Velocity, Waypoints or Arrived, got {type(answer).__name__}")
    if not np.isfinite(values).all():
        raise ValueError("the answer is not finite")
    return checked


def _described(error: Exception) -> str:
    """One short line for a person: the text may come from another process."""
    text = f"{type(error).__name__}: {error}"
    text = "".join(c if c.isprintable() else repr(c)[1:-1] for c in text[:_LONGEST_ERROR])
    return text[:_LONGEST_ERROR]
