"""Least squares: the camera that projects scene points onto their pixels, and its covariance."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Flag, auto
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from .camera import Array, Camera

_BEHIND = 1e7  # residuals of points that are not in front of the camera are limited to this [px]


class Unknowns(Flag):
    """Parameters of the lens that are solved for, beside the six of the pose."""

    POSE = 0
    FOCAL = auto()
    CENTRE = auto()  # the principal point
    K1 = auto()
    K2 = auto()

    @property
    def lens_names(self) -> list[str]:
        """Fields of Lens, in the order of Fit's columns."""
        names = {Unknowns.FOCAL: ["f"], Unknowns.CENTRE: ["cx", "cy"], Unknowns.K1: ["k1"], Unknowns.K2: ["k2"]}
        return [name for key, found in names.items() if key in self for name in found]

    @property
    def count(self) -> int:
        """Unknowns with the six of the pose."""
        return 6 + len(self.lens_names)

    @property
    def fewest_pairs(self) -> int:
        """One more than the equations require; with the principal point or distortion, twice as many equations as unknowns."""
        more = self & (Unknowns.CENTRE | Unknowns.K1 | Unknowns.K2)
        return self.count if more else (self.count + 1) // 2 + 1


@dataclass(frozen=True)
class Fit:
    """camera; residuals: pixel minus projection (n, 2) [px]; jacobian: of the projections (2 n, unknowns); loss: least squares' sum.

    Columns of the jacobian: turn in the optical frame [rad] (3), position [m] (3), f [px], cx, cy [px], k1, k2, if solved for.
    """

    camera: Camera
    residuals: Array
    jacobian: Array
    loss: float

    @property
    def freedom(self) -> int:
        return int(self.jacobian.shape[0] - self.jacobian.shape[1])

    @property
    def sigma(self) -> float:
        """Standard deviation of a coordinate of a pixel, estimated from the residuals [px]."""
        return float(np.sqrt(np.sum(self.residuals**2) / max(self.freedom, 1)))

    @property
    def rms(self) -> float:
        """Root mean square distance of pixels from projections [px]."""
        return float(np.sqrt(np.mean(np.sum(self.residuals**2, axis=1))))

    def cofactor(self) -> Array:
        """Covariance of the unknowns for pixels with a standard deviation of 1 px; infinite if they are not determined."""
        scale = np.linalg.norm(self.jacobian, axis=0)
        if not np.all(scale > 0):
            return np.full((len(scale), len(scale)), np.inf)
        _, values, rows = np.linalg.svd(self.jacobian / scale, full_matrices=False)
        if values[-1] < 1e-9 * values[0]:
            return np.full((len(scale), len(scale)), np.inf)
        root = rows.T / values / scale[:, None]
        return np.asarray(root @ root.T)


def refine(start: Camera, pixels: Array, points: Array, unknowns: Unknowns, robust: float | None = None) -> Fit:
    """The local least-squares camera near `start`. robust: residuals above this hardly count (Cauchy) [px]."""
    size = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    units = {"f": start.lens.f, "cx": start.lens.f, "cy": start.lens.f, "k1": 1.0, "k2": 1.0}
    scale = np.array([*[1.0] * 3, *[size] * 3, *(units[name] for name in unknowns.lens_names)])

    def camera_of(x: Array) -> Camera:
        return _moved(start, x * scale, unknowns)

    def residuals(x: Array) -> Array:
        projected, _ = camera_of(x).project(points)
        return np.asarray(np.clip(projected - pixels, -_BEHIND, _BEHIND).ravel())

    def derivatives(x: Array) -> Array:
        made = slopes(camera_of(x), points, unknowns)
        made[:, :3] = made[:, :3] @ _turn_by_vector(x[:3])
        return np.asarray(made * scale)

    first = np.array([0.0] * 6 + [getattr(start.lens, name) for name in unknowns.lens_names]) / scale
    kind = {"loss": "cauchy", "f_scale": robust} if robust else {}
    done = least_squares(residuals, first, jac=derivatives, xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=200, **kind)
    camera = camera_of(done.x)
    projected, _ = camera.project(points)
    return Fit(camera, pixels - projected, slopes(camera, points, unknowns), float(done.cost))


def _moved(start: Camera, x: Array, unknowns: Unknowns) -> Camera:
    values: dict[str, Any] = dict(zip(unknowns.lens_names, map(float, x[6:]), strict=True))
    lens = replace(start.lens, **values)
    return Camera(lens, Rotation.from_rotvec(x[:3]).as_matrix() @ start.R, start.p + x[3:6])


def _turn_by_vector(w: Array) -> Array:
    """Turn about fixed axes by a change of a rotation vector (3, 3): the left Jacobian of SO(3)."""
    angle = float(np.linalg.norm(w))
    cross = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    if angle < 1e-4:
        return np.asarray(np.eye(3) + cross / 2 + cross @ cross / 6)
    return np.asarray(np.eye(3) + (1 - np.cos(angle)) / angle**2 * cross + (angle - np.sin(angle)) / angle**3 * cross @ cross)


def slopes(camera: Camera, points: Array, unknowns: Unknowns) -> Array:
    """Jacobian of the projections, (2 n, unknowns), as in Fit."""
    lens = camera.lens
    seen = (points - camera.p) @ camera.R.T
    z = np.maximum(seen[:, 2], 1e-6)
    plane = seen[:, :2] / z[:, None]
    r2 = np.sum(plane**2, axis=1)
    factor, slope = 1 + lens.k1 * r2 + lens.k2 * r2**2, lens.k1 + 2 * lens.k2 * r2
    bent = factor[:, None, None] * np.eye(2) + 2 * slope[:, None, None] * plane[:, :, None] * plane[:, None, :]
    flat = np.zeros((len(points), 2, 3))
    flat[:, 0, 0] = flat[:, 1, 1] = 1 / z
    flat[:, :, 2] = -plane / z[:, None]
    by_seen = lens.f * bent @ flat
    x, y, depth = seen.T
    zero = np.zeros(len(points))
    turn = np.stack([zero, depth, -y, -depth, zero, x, y, -x, zero], axis=1).reshape(-1, 3, 3)  # d(w x seen)/dw
    columns = [by_seen @ turn, -by_seen @ camera.R]
    if Unknowns.FOCAL in unknowns:
        columns.append((factor[:, None] * plane)[:, :, None])
    if Unknowns.CENTRE in unknowns:
        columns.append(np.broadcast_to(np.eye(2), (len(points), 2, 2)))
    for key, power in ((Unknowns.K1, 1), (Unknowns.K2, 2)):
        if key in unknowns:
            columns.append((lens.f * r2[:, None] ** power * plane)[:, :, None])
    return np.concatenate(columns, axis=2).reshape(2 * len(points), -1)
