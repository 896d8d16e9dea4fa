"""Training places, and their scenes with one camera per view."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Condition = Literal["clear", "adversity"]
Level = Literal["minor", "major"]
_LEVELS: tuple[Level, Level] = ("minor", "major")
CONDITIONS: tuple[Condition, ...] = ("clear", "adversity")

FIRST_SEED = 1000  # places with lower seeds belong to the benchmark
# The site front_stereo_mount of assets/robots/quadruped in the keyframe home: ahead and left of the trunk's centre and
# above the floor [m]; its pitch [rad] and the vertical field of view [deg] of the sensor front_stereo.
AHEAD, LEFT, HEIGHT = 0.306, 0.0225, 0.3165
PITCH = -0.0873
FOVY = 75


@dataclass(frozen=True)
class Place:
    """A generated place. kind: house or warehouse; options: of its table; level: of its adversity."""

    kind: Literal["house", "warehouse"]
    seed: int
    options: tuple[tuple[str, int], ...]
    level: Level
    ev100: float | None = None  # of its images in adversity; None: of the scene

    @property
    def name(self) -> str:
        return f"{self.kind}_{self.seed}"


def places(houses: int, warehouses: int) -> list[Place]:
    """The training places, houses and warehouses mixed so that any first part has both.

    Seeds from FIRST_SEED. Errors: ValueError if a number is negative or there is no place.
    """
    if min(houses, warehouses) < 0 or houses + warehouses == 0:
        raise ValueError(f"{houses} houses and {warehouses} warehouses: there must be at least one place")
    answer = []
    for number in range(houses):
        rng = np.random.default_rng((FIRST_SEED + number, 0))
        level = _LEVELS[number % 2]
        # Smoke darkens rooms: most cameras would expose longer, and some of the images keep the exposure for clear air.
        brighter = float(rng.uniform(5.0, 7.2) if level == "minor" else rng.uniform(1.5, 5.4))
        ev100 = None if rng.random() < 0.3 else round(brighter, 2)
        options = (("rooms", int(4 + number % 4)),)
        answer.append((number / houses, Place("house", FIRST_SEED + number, options, level, ev100)))
    for number in range(warehouses):
        rng = np.random.default_rng((FIRST_SEED + number, 1))
        sides = (("length", int(rng.integers(24, 37))), ("width", int(rng.integers(16, 25))))
        answer.append((number / warehouses, Place("warehouse", FIRST_SEED + number, sides, _LEVELS[number % 2])))
    return [place for _, place in sorted(answer, key=lambda pair: pair[0])]


def place_toml(place: Place, condition: Condition) -> str:
    """The scene of a place without cameras."""
    lines = ["[scene]", f'name = "{place.name}_{condition}"', "", f"[environment.{place.kind}]", f"seed = {place.seed}"]
    lines += [f"{name} = {value}" for name, value in place.options]
    if condition == "adversity":
        lines += ["", "[adversity]", f'level = "{place.level}"']
        if place.ev100 is not None:
            lines += ["", "[render]", f"ev100 = {place.ev100:g}"]
    return "\n".join(lines) + "\n"


def camera_poses(poses: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """Positions (n, 3) [m] and orientations (n, 4) [w, x, y, z] of the camera for poses (n, 3) of the trunk (x, y, yaw).

    With the motion of a trot: height, pitch and roll vary by 1 cm, 1.5 and 1.2 degrees (standard deviations, cut at 2.5).
    """
    count = len(poses)
    noise = np.clip(rng.standard_normal((count, 3)), -2.5, 2.5) * (0.01, np.radians(1.5), np.radians(1.2))
    yaw = poses[:, 2]
    cosine, sine = np.cos(yaw), np.sin(yaw)
    position = np.column_stack(
        [
            poses[:, 0] + cosine * AHEAD - sine * LEFT,
            poses[:, 1] + sine * AHEAD + cosine * LEFT,
            HEIGHT - 0.01 + noise[:, 0],
        ]
    )
    # A camera of MJCF looks along its -z with y up: first to +x with z up, then roll, pitch (up positive) and yaw.
    level = np.array([0.5, 0.5, -0.5, -0.5])
    turn = _product(_about(yaw, 2), _product(_about(-(PITCH + noise[:, 1]), 1), _about(noise[:, 2], 0)))
    return position, _product(turn, np.broadcast_to(level, (count, 4)))


def cameras_toml(position: Array, orientation: Array) -> str:
    """One `[[camera]]` v00000 … per view."""
    parts = []
    for number, (place, turn) in enumerate(zip(position, orientation, strict=True)):
        where = ", ".join(f"{value:.3f}" for value in place)
        quaternion = ", ".join(f"{value:.4f}" for value in turn)
        parts.append(
            f'\n[[camera]]\nname = "{view_name(number)}"\nposition = [{where}]\norientation = [{quaternion}]\nfovy = {FOVY}\n'
        )
    return "".join(parts)


def view_name(number: int) -> str:
    """Name of a view's camera and image."""
    return f"v{number:05d}"


def _about(angle: Array, axis: int) -> Array:
    answer = np.zeros((len(angle), 4))
    answer[:, 0], answer[:, 1 + axis] = np.cos(angle / 2), np.sin(angle / 2)
    return answer


def _product(a: Array, b: Array) -> Array:
    """Products of quaternions (n, 4) [w, x, y, z]."""
    w = a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(1)
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
    return np.column_stack([w, vector])
