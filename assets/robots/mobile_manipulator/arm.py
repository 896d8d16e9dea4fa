"""Meshes of the arm in the frames of their links. At zero the upper arm points backwards, the forearm and
the gripper forwards."""

import numpy as np
from mesh_parts import Mesh, block, bolt, bolt_circle, cable_gland, fins, lathe, loft, plate, rounded, spline, tube
from mesh_parts.joints import SIDES, cap, cheeks, end_bolts, housing

R = 0.036  # radius of a joint's housing


def base_dark():
    m = Mesh()
    m.add(*lathe([(0, 0), (0.058, 0), (0.058, 0.007), (0.0545, 0.0095), (0.043, 0.0095), (0.0405, 0.012), (0.0405, 0.050), (0.037, 0.0545),
                  (0, 0.0545)],
                 (0, 0, 0), "z", segments=34, bevel=0.0015, steps=1))
    m.add(*block((-0.043, 0, 0.027), (0.010, 0.017, 0.015), 0.004, steps=1))
    cable_gland(m, (-0.052, 0, 0.025), "-x", 0.013)
    for k in range(4):
        m.add(*lathe([(0.0412, 0.018 + 0.0070 * k), (0.0425, 0.0185 + 0.0070 * k), (0.0425, 0.0207 + 0.0070 * k), (0.0412, 0.0212 + 0.0070 * k)],
                     (0, 0, 0), "z", segments=34, bevel=0))
    return m


def base_steel():
    m = Mesh()
    for k in range(8):
        a = np.pi / 8 + k * np.pi / 4
        bolt(m, (0.0495 * np.cos(a), 0.0495 * np.sin(a), 0.0095), "z", 0.0026, segments=8)
    return m


def link1_shell():
    """The turret: a round foot that widens into the shoulder's housing."""
    m = Mesh()
    m.add(*loft([(-0.003, 0, 0, 0.0385, 0.0385, 2.0), (0.012, 0, 0, 0.0385, 0.0385, 2.1), (0.030, 0, 0, 0.0365, 0.0330, 2.6),
                 (0.050, 0, 0, 0.0335, 0.0310, 3.0)],
                "z", end=(0.003, 0.004), segments=32, rows=7, end_rows=4, seams=(0.006,)))
    return m


def link1_dark():
    return housing(Mesh(), (0, 0, 0.045), "y", -0.034, 0.034, R)


def link2_shell():
    m = Mesh()
    m.add(*loft([(-0.322, 0, 0, 0.0255, 0.0270, 3.0), (-0.25, 0, 0, 0.0240, 0.0270, 3.4), (-0.14, 0, 0, 0.0260, 0.0305, 3.6),
                 (-0.062, 0, 0, 0.0335, 0.0330, 4.0),
                 (-0.040, 0, 0, 0.0340, 0.0300, 4.0)], "x", end=(0.004, 0.006), segments=30, rows=9, end_rows=4, seams=(-0.285, -0.085)))
    shoulder = [(0.036, -0.026), (0.036, 0.026), (0.0, 0.036), (-0.050, 0.034), (-0.086, 0.022), (-0.086, -0.022), (-0.050, -0.034), (0.0, -0.036)]
    return cheeks(m, shoulder, 0.020, 0.0350, 0.0125)


def link2_dark():
    m = housing(Mesh(), (-0.35, 0, 0), "y", -0.034, 0.034, R, ribs=4)
    for s in SIDES:
        cap(m, (0, s * 0.0470, 0), "y" if s > 0 else "-y", 0.030, 0.0075)
    m.add(*block((-0.18, 0, 0.0305), (0.050, 0.010, 0.003), 0.002))
    return m.add(*tube(spline([(-0.055, 0.018, 0.033), (-0.10, 0.014, 0.0365), (-0.19, 0, 0.0365), (-0.27, -0.010, 0.034), (-0.310, -0.016, 0.031)],
                              24), 0.0034, 8))


def link2_steel():
    m = end_bolts(Mesh(), (0, 0, 0), 0.0538, 0.0215)
    for s in SIDES:
        for x, z in ((-0.074, 0.012), (-0.074, -0.012)):
            bolt(m, (x, s * 0.0474, z), "y" if s > 0 else "-y", 0.0022, segments=8)
    return m


def link3_shell():
    m = Mesh()
    elbow = [(-0.035, -0.024), (-0.033, 0.020), (-0.010, 0.058), (0.020, 0.083), (0.078, 0.083), (0.086, 0.034), (0.046, 0.010), (0.034, -0.024), (0,
            -0.036)]
    cheeks(m, elbow, 0.018, 0.0350, 0.0115)
    m.add(*loft([(0.018, 0, 0.0575, 0.0345, 0.0245, 4.0), (0.060, 0, 0.0575, 0.0345, 0.0250, 4.0), (0.095, 0, 0.0570, 0.0270, 0.0245, 3.2),
                 (0.150, 0, 0.0570, 0.0250, 0.0240, 3.0),
                 (0.192, 0, 0.0570, 0.0265, 0.0280, 2.8)], "x", end=(0.008, 0.004), segments=30, rows=9, end_rows=4, seams=(0.108, 0.170)))
    return m


def link3_dark():
    m = housing(Mesh(), (0.218, 0, 0.057), "y", -0.0305, 0.0305, 0.0335, ribs=4, segments=30)
    for s in SIDES:
        cap(m, (0, s * 0.0460, 0), "y" if s > 0 else "-y", 0.029, 0.0075)
    fins(m, (0.135, 0, 0.0820), (0.026, 0.010, 0.0040), 8, "x", 0.0018)
    return m


def link3_steel():
    m = end_bolts(Mesh(), (0, 0, 0), 0.0528, 0.0205)
    for s in SIDES:
        for x, z in ((0.070, 0.072), (0.073, 0.042), (0.022, 0.072)):
            bolt(m, (x, s * 0.0464, z), "y" if s > 0 else "-y", 0.0020, segments=8)
    return m


def link4_shell():
    m = Mesh()
    fork = [(-0.030, -0.020), (-0.030, 0.020), (0.0, 0.0325), (0.046, 0.025), (0.052, 0.020), (0.052, -0.020), (0.046, -0.025), (0.0, -0.0325)]
    cheeks(m, fork, 0.016, 0.0315, 0.0095)
    return m.add(*loft([(0.036, 0, 0, 0.0400, 0.0245, 4.0), (0.050, 0, 0, 0.0400, 0.0255, 4.0), (0.070, 0, 0, 0.0300, 0.0270, 2.6)], "x",
                       end=(0.004, 0.002), segments=32, rows=5, end_rows=4))


def link4_dark():
    m = housing(Mesh(), (0.07, 0, 0), "z", -0.0300, 0.0300, 0.0335)
    for s in SIDES:
        cap(m, (0, s * 0.0405, 0), "y" if s > 0 else "-y", 0.0255, 0.0065)
        bolt_circle(m, (0, s * 0.0463, 0), "y" if s > 0 else "-y", 0.0190, 5, 0.0017, segments=8)
    return m


def link5_shell():
    m = Mesh()
    outline = rounded([(-0.030, -0.020), (-0.030, 0.020), (0.0, 0.0325), (0.040, 0.030), (0.044, 0.024), (0.044, -0.024), (0.040, -0.030),
                       (0.0, -0.0325)][::-1], 0.015, steps=5)
    for s in SIDES:
        low, high = sorted((s * 0.0310, s * 0.0400))
        m.add(*plate(outline, low, high, "z", bevel=0.0020, steps=2))
    return m.add(*lathe([(0, 0.036), (0.0405, 0.036), (0.0425, 0.038), (0.0425, 0.046), (0.0385, 0.0485), (0, 0.0485)], (0, 0, 0), "x", segments=34,
                        bevel=0.0015, steps=1))


def link5_dark():
    m = Mesh()
    for s in SIDES:
        cap(m, (0, 0, s * 0.0395), "z" if s > 0 else "-z", 0.0245, 0.0060)
        bolt_circle(m, (0, 0, s * 0.0448), "z" if s > 0 else "-z", 0.0182, 5, 0.0017, segments=8)
    return m


def link6_shell():
    m = Mesh()
    return m.add(*lathe([(0, 0.0), (0.0345, 0.0), (0.0365, 0.002), (0.0365, 0.016), (0.0345, 0.0175), (0, 0.0175)], (0, 0, 0), "x", segments=34,
                        bevel=0.0008, steps=1))


def link6_dark():
    m = housing(Mesh(), (0, 0, 0), "x", 0.016, 0.0505, 0.0345, ribs=4)
    bolt_circle(m, (0.002, 0, 0), "-x", 0.0315, 6, 0.0016, segments=8)
    return m


PARTS = {"arm_base_dark": base_dark, "arm_base_steel": base_steel, "arm_link1_shell": link1_shell, "arm_link1_dark": link1_dark,
         "arm_link2_shell": link2_shell,
         "arm_link2_dark": link2_dark, "arm_link2_steel": link2_steel, "arm_link3_shell": link3_shell, "arm_link3_dark": link3_dark,
         "arm_link3_steel": link3_steel,
         "arm_link4_shell": link4_shell, "arm_link4_dark": link4_dark, "arm_link5_shell": link5_shell, "arm_link5_dark": link5_dark,
         "arm_link6_shell": link6_shell, "arm_link6_dark": link6_dark}
