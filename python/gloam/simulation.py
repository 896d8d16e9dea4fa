"""Simulations: worlds that run."""
from __future__ import annotations

import atexit
import os
import sys
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from gloam import _core

from .cameras import Camera, Lidar, Sensor
from .dynamics import Dynamics
from .elements import Actuator, Body, Joint, Named, Robot
from .errors import StuckError, UsageError
from .info import Contact, Label, SimulationStats, TopicInfo, contact_of, of, stats_of
from .messages import Message
from .mujoco_memory import MujocoMemory
from .progress import ProgressLike
from .scene import Scene, as_scene
from .streams import M, MetricStream, Stream, Subscription
from .world import World

if TYPE_CHECKING:
    from .policy import PolicyDriver

Pace = Literal["lockstep", "fast", "realtime", "sensors"]
_alive: weakref.WeakSet[Simulation] = weakref.WeakSet()


class Checkpoint:
    """An instant to return to or branch from. `hash`: hash of the state; a restored simulation has the same hash."""

    def __init__(self, checkpoint: Any) -> None:
        self._checkpoint = checkpoint
        self.time: float = checkpoint.time
        self.step: int = checkpoint.step
        self.seed: int = checkpoint.seed
        self.hash: int = checkpoint.hash

    def __repr__(self) -> str:
        return f"<gloam.Checkpoint at {self.time:.4f} s>"


class Simulation:
    """A running World. It is paused until step() or run() is called.

    `pace` of run(): "lockstep" and "fast" run as fast as possible, "realtime" by the wall clock times `speed`,
    "sensors" like "realtime" but slower if open sensors need it, so that none of their messages is lost; `stats`
    reports the achieved speed and the cost of each sensor. `timestep` [s]: None = the model's. Values written into
    live arrays between two steps are inputs of the next step, after controllers, and are recorded in logs.
    """

    def __init__(self, world: World, seed: int = 1, timestep: float | None = None, pace: Pace = "lockstep", speed: float = 1.0) -> None:
        if not isinstance(world, World):
            raise TypeError(f"expected a World, got {world!r}; for files and scenes, use gloam.load()")
        if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed < 2**64:
            raise UsageError(f"a seed must be an integer from 0 to 2^64 - 1, got {seed!r}")
        self._mujoco = MujocoMemory.for_this_process()
        make = None if self._mujoco is None else self._mujoco.make
        self._core = _core.Run.create(world._world, int(seed), 0.0 if timestep is None else float(timestep), pace, float(speed), make)
        self.seed = int(seed)
        self._world = world
        self._core_world = world._world
        self._memory: Any = None
        self._generation = 0
        self._solver = _core.Solver()
        self._renderer: _core.Painter | None = None
        self._leases: dict[str, _core.Lease] = {}
        self._drives: dict[str, PolicyDriver] = {}  # of robots that a policy drives
        self._log: _core.LogStream | None = None
        self._streams: set[Stream[Any]] = set()  # with callbacks, which stay open
        self.joints: Named[Joint] = Named("joint", lambda: self._world.joints, lambda n: Joint(self, n))
        self.bodies: Named[Body] = Named("body", lambda: self._world.bodies, lambda n: Body(self, n))
        self.actuators: Named[Actuator] = Named("actuator", lambda: self._world.actuators, lambda n: Actuator(self, n))
        self.robots: Named[Robot] = Named("robot", lambda: self._world.robots, lambda n: Robot(self, n))
        self.sensors: Named[Sensor] = Named("sensor", lambda: self._world.sensors, lambda n: Sensor(self, n))
        self.cameras: Named[Camera] = Named("camera", lambda: [*self._world.cameras, "free"], lambda n: Camera(self, n))
        self.lidars: Named[Lidar] = Named("lidar", lambda: self._world.lidars, lambda n: Lidar(self, n))
        _alive.add(self)

    # ---- the present instant ----
    @property
    def time(self) -> float:
        """Simulation time [s]."""
        return float(self._core.time)

    @property
    def step_count(self) -> int:
        """Steps since the reset."""
        return int(self._core.step_count)

    @property
    def hash(self) -> int:
        """Hash of the state, chained over all steps."""
        return int(self._core.hash)

    @property
    def timestep(self) -> float:
        """[s]"""
        num, den = self._core.step_rate
        return float(den / num)

    @property
    def stats(self) -> SimulationStats:
        """Progress, and the cost and rate of each open stream."""
        return stats_of(self._core.stats)

    @property
    def paused(self) -> bool:
        return bool(self._core.paused)

    @property
    def world(self) -> World:
        return self._world

    @property
    def scene(self) -> Scene:
        """The Scene of the World that runs; a copy."""
        return self._world.scene

    @property
    def memory(self) -> Any:
        """MuJoCo's memory: memory.array("qpos") is a live array of any field of mjData (writable while paused) or mjModel (read only)."""
        self._look()
        return self._memory

    def _look(self) -> int:
        """Number of the memory in which physics steps; changes after a recompile, a restore of another run, or a
        failure."""
        generation: int = self._core.generation
        if generation != self._generation:
            self._memory = self._core.memory
            self._generation = generation
        return generation

    @property
    def model(self) -> Any:
        """mujoco.MjModel of the running model. ImportError without the package mujoco.

        Arrays of live fields (body_mass, geom_friction, actuator_gainprm, dof_damping, opt.gravity …) may be written
        while the simulation is paused: the change is an input of the next step, like set_live_field(), and a reset
        reverts it. Other arrays are read-only; writing another option (opt.timestep …) or writing by name
        (model.geom("ball").size) raises UsageError at the next step.
        """
        model = MujocoMemory.required(self._mujoco).model(self.memory)
        self._core.watch_model()
        return model

    @property
    def data(self) -> Any:
        """mujoco.MjData in which physics steps; values written while paused are inputs of the next step."""
        return MujocoMemory.required(self._mujoco).data(self.memory)

    def contacts(self) -> list[Contact]:
        """Contacts of the present instant."""
        return [contact_of(row, self._world.info.geoms) for row in self._solver.contacts(self._core.latest)]

    def value(self, field: str, element: str = "") -> Any:
        """A field of mjData or mjModel of the present instant after a forward pass: value("xfrc_applied", "go1/trunk")."""
        return self._solver.value(self._core.latest, field, element)

    def labels(self) -> list[Label]:
        """The rendered geoms, with their ids in images."""
        return [of(Label, row) for row in self._core.labels()]

    # ---- time ----
    def step(self, n: int = 1) -> None:
        """Takes n steps. Raises DivergedError: physics produced a value that is not finite."""
        self._core.step(n)

    def run_until(self, time: float | None = None, *, step: int | None = None) -> None:
        """Steps up to a time [s], to the first step at or after it, or to a step."""
        if (time is None) == (step is None):
            raise UsageError("run_until() takes either a time or a step")
        if step is None:
            num, den = self._core.step_rate
            if not np.isfinite(time):  # type: ignore[arg-type]
                raise UsageError(f"time must be finite, got {time} s")
            step = int(np.ceil(float(time) * num / den - 1e-6))  # type: ignore[arg-type]
        self._core.run_until(step)

    def step_until(self, stream: Stream[M]) -> M:
        """Steps until the next message of an open stream of a camera, LiDAR or sensor reaches a reader, and returns it,
        like stream.next(). The first message may be from this instant."""
        if not isinstance(stream, Stream) or stream._sim is not self:
            raise TypeError(f"expected an open stream of this simulation, such as sim.cameras[…].open(), got {stream!r}")
        if not self.paused:
            raise UsageError("the simulation is running", hint="pause() it before step_until(), or call next() of the stream")
        return stream.next()

    def run(self, pace: Pace | None = None, speed: float = 1.0) -> None:
        """Runs in the background until pause()."""
        if pace is not None:
            self._core.set_pace(pace, speed)
        self._core.resume()

    def pause(self) -> None:
        self._core.pause()

    def reset(self) -> None:
        """Returns to the initial state and pauses; time and frame numbers restart at 0."""
        self._core.reset()
        for drive in self._drives.values():
            drive._after_reset()

    def checkpoint(self) -> Checkpoint:
        return Checkpoint(self._core.checkpoint())

    def restore(self, checkpoint: Checkpoint) -> None:
        """Returns to a checkpoint of this or another simulation of the same scene and timestep. Raises PartialError:
        hooks had changed the run."""
        if not isinstance(checkpoint, Checkpoint):
            raise TypeError(f"expected a Checkpoint, got {checkpoint!r}")
        self._core.restore(checkpoint._checkpoint)
        self._take_world(World(self._core.world))

    # ---- changes ----
    def set(self, path: str | Mapping[str, Any], value: Any = None, progress: ProgressLike = None) -> None:
        """Changes options of the scene and continues from this instant, like recompile(): set("weather.visibility",
        8), or set({…})."""
        settings = path if isinstance(path, Mapping) else {path: value}
        scene = self.scene
        scene.update(settings)
        self.recompile(scene, progress)

    def recompile(self, source: Scene | World, progress: ProgressLike = None) -> None:
        """Continues in another World: elements of the same name keep their state. At time 0, without queued Commands,
        it starts from the initial state of the new World."""
        world = source if isinstance(source, World) else as_scene(source).compile(progress)
        self._core.recompile(world._world)
        self._take_world(world)

    def _take_world(self, world: World) -> None:
        """Continues in another World and releases the previous one, which may have 100 MB."""
        self._world = world
        self._core_world = world._world
        self._drives = {name: drive for name, drive in self._drives.items() if name in self.robots}
        self._renderer = None
        self._solver = _core.Solver()
        if self._memory is not None:
            self._look()
        for elements in (self.joints, self.bodies, self.actuators, self.robots):
            elements.forget_world()

    def set_live_field(self, field: str, values: Any, first: int = 0) -> None:
        """Changes a field of the model at the next step, from element `first` on: "gravity", "body_mass", "geom_color" … (docs/python.md).

        The change is a logged input: a replay repeats it, a reset reverts it. No World is compiled.
        """
        self._core.set_live_field(field, first, values)

    def scale_dynamics(self, *, mass: ArrayLike | None = None, friction: ArrayLike | None = None, gains: ArrayLike | None = None,
                       armature: ArrayLike | None = None, damping: ArrayLike | None = None) -> None:
        """Scales the dynamics of the whole model until the reset, by factors of the values in the model's files: one
        number, or one for each element.

        Bodies' masses, with their inertias; friction of geoms; gains of actuators; armature and damping of joints.
        Logged inputs of the next step that need no recompile, for domain randomisation. A factor of 1 reverts an
        earlier one. Robot.scale_dynamics() is for one robot.
        """
        Dynamics(self).scale(mass=mass, friction=friction, gains=gains, armature=armature, damping=damping)

    def on_step(self, hook: Callable[[Any], None] | None) -> None:
        """Calls hook(memory) before every step, on the physics thread, which waits for Python: slow. None = no longer."""
        if hook is None:
            self._core.set_hook(None)
            return
        sim = weakref.ref(self)

        def call() -> None:
            if (alive := sim()) is not None:
                hook(alive.memory)

        assert self.memory is not None
        self._core.set_hook(call)

    # ---- topics ----
    def topics(self) -> list[TopicInfo]:
        """Topics that it publishes and accepts."""
        return [of(TopicInfo, row) for row in self._core.topics()]

    def subscribe(self, topics: Sequence[str], callback: Callable[[Message], None] | None = None, required: bool = True) -> Subscription:
        """Opens topics by name, * matches any text: for message in subscription: message.decode()."""
        names = [topics] if isinstance(topics, str) else list(topics)
        return Subscription(self, ", ".join(names), lambda call: _core.open_topics(self._core, names, required, call),
                            Message, callback)

    def open_metrics(self, *, required: bool = True) -> MetricStream:
        """Opens the values of all metrics of the scene (docs/metrics.md), which accumulate from now on, sampled at
        record.metrics_rate as in a recorded run: metrics.latest()["go.path_length_m"]."""
        return MetricStream(self, "/metrics", lambda call: _core.open_topics(self._core, ["/metrics"], required, call, every_sample=True),
                            _metric_values)

    def publish(self, topic: str, message: Mapping[str, Any] | bytes) -> None:
        """Publishes a message to an input topic: its fields as a dict (omitted fields are 0), or CDR."""
        if not isinstance(message, bytes):
            kinds = {topic.name: topic.type for topic in self.topics() if topic.is_input}
            if topic not in kinds:
                raise UsageError(f"no input topic '{topic}'", hint=_core.suggest_name(topic, list(kinds)))
            message = _core.encode_message(kinds[topic], dict(message))
        self._core.publish(topic, message)

    # ---- records, pictures, pages ----
    @contextmanager
    def record(self, file: str | os.PathLike[str], topics: Sequence[str] | None = None, *, overwrite: bool = False, **options: Any) -> Iterator[_core.LogStream]:
        """Records a log (MCAP) until the end of the block. `options`: required, durable, embed, state_rate, width,
        height."""
        if topics is not None:
            options["topics"] = list(topics)
        log = _core.start_log(self._core, Path(file), {"overwrite": overwrite, **options})
        self._log = log
        try:
            yield log
        finally:
            self._log = None
            if not self._core.is_closed:
                log.finish()

    @contextmanager
    def view(self, port: int = 0, camera: str = "free", **render: Any) -> Iterator[_core.ViewServer]:
        """Serves the live page on this machine: .url. 0 = any free port."""
        server = _core.start_view(self._core, port, camera, render)
        try:
            yield server
        finally:
            server.stop()

    def _painter(self) -> _core.Painter:
        if self._renderer is None:
            self._renderer = _core.Painter(self._core_world)
        return self._renderer

    def _lease_of_joint(self, name: str) -> _core.Lease | None:
        return self._lease_where(lambda robot: name in robot.joints)

    def _lease_of_actuator(self, name: str) -> _core.Lease | None:
        return self._lease_where(lambda robot: name in robot.actuators)

    def _lease_where(self, has: Callable[[Robot], bool]) -> _core.Lease | None:
        for robot, lease in self._leases.items():
            if has(self.robots[robot]):
                return lease
        return None

    # ---- end ----
    def close(self) -> None:
        """Ends the simulation and its streams. Arrays stay readable. Raises StuckError if a callback or hook has not
        returned after 5 s."""
        try:
            if not self._core.is_closed:
                if self._log is not None:
                    self._log.finish()
                self._core.close()
            self._drives.clear()
            self._streams.clear()
        finally:
            self._renderer = None  # its memory must not wait for the garbage collector, which finds cycles late

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce__(self) -> Any:
        raise TypeError("a running Simulation cannot be pickled or copied: send its scene (sim.scene) and load it where it is needed; "
                        "checkpoint() and restore() go back to an instant of the same simulation")

    def __repr__(self) -> str:
        if self._core.is_closed:
            return "<gloam.Simulation, closed>"
        return f"<gloam.Simulation of '{self.scene.name}' at {self.time:.4f} s>"


def _metric_values(message: _core.Message) -> dict[str, float]:
    values: Any = message.decode()
    return {name: float(value) for name, value in zip(values["names"], values["values"], strict=True)}


@atexit.register
def _close_all() -> None:
    _core.destroy_deferred()
    for sim in list(_alive):
        try:
            sim.close()
        except StuckError as error:  # a callback that never returns must not keep the interpreter
            print(f"gloam: {error}", file=sys.stderr)


def load(source: Any, seed: int | None = None, timestep: float | None = None, pace: Pace = "lockstep", speed: float = 1.0, *,
         progress: ProgressLike = None, settings: Mapping[str, Any] | None = None) -> Simulation:
    """A simulation of a scene file, a model (MJCF, URDF), a Scene, a dict of tables or a World. `settings`: options to change before.

    `seed`: seed of all random numbers, including [[randomize]] and generators; None = the scene's own.
    """
    if isinstance(source, World):
        if settings:
            raise UsageError("the options of a compiled World cannot be changed", hint="load its scene instead: world.scene")
        return Simulation(source, 1 if seed is None else seed, timestep, pace, speed)
    scene = as_scene(source).copy()
    if settings:
        scene.update(settings)
    is_model = bool(os.fspath(scene._scene.bare_model) not in ("", "."))
    if seed is not None and not is_model:
        scene["sim.seed"] = seed
    if timestep is None and not is_model:
        timestep = scene["sim.timestep"]
    if seed is None:
        seed = 1 if is_model else scene["sim.seed"]
    return Simulation(scene.compile(progress), seed, timestep, pace, speed)


__all__ = ["Checkpoint", "Simulation", "load"]
