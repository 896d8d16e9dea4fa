"""One episode: a planner drives the quadruped from a start to a goal, and everything is measured on the way."""

from __future__ import annotations

import errno
import json
import math
import resource
import time
from collections import Counter
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam

from ..driver import WATCH_PERIOD, Driver, Rig
from ..ground import Ground, height_at
from ..paths import Point
from ..planner import Task
from .demonstration import map_of
from .key import Key
from .options import create
from .places import CAMERA, LIDAR, RADIUS, ROBOT, TOP_SPEED, Pair, ground_of, image_options, world_of
from .visibility import PROBE, VisibilityMeter

LOG_TOPICS = ("/clock", "/tf*", f"/{PROBE}")
_STAND = 0.3  # the quadruped's height above the ground at the start [m]
BEGIN = 1.0  # of the planner's time: until then the robot comes to rest on its feet [s]
_STUCK_TIME, _STUCK_REACH = 15.0, 0.25  # an episode ends when the robot has stayed within so many metres [s], [m]
_LOW = 0.05  # contacts below are steps on rugs and sills [m]
_TRACK = 10  # instants of a watch between two places of the track
_FORGET = 0.5  # a body counts again after so long without contact [s], as in docs/metrics.md


@dataclass(frozen=True)
class EpisodeSpec:
    """planner, place, level, number: the key of the episode; seed: of the benchmark; tier: of images; options: of the
    planner; log: whether run.mcap is written."""

    planner: str
    place: str
    level: str
    number: int
    seed: int = 1
    tier: str = "interactive"
    options: tuple[tuple[str, Any], ...] = ()
    log: bool = True

    @property
    def pair_seed(self) -> int:
        """The seed of start and goal: shared by planners and levels, so that episodes can be compared in pairs."""
        return self.seed * 100_003 + self.number

    @property
    def path(self) -> Path:
        """Its folder in `episodes` of the results."""
        return Path(Key(self.planner, self.place, self.level, self.number).name)


class Touched:
    """Counts collisions by object: a body counts once, and again after half a second without contact."""

    def __init__(self, ground: Ground | None = None) -> None:
        self._ground = ground
        self.places: list[tuple[float, float, float, str]] = []  # of collisions: time [s], x, y [m], object
        self.last: dict[str, float] = {}

    def sample(self, sim: gloam.Simulation) -> None:
        """Reads the contacts of this instant. Feet and trunk on level ground do not count."""
        for contact in sim.contacts():
            names = contact.geoms
            own = [name.startswith(f"{ROBOT}/") for name in names]
            is_ground = abs(float(np.asarray(contact.normal)[2])) > math.sqrt(0.5)
            x, y, z = (float(v) for v in contact.position)
            if own[0] == own[1] or is_ground or float(np.linalg.norm(contact.force)) <= 0:
                continue
            if z < height_at(self._ground, x, y) + _LOW:
                continue
            other = names[1] if own[0] else names[0]
            body = other.rpartition("/")[0] or other
            if sim.time - self.last.get(body, -math.inf) > _FORGET:
                self.places.append((round(sim.time, 3), round(x, 3), round(y, 3), _object_of(other)))
            self.last[body] = sim.time

    @property
    def by_object(self) -> dict[str, int]:
        """Collisions with each kind of object."""
        return dict(Counter(thing for *_, thing in self.places))

    def total(self) -> int:
        """All collisions."""
        return len(self.places)

    def is_touching(self, now: float) -> bool:
        """Whether anything was touched within the last five seconds."""
        return any(now - then < 5.0 for then in self.last.values())


def _object_of(geom: str) -> str:
    """The kind of object of a geom's name: living/chair_2/collider_1 is a chair, people3/torso is people."""
    parts = geom.split("/")
    name = parts[-2] if len(parts) > 1 else geom
    return name.rstrip("0123456789").rstrip("_") or name or "unnamed"


class Watch:
    """Follows an episode; called every 50 ms. True ends it."""

    def __init__(self, goal: Point, ground: Ground | None = None) -> None:
        self.goal, self.touched = goal, Touched(ground)
        self.length, self.outcome = 0.0, ""
        self.places: list[tuple[float, Point]] = []

    def __call__(self, sim: gloam.Simulation) -> bool:
        pose = sim.robots[ROBOT].pose
        here = (float(pose.p[0]), float(pose.p[1]))
        if self.places:
            self.length += math.dist(here, self.places[-1][1])
        self.places.append((sim.time, here))
        self.touched.sample(sim)
        if math.dist(here, self.goal) < RADIUS:
            self.outcome = "success"
        elif float(np.asarray(pose.R)[2, 2]) < 0.5:
            self.outcome = "fell"
        elif self._stays(here):
            self.outcome = "collided" if self.touched.is_touching(sim.time) else "stuck"
        return self.outcome != ""

    def track(self) -> list[tuple[float, float, float]]:
        """Time [s] and place [m] of the robot twice per second, and at the end."""
        kept = self.places[::_TRACK]
        if self.places and kept[-1] is not self.places[-1]:
            kept.append(self.places[-1])
        return [(round(time, 3), round(x, 3), round(y, 3)) for time, (x, y) in kept]

    def _stays(self, here: Point) -> bool:
        count = round(_STUCK_TIME / WATCH_PERIOD) + 1  # of instants, not a difference of times, which is rounded
        return len(self.places) >= count and all(math.dist(place, here) < _STUCK_REACH for _, place in self.places[-count:])


def run_episode(spec: EpisodeSpec, pair: Pair, folder: Path, maps: Path) -> dict[str, Any]:
    """Runs it and writes episode.json and run.mcap into a new or empty folder. An exception of the planner's creation or reset
    becomes an episode of outcome "error". Errors: OSError, gloam.Error if a file cannot be written."""
    begin, cpu = time.perf_counter(), _cpu_seconds()
    limit = 10.0 + 2.5 * pair.shortest / TOP_SPEED
    result: dict[str, Any] = {
        "planner": spec.planner, "scene": spec.place, "level": spec.level, "episode": spec.number, "seed": spec.pair_seed,
        "start": list(pair.start), "goal": list(pair.goal), "shortest": pair.shortest, "limit": limit, "tier": spec.tier,
    }  # fmt: skip
    folder.mkdir(parents=True, exist_ok=True)
    try:
        result |= _drive(spec, pair, folder, maps, limit)
    except Exception as error:  # of anybody's planner
        if _is_of_storage(error, folder, maps):
            raise
        result |= _failed(f"{type(error).__name__}: {error}", math.dist(pair.start[:2], pair.goal))
    result |= {
        "wall_seconds": time.perf_counter() - begin,
        "cpu_seconds": _cpu_seconds() - cpu,
        "log": "run.mcap" if (folder / "run.mcap").is_file() else None,
    }
    (folder / "episode.json").write_text(json.dumps(result, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return result


def _is_of_storage(error: Exception, *folders: Path) -> bool:
    """Whether an error means that results cannot be written, and not that the planner failed: the disk is full, or the error
    names a file in one of the folders."""
    file = Path(str(getattr(error, "file", "") or getattr(error, "filename", "") or ""))
    is_full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
    return is_full or any(file.is_relative_to(folder) for folder in folders)


def _drive(spec: EpisodeSpec, pair: Pair, folder: Path, maps: Path, limit: float) -> dict[str, Any]:
    world = world_of(spec.place, spec.level)
    planner = create(spec.planner, spec.options)
    map_ = map_of(spec.place, pair, maps / spec.place / f"{spec.number:04}", spec.tier) if planner.uses_map else None
    task = Task(ROBOT, spec.pair_seed, pair.goal, map_, world, TOP_SPEED, RADIUS)
    with gloam.Simulation(world, seed=spec.pair_seed) as sim:
        rig = Rig(ROBOT, CAMERA, LIDAR, image_options(spec.tier))
        driver = Driver(sim, rig, planner)
        ground = ground_of(spec.place)
        watch = Watch(pair.goal, ground)
        with ExitStack() as stack:
            stack.callback(driver.close)
            if spec.log:
                stack.enter_context(sim.record(folder / "run.mcap", LOG_TOPICS, overwrite=True))
            _stand(sim, pair, ground)
            meter = stack.enter_context(closing(VisibilityMeter(sim)))

            def ends(sim: gloam.Simulation) -> bool:
                meter.sample()
                return watch(sim)

            driver.run(task, BEGIN + limit, ends)
        return _measured(sim, driver, watch) | {"visibility_mean": meter.mean(), "visibility_min": meter.least()}


def _stand(sim: gloam.Simulation, pair: Pair, ground: Ground | None) -> None:
    x, y, yaw = pair.start
    sim.robots[ROBOT].place((x, y, height_at(ground, x, y) + _STAND), yaw=yaw)
    sim.run_until(time=BEGIN)


def _measured(sim: gloam.Simulation, driver: Driver, watch: Watch) -> dict[str, Any]:
    end, here = watch.places[-1] if watch.places else (sim.time, watch.goal)
    left = math.dist(here, watch.goal)
    outcome = watch.outcome or "timed_out"
    if driver.has_arrived and outcome in ("stuck", "collided", "timed_out"):  # it rests because the planner stopped it
        outcome = "lost"
    stats = driver.stats
    return {
        "outcome": outcome, "success": outcome == "success", "time": end - BEGIN, "path_length": watch.length,
        "final_distance": left, "collisions": watch.touched.total(), "collisions_by_object": watch.touched.by_object,
        "plans": stats.plans, "late": stats.late, "invalid": stats.invalid, "message": stats.error,
        "hash": f"{sim.hash:#018x}", "track": watch.track(), "touches": watch.touched.places,
    }  # fmt: skip


def _failed(message: str, distance: float) -> dict[str, Any]:
    return {
        "outcome": "error", "success": False, "time": 0.0, "path_length": 0.0, "final_distance": distance,
        "collisions": 0, "collisions_by_object": {}, "visibility_mean": None, "visibility_min": None, "plans": 0,
        "late": 0, "invalid": 0, "message": message, "hash": "", "track": [], "touches": [],
    }  # fmt: skip


def _cpu_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime
