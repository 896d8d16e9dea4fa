"""The page of a match: solution, residuals, exposure, and the photograph beside the render."""

from __future__ import annotations

import base64
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

import gloam
from gloam.experiments.files import replace_file
from gloam.experiments.page import render_page

from .edges import Picture

if TYPE_CHECKING:
    from .match import Match, Request

PAGE = "match.html"
_CAPTIONS = {
    "pairs": "The photograph with the picked pixels (circles) and the projections of their scene points (crosses)",
    "edges": "Edges of the scene, from exact depth, normals, parts and colours, over the photograph",
    "balanced": "The scene from the solved camera, with the photograph’s exposure and white balance",
    "render": "The same without the white balance, as Gloam renders it with the camera of camera.toml",
    "blend": "Mean of photograph and render",
    "checkerboard": "Fields of photograph and render in turn: edges continue across them where the camera fits",
}


def write_page(made: Match, request: Request) -> Path:
    """Writes match.html. Errors: gloam.UnsupportedError without jinja2; gloam.IoError."""
    text = _html(made, request)
    return replace_file(request.out / PAGE, lambda path: path.write_text(text, encoding="utf-8"))


def _html(made: Match, request: Request) -> str:
    """The page as HTML without external requests. All names are escaped."""
    solution = made.solution
    rows = [
        {"number": i + 1, "pair": pair, "point": made.points[i], "residual": solution.residuals[i],
         "distance": float(np.hypot(*solution.residuals[i])), "used": bool(solution.used[i])}
        for i, pair in enumerate(made.pairs)
    ]  # fmt: skip
    lens = solution.camera.lens
    values = {
        "made": made,
        "scene": request.scene.name,
        "solution": solution,
        "lens": lens,
        "solved": solution.unknowns.lens_names,
        "fovy_error": math.degrees(_fovy_slope(lens.f, lens.height) * solution.focal_error),
        "turn_error": [math.degrees(v) for v in solution.turn_error],
        "errors": dict(zip(solution.names, np.sqrt(np.diag(solution.covariance)), strict=True)),
        "rows": rows,
        "pictures": {name: (_uri(made.pictures[name]), caption) for name, caption in _CAPTIONS.items()},
        "version": gloam.__version__,
    }
    return render_page(Path(__file__).with_name("report.html"), values)


def _fovy_slope(f: float, height: int) -> float:
    """|d fovy / d f| [rad/px]."""
    return height / (f * f + height * height / 4)


def _uri(picture: Picture) -> str:
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, format="JPEG", quality=92, subsampling=0)
    return "data:image/jpeg;base64," + base64.b64encode(buffer.getvalue()).decode()
