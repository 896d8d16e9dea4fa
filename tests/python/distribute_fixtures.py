"""A ball, its scene and what tests of gloam.distribute do with it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gloam
import numpy as np

BALL = """<mujoco><worldbody>
  <geom type="plane" size="2 2 .1"/>
  <body name="ball" pos="0 0 .5"><freejoint name="free"/><geom size=".1" rgba="1 0 0 1"/></body>
</worldbody></mujoco>"""
SCENE = """
[sim]
duration = 0.2
timestep = 0.005
[environment]
file = "ball.xml"
[[camera]]
name = "cam"
position = [1, 0, 0.5]
look_at = [0, 0, 0.2]
width = 32
height = 24
rate = 10
[render]
tier = "direct"
spp = 1
[record]
outputs = ["png"]
"""
SKIES = '[[randomize]]\noption = "camera.cam.fovy"\nuniform = [30, 60]\n'


def write_ball(folder: Path) -> Path:
    """The scene; beside it are ball.xml and skies.toml."""
    (folder / "ball.xml").write_text(BALL)
    (folder / "skies.toml").write_text(SKIES)
    (folder / "scene.toml").write_text(SCENE)
    return folder / "scene.toml"


def throw(sim: gloam.Simulation, seed: int, folder: Path) -> Mapping[str, Any]:
    """Throws the ball by the seed."""
    rng = np.random.default_rng(seed)
    sim.joints["free"].set(qvel=rng.normal(size=6))
    sim.step(40)
    (folder / "note.txt").write_text(f"seed {seed}")
    return {"position": sim.bodies["ball"].pose.p, "seed": np.int64(seed)}


def states(out: Path) -> list[str]:
    return [task["state"] for task in json.loads((out / "manifest.json").read_text())["tasks"]]
