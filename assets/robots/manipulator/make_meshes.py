#!/usr/bin/env python3
"""Makes the drawn meshes of the manipulator: meshes/*.obj, one file per link and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: the links' own in manipulator.xml with all joints at zero: x along the stretched arm, y along
the axes of shoulder, elbow and wrist 1, z up. The gripper's parts are in gripper_parts.py.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from gripper_parts import PARTS as GRIPPER  # noqa: E402
from mesh_parts import (Mesh, block, bolt_circle, cable_gland, circle, lathe, loft, plate, slots, socket_screw,  # noqa: E402
                        write_parts)

UPPER, FOREARM = 0.425, 0.3922  # lengths of the links
LARGE, MIDDLE, SMALL = 0.0600, 0.0540, 0.0385  # radii of the joints


def housing(m, axis, radius, low, high, at=(0, 0, 0)):
    """A joint's housing about an axis, necked at `low` where it turns on its neighbour."""
    side = 1 if high > low else -1
    length = abs(high - low)
    r = radius
    profile = [(0.80 * r, 0.0), (0.955 * r, 0.0), (0.955 * r, 0.0035), (r, 0.0055), (r, length - 0.10 * r), (0.93 * r, length), (0.5 * r, length)]
    signed = axis if side > 0 else ("-" + axis)
    start = np.array(at, float)
    start["xyz".index(axis)] += low
    m.add(*lathe(profile, start, signed, segments=52, bevel=0.0030, steps=2))


# Lids of the joints, placed by the MJCF; z out of the joint.

def cap_dark(r):
    """A dished disc with a groove."""
    return Mesh().add(*lathe([(0.93 * r, -0.004), (0.93 * r, 0.0035), (0.88 * r, 0.0075), (0.66 * r, 0.0085), (0.63 * r, 0.0070), (0.16 * r, 0.0070), (0.14 * r, 0.0080),
                              (0, 0.0080)], (0, 0, 0), "z", segments=52, bevel=0.0014, steps=2))


def cap_trim(r):
    return Mesh().add(*lathe([(0.955 * r, -0.0020), (0.955 * r, 0.0012), (0.90 * r, 0.0014)], (0, 0, 0), "z", segments=52, bevel=0.0004, steps=1))


def cap_metal(r):
    m = Mesh()
    bolt_circle(m, (0, 0, 0.0077), "z", 0.76 * r, 6, 0.0024)
    return m


# ---------------------------------------------------------------------------------------------------- links

def base_shell():
    m = Mesh()
    m.add(*lathe([(0.0745, 0.0085), (0.0745, 0.0130), (0.0660, 0.0210), (0.0620, 0.0360), (0.0610, 0.0900), (0.0585, 0.0955), (0.0400, 0.0955)], (0, 0, 0), "z",
                 segments=60, bevel=0.005, steps=3))
    m.add(*loft([(-0.0860, 0.0, 0.0490, 0.0190, 0.0210, 4.0), (-0.0500, 0.0, 0.0480, 0.0230, 0.0250, 3.6)], "x", end=0.006, segments=40, rows=6, end_rows=4))
    return m


def base_dark():
    m = Mesh()
    m.add(*plate(circle(0.0765, segments=64), 0.0, 0.0090, bevel=0.0014))
    m.add(*lathe([(0.0590, 0.0900), (0.0590, 0.1000), (0.0500, 0.1005)], (0, 0, 0), "z", segments=64, bevel=0.0008))
    m.add(*block((-0.0862, 0, 0.0490), (0.0016, 0.0160, 0.0175), 0.0014))
    cable_gland(m, (-0.0875, 0.0, 0.0440), "-x", 0.0170)
    slots(m, (-0.0872, 0, 0.0605), (0, 0.0050, 0), 4, (0.0010, 0.0014, 0.0032), 0.0009)
    return m


def base_metal():
    m = Mesh()
    for k in range(4):
        t = np.radians(45 + 90 * k)
        socket_screw(m, (0.0675 * np.cos(t), 0.0675 * np.sin(t), 0.0118), "z", 0.0046)
    return m


def shoulder_shell():
    m = Mesh()
    housing(m, "z", LARGE, -0.0600, 0.0200)
    housing(m, "y", LARGE, 0.0715, -0.0700)
    # Neck between the two.
    m.add(*loft([(-0.0450, 0, 0, 0.0585, 0.0585, 2.0), (0.0, 0, 0, 0.0560, 0.0590, 2.4)], "z", end=0.002, segments=48, rows=4, end_rows=2))
    return m


def upper_arm_shell():
    m = Mesh()
    housing(m, "y", LARGE, -0.0640, 0.0640)
    housing(m, "y", MIDDLE, -0.0630, 0.0580, at=(UPPER, 0, 0))
    m.add(*loft([(0.0300, 0, 0, 0.0480, 0.0540, 2.3), (0.0700, 0, 0, 0.0475, 0.0500, 2.1), (0.1100, 0, 0, 0.0470, 0.0470, 2.0), (0.3200, 0, 0, 0.0445, 0.0445, 2.0),
                 (0.3600, 0, 0, 0.0450, 0.0460, 2.1), (0.4000, 0, 0, 0.0450, 0.0480, 2.3)], "x", end=0.004, segments=48, rows=14, end_rows=2, seams=(0.1080, 0.3220)))
    return m


def forearm_shell():
    m = Mesh()
    housing(m, "y", MIDDLE, 0.0670, -0.0580)
    housing(m, "y", SMALL, 0.0440, -0.0430, at=(FOREARM, 0, 0))
    m.add(*loft([(0.0260, 0, 0, 0.0420, 0.0480, 2.3), (0.0640, 0, 0, 0.0405, 0.0430, 2.1), (0.0950, 0, 0, 0.0395, 0.0395, 2.0), (0.3050, 0, 0, 0.0335, 0.0335, 2.0),
                 (0.3400, 0, 0, 0.0335, 0.0340, 2.1), (0.3760, 0, 0, 0.0330, 0.0345, 2.3)], "x", end=0.003, segments=44, rows=14, end_rows=2, seams=(0.0940, 0.3060)))
    return m


def wrist_1_shell():
    m = Mesh()
    housing(m, "y", SMALL, -0.0810, 0.0360)
    housing(m, "z", SMALL, -0.0460, 0.0460)
    return m


def wrist_2_shell():
    m = Mesh()
    housing(m, "z", SMALL, 0.0525, -0.0360)
    housing(m, "y", SMALL, 0.0460, -0.0460)
    return m


def wrist_3_shell():
    m = Mesh()
    housing(m, "y", SMALL, -0.0525, -0.0090)
    return m


def wrist_3_metal():
    """Tool flange after ISO 9409-1-50-4-M6, and the socket of the tool's cable."""
    m = Mesh()
    m.add(*lathe([(0.0365, -0.0110), (0.0365, -0.0070), (0.0315, -0.0062), (0.0315, 0.0), (0.0158, 0.0)], (0, 0, 0), "y", segments=56, bevel=0.0006))
    m.add(*lathe([(0.0065, 0.0), (0.0065, 0.0100), (0.0050, 0.0110), (0.0042, 0.0110), (0.0042, 0.0060), (0, 0.0060)], (0.0, -0.0260, 0.0370), "z", segments=28,
                 bevel=0.0005))
    return m


def wrist_3_light():
    """Status ring at the flange."""
    m = Mesh()
    m.add(*lathe([(0.0362, -0.0140), (0.0388, -0.0134), (0.0388, -0.0118), (0.0362, -0.0112)], (0, 0, 0), "y", segments=64, bevel=0.0005, steps=1))
    return m


def gap(m, axis, radius, at):
    """The sleeve seen in the slit between two housings."""
    return m.add(*lathe([(0.945 * radius, -0.0040), (0.945 * radius, 0.0040)], at, axis, segments=52, bevel=0))


def band(m, x, radius):
    """A ring over a seam of a tube."""
    r = radius + 0.0006
    return m.add(*lathe([(r - 0.0008, -0.0030), (r, -0.0022), (r, 0.0022), (r - 0.0008, 0.0030)], (x, 0, 0), "x", segments=52, bevel=0))


def upper_arm_dark():
    return band(band(gap(Mesh(), "y", LARGE, (0, -0.0650, 0)), 0.1080, 0.0471), 0.3220, 0.0446)


def forearm_dark():
    return band(band(gap(Mesh(), "y", MIDDLE, (0, 0.0680, 0)), 0.0940, 0.0397), 0.3060, 0.0336)


PARTS = {
    "base_shell": base_shell, "base_dark": base_dark, "base_metal": base_metal, "shoulder_shell": shoulder_shell,
    "shoulder_dark": lambda: gap(Mesh(), "z", LARGE, (0, 0, -0.0610)), "upper_arm_shell": upper_arm_shell, "upper_arm_dark": upper_arm_dark,
    "forearm_shell": forearm_shell, "forearm_dark": forearm_dark, "wrist_1_shell": wrist_1_shell,
    "wrist_1_dark": lambda: gap(Mesh(), "y", SMALL, (0, -0.0818, 0)), "wrist_2_shell": wrist_2_shell,
    "wrist_2_dark": lambda: gap(Mesh(), "z", SMALL, (0, 0, 0.0533)), "wrist_3_shell": wrist_3_shell,
    "wrist_3_dark": lambda: gap(Mesh(), "y", SMALL, (0, -0.0533, 0)), "wrist_3_metal": wrist_3_metal, "wrist_3_light": wrist_3_light,
}
for size, value in (("large", LARGE), ("middle", MIDDLE), ("small", SMALL)):
    for material, make in (("dark", cap_dark), ("trim", cap_trim), ("metal", cap_metal)):
        PARTS[f"cap_{size}_{material}"] = lambda make=make, value=value: make(value)
PARTS |= GRIPPER
COPIES = {"finger_dark": 2, "finger_metal": 2, "finger_rubber": 2}
COPIES |= {f"cap_{size}_{material}": count for size, count in (("large", 2), ("middle", 2), ("small", 3)) for material in ("dark", "trim", "metal")}

if __name__ == "__main__":
    write_parts(PARTS, pathlib.Path(__file__).parent / "meshes", COPIES)
