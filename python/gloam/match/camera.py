"""A camera in the world: pose and lens, and the projection of points into pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

# Rotates MuJoCo's camera axes (X right, Y up, looking along -Z) to the optical frame (X right, Y down, Z forward).
OPTICAL = np.diag([1.0, -1.0, -1.0])
NEAREST = 1e-6  # depth at which points in front of the camera begin [m]


@dataclass(frozen=True)
class Lens:
    """A lens with square pixels and radial distortion (Brown–Conrady). The origin is the corner of the top left pixel.

    width, height: of the image [px]; f: focal length [px]; cx, cy: principal point [px]; k1, k2: see docs/cameras.md.
    """

    width: int
    height: int
    f: float
    cx: float
    cy: float
    k1: float = 0.0
    k2: float = 0.0

    @classmethod
    def centred(cls, width: int, height: int, f: float) -> Lens:
        """Without distortion, and with the principal point in the middle."""
        return cls(width, height, f, width / 2, height / 2)

    @classmethod
    def of_fovy(cls, width: int, height: int, fovy: float) -> Lens:
        """The same with a vertical field of view [deg]."""
        return cls.centred(width, height, height / (2 * math.tan(math.radians(fovy) / 2)))

    @property
    def fovy(self) -> float:
        """Vertical field of view without distortion [deg], of an image whose centre is the principal point."""
        return math.degrees(2 * math.atan2(self.height / 2, self.f))


@dataclass(frozen=True)
class Camera:
    """R: world axes to optical axes (3, 3); p: position in the world [m] (3,)."""

    lens: Lens
    R: Array = field(default_factory=lambda: np.eye(3))
    p: Array = field(default_factory=lambda: np.zeros(3))

    def project(self, points: Array) -> tuple[Array, Array]:
        """Pixels (n, 2) of world points (n, 3) [m], and their depths along the axis (n,) [m].

        Points that are not in front of the camera are projected as if they were at NEAREST, far outside the image.
        """
        seen = (points - self.p) @ self.R.T
        depth = seen[:, 2]
        plane = seen[:, :2] / np.maximum(depth, NEAREST)[:, None]
        r2 = np.sum(plane**2, axis=1)
        lens = self.lens
        factor = 1 + lens.k1 * r2 + lens.k2 * r2**2
        return np.array([lens.cx, lens.cy]) + lens.f * factor[:, None] * plane, depth

    @property
    def quaternion(self) -> Array:
        """Orientation in the world as in [[camera]], wxyz (4,), w >= 0."""
        x, y, z, w = Rotation.from_matrix(self.R.T @ OPTICAL).as_quat(canonical=True)
        return np.array([w, x, y, z])
