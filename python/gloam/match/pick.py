"""A page on which a person picks pairs: the photograph beside renders of the scene, with exact depth behind each pixel.

The page is one file without requests to any server. It holds the images, and for every view its pose, focal length and depth.
"""

from __future__ import annotations

import base64
import io
import json
import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import gloam
from gloam.experiments.files import replace_file
from gloam.experiments.page import render_page

from .camera import OPTICAL, Lens
from .edges import Picture
from .pairs import Pair, scene_points
from .photo import Photo
from .view import Quality

_LONGEST_PHOTO = 4096  # of the embedded photograph; a larger one is reduced, and its pixels still count in the original's [px]
_MOST_VIEWS = 12
_SCRIPTS = ("pick_pane.js", "pick.js")


@dataclass(frozen=True)
class Rough:
    """A camera to pick in: position and a point that it looks at [m], vertical field of view [deg]."""

    position: tuple[float, float, float]
    look_at: tuple[float, float, float]
    fovy: float = 60.0


def write_pick_page(
    photo: Photo, scene: Path, cameras: Rough | Sequence[str], pairs: Sequence[Pair], quality: Quality, out: Path
) -> Path:  # fmt: skip
    """Writes the page. cameras: names of cameras to pick in, () = all of the scene, or a rough one.

    Lens distortion and other models of a camera are left out: a view is a pinhole image with the camera's pose and field of view.
    Errors: gloam.NotFoundError for an unknown camera or element; gloam.IoError.
    """
    with gloam.load(gloam.Scene(scene)) as sim:
        points = scene_points(sim, pairs)
        poses = _poses(sim, scene, cameras)
    views = [_view(name, frame) for name, frame in _frames(scene, poses, quality)]
    state = {
        "photo": {"name": photo.path.name, "width": photo.width, "height": photo.height},
        "views": views,
        "pairs": [
            {"name": pair.name, "pixel": list(pair.pixel), "point": point.tolist(), "kind": pair.kind, "element": pair.element, "corner": pair.corner}
            for pair, point in zip(pairs, points, strict=True)
        ],
    }
    scale = min(1.0, _LONGEST_PHOTO / max(photo.width, photo.height))
    picture = photo.image if scale == 1 else photo.resized(round(photo.width * scale), round(photo.height * scale))
    scripts = "".join(Path(__file__).with_name(name).read_text(encoding="utf-8") for name in _SCRIPTS)
    # "<" cannot end the script element.
    values = {
        "title": f"{photo.path.name} in {scene.name}", "photo": _jpeg(picture),
        "state": json.dumps(state).replace("<", "\\u003c"), "script": scripts,
    }  # fmt: skip
    text = render_page(Path(__file__).with_name("pick.html"), values)
    return replace_file(out, lambda path: path.write_text(text, encoding="utf-8"))


def _poses(sim: gloam.Simulation, scene: Path, cameras: Rough | Sequence[str]) -> list[dict[str, Any]]:
    """Tables of [[camera]]s to render: the pose of each camera at time 0, and its field of view."""
    if isinstance(cameras, Rough):
        if math.dist(cameras.position, cameras.look_at) < 1e-9 or not 0 < cameras.fovy < 179:
            raise gloam.UsageError("a rough camera looks at another point than its position, with a field of view of 0 to 179 degrees")
        return [{"name": "view", "position": cameras.position, "look_at": cameras.look_at, "fovy": cameras.fovy, "width": 640, "height": 480}]
    names = list(cameras) or sim.world.cameras or ["free"]
    if len(names) > _MOST_VIEWS:
        raise gloam.UsageError(f"the scene has {len(names)} cameras; a page has at most {_MOST_VIEWS}", hint="name some with --camera")
    tables = []
    for name in names:
        frame = sim.cameras[name].render(("depth",), tier="direct", spp=1)
        height, width = frame.depth.shape
        fovy = Lens.centred(width, height, float(frame.K[1, 1])).fovy
        pose = frame.pose
        tables.append({"name": name, "position": list(pose.p), "orientation": list(pose.q), "fovy": fovy, "width": width, "height": height})
    return tables


def _frames(scene: Path, tables: Sequence[dict[str, Any]], quality: Quality) -> list[tuple[str, gloam.Frame]]:
    made = gloam.Scene(scene).copy()
    for i, table in enumerate(tables):
        made.add("camera", **{**table, "name": f"pick/{i + 1}"})
    frames = []
    with gloam.load(made) as sim:
        for i, table in enumerate(tables):
            scale = quality.longest / max(table["width"], table["height"])
            size = (max(1, round(table["width"] * scale)), max(1, round(table["height"] * scale)))
            camera = sim.cameras[f"pick/{i + 1}"]
            frames.append((table["name"], camera.render(("rgb", "depth"), width=size[0], height=size[1], **quality.options(made))))
    return frames


def _view(name: str, frame: gloam.Frame) -> dict[str, Any]:
    depth = np.ascontiguousarray(frame.depth, dtype="<f4")
    depth = np.where(np.isfinite(depth), depth, np.float32(0)).astype("<f4")  # 0 = nothing
    K = frame.K
    return {
        "name": name,
        "width": depth.shape[1],
        "height": depth.shape[0],
        "image": _jpeg(np.asarray(frame.rgb)),
        "depth": base64.b64encode(zlib.compress(depth.tobytes(), 9)).decode(),
        "f": [float(K[0, 0]), float(K[1, 1])],
        "centre": [float(K[0, 2]), float(K[1, 2])],
        "p": frame.pose.p.tolist(),
        "R": (frame.pose.R @ OPTICAL).tolist(),  # optical axes to world axes
    }


def _jpeg(picture: Picture) -> str:
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, format="JPEG", quality=93, subsampling=0)
    return "data:image/jpeg;base64," + base64.b64encode(buffer.getvalue()).decode()
