"""Observation terms of the network and of the critic, in the network's order. No JAX: export and evaluation use them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .robot import Robot

HISTORY = 5
GAIT_PARAMETERS = ("frequency", "phase", "offset", "bound", "duration", "swing_height", "body_height")
_MIRRORED_CLOCK = (1, 0, 3, 2)  # FL and FR change places, RL and RR too


@dataclass(frozen=True)
class Term:
    """A term, its scales, and its mirror image: element i of the image is sign[i] times element source[i]."""

    name: str
    scale: tuple[float, ...]
    history: int
    source: np.ndarray
    sign: np.ndarray

    @property
    def size(self) -> int:
        return len(self.source)


def _term(name: str, scale: float | tuple[float, ...], history: int, sign: object, source: object = None) -> Term:
    signs = np.asarray(sign, float)
    sources = np.arange(len(signs)) if source is None else np.asarray(source)
    scales = scale if isinstance(scale, tuple) else (scale,)
    return Term(name, scales, history, sources, signs)


def actor_terms(robot: Robot) -> tuple[Term, ...]:
    """Of the network: terms of Gloam (docs/policies.md)."""
    joints = robot.mirrored_signs, robot.mirrored_joints
    velocity = (_term("base_lin_vel", 2.0, 1, [1, -1, 1]),) if robot.observes_velocity else ()
    return (
        *velocity,
        _term("base_ang_vel", 0.25, HISTORY, [-1, 1, -1]),
        _term("projected_gravity", 1.0, HISTORY, [1, -1, 1]),
        _term("joint_pos", 1.0, HISTORY, *joints),
        _term("joint_vel", 0.05, HISTORY, *joints),
        _term("last_action", 1.0, HISTORY, *joints),
        _term("velocity_commands", (2.0, 2.0, 1.0), 1, [1, -1, -1]),
        _term("gait_parameters", (0.5, 1.0, 1.0, 1.0, 2.0, 10.0, 10.0), 1, np.ones(len(GAIT_PARAMETERS))),
        _term("gait_clock", 1.0, 2, np.ones(4), _MIRRORED_CLOCK),
    )


def critic_terms(robot: Robot) -> tuple[Term, ...]:
    """What only the critic sees; world: friction, payload, compliance of soil, load in the hand."""
    feet = np.arange(len(robot.feet)) ^ 1
    ground = np.arange(len(robot.nearby)) ^ 1
    arm = (_term("arm", 1.0, 1, np.tile(robot.arm.mirrored_signs, 2)),) if robot.arm else ()
    return (
        _term("base_lin_vel", 2.0, 1, [1, -1, 1]),
        _term("foot_height", 10.0, 1, np.ones(len(feet)), feet),
        _term("foot_force", 2.5 / robot.weight, 1, np.ones(len(feet)), feet),
        _term("sinkage", 10.0, 1, np.ones(len(feet)), feet),
        _term("ground", 5.0, 1, np.ones(len(ground)), ground),
        _term("world", 1.0, 1, np.ones(4)),
        *arm,
    )


def size(terms: tuple[Term, ...]) -> int:
    return sum(term.size * term.history for term in terms)


def mirror_table(terms: tuple[Term, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Sources and signs of the mirror image of a whole observation."""
    sources, signs, start = [], [], 0
    for term in terms:
        for _ in range(term.history):
            sources.append(start + term.source)
            signs.append(term.sign)
            start += term.size
    return np.concatenate(sources), np.concatenate(signs)
