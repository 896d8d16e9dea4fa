"""Pairs that determine no camera: refusals with a reason and a remedy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gloam.errors import InputError

from .camera import NEAREST, Array, Lens
from .refine import Fit, Unknowns

_THIN = 0.01  # spread across a line or plane, as part of the spread along it
_LOOSE = 0.25  # largest relative standard error of focal length and distance for pixels that are 1 px off
_SAME = 1.0  # a camera whose residuals are below this is as good as a better one [px]


def check_pairs(pixels: Array, points: Array, lens: Lens, unknowns: Unknowns) -> None:
    """Errors: InputError for pairs that no method could solve."""
    if pixels.shape != (len(points), 2) or points.shape != (len(pixels), 3):
        raise InputError(f"pairs are pixels (n, 2) and points (n, 3), got {pixels.shape} and {points.shape}")
    if not (np.isfinite(pixels).all() and np.isfinite(points).all()):
        raise InputError("a pixel or a scene point is not finite")
    outside = (pixels < 0).any(axis=1) | (pixels[:, 0] > lens.width) | (pixels[:, 1] > lens.height)
    if outside.any():
        u, v = pixels[outside][0]
        where = f"pair {int(np.argmax(outside)) + 1}: pixel ({u:g}, {v:g})"
        raise InputError(f"{where} is outside the photograph of {lens.width} x {lens.height}")
    distinct = min(len(np.unique(pixels, axis=0)), len(np.unique(points, axis=0)))
    if distinct < unknowns.fewest_pairs:
        same = "" if distinct == len(points) else f"; {len(points)} pairs are given, but some share a pixel or a point"
        raise InputError(f"{_names(unknowns)} need {unknowns.fewest_pairs} different pairs, got {distinct}{same}", hint=_remedy(unknowns))
    if thickness(points)[0] < _THIN:
        raise InputError("the scene points lie on a line: the camera could be anywhere around it", hint="add pairs beside that line")
    if thickness(pixels)[0] < _THIN:
        raise InputError("the pixels lie on a line, so they do not determine the camera", hint="add pairs beside that line")


def thickness(points: Array) -> NDArray[np.float64]:
    """Spread of points (n, d) along each further principal axis, as part of the spread along the first one (d - 1,)."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return np.asarray(spread[1:] / spread[0] if spread[0] > 0 else np.zeros(points.shape[1] - 1))


def check_fit(fit: Fit, points: Array, unknowns: Unknowns) -> None:
    """Errors: InputError if a point is behind the camera, or if the pairs leave a parameter open."""
    _, depth = fit.camera.project(points)
    if (depth <= NEAREST).any():
        raise InputError("the best camera has some of the scene points behind it", hint="check that pixels and points belong together")
    cofactor = fit.cofactor()
    flat = thickness(points)[-1] < _THIN
    little = "the pairs hardly differ in depth or cover little of the image"
    plane = "the scene points lie in one plane, which the camera faces" if flat else little
    if Unknowns.FOCAL in unknowns and not np.sqrt(cofactor[6, 6]) < _LOOSE * fit.camera.lens.f:
        raise InputError(f"the focal length is not determined: {plane}", hint="add pairs at other depths, or give --fovy")
    distance = float(np.median(depth))
    if not np.sqrt(np.trace(cofactor[3:6, 3:6])) < _LOOSE * distance or not np.isfinite(cofactor).all():
        raise InputError(f"the camera is not determined: {plane}", hint=_remedy(unknowns))


def check_single(others: list[Fit], best: Fit, points: Array) -> None:
    """Errors: InputError if a camera elsewhere explains the pairs nearly as well."""
    size = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    for other in others:
        _, depth = other.camera.project(points)
        apart = float(np.linalg.norm(other.camera.p - best.camera.p))
        if apart > 0.1 * size and (depth > NEAREST).all() and other.rms < max(2 * best.rms, _SAME) and np.isfinite(other.cofactor()).all():
            a, b = (", ".join(f"{value:.2f}" for value in fit.camera.p) for fit in (best, other))
            raise InputError(f"two cameras explain the pairs: one at ({a}), one at ({b}) m", hint="add pairs at other depths")


def _names(unknowns: Unknowns) -> str:
    names = {Unknowns.FOCAL: "the focal length", Unknowns.CENTRE: "the principal point", Unknowns.K1: "the distortion"}
    found = ["the pose", *(name for key, name in names.items() if key in unknowns)]
    return found[0] if len(found) == 1 else ", ".join(found[:-1]) + " and " + found[-1]


def _remedy(unknowns: Unknowns) -> str:
    return "add pairs" + (", or solve for less of the lens" if unknowns.count > 6 else "")
