"""Meshes of the legs: hip, thigh and calf of the left front leg, in the frames of their links. The others are mirrored
in the MJCF."""

import numpy as np
from mesh_parts import Mesh, block, bolt, bolt_circle, lathe, loft, plate, rounded, turned_by

MOTOR = 0.076  # radius of the thigh's motor
LINK = 0.35


def hip_dark():
    """The axle between the trunk's flanges, and the thigh's motor with cooling ribs around it."""
    m = Mesh()
    m.add(*lathe([(0, -0.086), (0.030, -0.086), (0.036, -0.080), (0.036, 0.080), (0.030, 0.086), (0, 0.086)], (0, 0, 0), "x", segments=26, steps=1))
    for x in (-0.066, 0.066):
        m.add(*lathe([(0.034, -0.012), (0.0445, -0.010), (0.0445, 0.010), (0.034, 0.012)], (x, 0, 0), "x", segments=28, steps=1))
    profile = [(0, 0.030), (0.060, 0.030), (0.066, 0.036), (MOTOR, 0.038)]
    h = 0.040
    for _ in range(5):
        profile += [(MOTOR, h + 0.0042), (MOTOR - 0.0036, h + 0.0048), (MOTOR - 0.0036, h + 0.0068), (MOTOR, h + 0.0074)]
        h += 0.0086
    profile += [(MOTOR, 0.088), (MOTOR - 0.004, 0.092), (0, 0.092)]
    return m.add(*lathe(profile, (0, 0, 0), "y", segments=34, bevel=0))


def hip_shell():
    """The bracket from the axle to the motor, with a panel gap."""
    m = Mesh()
    m.add(*loft([(-0.046, 0, 0, 0.040, 0.040, 2.4), (-0.012, 0, 0, 0.047, 0.052, 2.8), (0.020, 0, 0, 0.060, 0.066, 2.6),
                 (0.038, 0, 0, 0.068, 0.072, 2.3)],
                "y", end=(0.010, 0.004), segments=36, rows=10, end_rows=4, seams=(0.006,)))
    return m


def hip_steel():
    m = Mesh()
    for axis, x in (("x", 0.0775), ("-x", -0.0775)):
        bolt_circle(m, (x, 0, 0), axis, 0.0405, 6, 0.0028, segments=8)
    return m


def thigh_dark():
    m = Mesh()
    profile = [(0, -0.0345), (0.054, -0.0345), (0.058, -0.031), (0.058, 0.026), (0, 0.026)]
    m.add(*lathe(profile, (0, 0, 0), "y", segments=36, bevel=0.0016, steps=1))
    # Knee: axle between the cheeks of the beam.
    m.add(*lathe([(0, -0.034), (0.024, -0.034), (0.029, -0.029), (0.029, 0.029), (0.024, 0.034), (0, 0.034)], (0, 0, -LINK), "y", segments=26,
                 bevel=0.0012, steps=1))
    # Machined cover of the transmission on the outside of the beam, with two lightening pockets.
    cover = rounded([(-0.318, -0.020), (-0.318, 0.016), (-0.10, 0.030), (-0.066, 0.028), (-0.066, -0.036), (-0.10, -0.038)], 0.012)
    pockets = [rounded([(-0.290, -0.013), (-0.290, 0.009), (-0.215, 0.0145), (-0.215, -0.020)], 0.007),
               rounded([(-0.195, -0.022), (-0.195, 0.0155), (-0.115, 0.021), (-0.115, -0.030)], 0.008)]
    return m.add(*plate(cover, 0.0225, 0.0305, "y", bevel=0.0012, holes=pockets))


def thigh_shell():
    m = Mesh()
    r = 0.071
    head = [(r * np.sin(t), 0, 0, r * np.cos(t), 0.027 - 0.003 * max(0.0, np.sin(t)) ** 2, 5.0) for t in np.radians([-25, 0, 20, 40, 55, 68, 78])]
    m.add(*loft([(-0.377, 0.0, 0, 0.027, 0.021, 3.0), (-0.340, -0.001, 0, 0.031, 0.024, 3.2), (-0.27, -0.005, 0, 0.031, 0.0245, 3.6),
                 (-0.16, -0.008, 0, 0.041, 0.026, 4.2), (-0.075, -0.004, 0, 0.058, 0.027, 4.8)] + head,
                "z", end=(0.014, 0.004), segments=32, rows=15, end_rows=4, seams=(-0.298,)))
    # Cover of the knee's motor: three steps and a dished middle.
    return m.add(*lathe([(0.0625, 0.024), (0.0625, 0.034), (0.058, 0.0385), (0.044, 0.0385), (0.042, 0.0365), (0.030, 0.0365), (0.028, 0.0385),
                         (0, 0.0385)],
                        (0, 0, 0), "y", segments=36, bevel=0.0022, steps=2))


def thigh_trim():
    """A painted ring on the motor's cover and an inlay in the upper pocket."""
    m = Mesh()
    m.add(*lathe([(0.0425, 0.0362), (0.0425, 0.0378), (0.0300, 0.0378), (0.0300, 0.0362)], (0, 0, 0), "y", segments=34, bevel=0.0006, steps=1))
    return m.add(*plate(rounded([(-0.190, -0.0195), (-0.190, 0.013), (-0.121, 0.018), (-0.121, -0.0265)], 0.006), 0.022, 0.0268, "y"))


def thigh_steel():
    m = Mesh()
    for k in range(6):
        a = 2 * np.pi * k / 6 + 0.2
        bolt(m, (0.0515 * np.sin(a), 0.0380, 0.0515 * np.cos(a)), "y", 0.0027, segments=8)
    for z, x in ((-0.306, -0.002), (-0.205, 0.0165), (-0.205, -0.0235), (-0.082, 0.022), (-0.082, -0.030)):
        bolt(m, (x, 0.0304, z), "y", 0.0024, segments=8)
    for y, axis in ((0.0338, "y"), (-0.0338, "-y")):
        bolt_circle(m, (0, y, -LINK), axis, 0.0185, 4, 0.0030, segments=8)
    return m.add(*lathe([(0.013, 0.036), (0.013, 0.0405), (0.009, 0.0410), (0.007, 0.0395), (0, 0.0395)], (0, 0, 0), "y", segments=20, bevel=0.0008,
                        steps=1))


def calf_dark():
    m = Mesh()
    m.add(*loft([(-0.325, 0.001, 0, 0.0155, 0.0155, 2.0), (-0.28, 0.006, 0, 0.0160, 0.0150, 2.2), (-0.18, 0.013, 0, 0.0200, 0.0160, 2.6),
                 (-0.08, 0.012, 0, 0.0260, 0.0170, 3.0), (-0.02, 0.003, 0, 0.0290, 0.0175, 3.0), (0.025, 0, 0, 0.0210, 0.0165, 2.6)],
                "z", end=(0.004, 0.012), segments=22, rows=12, end_rows=4))
    # Push rod of the knee behind the calf.
    m.add(*loft([(-0.12, -0.022, 0, 0.0045, 0.0055, 2.4), (-0.012, -0.0315, 0, 0.0055, 0.0065, 2.4)], "z", end=0.003, segments=14, rows=4,
                end_rows=4))
    return m.add(*block((-0.014, 0, -0.128), (0.013, 0.010, 0.012), 0.004, steps=1))


def calf_shell():
    """Guard over the upper calf, and a bumper below it."""
    m = Mesh()
    m.add(*loft([(-0.205, 0.0145, 0, 0.0205, 0.0190, 2.8), (-0.15, 0.0165, 0, 0.0240, 0.0200, 3.0), (-0.08, 0.0150, 0, 0.0285, 0.0210, 3.2),
                 (-0.045, 0.0105, 0, 0.0290, 0.0205, 3.0)], "z", end=(0.006, 0.006), segments=26, rows=8, end_rows=4, seams=(-0.115,)))
    return m


def calf_rubber():
    """Foot with treads around the ball, and a cap over its collar."""
    m = Mesh()
    r = 0.040
    ball = [(r * np.sin(t), -r * np.cos(t)) for t in np.linspace(0.0, 0.30, 3)]
    for t0 in np.arange(0.36, 1.75, 0.24):  # grooves of 1.6 mm
        ball += [((r + d) * np.sin(t), -(r + d) * np.cos(t)) for t, d in ((t0, 0), (t0 + 0.015, -0.0016), (t0 + 0.07, -0.0016), (t0 + 0.085, 0))]
    ball += [(r * np.sin(t), -r * np.cos(t)) for t in np.linspace(2.0, 2.25, 3)]
    collar = [(0.0265, 0.034), (0.0265, 0.041), (0.0240, 0.0425), (0.0240, 0.0465), (0.0258, 0.048), (0.0258, 0.056), (0.0200, 0.062), (0.0150,
            0.062)]
    m.add(*lathe(ball + collar, (0, 0, -LINK), "z", segments=28, bevel=0))
    for k in range(4):  # knee pad
        m.add(*turned_by(block((0.0305, 0, -0.004), (0.0045, 0.0155, 0.0055), 0.0035, steps=1), "y", -42 + 26 * k))
    return m


PARTS = {"hip_dark": hip_dark, "hip_shell": hip_shell, "hip_steel": hip_steel, "thigh_dark": thigh_dark, "thigh_shell": thigh_shell,
         "thigh_steel": thigh_steel, "thigh_trim": thigh_trim, "calf_dark": calf_dark, "calf_shell": calf_shell, "calf_rubber": calf_rubber}
