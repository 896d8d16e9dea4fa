"""Tours: the quadruped walks from a start to a goal and back, recorded once, so that every condition has the same motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam.navigation.benchmark.places import EYE, LIDAR, PLACES, ROBOT, Course, quadruped
from gloam.navigation.benchmark.visibility import PROBE, visibility_probe
from gloam.navigation.driver import Driver, Rig
from gloam.navigation.planner import Task
from gloam.navigation.planners.geometric import Route

EYES = "eyes"
LEFT, RIGHT = f"{EYES}/left", f"{EYES}/right"
BEGIN = 1.0  # of the tour: until then the robot comes to rest on its feet [s]
TOPICS = ("/clock", "/tf*", f"/{ROBOT}/imu/*")
IMU_TOPIC = f"/{ROBOT}/imu/imu"
IMU_RATE = 200  # [Hz]
BASELINE = 0.06  # of the stereo cameras [m], between the Go1's 0.045 m and common modules
REACH = {"tunnel": (30.0, 45.0), "mine": (30.0, 45.0)}  # length of a path [m]; elsewhere 4 to 12 m, within a room and to the next ones
_SPEED = 0.4  # [m/s]
_REACH = 0.4  # of a goal [m]
_STAND = 0.3  # the trunk's height above the ground at the start [m]


@dataclass(frozen=True)
class Sensors:
    """Of the robot of a log, by their names. left, right: cameras, right = "": one camera; baseline: [m]; lidar: "" = none; imu:
    topic, "" = none; begin: of the sequence in the log [s]; probe: of the visibility; overlay: text of a scene file that adds
    it, "" = the log has it; clutter: of the place, which levels must not change, None = none; has_people: in the run;
    has_depth_camera: the left camera has a depth sensor's model, else methods read the true depth."""

    left: str
    right: str
    baseline: float
    lidar: str
    imu: str
    begin: float
    probe: str
    overlay: str
    clutter: float | None
    has_people: bool
    has_depth_camera: bool = False


# 0.5 is the clutter of all generated places, by default.
TOUR_SENSORS = Sensors(LEFT, RIGHT, BASELINE, LIDAR, IMU_TOPIC, BEGIN, PROBE, "", 0.5, False, has_depth_camera=True)


@dataclass(frozen=True)
class Tour:
    """place: one of the benchmark's; seed: of start and goal, a path of REACH; legs: 1 = to the goal, 2 = and back, 3 = and
    to the goal again, so that views return; longest: of a leg [s]."""

    place: str
    seed: int = 1
    legs: int = 3
    longest: float = 180.0


def tour_scene(place: str, environment: dict[str, Any] | None = None) -> gloam.Scene:
    """A place in clear air with the quadruped, its walking policy, a stereo camera in its face whose left eye is also the
    reference of a depth camera, a LiDAR and an IMU.

    environment: table of a place that is none of the benchmark's. Errors: NotFoundError for an unknown place.
    """
    if environment is None and place not in PLACES:
        raise gloam.NotFoundError(f"there is no scene '{place}'; there are: {', '.join(PLACES)}")
    exposure = {"time_constant": 0.3, "metering": "average", "compensation": 0.7, "max_shutter": 0.02, "max_iso": 6400}
    # White at ISO 100 takes 9,600 electrons: a smaller full well would show it grey.
    pixel = {"full_well": 10500, "quantum_efficiency": 0.62, "pitch": 2.2, "shot_noise": True, "read_noise": 2.4, "bits": 10}
    camera: dict[str, Any] = {
        "width": 640, "height": 480, "rate": 20, "fovy": 60,
        "imager": {"exposure": {"f_number": 2.0}, "auto_exposure": exposure, "pixel": pixel}, "stereo_depth": {"preset": "d435"},
    }  # fmt: skip
    tables: dict[str, Any] = {
        "scene": {"name": place},
        "environment": environment or PLACES[place],
        "robot": [quadruped()],
        "stereo": [{"name": EYES, "body": f"{ROBOT}/front_stereo_mount", "baseline": BASELINE, **camera}],
        "probe": [visibility_probe(f"{ROBOT}/trunk", EYE)],
        "lidar": [
            {"name": LIDAR, "body": f"{ROBOT}/lidar_mount", "preset": "VLP-16", "rate": 10, "motion_keys": 1, "noise": True, "outputs": ["npy"]}
        ],
        "sensor": [
            {"match": f"{ROBOT}/imu_gyro", "preset": "bmi088_gyro", "rate": IMU_RATE},
            {"match": f"{ROBOT}/imu_accelerometer", "preset": "bmi088_accel", "rate": IMU_RATE},
        ],
    }
    return gloam.Scene.from_dict(tables)


def record_tour(tour: Tour, log: Path) -> float:
    """Records a tour into a new log, and returns its length [m].

    The planner knows the scene, so a tour shows motions of a good controller. Errors: gloam.Error if a goal is not reached.
    """
    world = tour_scene(tour.place).compile()
    pair = Course(tour.place).pair(tour.seed, REACH.get(tour.place, (4.0, 12.0)))
    places: list[tuple[float, float]] = []

    def place_of(sim: gloam.Simulation) -> tuple[float, float]:
        pose = sim.robots[ROBOT].pose
        places.append((float(pose.p[0]), float(pose.p[1])))
        return places[-1]

    with gloam.Simulation(world, seed=tour.seed) as sim:
        driver = Driver(sim, Rig(ROBOT), Route())
        with sim.record(log, TOPICS):
            sim.robots[ROBOT].place((*pair.start[:2], _STAND), yaw=pair.start[2])
            sim.run_until(time=BEGIN)
            for leg in range(tour.legs):
                goal = (pair.goal, pair.start[:2])[leg % 2]

                def is_there(sim: gloam.Simulation, goal: tuple[float, float] = goal) -> bool:
                    return math.dist(place_of(sim), goal) < _REACH

                driver.run(Task(ROBOT, tour.seed, goal, None, world, _SPEED, _REACH), sim.time + tour.longest, is_there)
                if math.dist(place_of(sim), goal) >= _REACH:
                    problem = f"the robot has not reached the goal of leg {leg + 1} of the tour in '{tour.place}'"
                    raise gloam.Error(problem, hint="choose another seed")
    return float(np.linalg.norm(np.diff(np.array(places), axis=0), axis=1).sum())
