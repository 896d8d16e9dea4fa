"""A photograph in a scene: camera, exposure, comparison and files (docs/match.md)."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import gloam
from gloam.experiments.files import locked, replace_file

from . import edges
from .camera import Array, Lens
from .exposure import Exposure, fit_exposure
from .pairs import Pair, scene_points
from .photo import Photo, to_srgb
from .refine import Unknowns
from .scene_file import camera_text, matched_table, write_scene
from .solve import Solution, solve
from .view import Quality, has_light, render, scene_with

_OUTPUTS = ("rgb", "radiance", "depth", "normal", "segmentation", "albedo")


@dataclass(frozen=True)
class Request:
    """scene: a file; out: folder of the results; fovy: of the lens [deg], None = solved for; unknowns: of the lens beside it; name: of
    the camera; mask: pixels to compare; copy: scene file to write, None = none."""

    scene: Path
    out: Path
    fovy: float | None = None
    unknowns: Unknowns = Unknowns.POSE
    name: str = "photo"
    mask: NDArray[np.bool_] | None = None
    copy: Path | None = None
    quality: Quality = field(default_factory=Quality)


@dataclass(frozen=True)
class Match:
    """points: of the pairs in the world (n, 3) [m]; exposure: None with the reason in `problem`; text: the camera as TOML;
    pictures: of the page, by name; files: written."""

    photo: Photo
    pairs: tuple[Pair, ...]
    points: Array
    solution: Solution
    exposure: Exposure | None
    problem: str
    text: str
    pictures: dict[str, edges.Picture]
    files: tuple[Path, ...] = ()

    def summary(self) -> str:
        """A few lines for a terminal."""
        s, lens = self.solution, self.solution.camera.lens
        place = ", ".join(f"{value:.3f} ± {error:.3f}" for value, error in zip(s.camera.p, s.position_error, strict=True))
        solved = f" ± {s.focal_error:.1f}" if Unknowns.FOCAL in s.unknowns else " (given)"
        bent = "".join(f", {name} {getattr(lens, name):.4f}" for name in ("k1", "k2") if name in s.unknowns.lens_names)
        lines = [
            f"position     {place} m",
            f"lens         f {lens.f:.1f}{solved} px, fovy {lens.fovy:.2f} deg{bent}",
            f"residuals    {s.rms:.2f} px RMS over {int(s.used.sum())} of {len(self.pairs)} pairs",
        ]
        if self.exposure is not None:
            gains = ", ".join(f"{gain:.3f}" for gain in self.exposure.gains)
            lines.append(f"exposure     EV {self.exposure.ev100:.2f} at ISO 100, gains of red, green, blue {gains}")
        return "\n".join(lines)


def match(photo: Photo, pairs: Sequence[Pair], request: Request, tell: Callable[[str], None] = lambda _: None) -> Match:
    """Solves the camera, renders its view, fits the exposure, and writes all files into request.out.

    Errors: gloam.InputError for pairs that determine no camera; gloam.NotFoundError for unknown elements; gloam.IoError.
    """
    from .report import write_page

    request.out.mkdir(parents=True, exist_ok=True)
    with locked(request.out):
        scene = gloam.Scene(request.scene)
        with gloam.load(scene) as sim:
            points, lit = scene_points(sim, pairs), has_light(sim)
        pixels = np.array([pair.pixel for pair in pairs], dtype=np.float64).reshape(-1, 2)
        solution = solve(pixels, points, *_lens(photo, request))
        for i in map(int, np.flatnonzero(~solution.used)):
            off = float(np.hypot(*solution.residuals[i]))
            tell(f"pair {i + 1} ('{pairs[i].name}') contradicts the others and is left out: it is {off:.1f} px off")
        made = _compare(photo, pairs, points, solution, scene, lit, request)
        if made.problem:
            tell(f"the exposure is not fitted: {made.problem}")
        files = [*_write(made, request), write_page(made, request)]
        if request.copy is not None:
            files.append(write_scene(request.scene, made.text, request.copy))
        return replace(made, files=tuple(files))


def _lens(photo: Photo, request: Request) -> tuple[Lens, Unknowns]:
    lens = Lens.centred(photo.width, photo.height, float(max(photo.width, photo.height)))
    if request.fovy is None:
        return lens, request.unknowns | Unknowns.FOCAL
    return Lens.of_fovy(photo.width, photo.height, request.fovy), request.unknowns


def _compare(
    photo: Photo, pairs: Sequence[Pair], points: Array, solution: Solution, scene: gloam.Scene, lit: bool, request: Request
) -> Match:  # fmt: skip
    size = request.quality.size_of(photo.width, photo.height)
    seen = scene_with(scene, matched_table(request.name, solution, None))
    try:
        frame = render(seen, request.name, size, _OUTPUTS, request.quality)
    except gloam.InputError as error:
        if solution.unknowns & (Unknowns.K1 | Unknowns.K2):
            hint = "solve for less of the distortion, or add pairs near the corners of the photograph"
            raise gloam.InputError(f"the solved lens cannot be rendered: {error.message}", hint=hint) from None
        raise
    radiance = np.asarray(frame.radiance, dtype=np.float64)
    exposure, problem = None, "" if lit else "the scene has no lamp and no sky"
    if lit:
        light, usable = photo.light(*size)
        if request.mask is not None:
            usable &= np.asarray(Image.fromarray(request.mask.astype(np.uint8) * 255).resize(size, Image.Resampling.BOX)) == 255
        try:
            exposure = fit_exposure(light, radiance, usable)
        except gloam.InputError as error:
            problem = error.message
    shown = np.asarray(frame.rgb) if exposure is None else _developed(radiance, exposure, balanced=False)
    balanced = shown if exposure is None else _developed(radiance, exposure, balanced=True)
    small = photo.resized(*size)
    scale = np.array([size[0] / photo.width, size[1] / photo.height])
    pixels = np.array([pair.pixel for pair in pairs]) * scale
    projected = pixels - solution.residuals * scale
    lines = edges.edges_of(frame)
    pictures = {
        "photo": small,
        "pairs": edges.draw_pairs(small, pixels, projected, list(map(bool, solution.used))),
        "render": shown,
        "balanced": balanced,
        "edges": edges.draw_edges(small, lines),
        "blend": edges.blend(small, balanced),
        "checkerboard": edges.checkerboard(small, balanced),
    }
    table = matched_table(request.name, solution, exposure)
    text = camera_text(table, solution, exposure, photo.path.name)
    return Match(photo, tuple(pairs), points, solution, exposure, problem, text, pictures)


def _developed(radiance: Array, exposure: Exposure, balanced: bool) -> edges.Picture:
    """sRGB of a radiance by Gloam's curve (docs/light.md), with the photograph's exposure."""
    light = exposure.display(radiance)
    light = light if balanced else light / np.array(exposure.gains)
    return to_srgb(np.where(light > 0.85, 1 - 0.15 * np.exp((0.85 - np.maximum(light, 0.85)) / 0.15), light))


def _write(made: Match, request: Request) -> list[Path]:
    out = request.out
    files = [replace_file(out / "camera.toml", lambda path: path.write_text(made.text, encoding="utf-8"))]
    table = json.dumps(numbers(made), indent=1) + "\n"
    files.append(replace_file(out / "match.json", lambda path: path.write_text(table, encoding="utf-8")))
    return files + [_write_picture(out / f"{name}.png", picture) for name, picture in made.pictures.items()]


def _write_picture(path: Path, picture: edges.Picture) -> Path:
    return replace_file(path, lambda file: Image.fromarray(picture).save(file, format="PNG"))


def numbers(made: Match) -> dict[str, Any]:
    """All numbers of a match, for match.json."""
    solution, lens = made.solution, made.solution.camera.lens
    result: dict[str, Any] = {
        "photo": {"file": made.photo.path.name, "width": made.photo.width, "height": made.photo.height},
        "position_m": solution.camera.p.tolist(),
        "position_error_m": solution.position_error.tolist(),
        "orientation_wxyz": solution.camera.quaternion.tolist(),
        "orientation_error_rad": solution.turn_error.tolist(),
        "lens": {"f_px": lens.f, "cx_px": lens.cx, "cy_px": lens.cy, "k1": lens.k1, "k2": lens.k2, "fovy_deg": lens.fovy},
        "focal_error_px": solution.focal_error,
        "rms_px": solution.rms,
        "sigma_px": solution.sigma,
        "covariance": solution.covariance.tolist(),
        "covariance_of": solution.names,
        "exposure": None,
        "exposure_problem": made.problem,
        "pairs": [
            {"name": pair.name, "pixel": list(pair.pixel), "point_m": point.tolist(), "residual_px": residual.tolist(), "used": bool(used)}
            for pair, point, residual, used in zip(made.pairs, made.points, solution.residuals, solution.used, strict=True)
        ],
    }
    if made.exposure is not None:
        e = made.exposure
        result["exposure"] = {"ev100": e.ev100, "gains_rgb": list(e.gains), "spread_ev": e.spread, "share": e.share}
    return result
