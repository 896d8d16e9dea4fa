"""The room in which a robot is timed on a card: 6 walls, 20 boxes, the robot's own spot lamp and one point lamp.

`go1_room.write(FOLDER, XML)` makes FOLDER/room.xml beside a copy of the robot's files. Cameras: `far` in a corner (the
robot is 1 % of the picture), `close` 1.2 m from it.
"""
import math
import shutil
from pathlib import Path


def look_at(eye, target):
    """MuJoCo's xyaxes of a camera at `eye`."""
    z = [e - t for e, t in zip(eye, target)]
    n = math.sqrt(sum(v * v for v in z))
    z = [v / n for v in z]
    x = [-z[1], z[0], 0]
    n = math.hypot(x[0], x[1])
    x = [v / n for v in x]
    y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
    return " ".join(f"{v:.6f}" for v in x + y)


def room(robot):
    lines = [f'<mujoco model="room">\n  <include file="{robot}"/>\n  <worldbody>']
    walls = [("6 6 .05", "0 0 -.05", ".5 .4 .3"), ("6 6 .05", "0 0 3.05", ".8 .8 .8"),
             (".05 6 1.5", "-6.05 0 1.5", ".6 .2 .2"), (".05 6 1.5", "6.05 0 1.5", ".2 .5 .2"),
             ("6 .05 1.5", "0 -6.05 1.5", ".7 .7 .7"), ("6 .05 1.5", "0 6.05 1.5", ".7 .7 .7")]
    for size, pos, rgb in walls:
        lines.append(f'    <geom type="box" size="{size}" pos="{pos}" rgba="{rgb} 1"/>')
    for i in range(20):
        a, r, s = 2.399963 * i, 1.2 + 0.2 * i, 0.12 + 0.02 * (i % 5)
        lines.append(f'    <geom type="box" size="{s} {s} {s}" pos="{r * math.cos(a):.4f} {r * math.sin(a):.4f} {s}" '
                     f'euler="0 0 {a:.4f}" rgba=".{2 + i % 7} .{3 + i % 5} .{8 - i % 6} 1"/>')
    lines.append('    <light type="point" pos="1.5 -1 2.8" diffuse=".8 .8 .8" castshadow="true"/>')
    for name, eye in (("far", (-5.5, -5.5, 2.2)), ("close", (0.85, -0.75, 0.75))):
        position = " ".join(f"{v}" for v in eye)
        lines.append(f'    <camera name="{name}" pos="{position}" fovy="60" xyaxes="{look_at(eye, (0, 0, 0.35))}"/>')
    lines.append("  </worldbody>\n</mujoco>\n")
    return "\n".join(lines)


def write(folder, robot):
    """`robot`: an MJCF whose assets lie beside it in assets/. Returns the room's path."""
    folder, robot = Path(folder), Path(robot)
    shutil.copytree(robot.parent, folder, dirs_exist_ok=True)
    path = folder / "room.xml"
    path.write_text(room(robot.name))
    return path
