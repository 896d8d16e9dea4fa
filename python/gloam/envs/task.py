"""Definition of a task: a scene, spaces, and for each world its reset, actions, observations and rewards."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium import spaces

import gloam
from gloam.envs.noise import Array
from gloam.envs.pipeline import Layout
from gloam.envs.terms import Term

SceneSource = str | Path | Mapping[str, Any] | gloam.Scene | gloam.World


@dataclass(frozen=True)
class Outcome:
    """How one control step ended. terminated: the task is done or failed, not that its time is up."""

    reward: float
    terminated: bool = False
    info: dict[str, Any] = field(default_factory=dict)


class TaskWorld(ABC):
    """A task in one world. Its methods are called by one thread at a time, not always the same."""

    def __init__(self, sim: gloam.Simulation) -> None:
        self.sim = sim

    def begin(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        """Begins an episode: the simulation is at its initial state; draws and places the random elements of the
        task."""

    def decide(self, action: Array) -> None:
        """Called with an action at the beginning of its control step, before its delay."""

    @abstractmethod
    def apply(self, action: Array) -> None:
        """Applies an action to the robot, effective from the next physics step."""

    @abstractmethod
    def observe(self) -> dict[str, Array]:
        """Raw values of all terms by name, of the present instant."""

    @abstractmethod
    def judge(self, action: Array) -> Outcome:
        """Reward and end of the control step that was taken with `action`; `observe` has been called before."""

    def start_info(self) -> dict[str, Any]:
        """`info` of a reset."""
        return {}

    def close(self) -> None:
        """Ends streams."""


class Task(ABC):
    """Common part of all worlds of an environment."""

    control_interval: float = 0.1
    """Simulated time between two actions [s], rounded to physics steps."""
    layout: Layout = "dict"
    settle: float = 0.0
    """Time that passes in a reset before the first observation [s]."""
    places: bool = True
    """Whether a reset places things: then a physics step at least passes, which is when they come to be there."""

    @abstractmethod
    def scene(self) -> SceneSource:
        """The scene that is compiled once for all worlds."""

    @abstractmethod
    def action_space(self, world: gloam.World) -> spaces.Box:
        """Actions of one world."""

    @abstractmethod
    def terms(self, world: gloam.World) -> Sequence[Term]:
        """Observation terms of one world."""

    @abstractmethod
    def bind(self, sim: gloam.Simulation) -> TaskWorld:
        """The task in a new simulation of the scene."""

    def neutral_action(self, space: spaces.Box) -> Array | None:
        """Action in effect until an episode's first action: the middle of the space. None = the controls of the
        scene."""
        return ((space.low.astype(np.float64) + space.high.astype(np.float64)) / 2).astype(space.dtype)
