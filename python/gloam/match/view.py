"""Images of a scene from a camera that is added to it."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

import gloam

from .camera import Camera

LIGHTS = {"light", "sky", "fire"}  # tables of a scene


@dataclass(frozen=True)
class Quality:
    """longest: side of rendered images [px]; tier, spp: as in [render]."""

    longest: int = 960
    tier: str = "path"
    spp: int = 64

    def size_of(self, width: int, height: int) -> tuple[int, int]:
        """Width and height of a rendered image with the proportions of another one, not larger than that [px]."""
        scale = min(1.0, self.longest / max(width, height))
        return max(1, round(width * scale)), max(1, round(height * scale))

    def options(self, scene: gloam.Scene) -> dict[str, Any]:
        """Of Camera.render(), which does not read [render] of the scene."""
        own = {name: scene[f"render.{name}"] for name in ("ev100", "max_depth")}
        return {"tier": self.tier, "spp": self.spp, **{name: value for name, value in own.items() if value is not None}}


def camera_table(name: str, camera: Camera) -> dict[str, Any]:
    """The camera as a [[camera]] of a scene."""
    lens = camera.lens
    table: dict[str, Any] = {"model": "pinhole"}
    if lens.k1 or lens.k2:
        table = {"model": "plumb_bob", "d": [_plain(lens.k1), _plain(lens.k2), 0.0, 0.0]}
    table |= {"fx": _plain(lens.f), "cx": _plain(lens.cx), "cy": _plain(lens.cy)}
    return {
        "name": name,
        "position": [_plain(v) for v in camera.p],
        "orientation": [_plain(v) for v in camera.quaternion],
        "width": lens.width,
        "height": lens.height,
        "lens": table,
    }


def _plain(value: float) -> float:
    """Rounded to 1e-9, far below the errors of any pick."""
    return round(float(value), 9) + 0.0


def scene_with(scene: gloam.Scene, table: Mapping[str, Any]) -> gloam.Scene:
    """A scene with one more camera. Errors: UsageError if the scene has a camera of that name."""
    changed = scene.copy()
    changed.add("camera", **table)
    return changed


def render(scene: gloam.Scene, camera: str, size: tuple[int, int], outputs: tuple[str, ...], quality: Quality) -> gloam.Frame:
    """An image of the scene at time 0. MuJoCo's headlight lights it if nothing else does."""
    with gloam.load(scene) as sim:
        return sim.cameras[camera].render(outputs, width=size[0], height=size[1], look="model", **quality.options(scene))


def has_light(sim: gloam.Simulation) -> bool:
    """Whether anything but a headlight or a studio lights the scene."""
    tables = tomllib.loads(sim.scene.to_toml())
    places = set(tables.get("environment", {})) - {"file", "up", "unit", "colliders", "clash"}  # generators bring lamps and a sky
    emission = np.asarray(sim.memory.array("mat_emission"))
    glows = bool(emission.size and emission.max() > 0) or any("emission" in material for material in tables.get("material", []))
    return bool(places or LIGHTS & set(tables) or sim.world.info.lights or glows)
