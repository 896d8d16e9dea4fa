"""Camera of a photograph from pairs: start, least squares, wrong pairs, and refusal of pairs that determine no camera."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from gloam.errors import InputError

from .camera import NEAREST, Array, Camera, Lens
from .checks import check_fit, check_pairs, check_single
from .refine import Fit, Unknowns, refine, slopes
from .start import focal_lengths, starts

CLICK = 0.3  # least standard deviation of a coordinate of a picked pixel [px]
Flags = NDArray[np.bool_]
_WRONG = 0.01  # probability of calling a pair wrong in a set of pairs without wrong ones
_BLUNDER = 0.005  # residuals of starts above this part of the diagonal hardly count


@dataclass(frozen=True)
class Solution:
    """camera; unknowns: solved for; residuals: pixel minus projection of all pairs (n, 2) [px]; used: pairs that are not wrong (n,);
    rms: of the used pairs [px]; sigma: their standard deviation per coordinate [px]; covariance: of the unknowns, see Fit."""

    camera: Camera
    unknowns: Unknowns
    residuals: Array
    used: Flags
    rms: float
    sigma: float
    covariance: Array

    @property
    def position_error(self) -> Array:
        """Standard errors of the position in the world [m] (3,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)[3:6]))

    @property
    def turn_error(self) -> Array:
        """Standard errors of the orientation about the optical axes [rad] (3,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)[:3]))

    @property
    def names(self) -> list[str]:
        """Of the unknowns, in the order of the covariance."""
        pose = ["turn_x_rad", "turn_y_rad", "turn_z_rad", "x_m", "y_m", "z_m"]
        return [*pose, *self.unknowns.lens_names]

    @property
    def focal_error(self) -> float:
        """Standard error of the focal length [px]; 0 if it was given."""
        return float(np.sqrt(self.covariance[6, 6])) if Unknowns.FOCAL in self.unknowns else 0.0


def solve(pixels: Array, points: Array, lens: Lens, unknowns: Unknowns = Unknowns.FOCAL) -> Solution:
    """The camera that sees world points (n, 3) [m] at pixels (n, 2).

    lens: its size and given parameters; its focal length is ignored if it is among the unknowns. Pairs that contradict the others are
    found and left out. Errors: InputError with the reason if the pairs are too few, or do not determine a camera.
    """
    check_pairs(pixels, points, lens, unknowns)
    lenses = [replace(lens, f=f) for f in focal_lengths(lens.width, lens.height)] if Unknowns.FOCAL in unknowns else [lens]
    found = starts(pixels, points, lenses)
    if not found:
        raise InputError("every three of the scene points lie on a line", hint="add pairs beside that line")
    limit = _BLUNDER * float(np.hypot(lens.width, lens.height))
    fits = sorted((_rough(start, pixels, points, unknowns, limit) for start in found), key=lambda fit: fit.loss)
    used = _near(fits[0], limit, unknowns.fewest_pairs)
    used = _without_wrong(fits[0].camera, pixels, points, unknowns, used)
    fit = refine(fits[0].camera, pixels[used], points[used], unknowns)
    check_fit(fit, points[used], unknowns)
    check_single([refine(other.camera, pixels[used], points[used], unknowns) for other in fits[1:]], fit, points[used])
    projected, _ = fit.camera.project(points)
    return Solution(fit.camera, unknowns, pixels - projected, used, fit.rms, fit.sigma, fit.sigma**2 * fit.cofactor())


def _rough(start: Camera, pixels: Array, points: Array, unknowns: Unknowns, limit: float) -> Fit:
    """First pose and focal length, then all unknowns: distortion would make up for a wrong start."""
    base = unknowns & Unknowns.FOCAL
    fit = refine(start, pixels, points, base, limit)
    return fit if base == unknowns else refine(fit.camera, pixels, points, unknowns, limit)


def _near(fit: Fit, limit: float, fewest: int) -> Flags:
    """Pairs that the robust camera explains, at least `fewest`."""
    distance = np.linalg.norm(fit.residuals, axis=1)
    spread = max(3 * 1.4826 * float(np.median(distance)), limit / 2)
    return np.asarray(distance <= max(spread, float(np.sort(distance)[fewest - 1])))


def _without_wrong(camera: Camera, pixels: Array, points: Array, unknowns: Unknowns, used: Flags) -> Flags:
    """Leaves out wrong pairs one by one, and takes back the ones that the result explains.

    A pair is tested against the camera of the others (data snooping, Baarda 1968, with an estimated standard deviation: Pope 1976).
    """
    used = used.copy()
    for _ in range(2 * len(used)):
        fit = refine(camera, pixels[used], points[used], unknowns)
        back = _acceptable(fit, pixels, points, unknowns, used)
        if back is not None:
            used[back] = True
            continue
        worst = _wrong(fit, used) if used.sum() > unknowns.fewest_pairs else None
        if worst is None:
            break
        used[worst] = False
    return used


def _wrong(fit: Fit, used: Flags) -> int | None:
    """The pair that contradicts the others most, if chance does not explain it."""
    cofactor, indices = fit.cofactor(), np.flatnonzero(used)
    if not np.isfinite(cofactor).all() or fit.freedom < 3:
        return None
    total = float(np.sum(fit.residuals**2))
    chances = np.ones(len(indices))
    for i, residual in enumerate(fit.residuals):
        rows = fit.jacobian[2 * i : 2 * i + 2]
        share = np.eye(2) - rows @ cofactor @ rows.T
        if np.linalg.eigvalsh(share)[0] < 1e-6:
            continue  # the camera depends on this pair: nothing checks it
        explained = float(residual @ np.linalg.solve(share, residual))
        rest = max((total - explained) / (fit.freedom - 2), CLICK**2)
        chances[i] = stats.f.sf(explained / 2 / rest, 2, fit.freedom - 2)
    worst = int(np.argmin(chances))
    return int(indices[worst]) if chances[worst] < _WRONG / len(used) else None


def _acceptable(fit: Fit, pixels: Array, points: Array, unknowns: Unknowns, used: Flags) -> int | None:
    """The pair among the unused that the camera of the used ones predicts best, if chance explains its deviation."""
    cofactor = fit.cofactor()
    others = np.flatnonzero(~used)
    if not len(others) or not np.isfinite(cofactor).all():
        return None
    variance = max(fit.sigma, CLICK) ** 2
    projected, depth = fit.camera.project(points[others])
    deviations = pixels[others] - projected
    rows = slopes(fit.camera, points[others], unknowns).reshape(len(others), 2, -1)
    chances = np.zeros(len(others))
    for i, deviation in enumerate(deviations):
        spread = np.eye(2) + rows[i] @ cofactor @ rows[i].T
        if depth[i] > NEAREST:
            chances[i] = stats.f.sf(float(deviation @ np.linalg.solve(spread, deviation)) / 2 / variance, 2, fit.freedom)
    best = int(np.argmax(chances))
    return int(others[best]) if chances[best] > _WRONG / len(used) else None
