"""Cameras to start from: poses that map three pairs exactly, for a sweep of focal lengths, ranked by all pairs.

The pose of three points follows Grunert (1841) in the form of Haralick et al. 1991, "Analysis and Solutions of the Three Point
Perspective Pose Estimation Problem"; the ranking is MSAC (Torr and Zisserman 2000), which a few wrong pairs do not mislead.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .camera import NEAREST, Array, Camera, Lens

_FIELDS = (8, 12, 17, 23, 30, 38, 47, 56, 66, 76, 87, 98, 110, 122)  # of view along the longer side [deg]
_MOST_TRIPLES = 150
_TOLERANCE = 0.05  # of a start, as part of the image's diagonal: the sweep and distortion leave errors


def focal_lengths(width: int, height: int) -> list[float]:
    """A sweep from telephoto to wide lenses [px]."""
    return [max(width, height) / (2 * math.tan(math.radians(field) / 2)) for field in _FIELDS]


def starts(pixels: Array, points: Array, lenses: Sequence[Lens], count: int = 8) -> list[Camera]:
    """The `count` best cameras for pixels (n, 2) and world points (n, 3), n >= 4, with different poses or lenses.

    Points that lie behind a camera count as wrong. The result is empty if every three points are collinear.
    """
    triples = _triples(len(points))
    ranked: list[tuple[float, Camera]] = []
    for lens in lenses:
        bearings = _bearings(pixels, lens)
        R, p = three_point_poses(bearings[triples], points[triples])
        limit = (_TOLERANCE * math.hypot(lens.width, lens.height)) ** 2
        seen = np.einsum("kij,knj->kni", R, points[None] - p[:, None])
        depth = seen[:, :, 2]
        plane = np.array([lens.cx, lens.cy]) + lens.f * seen[:, :, :2] / np.maximum(depth, NEAREST)[:, :, None]
        squares = np.where(depth > NEAREST, np.sum((plane - pixels) ** 2, axis=2), np.inf)
        costs = np.minimum(squares, limit).sum(axis=1)
        ranked += [(float(costs[i]), Camera(lens, R[i], p[i])) for i in np.argsort(costs, kind="stable")[: 4 * count]]
    ranked.sort(key=lambda entry: entry[0])
    size = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    best: list[Camera] = []
    for _, camera in ranked:
        if len(best) < count and not any(_alike(camera, other, size) for other in best):
            best.append(camera)
    return best


def three_point_poses(bearings: Array, points: Array) -> tuple[Array, Array]:
    """All poses that see three points (k, 3, 3) [m] along unit bearings (k, 3, 3) in the optical frame.

    Returns rotations from world to optical axes (m, 3, 3) and positions in the world (m, 3), up to four per triple.
    """
    a2, b2, c2 = (np.sum((points[:, i] - points[:, j]) ** 2, axis=1) for i, j in ((1, 2), (0, 2), (0, 1)))
    ca, cb, cg = (np.sum(bearings[:, i] * bearings[:, j], axis=1) for i, j in ((1, 2), (0, 2), (0, 1)))
    area = np.linalg.norm(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        d, e, c = (a2 - c2) / b2, (a2 + c2) / b2, c2 / b2
        a = a2 / b2
        quartic = [
            (d - 1) ** 2 - 4 * c * ca**2,
            4 * (d * (1 - d) * cb - (1 - e) * ca * cg + 2 * c * ca**2 * cb),
            2 * (d**2 - 1 + 2 * d**2 * cb**2 + 2 * (1 - c) * ca**2 - 4 * e * ca * cb * cg + 2 * (1 - a) * cg**2),
            4 * (-d * (1 + d) * cb + 2 * a * cg**2 * cb - (1 - e) * ca * cg),
            (1 + d) ** 2 - 4 * a * cg**2,
        ]
        companion = np.zeros((len(points), 4, 4))
        companion[:, 1:, :3] = np.eye(3)
        companion[:, 0, :] = -np.stack(quartic[1:], axis=1) / quartic[0][:, None]
    sound = np.isfinite(companion).all(axis=(1, 2)) & (area > 1e-9 * np.maximum(a2, np.maximum(b2, c2)))
    companion[~sound] = 0.0
    roots = np.linalg.eigvals(companion)
    v = roots.real
    with np.errstate(divide="ignore", invalid="ignore"):
        u = ((d[:, None] - 1) * v**2 - 2 * (d * cb)[:, None] * v + 1 + d[:, None]) / (2 * (cg[:, None] - v * ca[:, None]))
        s = np.sqrt(b2[:, None] / (1 + v**2 - 2 * v * cb[:, None]))
    real = np.abs(roots.imag) < 1e-3 * np.maximum(np.abs(v), 1e-3)  # near a double root noise makes pairs complex
    good = sound[:, None] & real & np.isfinite(u) & np.isfinite(s) & (v > 0) & (u > 0)
    which, root = np.nonzero(good)
    ranges = s[which, root, None] * np.stack([np.ones(len(which)), u[which, root], v[which, root]], axis=1)
    seen = ranges[:, :, None] * bearings[which]
    R = np.einsum("kia,kja->kij", _axes(seen), _axes(points[which]))
    return R, points[which, 0] - np.einsum("kji,kj->ki", R, seen[:, 0])


def _axes(triangle: Array) -> Array:
    """Orthonormal axes of triangles (k, 3, 3), in columns."""
    x = triangle[:, 1] - triangle[:, 0]
    z = np.cross(x, triangle[:, 2] - triangle[:, 0])
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=2)


def _bearings(pixels: Array, lens: Lens) -> Array:
    rays = np.concatenate([(pixels - np.array([lens.cx, lens.cy])) / lens.f, np.ones((len(pixels), 1))], axis=1)
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))


def _triples(n: int) -> NDArray[np.int64]:
    """All triples of n pairs, or an even choice of them."""
    rng = np.random.default_rng(0)
    if n > 20:
        return np.array([rng.choice(n, 3, replace=False) for _ in range(_MOST_TRIPLES)])
    return rng.permutation(np.array(list(itertools.combinations(range(n), 3))))[:_MOST_TRIPLES]


def _alike(a: Camera, b: Camera, size: float) -> bool:
    turn = math.acos(min(1.0, max(-1.0, (float(np.trace(a.R @ b.R.T)) - 1) / 2)))
    return turn < 0.05 and float(np.linalg.norm(a.p - b.p)) < 0.05 * size and abs(a.lens.f / b.lens.f - 1) < 0.05
