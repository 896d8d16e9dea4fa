#!/usr/bin/env python3
"""Makes the drawn meshes of the differential-drive base: meshes/*.obj, one file per part and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: the chassis (x ahead, y left, z up, origin on the floor between the wheels) and the left wheel
(y along its axle, outwards).
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from mesh_parts import (Mesh, arc, block, bolt, bolt_circle, cable_gland, circle, lathe, lens, loft, mirrored, pill, place, plate,  # noqa: E402
                        rounded, slots, socket_screw, spline, tube, turned_by, wrap, write_parts)

WHEEL_RADIUS, WHEEL_WIDTH, WHEEL_Y = 0.035, 0.021, 0.115
CASTERS = ((0.115, 0.017), (-0.135, 0.017))  # x, radius
CAMERA = np.array([0.1130, 0.0, 0.1400])  # middle of the camera
BUMPER = 75.0  # half angle [degrees]


def around(radius, angle, z):
    a = np.radians(angle)
    return np.array([radius * np.cos(a), radius * np.sin(a), z])


def notched(radius, half, depth, count=24):
    """A disc with a notch for each wheel: |x| < half, |y| > depth."""
    edge = np.degrees(np.arccos(half / radius))
    front, rear = np.radians(np.linspace(-edge, edge, count)), np.radians(np.linspace(180 - edge, 180 + edge, count))
    ring = [np.stack([radius * np.cos(a), radius * np.sin(a)], axis=1) for a in (front, rear)]
    return np.concatenate([ring[0], [(half, depth), (-half, depth)], ring[1], [(-half, -depth), (half, -depth)]])


# ---------------------------------------------------------------------------------------------------- chassis

def base_shell():
    m = Mesh()
    # Deck: a ring with a soft edge over bumper and skirt.
    m.add(*lathe([(0.1600, 0.0735), (0.1705, 0.0735), (0.1725, 0.0765), (0.1725, 0.0880), (0.1660, 0.0965), (0.1540, 0.0985), (0.1520, 0.0970),
                  (0.0600, 0.0970)], (0, 0, 0), "z", segments=96, bevel=0.004, steps=3))
    # Skirt behind the wheels, with its lower lip.
    skirt = rounded([(0.1560, 0.0220), (0.1655, 0.0220), (0.1715, 0.0300), (0.1715, 0.0715), (0.1560, 0.0715)], 0.003, 3)
    m.add(*arc(skirt, 180 - BUMPER, 180 + BUMPER, rounding=0.004))
    # Housing of the computer.
    m.add(*loft([(0.0965, -0.0450, 0, 0.0960, 0.1130, 3.4), (0.1280, -0.0450, 0, 0.0930, 0.1100, 3.4), (0.1560, -0.0460, 0, 0.0850, 0.1020, 3.2)],
                "z", end=(0.001, 0.014), segments=64, rows=6, end_rows=6, seams=(0.1120,)))
    # Back of the camera.
    m.add(*loft([(-0.0460, 0.1400, CAMERA[0], 0.0118, 0.0112, 3.6), (0.0460, 0.1400, CAMERA[0], 0.0118, 0.0112, 3.6)], "y", end=0.010, segments=40, rows=4,
                end_rows=6))
    return m


def base_dark():
    m = Mesh()
    # Chassis with the wheel arches, and the belly.
    m.add(*plate(notched(0.1610, 0.0415, 0.0960), 0.0190, 0.0745, bevel=0.0015))
    m.add(*plate(notched(0.1480, 0.0430, 0.0940), 0.0150, 0.0200, bevel=0.0012))
    # Bumper.
    bumper = rounded([(0.1660, 0.0250), (0.1735, 0.0250), (0.1755, 0.0290), (0.1755, 0.0690), (0.1735, 0.0715), (0.1660, 0.0715)], 0.0022, 3)
    m.add(*arc(bumper, -BUMPER, BUMPER, rounding=0.0035))
    # Infrared window along the bumper is in base_lens; its frame:
    frame = rounded([(0.1745, 0.0565), (0.1762, 0.0570), (0.1762, 0.0660), (0.1745, 0.0665)], 0.0004, 1)
    m.add(*arc(frame, -40, 40, rounding=0.001))
    # Deck inlay with a grid of inserts.
    m.add(*plate(circle(0.1505, segments=96), 0.0968, 0.0982, bevel=0.0005, steps=1))
    # Fork and socket of each caster.
    for x, r in CASTERS:
        m.add(*lathe([(0.0180, 0.0), (0.0180, 0.0050), (0.0150, 0.0070), (0, 0.0070)], (x, 0, 0.0150), "-z", segments=32, bevel=0.001))
        for y in (0.0105, -0.0105):
            m.add(*block((x - 0.001, y, 0.0155), (0.0090, 0.0012, 0.0075), 0.0010, steps=1))
    # Vents on both sides of the housing, and the ports behind.
    for y in (0.1108, -0.1108):
        slots(m, (-0.0450, y, 0.1300), (0.0075, 0, 0), 11, (0.0021, 0.0016, 0.0100), 0.0014)
    panel = rounded([(-0.0480, 0.1180), (0.0480, 0.1180), (0.0480, 0.1460), (-0.0480, 0.1460)], 0.004)
    m.add(*plate(panel, -0.1395, -0.1362, "x", bevel=0.0008))
    # Bracket of the camera.
    bracket = rounded([(0.0940, -0.0260), (0.1150, -0.0200), (0.1150, 0.0200), (0.0940, 0.0260)], 0.005)
    m.add(*plate(bracket, 0.0978, 0.1012, bevel=0.0008))
    rib = rounded([(0.0990, 0.0960), (0.0990, 0.1120), (0.1310, 0.1180), (0.1380, 0.1160), (0.1380, 0.1060), (0.1310, 0.1060), (0.1100, 0.0980)], 0.003)
    for y in (0.0120, -0.0120):
        m.add(*plate(rib, y - 0.0016, y + 0.0016, "y", bevel=0.0006))
    # Handle across the front of the housing.
    m.add(*tube(spline([(0.0420, 0.0640, 0.1490), (0.0560, 0.0600, 0.1545), (0.0590, 0.0480, 0.1560), (0.0590, -0.0480, 0.1560), (0.0560, -0.0600, 0.1545),
                        (0.0420, -0.0640, 0.1490)], 44), 0.0042, 14))
    return m


def base_rubber():
    m = Mesh()
    strip = rounded([(0.1740, 0.0370), (0.1775, 0.0385), (0.1785, 0.0425), (0.1775, 0.0465), (0.1740, 0.0480)], 0.0012, 2)
    m.add(*arc(strip, -BUMPER + 2, BUMPER - 2, rounding=0.0025))
    for x, r in CASTERS:  # caster wheels
        m.add(*lathe([(0.0060, -0.0088), (r - 0.0015, -0.0088), (r, -0.0060), (r, 0.0060), (r - 0.0015, 0.0088), (0.0060, 0.0088)], (x, 0, r), "y", segments=32,
                     bevel=0.0012))
    # Pads for a payload on the deck, foot of the LiDAR, and the cable of the camera.
    for angle in (38, 62, -38, -62):
        m.add(*lathe([(0.0090, 0.0), (0.0090, 0.0012), (0.0080, 0.0020), (0, 0.0020)], around(0.1340, angle, 0.0980), "z", segments=28, bevel=0.0006, steps=1))
    m.add(*tube(spline([CAMERA + (-0.010, 0.030, 0.0), CAMERA + (-0.026, 0.032, -0.003), (0.0800, 0.0330, 0.1180), (0.0640, 0.0330, 0.1130), (0.0460, 0.0330, 0.1130)], 30),
                0.0021, 10))
    return m


def base_metal():
    m = Mesh()
    bolt_circle(m, (0, 0, 0.0982), "z", 0.1430, 16, 0.0024, phase=0.2)
    for x in np.arange(-2, 3) * 0.020:  # threaded inserts in the deck, ahead of the housing
        m.add(*lathe([(0.0034, 0.0), (0.0034, 0.0009), (0.0022, 0.0009), (0.0020, 0.0002)], (0.0760, x, 0.0982), "z", segments=20, bevel=0.0002, steps=1))
    for y in (0.0430, -0.0430):
        for z in (0.1220, 0.1420):
            socket_screw(m, (-0.1393, y, z), "-x", 0.0018)
    for x in (0.0465,):
        for y in (0.0640, -0.0640):
            m.add(*lathe([(0.0068, 0.0), (0.0068, 0.0035), (0.0052, 0.0048), (0, 0.0048)], (0.0415, y, 0.1455), "z", segments=28, bevel=0.0008))
    for y in (0.0200, -0.0200):
        bolt(m, (0.1020, y, 0.1012), "z", 0.0026)
    for y in (0.0250, -0.0250):  # contacts of the charging dock
        m.add(*block((-0.1560, y, 0.0290), (0.0120, 0.0100, 0.0012), 0.0010, steps=1))
    for angle in np.arange(-60, 61, 30):  # screws of the bumper
        bolt(m, around(0.1754, angle, 0.0310), around(1, angle, 0), 0.0017)
    for k in range(6):  # screws of the belly
        bolt(m, around(0.1250, 30 + 60 * k, 0.0151), "-z", 0.0024)
    cable_gland(m, (0.0440, 0.0330, 0.1130), "x", 0.0085)
    glass = Mesh()
    for y, r in ((0.0375, 0.0042), (0.0180, 0.0042), (-0.0125, 0.0050), (-0.0320, 0.0042)):
        lens(glass, m, CAMERA + (0.0118, y, 0), "x", r, 0.0022)
    m.glass = glass
    return m


def base_lens():
    m = base_metal().glass
    m.add(*block(CAMERA + (0.0098, 0, 0), (0.0024, 0.0440, 0.0094), 0.0020))  # front of the camera
    window = rounded([(0.1750, 0.0580), (0.1766, 0.0583), (0.1766, 0.0647), (0.1750, 0.0650)], 0.0003, 1)
    m.add(*arc(window, -38.5, 38.5, rounding=0.001))
    m.add(*plate(rounded([(0.0080, -0.0280), (0.0330, -0.0280), (0.0330, 0.0280), (0.0080, 0.0280)], 0.003), 0.1546, 0.1568, bevel=0.0008))  # display
    return m


def base_trim():
    m = Mesh()
    m.add(*lathe([(0.0095, 0.0), (0.0095, 0.0035), (0.0130, 0.0055), (0.0130, 0.0088), (0.0100, 0.0112), (0, 0.0118)], (-0.0980, 0.0560, 0.1545), "z", segments=36,
                 bevel=0.0016, steps=3))  # stop button
    return m


def base_light():
    m = Mesh()
    section = rounded([(0.1723, 0.0722), (0.1729, 0.0723), (0.1729, 0.0737), (0.1723, 0.0738)], 0.0002, 1)
    m.add(*arc(section, 183 - BUMPER, 177 + BUMPER, rounding=0.0003))
    slots(m, (-0.1396, 0.0, 0.1415), (0, 0.0062, 0), 5, (0.0007, 0.0019, 0.0009), 0.0006)
    m.add(*lathe([(0.0062, 0.0), (0.0062, 0.0006), (0.0050, 0.0006), (0.0050, 0.0)], (0.0205, -0.0460, 0.1560), "z", segments=32, bevel=0.0002, steps=1))
    return m


def ports_dark():
    """Sockets on the rear panel and the power button."""
    m = Mesh()
    for y, w in ((0.0280, 0.0070), (0.0090, 0.0070), (-0.0100, 0.0045), (-0.0260, 0.0060)):
        pill(m, (-0.1398, y, 0.1290), (0.0012, w, 0.0034), 0.0011)
    m.add(*lathe([(0.0048, 0.0), (0.0048, 0.0010), (0, 0.0012)], (0.0205, -0.0460, 0.1556), "z", segments=28, bevel=0.0004, steps=1))
    m.add(*lathe([(0.0150, 0.0), (0.0150, 0.0022), (0.0100, 0.0030)], (-0.0980, 0.0560, 0.1545), "z", segments=36, bevel=0.0006))
    return m


# ---------------------------------------------------------------------------------------------------- LiDAR (origin at its foot)

def lidar_dark():
    m = Mesh()
    m.add(*lathe([(0.0420, -0.001), (0.0420, 0.0030), (0.0385, 0.0060), (0.0385, 0.0150), (0.0370, 0.0165), (0.0200, 0.0165)], (0, 0, 0), "z", segments=56,
                 bevel=0.0015))
    m.add(*lathe([(0.0340, 0.0372), (0.0362, 0.0372), (0.0362, 0.0430), (0.0325, 0.0462), (0.0120, 0.0462), (0.0110, 0.0450), (0, 0.0450)], (0, 0, 0), "z",
                 segments=56, bevel=0.0014))
    return m


def lidar_lens():
    m = Mesh()
    m.add(*lathe([(0.0345, 0.0160), (0.0350, 0.0170), (0.0350, 0.0372), (0.0335, 0.0380)], (0, 0, 0), "z", segments=56, bevel=0.0008))
    return m


def lidar_trim():
    m = Mesh()
    m.add(*lathe([(0.0363, 0.0398), (0.0363, 0.0412), (0.0340, 0.0412)], (0, 0, 0), "z", segments=56, bevel=0.0003, steps=1))
    return m


# ---------------------------------------------------------------------------------------------------- wheel

def wheel_rubber():
    m = Mesh()
    r, w = WHEEL_RADIUS, WHEEL_WIDTH / 2
    m.add(*lathe([(0.0265, -w + 0.001), (r - 0.0040, -w), (r - 0.0016, -w + 0.0022), (r - 0.0016, w - 0.0022), (r - 0.0040, w), (0.0265, w - 0.001)], (0, 0, 0), "y",
                 segments=60, bevel=0.0012))
    count = 26
    for k in range(count):  # lugs in two staggered rows
        lug = wrap(turned_by(block((0, 0, 0), (0.0022, 0.0044, 0.0012), 0.0005, steps=1), "z", 20), r - 0.0012)
        for side in (1, -1):
            part = lug if side > 0 else mirrored(lug, "y")
            m.add(*turned_by(place(part, (0, side * 0.0052, 0)), "y", 360 * (k + (side > 0) / 2) / count))
    return m


def wheel_shell():
    """Rim with five spokes."""
    m = Mesh()
    windows = []
    for k in range(5):
        t = np.radians(np.linspace(14, 58, 7)) + 2 * np.pi * k / 5
        outer, inner = np.stack([0.0232 * np.cos(t), 0.0232 * np.sin(t)], axis=1), np.stack([0.0118 * np.cos(t), 0.0118 * np.sin(t)], axis=1)[::-1]
        windows.append(rounded(np.concatenate([outer, inner]), 0.0020, 3))
    m.add(*plate(circle(0.0262, segments=60), 0.0040, 0.0092, "y", bevel=0.0010, holes=windows))
    m.add(*lathe([(0.0255, 0.0020), (0.0272, 0.0020), (0.0272, 0.0100), (0.0255, 0.0104), (0.0245, 0.0092)], (0, 0, 0), "y", segments=60, bevel=0.0006))
    return m


def wheel_metal():
    m = Mesh()
    m.add(*lathe([(0.0085, 0.0085), (0.0085, 0.0108), (0.0060, 0.0120), (0, 0.0120)], (0, 0, 0), "y", segments=36, bevel=0.0007))
    bolt_circle(m, (0, 0.0118, 0), "y", 0.0042, 3, 0.0011)
    m.add(*lathe([(0.0240, -0.0095), (0.0240, 0.0035), (0, 0.0035)], (0, 0, 0), "y", segments=40, bevel=0.0006))  # gearbox behind the spokes
    return m


PARTS = {
    "base_shell": base_shell, "base_dark": base_dark, "base_rubber": base_rubber, "base_metal": base_metal, "base_lens": base_lens,
    "base_trim": base_trim, "base_light": base_light, "ports_dark": ports_dark,
    "lidar_dark": lidar_dark, "lidar_lens": lidar_lens, "lidar_trim": lidar_trim, "wheel_rubber": wheel_rubber, "wheel_shell": wheel_shell,
    "wheel_metal": wheel_metal,
}

if __name__ == "__main__":
    write_parts(PARTS, pathlib.Path(__file__).parent / "meshes", {"wheel_rubber": 2, "wheel_shell": 2, "wheel_metal": 2})
