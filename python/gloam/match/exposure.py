"""Exposure and white balance of a photograph: gains between the light of a render and the light of the photograph."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gloam.errors import InputError

from .camera import Array

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of Rec. 709
_TOP = 1.2  # L_max = 1.2 · 2^EV cd/m², docs/light.md
_LIGHT = (0.01, 0.85)  # of the photograph; above, cameras and Gloam's own curve roll off
_FEWEST = 50  # blocks of pixels


@dataclass(frozen=True)
class Exposure:
    """ev100: exposure value at ISO 100 that gives a render the photograph's brightness; gains: of red, green and blue that then give it
    the photograph's colours, with a luminance of 1 (3,); spread: median absolute deviation of the brightness [EV]; share: part of the
    image that was compared."""

    ev100: float
    gains: tuple[float, float, float]
    spread: float
    share: float

    def display(self, radiance: Array) -> Array:
        """Light in units of white (…, 3) of a radiance [cd/m²], with exposure and gains."""
        return np.asarray(radiance * np.array(self.gains) / (_TOP * 2**self.ev100))


def fit_exposure(photo: Array, radiance: Array, usable: NDArray[np.bool_]) -> Exposure:
    """Gains between linear light of a photograph (h, w, 3), 1 = white, and the radiance of a render of the same view [cd/m²].

    usable: pixels to compare (h, w), without clipped ones. Medians tolerate objects that only one of the images shows.
    Errors: InputError if too few pixels can be compared.
    """
    low, high = _LIGHT
    lit = np.isfinite(radiance).all(axis=2) & (radiance > 0).all(axis=2)
    if not lit.any():
        raise InputError("no light of the scene reaches the camera")
    use = usable & lit & (photo > low).all(axis=2) & (photo < high).all(axis=2)
    if use.sum() < _FEWEST:
        raise InputError(f"only {int(use.sum())} blocks of the photograph are neither clipped, nor dark, nor masked; {_FEWEST} are needed")
    ratios = np.log2(photo[use] / radiance[use])
    middle = np.median(ratios, axis=0)
    channels = np.exp2(middle)
    whole = float(channels @ LUMINANCE)
    return Exposure(
        ev100=-math.log2(_TOP * whole),
        gains=(float(channels[0] / whole), float(channels[1] / whole), float(channels[2] / whole)),
        spread=float(np.median(np.abs(np.mean(ratios - middle, axis=1)))),
        share=float(use.mean()),
    )


def shutter_of(ev100: float, f_number: float, iso: float = 100.0) -> float:
    """Exposure time that gives an exposure value [s] (ISO 12232)."""
    return f_number**2 / 2**ev100 * 100 / iso
