"""Views of a scene in variants that each lack one thing, for the baselines of a comparison: all have the same cameras."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam._distribute.manifest import write_json
from gloam.experiments.files import locked, replace_file
from gloam.experiments.optional import require
from gloam.navigation.free_space import free_space
from gloam.navigation.grid import Grid

from .classic import SCRIPT, classic_python
from .network import Floats

VIEWS = "views.json"
GLOAM, NO_INDIRECT, NO_TEXTURES, NO_NOISE, MUJOCO = "gloam", "no_indirect", "no_textures", "no_noise", "mujoco"
VARIANTS = (GLOAM, NO_INDIRECT, NO_TEXTURES, NO_NOISE, MUJOCO)
_CLEARANCE = 0.45  # of a camera from walls and objects [m]
_OPEN = 0.75  # of the largest median depth around a camera: so deep a view is at least
_FAR = 10.0  # [m]
_DOWN = 0.15  # tangent of the angle below the horizon
_TEXTURED = 0.004  # deviation of a material's albedo above which it has a texture
_PIXEL = {"full_well": 10500, "quantum_efficiency": 0.62, "pitch": 3.45, "bits": 10}
_NOISE = {"shot_noise": True, "read_noise": 2.4}
_F_NUMBER, _LEAST_ISO, _LONGEST = 2.0, 400.0, 0.02  # the longest shutter in a room [s]
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Shots:
    """count: of views at random free places, 0 = the scene's own cameras; width, height [px]; height_above: of cameras over the
    floor [m]; fovy: vertical field of view [deg]; tier, samples: of Gloam's images; seed: of places, directions and noise."""

    count: int = 6
    width: int = 320
    height: int = 240
    height_above: float = 1.2
    fovy: float = 60.0
    tier: str = "path"
    samples: int = 256
    seed: int = 1

    def check(self) -> None:
        """Errors: UsageError for numbers out of range."""
        if not 0 <= self.count <= 10_000 or not (16 <= self.width <= 4096 and 16 <= self.height <= 4096):
            raise gloam.UsageError("expected up to 10000 views of 16 to 4096 pixels")
        if not 0.05 <= self.height_above <= 100 or not 1 <= self.fovy <= 170 or not 1 <= self.samples <= 65536:
            raise gloam.UsageError("expected a height of 0.05 to 100 m, a field of view of 1 to 170 degrees, and 1 to 65536 samples")


def render(scene: gloam.Scene, shots: Shots, out: Path, variants: tuple[str, ...] = VARIANTS, tell: Tell | None = None) -> list[Path]:
    """Renders the views in folders OUT/VARIANT, whose images have equal names. Images that exist are kept. Returns the folders.

    Errors: UsageError for an unknown variant, for another request in the folder, without free space, or if MuJoCo's renderer is
    not installed; as Scene.compile.
    """
    shots.check()
    say = tell or (lambda _: None)
    if unknown := set(variants) - set(VARIANTS):
        raise gloam.UsageError(f"there is no variant '{sorted(unknown)[0]}'; there are: {', '.join(VARIANTS)}")
    if MUJOCO in variants:
        classic_python()  # before minutes of rendering
    out.mkdir(parents=True, exist_ok=True)
    with locked(out):
        cameras = _cameras(scene, shots)
        _keep(out, {"scene": scene.to_toml(), "shots": vars(shots), "cameras": cameras})
        base = scene.overlay({"camera": cameras})
        missing = {one: [c for c in cameras if not (out / one / f"{c['name']}.png").is_file()] for one in variants}
        exposed = _exposed(base, cameras) if any(missing[one] for one in variants if one != MUJOCO) else []
        for one in variants:
            folder = out / one
            folder.mkdir(exist_ok=True)
            if not missing[one]:
                continue
            say(f"{one}: {len(missing[one])} views")
            if one == MUJOCO:
                _classic(base, shots, folder, missing[one])
                continue
            changed = base.overlay({"camera": [_imager(*table, one != NO_NOISE) for table in exposed]})
            if one == NO_TEXTURES:
                changed = changed.overlay({"material": _flat(base, cameras, say)})
            _gloam(changed, shots, folder, missing[one], one == NO_INDIRECT)
    return [out / one for one in variants]


def _keep(out: Path, request: dict[str, Any]) -> None:
    """Writes views.json. Errors: UsageError if the folder holds other views."""
    import json

    file = out / VIEWS
    plain = json.loads(json.dumps(request))
    if file.is_file() and json.loads(file.read_text(encoding="utf-8")) != plain:
        raise gloam.UsageError(f"{out} holds other views", hint="choose another folder")
    write_json(file, plain)


def _cameras(scene: gloam.Scene, shots: Shots) -> list[dict[str, Any]]:
    """Tables [[camera]] of the views."""
    world = scene.compile()
    size = {"width": shots.width, "height": shots.height}
    if not shots.count:
        if not world.cameras:
            raise gloam.UsageError("the scene has no cameras", hint="--views N chooses some")
        return [{"name": name, **size} for name in world.cameras]
    grid = free_space(world, (), _CLEARANCE, (0.03, shots.height_above + 0.2))
    random = np.random.default_rng([shots.seed, 49])
    cameras = []
    with gloam.Simulation(world) as sim:
        for k in range(shots.count):
            eye, yaw = _open_view(sim, grid, shots.height_above, random)
            # Slightly down, as a camera in a hand.
            target = [round(float(v), 4) for v in eye + [math.cos(yaw), math.sin(yaw), -_DOWN]]
            cameras.append({"name": f"view_{k:04}", "position": eye.tolist(), "look_at": target, "fovy": shots.fovy, **size})
    return cameras


def _open_view(sim: gloam.Simulation, grid: Grid, height: float, random: np.random.Generator) -> tuple[Floats, float]:
    """Place [m] and yaw [rad] of a view that no wall or object close by blocks, at random from 4 places × 12 directions."""
    views, reach = [], []
    for _ in range(4):
        eye = np.array([*(round(float(v), 4) for v in grid.sample(random)), height])
        for yaw in (np.arange(12) + random.uniform()) * (2 * math.pi / 12):
            c, s = math.cos((yaw - math.pi / 2) / 2) * math.sqrt(0.5), math.sin((yaw - math.pi / 2) / 2) * math.sqrt(0.5)
            pose = gloam.Pose(eye, np.array([c, c, s, s]))  # looks along -z: upright, then turned about the vertical
            frame = sim.cameras["free"].render(("depth",), width=24, height=18, pose=pose, tier="direct", spp=1)
            views.append((eye, float(yaw)))
            reach.append(float(np.median(np.minimum(frame.depth, _FAR))))
    order = random.permutation(len(views))
    return views[next(int(k) for k in order if reach[k] >= _OPEN * max(reach))]


def _exposed(base: gloam.Scene, cameras: list[dict[str, Any]]) -> list[tuple[str, dict[str, float]]]:
    """Names of the cameras with exposures as bright as the views without an imager."""
    tables = []
    with gloam.Simulation(base.compile()) as sim:
        for camera in cameras:
            frame = sim.cameras[camera["name"]].render(("rgb",), width=16, height=16, tier="direct", spp=1)
            wanted = _F_NUMBER**2 * 100 / (_LEAST_ISO * 2 ** float(frame.ev100))  # shutter at the least ISO [s]
            shutter = min(max(wanted, 1e-7), _LONGEST)
            iso = min(1e6, _LEAST_ISO * max(wanted / shutter, 1))
            tables.append((camera["name"], {"f_number": _F_NUMBER, "shutter": shutter, "iso": iso}))
    return tables


def _imager(name: str, exposure: dict[str, float], has_noise: bool) -> dict[str, Any]:
    """Table [[camera]] with the imager of a machine-vision camera."""
    return {"name": name, "imager": {"exposure": exposure, "pixel": _PIXEL | (_NOISE if has_noise else {})}}


def _flat(base: gloam.Scene, cameras: list[dict[str, Any]], say: Tell) -> list[dict[str, Any]]:
    """Tables [[material]] that give each procedural material its mean colour in these views.

    Images on materials of a model cannot be removed by a scene; they are reported.
    """
    albedo: dict[str, list[Any]] = {}
    with gloam.Simulation(base.compile()) as sim:
        material_of = {label.part: label.material for label in sim.labels()}
        names = sim.world.info.materials
        roughness = dict(zip(names, np.array(sim.memory.array("mat_roughness")).tolist(), strict=True))
        with_image = {name for name, row in zip(names, np.array(sim.memory.array("mat_texid")), strict=True) if (row >= 0).any()}
        for camera in cameras:
            frame = sim.cameras[camera["name"]].render(("albedo", "segmentation"), width=160, height=120, tier="path", spp=4)
            parts, colours = np.array(frame.part), np.array(frame.albedo, np.float64)
            for part in np.unique(parts):
                albedo.setdefault(material_of.get(int(part), ""), []).append(colours[parts == part])
    tables = []
    for name, seen in albedo.items():
        colours = np.concatenate(seen)
        if not name or colours.std(axis=0).max() < _TEXTURED:
            continue
        if name in with_image:
            say(f"material '{name}' keeps its image, which a scene cannot remove")
            continue
        mean = [round(float(v), 4) for v in colours.mean(axis=0).clip(0, 1)]
        pattern: dict[str, Any] = {"kind": "noise", "color_a": mean, "color_b": mean, "depth": 0.0}
        if roughness.get(name, -1) >= 0:
            pattern["roughness"] = float(roughness[name])
        tables.append({"name": name, "pattern": pattern})
    return tables


def _gloam(scene: gloam.Scene, shots: Shots, folder: Path, cameras: list[dict[str, Any]], is_direct: bool) -> None:
    options: dict[str, Any] = {"tier": shots.tier, "spp": shots.samples}
    if is_direct:
        options |= {"tier": "path", "max_depth": 2}  # from lamps and sky to a surface to the camera
    pillow = require("PIL.Image")
    with gloam.Simulation(scene.compile(), seed=shots.seed) as sim:
        for camera in cameras:
            frame = sim.cameras[camera["name"]].render(("rgb",), width=shots.width, height=shots.height, **options)
            image = pillow.fromarray(np.array(frame.rgb))

            def write(path: Path, image: Any = image) -> None:
                image.save(path, "PNG")

            replace_file(folder / f"{camera['name']}.png", write)


def _classic(base: gloam.Scene, shots: Shots, folder: Path, cameras: list[dict[str, Any]]) -> None:
    """Images of MuJoCo's classic renderer, in a process of its own. Errors: gloam.Error with its last line."""
    exported = folder.parent / "exported"
    base.compile().export_mjcf(exported)
    command = [str(classic_python()), str(SCRIPT), str(exported / "scene.xml"), str(folder), str(shots.width), str(shots.height)]
    done = subprocess.run([*command, *(camera["name"] for camera in cameras)], capture_output=True, text=True, check=False, timeout=3600)
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no output"])[-1]
        raise gloam.Error(
            f"MuJoCo's renderer: {last}", hint="it needs EGL or OSMesa: apt install libegl1, or MUJOCO_GL=osmesa with libosmesa6"
        )
