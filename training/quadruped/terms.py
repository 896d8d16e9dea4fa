"""Observation terms of the network and of the critic, in the network's order. No JAX: export and evaluation use them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

HISTORY = 5
GAIT_PARAMETERS = ("frequency", "phase", "offset", "bound", "duration", "swing_height", "body_height")
MIRRORED_LEGS = np.array([1, 0, 3, 2])  # of the mirrored robot: FL and FR change places, RL and RR too
MIRRORED_JOINTS = (3 * MIRRORED_LEGS[:, None] + np.arange(3)).ravel()
MIRRORED_SIGNS = np.tile([-1.0, 1.0, 1.0], 4)  # hips turn about x


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


TERMS = (
    _term("base_ang_vel", 0.25, HISTORY, [-1, 1, -1]),
    _term("projected_gravity", 1.0, HISTORY, [1, -1, 1]),
    _term("joint_pos", 1.0, HISTORY, MIRRORED_SIGNS, MIRRORED_JOINTS),
    _term("joint_vel", 0.05, HISTORY, MIRRORED_SIGNS, MIRRORED_JOINTS),
    _term("last_action", 1.0, HISTORY, MIRRORED_SIGNS, MIRRORED_JOINTS),
    _term("velocity_commands", (2.0, 2.0, 1.0), 1, [1, -1, -1]),
    _term("gait_parameters", (0.5, 1.0, 1.0, 1.0, 2.0, 10.0, 10.0), 1, np.ones(len(GAIT_PARAMETERS))),
    _term("gait_clock", 1.0, 2, np.ones(4), MIRRORED_LEGS),
)
SIZE = sum(term.size * term.history for term in TERMS)

# Of the critic: base velocity (3), feet: height above ground (4), force (4), print depth (4), ground around (8),
# friction, payload, soil.
PRIVILEGED = (
    _term("base_lin_vel", 2.0, 1, [1, -1, 1]),
    _term("foot_height", 10.0, 1, np.ones(4), MIRRORED_LEGS),
    _term("foot_force", 0.02, 1, np.ones(4), MIRRORED_LEGS),
    _term("sinkage", 10.0, 1, np.ones(4), MIRRORED_LEGS),
    _term("ground", 5.0, 1, np.ones(8), [1, 0, 3, 2, 5, 4, 7, 6]),
    _term("world", 1.0, 1, np.ones(3)),
)
PRIVILEGED_SIZE = sum(term.size for term in PRIVILEGED)


def mirror_table(terms: tuple[Term, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Sources and signs of the mirror image of a whole observation."""
    sources, signs, start = [], [], 0
    for term in terms:
        for _ in range(term.history):
            sources.append(start + term.source)
            signs.append(term.sign)
            start += term.size
    return np.concatenate(sources), np.concatenate(signs)
