#!/usr/bin/env python3
"""Makes the drawn meshes of the quadruped: meshes/*.obj, one file per link and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: those of the links in quadruped.xml (x ahead, y left, z up); legs are made for the left side
and mirrored in the MJCF. Normals are smooth except at edges sharper than 40 degrees. Texture coordinates run around
and along each part.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from mesh_parts import Mesh, block, bolt, bolt_circle, lathe, loft, pill  # noqa: E402

# ---------------------------------------------------------------------------------------------------- trunk

HIP_X, HIP_Y = 0.1881, 0.04675


def trunk_shell():
    m = Mesh()
    # s = x; section in (y, z): centre, half width, half height, squareness.
    m.add(*loft([(-0.212, 0, 0.012, 0.041, 0.027, 3.6), (-0.17, 0, 0.0165, 0.0455, 0.0345, 4.2),
                 (-0.06, 0, 0.0185, 0.0485, 0.0385, 4.6), (0.06, 0, 0.0185, 0.0485, 0.0385, 4.6),
                 (0.17, 0, 0.0165, 0.0455, 0.0345, 4.2), (0.212, 0, 0.013, 0.042, 0.029, 3.6)],
                "x", end=0.014, segments=60, rows=30, end_rows=6, seams=(-0.118, 0.118)))
    # Head: from the neck seam to the face, chin drawn back.
    m.add(*loft([(0.213, 0, 0.0115, 0.041, 0.029, 3.6), (0.24, 0, 0.0125, 0.0435, 0.034, 3.8),
                 (0.272, 0, 0.0135, 0.0435, 0.0335, 4.0), (0.296, 0, 0.016, 0.040, 0.0285, 4.0)],
                "x", end=(0.004, 0.013), segments=60, rows=14))
    # Fairings over the four hip motors.
    for sx in (1, -1):
        for sy in (1, -1):
            m.add(*loft([(sx * 0.148 - 0.038, sy * 0.044, 0.0, 0.034, 0.0385, 2.6), (sx * 0.148, sy * 0.046, 0.0, 0.0385, 0.0425, 2.5),
                         (sx * 0.148 + 0.038, sy * 0.044, 0.0, 0.034, 0.0385, 2.6)], "x", end=0.010, segments=40, rows=8, end_rows=6))
    return m


def trunk_dark():
    m = Mesh()
    # Chassis seen in the gap, and the belly pan under it.
    m.add(*loft([(-0.203, 0, -0.012, 0.038, 0.026, 5), (0.203, 0, -0.012, 0.038, 0.026, 5)], "x", end=0.006, segments=48, rows=4))
    m.add(*loft([(-0.198, 0, -0.037, 0.036, 0.012, 4), (-0.15, 0, -0.041, 0.0435, 0.0155, 4.6), (0.15, 0, -0.041, 0.0435, 0.0155, 4.6),
                 (0.198, 0, -0.037, 0.036, 0.012, 4)], "x", end=0.010, segments=44, rows=12, end_rows=5, seams=(-0.08, 0.08)))
    # Neck ring between body and head.
    m.add(*loft([(0.204, 0, 0.012, 0.0385, 0.0265, 3.6), (0.222, 0, 0.012, 0.0385, 0.0265, 3.6)], "x", end=0.002, segments=56, rows=3))
    # Rails on the back, with feet and screws, for a payload.
    for sy in (1, -1):
        m.add(*block((0, sy * 0.030, 0.0605), (0.092, 0.0042, 0.0038), 0.0022))
        for x in (-0.075, -0.025, 0.025, 0.075):
            m.add(*block((x, sy * 0.030, 0.0555), (0.008, 0.0066, 0.0032), 0.0022))
            bolt(m, (x, sy * 0.030, 0.0643), "z", 0.0023)
    # Cooling slots on the flanks and behind.
    for sy in (1, -1):
        for k in range(7):
            pill(m, (-0.042 + 0.014 * k, sy * 0.0482, 0.022), (0.0026, 0.0012, 0.0115), 0.0011)
    m.add(*block((-0.2095, 0, 0.012), (0.0055, 0.027, 0.0145), 0.004))
    # Hip motors: the flanges on both faces of each fairing.
    for sx in (1, -1):
        for sy in (1, -1):
            for face in (1, -1):
                x = sx * 0.148 + face * 0.0355
                axis = "x" if face > 0 else "-x"
                m.add(*lathe([(0.0325, -0.004), (0.0325, 0.0052), (0.0255, 0.0052), (0.0245, 0.0036), (0.010, 0.0036), (0.009, 0.0062), (0, 0.0062)],
                             (x, sy * HIP_Y, 0), axis, segments=32, steps=1))
                bolt_circle(m, (x + face * 0.0052, sy * HIP_Y, 0), axis, 0.0290, 6, 0.0019)
    return m


def trunk_lens():
    m = Mesh()
    # The visor: one glossy black bar around the face.
    m.add(*loft([(-0.0385, 0.016, 0.286, 0.0125, 0.0105, 3.2), (-0.026, 0.016, 0.2895, 0.0145, 0.0115, 3.6), (0.026, 0.016, 0.2895, 0.0145, 0.0115, 3.6),
                 (0.0385, 0.016, 0.286, 0.0125, 0.0105, 3.2)], "y", end=0.007, segments=40, rows=12))
    for y, r in ((0.0225, 0.0062), (-0.0225, 0.0062), (0.0, 0.0040)):
        dome = [(r * np.cos(t), 0.30 * r * np.sin(t)) for t in np.linspace(0, np.pi / 2, 7)]
        m.add(*lathe(dome, (0.3018, y, 0.0165), "x", segments=28, bevel=0))
    # Rear sensor window.
    m.add(*block((-0.2150, 0, 0.0165), (0.0015, 0.015, 0.0050), 0.0014))
    return m


def trunk_ring():
    """Bright metal trim: lens rings, the seam of the head, the lifting eye."""
    m = Mesh()
    for y, r in ((0.0225, 0.0062), (-0.0225, 0.0062), (0.0, 0.0040)):
        m.add(*lathe([(r + 0.0026, -0.003), (r + 0.0026, 0.0012), (r + 0.0010, 0.0020), (r, 0.0010), (r, -0.001)],
                     (0.3006, y, 0.0165), "x", segments=32, bevel=0.0004, steps=2))
    return m


def trunk_light():
    m = Mesh()
    pill(m, (0.2950, 0, -0.0035), (0.0024, 0.0130, 0.0015), 0.0014)
    pill(m, (-0.2152, 0, 0.0045), (0.0012, 0.0110, 0.0011), 0.0010)
    return m


# ---------------------------------------------------------------------------------------------------- legs (left)

def hip_dark():
    """Thigh motor in the hip link: axis y, fins around it."""
    m = Mesh()
    profile = [(0, 0.0), (0.031, 0.0), (0.034, 0.003), (0.043, 0.003)]
    h = 0.003
    for _ in range(4):
        profile += [(0.043, h + 0.0028), (0.0410, h + 0.0034), (0.0410, h + 0.0046), (0.043, h + 0.0052)]
        h += 0.0058
    profile += [(0.043, 0.036), (0.0405, 0.038), (0.034, 0.038), (0.033, 0.041), (0, 0.041)]
    m.add(*lathe(profile, (0, 0.0215, 0), "y", segments=52, bevel=0.0007, steps=1))
    bolt_circle(m, (0, 0.0215 + 0.038, 0), "y", 0.0372, 10, 0.0016)
    # Axle of the hip joint between the two flanges of the trunk.
    m.add(*lathe([(0, -0.010), (0.019, -0.010), (0.019, 0.010), (0, 0.010)], (0, 0, 0), "x", segments=32))
    return m


def hip_shell():
    """Bracket from the hip axle to the thigh motor."""
    m = Mesh()
    m.add(*loft([(-0.006, 0, 0, 0.0195, 0.0195, 2.2), (0.012, 0, 0, 0.026, 0.024, 2.4), (0.0275, 0, 0, 0.037, 0.0365, 2.3)], "y",
                end=(0.004, 0.005), segments=44, rows=8))
    return m


def thigh_dark():
    m = Mesh()
    # Knee motor on the hip axis, outside.
    profile = [(0, -0.0215), (0.030, -0.0215), (0.0375, -0.0185), (0.0375, 0.0175), (0.036, 0.0175), (0, 0.0175)]
    m.add(*lathe(profile, (0, 0, 0), "y", segments=44, bevel=0.0014))
    # Knee axle and fork.
    m.add(*lathe([(0, -0.0185), (0.0155, -0.0185), (0.0175, -0.0165), (0.0175, 0.0165), (0.0155, 0.0185), (0, 0.0185)], (0, 0, -0.213), "y",
                 segments=40, bevel=0.001))
    bolt_circle(m, (0, 0.0182, -0.213), "y", 0.0105, 5, 0.0019)
    bolt_circle(m, (0, -0.0182, -0.213), "-y", 0.0105, 5, 0.0019)
    return m


def thigh_shell():
    m = Mesh()
    # Beam from the motor to the knee, s = z downwards to upwards; section in (x, y).
    r = 0.0420
    head = [(r * np.sin(t), 0, 0, r * np.cos(t), 0.0160 - 0.002 * max(0.0, np.sin(t)) ** 2, 5.0) for t in np.radians([-25, 0, 20, 40, 55, 68, 78])]
    m.add(*loft([(-0.228, 0.0000, 0, 0.0165, 0.0125, 2.8), (-0.205, -0.001, 0, 0.0185, 0.0140, 3.0), (-0.16, -0.0055, 0, 0.0200, 0.0145, 3.2),
                 (-0.09, -0.0085, 0, 0.0265, 0.0155, 3.8), (-0.045, -0.0040, 0, 0.0345, 0.0160, 4.6)] + head,
                "z", end=(0.010, 0.0025), segments=48, rows=34, end_rows=6, seams=(-0.178,)))
    # Painted cover of the knee motor, dished.
    m.add(*lathe([(0.0350, 0.015), (0.0350, 0.0205), (0.0320, 0.0235), (0.0225, 0.0235), (0.0205, 0.0218), (0, 0.0218)], (0, 0, 0), "y",
                 segments=44, bevel=0.0018, steps=3))
    return m


def thigh_trim():
    """Accent: the ring of the motor cover and a cap on it."""
    m = Mesh()
    m.add(*lathe([(0.0205, 0.0205), (0.0205, 0.0226), (0.0178, 0.0226), (0.0178, 0.0205)], (0, 0, 0), "y", segments=48, bevel=0.0005, steps=2))
    return m


def thigh_metal():
    m = Mesh()
    bolt_circle(m, (0, 0.0232, 0), "y", 0.0272, 6, 0.0022, phase=0.3)
    m.add(*lathe([(0.0085, 0.020), (0.0085, 0.0235), (0.0045, 0.0235), (0.0035, 0.0225), (0, 0.0225)], (0, 0, 0), "y", segments=28, bevel=0.0006))
    return m


def calf_dark():
    m = Mesh()
    # Tube, bowed backwards, flattening below the knee.
    m.add(*loft([(-0.204, 0.0005, 0, 0.0090, 0.0090, 2.0), (-0.17, 0.0035, 0, 0.0092, 0.0088, 2.1), (-0.11, 0.0080, 0, 0.0112, 0.0092, 2.4),
                 (-0.05, 0.0075, 0, 0.0150, 0.0095, 2.8), (-0.012, 0.002, 0, 0.0170, 0.0095, 2.8), (0.014, 0, 0, 0.0120, 0.0090, 2.4)],
                "z", end=(0.003, 0.008), segments=32, rows=30, end_rows=5))
    return m


def calf_shell():
    """Guard on the front of the calf below the knee."""
    m = Mesh()
    m.add(*loft([(-0.122, 0.0075, 0, 0.0132, 0.0112, 2.6), (-0.09, 0.0090, 0, 0.0148, 0.0116, 2.8), (-0.05, 0.0082, 0, 0.0172, 0.0120, 2.9),
                 (-0.028, 0.0055, 0, 0.0180, 0.0118, 2.8)], "z", end=(0.0035, 0.004), segments=36, rows=16, end_rows=5))
    return m


def calf_rubber():
    m = Mesh()
    # The ball, its collar and three grooves; s runs up the calf.
    ball = [(0.022 * np.sin(t), -0.022 * np.cos(t)) for t in np.linspace(0.0, 2.30, 18)]
    collar = [(0.0150, 0.0215), (0.0150, 0.0255), (0.0136, 0.0262), (0.0136, 0.0285), (0.0144, 0.0292), (0.0144, 0.0330), (0.0115, 0.0362), (0.0088, 0.0362)]
    m.add(*lathe(ball + collar, (0, 0, -0.213), "z", segments=36, bevel=0))
    return m


PARTS = {
    "trunk_shell": trunk_shell, "trunk_dark": trunk_dark, "trunk_lens": trunk_lens, "trunk_ring": trunk_ring, "trunk_light": trunk_light,
    "hip_dark": hip_dark, "hip_shell": hip_shell, "thigh_dark": thigh_dark, "thigh_shell": thigh_shell, "thigh_trim": thigh_trim,
    "thigh_metal": thigh_metal, "calf_dark": calf_dark, "calf_shell": calf_shell, "calf_rubber": calf_rubber,
}


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "meshes")
    folder.mkdir(parents=True, exist_ok=True)
    total = 0
    for name, make in PARTS.items():
        count = make().write(folder / f"{name}.obj")
        total += count * (1 if name.startswith("trunk") else 4)
        print(f"{name:12} {count:6} triangles")
    print(f"{'whole robot':12} {total:6} triangles")


if __name__ == "__main__":
    main()
