"""Small scenes that the tests of Python share."""
from __future__ import annotations

from pathlib import Path

import gloam

ROOT = Path(gloam.home())
QUADRUPED = ROOT / "assets" / "robots" / "quadruped" / "quadruped.xml"

BALL = """<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="ball" pos="0 0 1"><freejoint name="free"/><geom name="skin" size="0.1" mass="1"/></body>
    <body name="arm" pos="1 0 0.5">
      <joint name="elbow" type="hinge" axis="0 1 0"/><geom size="0.05" fromto="0 0 0 0.3 0 0" type="capsule"/>
    </body>
    <camera name="front" pos="0 -3 1" xyaxes="1 0 0 0 0.3 1"/>
  </worldbody>
  <actuator><motor name="motor" joint="elbow"/></actuator>
  <sensor><framepos name="where" objtype="body" objname="ball"/></sensor>
</mujoco>
"""


def ball_file(folder: Path) -> Path:
    """A model of a falling ball and a hinged arm, with a camera of its own."""
    file = folder / "ball.xml"
    file.write_text(BALL)
    return file


def ball_scene(folder: Path) -> gloam.Scene:
    """The same in a scene, with a camera of few pixels."""
    ball_file(folder)
    return gloam.Scene.from_dict({
        "sim": {"duration": 1.0},
        "robot": [{"name": "go", "file": "ball.xml"}],
        "light": [{"name": "sun", "type": "directional", "illuminance": 20000.0, "position": [-1.0, -1.0, 4.0], "look_at": [0.0, 0.0, 0.0]}],
        "camera": [{"name": "small", "position": [0.0, -3.0, 1.0], "look_at": [0.0, 0.0, 0.5], "width": 32, "height": 24, "rate": 50}],
    }, folder)
