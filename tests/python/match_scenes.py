"""Cameras, pairs and a small room for the tests of gloam match."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from gloam.match.camera import Array, Camera, Lens

ROOM = """<mujoco><visual><headlight active="0"/></visual>
<asset>
  <material name="wall" rgba=".75 .72 .66 1"/><material name="wood" rgba=".5 .3 .15 1"/>
  <material name="red" rgba=".7 .1 .1 1"/><material name="floor" rgba=".35 .36 .4 1"/>
</asset>
<worldbody>
  <geom name="floor" type="box" size="3 3 .05" pos="0 0 -.05" material="floor"/>
  <geom name="north" type="box" size="3 .05 1.3" pos="0 3 1.3" material="wall"/>
  <geom name="east" type="box" size=".05 3 1.3" pos="3 0 1.3" material="wall"/>
  <geom name="south" type="box" size="3 .05 1.3" pos="0 -3 1.3" material="wall"/>
  <geom name="west" type="box" size=".05 3 1.3" pos="-3 0 1.3" material="wall"/>
  <geom name="ceiling" type="box" size="3 3 .05" pos="0 0 2.65" material="wall"/>
  <body name="table" pos="0.6 0.5 0">
    <geom name="top" type="box" size=".6 .4 .02" pos="0 0 .72" material="wood"/>
    <geom name="leg" type="box" size=".03 .03 .35" pos=".5 .3 .35" material="wood"/>
    <geom name="leg_2" type="box" size=".03 .03 .35" pos="-.5 -.3 .35" material="wood"/>
    <geom name="can" type="cylinder" size=".06 .1" pos=".2 .1 .84" material="red"/>
    <site name="mark" pos="-.4 -.2 .74"/>
  </body>
  <geom name="box" type="box" size=".25 .2 .3" pos="-1.2 1.2 .3" euler="0 0 25" material="red"/>
</worldbody></mujoco>
"""
SCENE = """# A small room.
[environment]
file = "room.xml"   # beside this file

[[light]]
name = "ceiling"
type = "rect"
position = [0, 0, 2.4]
size = [1.0, 1.0]
flux = 4000
temperature = 4000

[[camera]]
name = "rough"
position = [-2.2, -2.0, 1.7]
look_at = [0.3, 0.6, 0.4]
fovy = 60
"""
# Scene points that the camera below sees, as [[pair]]s name them.
ELEMENTS = [
    *(("geom", "top", corner) for corner in ("+-+", "-++", "--+", "--0")),
    *(("geom", "box", corner) for corner in ("+-+", "--+", "-++", "+-0")),
    ("geom", "can", "00+"),
    ("site", "mark", "000"),
    ("geom", "north", "0-0"),
    ("geom", "north", "0--"),
]


def room(folder: Path) -> Path:
    """Writes the room, and returns its scene."""
    (folder / "room.xml").write_text(ROOM)
    scene = folder / "room.toml"
    scene.write_text(SCENE)
    return scene


def looking(lens: Lens, position: Array, target: Array, roll: float = 0.0) -> Camera:
    """A camera that looks at a point, turned about its axis by `roll` [rad]."""
    ahead = (target - position) / np.linalg.norm(target - position)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    turn = Rotation.from_rotvec([0, 0, roll]).as_matrix()
    return Camera(lens, turn @ np.stack([right, np.cross(ahead, right), ahead]), np.asarray(position, dtype=float))


def drawn(seed: int, count: int, *, lens: Lens | None = None, flat: bool = False) -> tuple[Camera, Array, Array]:
    """A camera drawn at random, scene points in its image (n, 3), in the plane z = 0 if `flat`, and their pixels (n, 2)."""
    rng = np.random.default_rng(seed)
    lens = lens or Lens.centred(1280, 960, 900 * rng.uniform(0.6, 1.6))
    camera = looking(lens, rng.uniform(-1, 1, 3) + [0, -5, 1.5], rng.uniform(-0.3, 0.3, 3) + [0, 0, 1], rng.uniform(-0.2, 0.2))
    points: list[Array] = []
    while len(points) < count:
        point = rng.uniform(-2, 2, 3) * ([1, 1, 0] if flat else [1, 1, 1])
        pixels, depth = camera.project(point[None])
        if depth[0] > 0.5 and (pixels > 5).all() and (pixels[0] < [lens.width - 5, lens.height - 5]).all():
            points.append(point)
    return camera, np.array(points), camera.project(np.array(points))[0]
