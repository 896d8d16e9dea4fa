"""A plugin for tests: planner `brief` turns for a moment by its seed, and stops. Episodes with it take seconds."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import ClassVar

import numpy as np
from gloam.navigation import Arrived, Observation, Planner, Task, Velocity, register_planner
from gloam.navigation.planner import Need


class Brief(Planner):
    """Writes "SEED PID" to the file of the environment variable GLOAM_TEST_MARKS when an episode begins. pause: wall time of
    each answer [s], so that a test can kill the process meanwhile."""

    uses_map: ClassVar[bool] = False

    def __init__(self, pause: float = 0.0, weights: str = "") -> None:
        self._pause = pause

    def reset(self, task: Task) -> None:
        self._random = np.random.Generator(np.random.Philox(key=task.seed))
        self._count = 0
        if marks := os.environ.get("GLOAM_TEST_MARKS"):
            with Path(marks).open("a") as stream:
                stream.write(f"{task.seed} {os.getpid()}\n")

    def plan(self, observation: Observation) -> Velocity | Arrived:
        time.sleep(self._pause)
        self._count += 1
        return Velocity(yaw_rate=float(self._random.uniform(-1, 1))) if self._count < 4 else Arrived()


register_planner("brief", Brief)


class Seeing(Brief):
    """The same with images."""

    needs: ClassVar[frozenset[Need]] = frozenset({"image"})
    uses_map: ClassVar[bool] = True


register_planner("seeing", Seeing)
