#!/usr/bin/env python3
"""Makes the drawn meshes of the quadrotor: meshes/*.obj, one file per part and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: the frame's body in quadrotor.xml (x ahead, y left, z up); motors and propellers have their
origins at the foot of the motor and on the disc, z along the shaft.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from mesh_parts import (Mesh, blade, block, bolt, bolt_circle, circle, fins, lathe, lens, loft, mirrored, pill, place, plate,  # noqa: E402
                        rounded, slots, spline, tube, turned_by, unit, write_parts)

# End of each left arm at the foot of its motor, and its shoulder.
ARMS = {"front": ((0.140, 0.180, 0.0620), (0.088, 0.028, 0.0520)), "rear": ((-0.140, 0.180, 0.0320), (-0.088, 0.026, 0.0280))}
FOOT_Z = -0.0500  # centre of the feet
LENS_X, LENS_Y, LENS_Z = 0.1415, 0.0250, 0.0500  # stereo lenses, on the nose
GIMBAL = np.array([0.1600, 0.0, 0.0060])


def both(mesh, part):
    """Adds a part and its mirror image on the right."""
    mesh.add(*part)
    mesh.add(*mirrored(part, "y"))


def along(start, end):
    """Length, and the rotation that turns x to the way from start to end with z upwards."""
    d = np.array(end, float) - np.array(start, float)
    u = unit(d)
    v = unit(np.cross((0, 0, 1), u))
    return np.linalg.norm(d), np.stack([u, v, np.cross(u, v)], axis=1)


def leg_path(arm):
    tip = np.array(ARMS[arm][0])
    out = unit(np.array([np.sign(tip[0]) * 0.35, 1.0, 0]))
    foot = np.array([*(tip + out * 0.010)[:2], FOOT_Z])
    return tip + (0, 0, -0.012), foot


# ---------------------------------------------------------------------------------------------------- fuselage

def frame_shell():
    m = Mesh()
    m.add(*loft([(-0.152, 0, 0.034, 0.0255, 0.0200, 3.2), (-0.115, 0, 0.037, 0.0325, 0.0285, 3.8), (-0.03, 0, 0.039, 0.0350, 0.0325, 4.2),
                 (0.075, 0, 0.041, 0.0350, 0.0325, 4.2), (0.118, 0, 0.042, 0.0345, 0.0290, 4.0), (0.137, 0, 0.043, 0.0335, 0.0245, 3.8)],
                "x", end=(0.012, 0.006), segments=52, rows=18, end_rows=5, seams=(-0.062, 0.098)))
    # Fairings from the fuselage to the shoulders.
    for arm, lift in (("front", 0.0), ("rear", 0.002)):
        tip, root = (np.array(p) for p in ARMS[arm])
        length, R = along(root, tip)
        both(m, place(loft([(-0.014, 0, lift, 0.0230, 0.0170, 2.8), (0.012, 0, lift, 0.0175, 0.0130, 2.7), (0.034, 0, 0, 0.0108, 0.0085, 2.4)],
                           "x", end=0.004, segments=28, rows=7, end_rows=3), root, R))
    # Camera head on the gimbal, with its panel gap.
    m.add(*place(loft([(-0.0215, 0, 0, 0.0175, 0.0165, 2.8), (0.0, 0, 0, 0.0205, 0.0195, 3.2), (0.0165, 0, 0, 0.0195, 0.0185, 3.4)],
                      "x", end=(0.010, 0.004), segments=44, rows=12, end_rows=5, seams=(0.004,)), GIMBAL))
    # Motor pods.
    for arm in ARMS:
        tip = np.array(ARMS[arm][0])
        both(m, lathe([(0, -0.0130), (0.0085, -0.0130), (0.0125, -0.0085), (0.0158, -0.0022), (0.0158, -0.0010)], tip, "z", segments=36, bevel=0.003, steps=3))
    return m


def frame_dark():
    m = Mesh()
    # Belly pan with its gap, the tray under the battery, the nose plate.
    m.add(*loft([(-0.135, 0, 0.010, 0.022, 0.009, 3.6), (-0.10, 0, 0.0085, 0.0285, 0.0115, 4.2), (0.09, 0, 0.0090, 0.0290, 0.0115, 4.2),
                 (0.122, 0, 0.0125, 0.025, 0.009, 3.8)], "x", end=0.008, segments=40, rows=8, end_rows=4, seams=(-0.05, 0.045)))
    nose = rounded([(0.0295, 0.0235), (-0.0295, 0.0235), (-0.0320, 0.036), (-0.0305, 0.0605), (0.0305, 0.0605), (0.0320, 0.036)], 0.007, 4)
    m.add(*plate(nose, 0.1340, 0.1392, "x", bevel=0.0016, steps=3))
    # Arms: tubes that flatten outwards, with a collar at each end.
    for arm in ARMS:
        tip, root = (np.array(p) for p in ARMS[arm])
        end = tip + (0, 0, -0.0070)
        length, R = along(root, end)
        both(m, place(loft([(0.015, 0, 0, 0.0085, 0.0066, 2.3), (0.45 * length, 0, 0, 0.0078, 0.0060, 2.4), (length, 0, 0, 0.0072, 0.0052, 2.4)],
                           "x", end=0.002, segments=24, rows=6, end_rows=2), root, R))
        for s, a, b in ((0.036, 0.0108, 0.0086), (length - 0.0215, 0.0092, 0.0072)):
            both(m, place(loft([(s, 0, 0, a, b, 2.4), (s + 0.0075, 0, 0, a - 0.0006, b - 0.0005, 2.4)], "x", end=0.0012, segments=26, rows=2, end_rows=3), root, R))
        # The hinge on which the arm folds.
        both(m, lathe([(0.0112, 0.010), (0.0112, 0.0188), (0.0098, 0.0200), (0.0066, 0.0200), (0.0060, 0.0190), (0, 0.0190)], root, "z", segments=28,
                      bevel=0.0008))
        # Leg, flattened along its way.
        top, foot = leg_path(arm)
        length, R = along(top, foot)
        both(m, place(loft([(0, 0, 0, 0.0052, 0.0074, 2.3), (0.35 * length, 0, 0, 0.0036, 0.0058, 2.3), (length, 0, 0, 0.0032, 0.0046, 2.2)],
                           "x", end=0.001, segments=20, rows=7, end_rows=2), top, R))
        # Seat of the motor.
        both(m, lathe([(0.0148, -0.0020), (0.0148, 0.0004), (0.0090, 0.0004)], np.array(ARMS[arm][0]), "z", segments=32, bevel=0.0006, steps=1))
    # Heat sink on the deck, in its frame.
    deck = rounded([(0.046, -0.0235), (0.094, -0.0235), (0.094, 0.0235), (0.046, 0.0235)], 0.005)
    well = rounded([(0.0485, -0.0210), (0.0915, -0.0210), (0.0915, 0.0210), (0.0485, 0.0210)], 0.003)
    m.add(*plate(deck, 0.0690, 0.0755, bevel=0.0010, holes=[well]))
    m.add(*block((0.070, 0, 0.0706), (0.0216, 0.0212, 0.0012), 0.0002, steps=1))
    fins(m, (0.070, 0, 0.0735), (0.0208, 0.0196, 0.0024), 15, along="y", thickness=0.0011)
    # Air intakes on the flanks, the grille at the rear.
    for y in (0.0352, -0.0352):
        slots(m, (0.012, y, 0.0400), (0.0068, 0, 0), 8, (0.0018, 0.0012, 0.0095), 0.0011)
    slots(m, (-0.1515, 0, 0.0330), (0, 0.0052, 0), 7, (0.0014, 0.0013, 0.0085), 0.0012)
    # Gimbal: the plate on dampers, the yaw motor, the bent arm and the pitch motor.
    tray = rounded([(0.118, -0.021), (0.154, -0.019), (0.154, 0.019), (0.118, 0.021)], 0.006)
    m.add(*plate(tray, 0.0290, 0.0318, bevel=0.0008))
    m.add(*lathe([(0.0105, 0.0), (0.0105, -0.0), (0.0118, 0.0012), (0.0118, 0.0085), (0, 0.0085)], (0.1360, 0, 0.0212), "z", segments=36, bevel=0.0008))
    m.add(*tube(spline([(0.1360, 0.0, 0.0215), (0.1340, 0.014, 0.0180), (0.1400, 0.0255, 0.0100), (0.1530, 0.0262, 0.0060)], 22), 0.0050, 14))
    both(m, lathe([(0.0105, 0.0), (0.0105, 0.0062), (0.0088, 0.0074), (0, 0.0074)], GIMBAL + (0, 0.0198, 0), "y", segments=36, bevel=0.0009))
    # Face of the camera head.
    face = rounded([(-0.0165, -0.0155), (0.0165, -0.0155), (0.0165, 0.0155), (-0.0165, 0.0155)], 0.007)
    m.add(*plate(face + GIMBAL[1:], GIMBAL[0] + 0.0135, GIMBAL[0] + 0.0182, "x", bevel=0.0012, steps=3))
    return m


def battery_shell():
    m = Mesh()
    m.add(*loft([(-0.156, 0, 0.0715, 0.0235, 0.0100, 3.6), (-0.12, 0, 0.0725, 0.0285, 0.0125, 4.2), (0.0, 0, 0.0735, 0.0300, 0.0128, 4.4),
                 (0.034, 0, 0.0725, 0.0285, 0.0105, 4.2)], "x", end=(0.008, 0.007), segments=44, rows=12, end_rows=4, seams=(-0.128, 0.012)))
    # Grip ribs on the lid.
    slots(m, (-0.0885, 0, 0.0858), (0.0062, 0, 0), 6, (0.0016, 0.0185, 0.0011), 0.0010)
    return m


def frame_trim():
    m = Mesh()
    both(m, block((-0.141, 0.0262, 0.0722), (0.0085, 0.0022, 0.0042), 0.0018))  # latches of the battery
    for arm in ("front",):  # a band on each front arm
        tip, root = (np.array(p) for p in ARMS[arm])
        length, R = along(root, tip + (0, 0, -0.0070))
        s = length - 0.0330
        both(m, place(loft([(s, 0, 0, 0.0077, 0.0059, 2.4), (s + 0.0060, 0, 0, 0.0077, 0.0059, 2.4)], "x", end=0.0005, segments=28, rows=3, end_rows=2), root, R))
    m.add(*lathe([(0.0128, 0.0), (0.0128, 0.0010), (0.0116, 0.0010)], (GIMBAL[0] + 0.0180, 0.0035, GIMBAL[2] + 0.0015), "x", segments=40, bevel=0.0003, steps=1))
    return m


def frame_rubber():
    m = Mesh()
    for arm in ARMS:
        foot = leg_path(arm)[1]
        ball = [(0.0065 * np.sin(t), -0.0065 * np.cos(t)) for t in np.linspace(0, 1.75, 9)]
        both(m, lathe(ball + [(0.0062, 0.0060), (0.0052, 0.0075), (0.0040, 0.0120)], foot, "z", segments=24, bevel=0))
    for x, y in ((0.124, 0.0165), (0.148, 0.0150)):  # dampers of the gimbal
        both(m, lathe([(0.0026, 0.0310), (0.0044, 0.0328), (0.0030, 0.0344), (0.0044, 0.0360), (0.0026, 0.0385)], (x, y, 0), "z", segments=18, bevel=0.0004))
    m.add(*block((-0.1530, 0.0, 0.0205), (0.0014, 0.0082, 0.0030), 0.0012))  # door of the charging socket
    # Cable from the fuselage to the gimbal.
    m.add(*tube(spline([(0.122, -0.012, 0.0280), (0.126, -0.021, 0.0170), (0.140, -0.0245, 0.0060), (0.152, -0.0215, 0.0030)], 24), 0.0016, 10))
    return m


def frame_metal():
    m = Mesh()
    for arm in ARMS:
        tip, root = (np.array(p) for p in ARMS[arm])
        for sy in (1, -1):
            bolt(m, root * (1, sy, 1) + (0, 0, 0.0190), "z", 0.0036)
    for x in (0.0472, 0.0928):  # the deck
        for y in (0.0222, -0.0222):
            bolt(m, (x, y, 0.0753), "z", 0.0009)
    for x in (-0.075, -0.025, 0.025, 0.070):  # the belly
        for y in (0.0190, -0.0190):
            bolt(m, (x, y, -0.0021), "-z", 0.0018)
    for y in (0.0262, -0.0262):  # the nose
        for z in (0.0290, 0.0562):
            bolt(m, (0.1390, y, z), "x", 0.0014)
    for side, axis in ((1, "y"), (-1, "-y")):  # axle of the gimbal
        bolt_circle(m, GIMBAL + (0, side * 0.0271, 0), axis, 0.0062, 3, 0.0011)
    glass = Mesh()
    for y in (LENS_Y, -LENS_Y):
        lens(glass, m, (LENS_X - 0.0030, y, LENS_Z), "x", 0.0055, 0.0034)
    lens(glass, m, (0.0, 0.0, -0.0012), "-z", 0.0055, 0.0034)  # downward camera
    lens(glass, m, (GIMBAL[0] + 0.0175, 0.0035, GIMBAL[2] + 0.0015), "x", 0.0088, 0.0050)
    lens(glass, m, (GIMBAL[0] + 0.0175, -0.0108, GIMBAL[2] - 0.0065), "x", 0.0034, 0.0030)
    m.glass = glass
    return m


def frame_lens():
    glass = frame_metal().glass
    # Windows of the range finder beside the downward camera, and of the emitter on the nose.
    glass.add(*block((0.026, 0.0, -0.0030), (0.0090, 0.0055, 0.0012), 0.0011))
    glass.add(*block((0.1392, 0.0, LENS_Z), (0.0012, 0.0095, 0.0044), 0.0011))
    return glass


def light_white():
    m = Mesh()
    slots(m, (-0.1562, 0, 0.0715), (0, 0.0060, 0), 4, (0.0008, 0.0018, 0.0009), 0.0007)  # charge of the battery
    pill(m, (0.1395, 0, 0.0390), (0.0010, 0.0120, 0.0009), 0.0008)  # status, on the nose
    return m


def light_side():
    """Position light under the end of a left arm: red; mirrored for the right: green."""
    m = Mesh()
    for arm in ARMS:
        tip = np.array(ARMS[arm][0])
        out = unit(np.array([np.sign(tip[0]) * 0.35, 1.0, 0]))
        m.add(*place(block((0, 0, 0), (0.0012, 0.0050, 0.0016), 0.0011), tip + out * 0.0150 + (0, 0, -0.0040),
                     np.stack([out, np.cross((0, 0, 1), out), (0, 0, 1)], axis=1)))
    return m


# ---------------------------------------------------------------------------------------------------- motor and propeller

def motor_dark():
    """Base, flux ring with its chamfers, and the spoked lid of the bell."""
    m = Mesh()
    m.add(*lathe([(0.0132, 0.0004), (0.0132, 0.0022), (0.0090, 0.0034), (0.0050, 0.0034)], (0, 0, 0), "z", segments=36, bevel=0.0004, steps=1))
    m.add(*lathe([(0.0120, 0.0038), (0.0140, 0.0038), (0.0140, 0.0108), (0.0132, 0.0122), (0.0120, 0.0122), (0.0120, 0.0038)], (0, 0, 0), "z", segments=48,
                 bevel=0.0005, steps=1))
    lid = circle(0.0134, segments=54)
    windows = []
    for k in range(6):
        t = np.linspace(np.radians(9), np.radians(51), 6) + k * np.pi / 3
        ring = np.concatenate([np.stack([0.0117 * np.cos(t), 0.0117 * np.sin(t)], axis=1), np.stack([0.0062 * np.cos(t), 0.0062 * np.sin(t)], axis=1)[::-1]])
        windows.append(rounded(ring, 0.0008, 2))
    m.add(*plate(lid, 0.0118, 0.0136, bevel=0.0004, steps=1, holes=windows))
    m.add(*lathe([(0.0058, 0.0130), (0.0058, 0.0148), (0.0050, 0.0156), (0, 0.0156)], (0, 0, 0), "z", segments=28, bevel=0.0005, steps=1))
    return m


def motor_copper():
    """Twelve wound teeth of the stator, seen through the lid and the gap."""
    m = Mesh()
    for k in range(12):
        for z in np.linspace(0.0045, 0.0109, 4):
            m.add(*turned_by(block((0.0088, 0, z), (0.0026, 0.0019, 0.0008), 0.0007, steps=1), "z", 30 * k + 15))
    return m


def propeller():
    """Two folding blades, counterclockwise from above; the origin is in the disc, 0.018 m over the foot of the motor."""
    m = Mesh()
    r = 0.0165 + 0.112 * np.concatenate([np.linspace(0, 0.86, 15), 0.87 + 0.13 * np.sin(np.linspace(0, np.pi / 2, 10))])
    x = (r - r[0]) / (r[-1] - r[0])
    chord = 0.0085 + 0.0185 * np.sin(np.pi * np.clip(x, 0, 1) ** 0.72) ** 0.9 * (1 - 0.45 * x) + 0.003 * x
    tip = np.clip((x - 0.87) / 0.13, 0, 1)
    chord *= np.sqrt(np.maximum(1 - tip**2 * 0.998, 0))
    pitch = np.degrees(np.arctan2(0.114, 2 * np.pi * np.maximum(r, 0.030)))  # 4.5 inches per turn
    sweep = 0.0030 * np.sin(np.pi * x) - 0.0075 * x**3 - 0.003 * tip**2
    rise = 0.0040 * x**2 + 0.012 * tip**3 * 0.12
    wing = blade(list(zip(r, chord, pitch, sweep, rise)), 1, thickness=0.085, camber=0.045, points=26)
    for turn in (0, 180):
        m.add(*turned_by(wing, "z", turn))
        root = rounded([(0.0065, -0.0046), (0.0130, -0.0052), (0.0215, -0.0042), (0.0215, 0.0042), (0.0130, 0.0052), (0.0065, 0.0046)], 0.003)
        m.add(*turned_by(plate(root, -0.0020, 0.0022, bevel=0.0009), "z", turn))
    hub = rounded([(-0.0135, -0.0048), (0.0135, -0.0048), (0.0135, 0.0048), (-0.0135, 0.0048)], 0.0047, 6)
    for low, high in ((-0.0046, -0.0023), (0.0025, 0.0044)):
        m.add(*plate(hub, low, high, bevel=0.0006))
    m.add(*lathe([(0.0040, -0.004), (0.0040, 0.0040)], (0, 0, 0), "z", segments=20, bevel=0))
    return m


def propeller_metal():
    m = Mesh()
    for x in (0.0098, -0.0098):
        bolt(m, (x, 0, 0.0044), "z", 0.0019)
    m.add(*lathe([(0.0030, 0.0040), (0.0030, 0.0062), (0.0022, 0.0070), (0, 0.0070)], (0, 0, 0), "z", segments=20, bevel=0.0004))
    return m


def write_disc(folder):
    """The disc of a propeller in flight as the eye sees it: a translucent ring. OBJ with its material, for [[visual]]."""
    turns = 2 * np.pi * np.arange(48) / 48
    rings = [(0.0165, -0.0005), (0.1285, 0.0040)]
    lines = ["mtllib propeller_disc.mtl", "usemtl disc"]
    lines += [f"v {r * np.cos(a):.5f} {r * np.sin(a):.5f} {z:.5f}" for r, z in rings for a in turns]
    lines += [f"f {k + 1} {k + 49} {(k + 1) % 48 + 49} {(k + 1) % 48 + 1}" for k in range(48)]
    (folder / "propeller_disc.obj").write_text("\n".join(lines) + "\n")
    (folder / "propeller_disc.mtl").write_text("newmtl disc\nKd 0.06 0.06 0.065\nNs 40\nd 0.3\n")


PARTS = {
    "frame_shell": frame_shell, "frame_dark": frame_dark, "battery_shell": battery_shell, "frame_trim": frame_trim, "frame_rubber": frame_rubber,
    "frame_metal": frame_metal, "frame_lens": frame_lens, "light_white": light_white, "light_side": light_side, "motor_dark": motor_dark,
    "motor_copper": motor_copper, "propeller": propeller, "propeller_metal": propeller_metal,
}

if __name__ == "__main__":
    write_parts(PARTS, pathlib.Path(__file__).parent / "meshes",
                {"light_side": 2, "motor_dark": 4, "motor_copper": 4, "propeller": 4, "propeller_metal": 4})
    write_disc(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "meshes")
