"""The solved camera as a table of a scene file, and a copy of the scene that contains it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gloam
from gloam import _toml
from gloam.experiments.files import replace_file

from .exposure import Exposure, shutter_of
from .solve import Solution
from .view import camera_table

_F_NUMBER = 2.8
_SHUTTERS = (1e-7, 60.0)  # limits of [camera.imager.exposure] [s]


def matched_table(name: str, solution: Solution, exposure: Exposure | None) -> dict[str, Any]:
    """The [[camera]], with the exposure in its imager."""
    table = camera_table(name, solution.camera)
    if exposure is not None:
        shutter, iso = shutter_of(exposure.ev100, _F_NUMBER), 100.0
        if shutter > _SHUTTERS[1]:
            shutter, iso = _SHUTTERS[1], 100.0 * shutter / _SHUTTERS[1]
        table["imager"] = {"exposure": {"f_number": _F_NUMBER, "shutter": _rounded(max(shutter, _SHUTTERS[0])), "iso": _rounded(iso)}}
    return table


def _rounded(value: float) -> float:
    """To seven digits."""
    return float(f"{value:.7g}")


def camera_text(table: Mapping[str, Any], solution: Solution, exposure: Exposure | None, photo: str) -> str:
    """The table as TOML with comments; an overlay of the scene."""
    safe = "".join(c if c.isprintable() else "?" for c in photo)
    turn = ", ".join(f"{math.degrees(v):.3f}" for v in solution.turn_error)
    place = ", ".join(f"{1000 * v:.1f}" for v in solution.position_error)
    lines = [
        f"# The camera of the photograph {safe}, by gloam match: {int(solution.used.sum())} pairs, {solution.rms:.2f} px RMS.",
        f"# Standard errors: position {place} mm; orientation {turn} deg; focal length {solution.focal_error:.2f} px.",
    ]
    if exposure is not None:
        gains = ", ".join(f"{gain:.3f}" for gain in exposure.gains)
        lines.append(f"# EV {exposure.ev100:.2f} at ISO 100. White balance of the photograph, as gains of a render: {gains}.")
    return "\n".join(lines) + "\n" + _toml.table_text({"camera": [dict(table)]})


def write_scene(scene: Path, text: str, out: Path) -> Path:
    """Writes the scene with the camera's table at its end; the rest of the file stays as it is. `out` may be the scene itself.

    A bare MJCF or URDF becomes the environment of a new scene. Errors: gloam.IoError; InputError if the result does not load.
    """
    if scene.suffix == ".toml":
        try:
            before = scene.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise gloam.IoError(f"cannot read the scene: {error}", str(scene)) from error
        made = before + ("" if before.endswith("\n") or not before else "\n") + "\n" + text
    else:
        file = scene.resolve()
        relative = file.name if file.parent == out.resolve().parent else str(file)
        made = _toml.table_text({"environment": {"file": relative}}) + "\n" + text
    try:
        gloam.Scene.parse(made, out.parent).compile(progress=False)
    except gloam.InputError as error:
        raise gloam.InputError(f"the scene with the camera does not load from {out}: {error}",
                               hint=f"write it beside {scene}, because its paths are relative to its folder") from None  # fmt: skip
    return replace_file(out, lambda path: path.write_text(made, encoding="utf-8"))
