"""Meshes of the pelvis and of the left leg, in the frames of their links. The right leg is mirrored in the MJCF. The frames
of hip_roll and hip_yaw lean back by 10 degrees."""

import numpy as np
from mesh_parts import Mesh, block, bolt, bolt_circle, lathe, loft, plate, rounded, spline, tube
from mesh_parts.joints import SIDES, cap, cheeks, end_bolts, housing

KNEE = (-0.078, 0.002, -0.177)  # in the frame of hip_yaw
SOLE = -0.035  # in the frame of ankle_roll


def pelvis_shell():
    m = Mesh()
    m.add(*loft([(-0.128, -0.004, 0, 0.040, 0.030, 3.0), (-0.105, -0.002, 0, 0.054, 0.043, 3.4), (-0.065, 0, 0, 0.064, 0.056, 3.6),
                 (-0.030, 0, 0, 0.060, 0.060, 3.2)],
                "z", end=(0.014, 0.006), segments=44, rows=9, end_rows=4, seams=(-0.088,)))
    return m


def pelvis_dark():
    m = Mesh()
    housing(m, (0, 0, 0), "z", -0.036, 0.012, 0.050, ribs=3, segments=40)
    for s in SIDES:
        housing(m, (0, 0, -0.1027), "y" if s > 0 else "-y", 0.030, 0.066, 0.0455, segments=40)
    # Plate behind, with vents.
    m.add(*plate(rounded([(-0.030, -0.096), (0.030, -0.096), (0.034, -0.048), (-0.034, -0.048)], 0.007), -0.0655, -0.058, "x", bevel=0.001))
    return m


def pelvis_steel():
    m = Mesh()
    bolt_circle(m, (0, 0, 0.0118), "z", 0.044, 8, 0.0022, segments=8)
    for y in (-0.026, 0.026):
        for z in (-0.090, -0.054):
            bolt(m, (-0.0652, y, z), "-x", 0.0020, segments=8)
    return m


def hip_pitch_dark():
    """The pitch motor's output, and the housing of the roll motor."""
    m = Mesh()
    m.add(*lathe([(0, 0.0035), (0.043, 0.0035), (0.0465, 0.007), (0.0465, 0.020), (0.042, 0.024), (0, 0.024)], (0, 0, 0), "y", segments=40,
                 bevel=0.0008, steps=1))
    housing(m, (0, 0.052, -0.030465), "x", -0.058, 0.030, 0.0415, ribs=6, segments=38)
    return m.add(*loft([(0.018, -0.012, 0, 0.034, 0.034, 3.0), (0.036, -0.022, -0.006, 0.034, 0.030, 3.4)], "y", end=0.004, segments=32, rows=5,
                       end_rows=3))


def hip_pitch_shell():
    m = Mesh()
    cap(m, (-0.0565, 0.052, -0.030465), "-x", 0.0395, 0.010)
    return m


def hip_pitch_steel():
    m = Mesh()
    bolt_circle(m, (-0.0660, 0.052, -0.030465), "-x", 0.0325, 6, 0.0019, segments=8)
    bolt_circle(m, (0, 0.0240, 0), "y", 0.0375, 6, 0.0019, segments=8)
    return m


def hip_roll_shell():
    """The yoke from the roll axis, clasped ahead and behind, to the yaw motor."""
    m = Mesh()
    face = [(-0.038, 0.020), (-0.020, 0.038), (0.020, 0.038), (0.038, 0.020), (0.042, -0.030), (0.042, -0.082), (-0.042, -0.082), (-0.042, -0.030)]
    for low, high in ((0.034, 0.0465), (-0.0700, -0.0590)):
        m.add(*plate(rounded(face, 0.016, steps=5), low, high, "x", bevel=0.0025))
    return m.add(*loft([(-0.106, 0.020, 0, 0.0500, 0.0490, 2.5), (-0.088, 0.012, 0, 0.0565, 0.0480, 3.2), (-0.066, -0.010, 0, 0.0570, 0.0440, 4.0),
                        (-0.052, -0.012, 0, 0.0570, 0.0430, 4.4)],
                       "z", end=(0.004, 0.005), segments=44, rows=8, end_rows=4, seams=(-0.097,)))


def hip_roll_dark():
    m = Mesh()
    cap(m, (0.0450, 0, 0), "x", 0.033, 0.0085)
    return m.add(*lathe([(0, -0.124), (0.047, -0.124), (0.047, -0.106), (0, -0.106)], (0.025, 0, 0), "z", segments=40, bevel=0.001, steps=1))


def hip_roll_steel():
    m = Mesh()
    bolt_circle(m, (0.0530, 0, 0), "x", 0.0265, 6, 0.0019, segments=8)
    for y in (-0.030, 0.030):
        bolt(m, (0.0462, y, -0.066), "x", 0.0023, segments=8)
    return m


def hip_yaw_shell():
    m = Mesh()
    m.add(*loft([(-0.236, -0.080, 0.002, 0.040, 0.0315, 3.2), (-0.200, -0.078, 0.002, 0.050, 0.0335, 3.4),
                 (-0.150, -0.064, 0.001, 0.056, 0.0390, 3.2), (-0.090, -0.036, 0, 0.057, 0.0480, 2.8),
                 (-0.040, -0.013, 0, 0.054, 0.0520, 2.5), (-0.002, 0, 0, 0.0495, 0.0495, 2.2)], "z", end=(0.014, 0.004), segments=44, rows=14,
                 end_rows=4, seams=(-0.030, -0.128)))
    return m


def hip_yaw_dark():
    """The knee's motor, and a panel on the outside of the thigh."""
    m = Mesh()
    housing(m, KNEE, "y", -0.0445, 0.0445, 0.0470, segments=44)
    return m.add(*_inlay(-0.126, -0.036, 0.0275, 0.0028))


def _inlay(low, high, half, proud):
    """A panel in the outside of the thigh that stands out from the shell by `proud`."""
    z = np.linspace(low, high, 5)
    x = np.interp(z, [-0.150, -0.090, -0.040], [-0.064, -0.036, -0.013])
    y = np.interp(z, [-0.150, -0.090, -0.040], [0.0400, 0.0480, 0.0520])
    return loft([(k, a - 0.002, b + proud - 0.020, half, 0.020, 4.5) for k, a, b in zip(z, x, y)], "z", end=0.008, segments=28, rows=5, end_rows=3)


def hip_yaw_trim():
    m = Mesh()
    return m.add(*_inlay(-0.094, -0.046, 0.0150, 0.0038))


def hip_yaw_steel():
    m = Mesh()
    end_bolts(m, KNEE, 0.0443, 0.0395, 6, 0.0021)
    return m


def knee_shell():
    """Shin: cheeks around the knee's motor, a shin guard, and a calf behind."""
    m = Mesh()
    side = [(-0.040, 0.010), (-0.022, 0.040), (0.022, 0.040), (0.042, 0.010), (0.043, -0.060), (0.034, -0.105), (-0.034, -0.105), (-0.044, -0.050)]
    cheeks(m, side, 0.020, 0.0465, 0.0095, center=0.0, bevel=0.0022)
    m.add(*loft([(-0.272, 0.003, 0, 0.0240, 0.0255, 2.6), (-0.235, 0.004, 0, 0.0290, 0.0310, 2.8), (-0.17, 0.004, 0, 0.0400, 0.0415, 3.0),
                 (-0.110, 0.004, 0, 0.0460, 0.0500, 3.4),
                 (-0.062, 0.008, 0, 0.0420, 0.0490, 3.6)], "z", end=(0.005, 0.010), segments=44, rows=12, end_rows=4, seams=(-0.090, -0.205)))
    return m


def knee_dark():
    m = Mesh()
    for s in SIDES:
        cap(m, (0, s * 0.0555, 0), "y" if s > 0 else "-y", 0.030, 0.0070)
    # Ankle: motors in the calf, fork below.
    m.add(*loft([(-0.212, -0.020, 0, 0.0180, 0.0330, 3.4), (-0.130, -0.026, 0, 0.0270, 0.0420, 3.4)], "z", end=0.008, segments=36, rows=5,
                end_rows=4))
    m.add(*loft([(-0.300, 0, 0, 0.0130, 0.0150, 2.6), (-0.262, 0.002, 0, 0.0200, 0.0210, 2.6)], "z", end=(0.006, 0.002), segments=30, rows=5,
                end_rows=3))
    m.add(*block((0.0415, 0, -0.020), (0.0070, 0.026, 0.030), 0.006, steps=2))
    return m


def knee_steel():
    """Screws, and the rods that move the ankle."""
    m = Mesh()
    end_bolts(m, (0, 0, 0), 0.0620, 0.0225, 5, 0.0019)
    for s in SIDES:
        rod = [(-0.032, s * 0.024, -0.196), (-0.035, s * 0.0245, -0.250), (-0.037, s * 0.0245, -0.314)]
        m.add(*tube(spline(rod, 8), 0.0042, 12))
        for at in (rod[0], rod[-1]):
            m.add(*lathe([(0, -0.006), (0.0072, -0.006), (0.0072, 0.006), (0, 0.006)], at, "y", segments=16, bevel=0.0008, steps=1))
    return m


def ankle_pitch_steel():
    m = Mesh()
    m.add(*lathe([(0, -0.027), (0.0085, -0.027), (0.0085, 0.027), (0, 0.027)], (0, 0, 0), "y", segments=24, bevel=0.001, steps=1))
    m.add(*lathe([(0, -0.024), (0.0075, -0.024), (0.0075, 0.024), (0, 0.024)], (0, 0, -0.017558), "x", segments=24, bevel=0.001, steps=1))
    return m.add(*block((0, 0, -0.0088), (0.0095, 0.0095, 0.0125), 0.003, steps=1))


def foot_outline(grow=0.0):
    g = grow
    return rounded([(-0.060 - g, -0.024 - g), (-0.060 - g, 0.024 + g), (0.060, 0.034 + g), (0.122 + g, 0.031 + g), (0.141 + g, 0.010),
                    (0.141 + g, -0.010), (0.122 + g, -0.031 - g),
                    (0.060, -0.034 - g)], 0.018, steps=5)


def ankle_roll_shell():
    """Instep and heel."""
    m = Mesh()
    m.add(*loft([(-0.052, 0, -0.0145, 0.0235, 0.0090, 3.4), (-0.020, 0, -0.0100, 0.0270, 0.0135, 3.2), (0.030, 0, -0.0095, 0.0310, 0.0150, 3.0),
                 (0.085, 0, -0.0135, 0.0325, 0.0120, 3.2),
                 (0.137, 0, -0.0175, 0.0270, 0.0080, 3.4)], "x", end=(0.008, 0.008), segments=44, rows=14, end_rows=4, seams=(0.062,)))
    return m


def ankle_roll_dark():
    m = Mesh()
    for x in (-0.0245, 0.0245):  # brackets of the roll axis
        m.add(*plate(rounded([(-0.016, -0.022), (0.016, -0.022), (0.010, 0.009), (-0.010, 0.009)], 0.007, steps=4), x - 0.0042, x + 0.0042, "x",
                     bevel=0.001))
    for s in SIDES:  # ears of the rods
        ear = rounded([(-0.022, -0.026), (-0.022, -0.052), (0.004, -0.047), (0.018, -0.045), (0.018, -0.033), (0.004, -0.031)], 0.005, steps=4)
        low, high = sorted((s * 0.0305, s * 0.0355))
        m.add(*plate(ear, low, high, "y", bevel=0.001))
        m.add(*block((-0.039, s * 0.0270, -0.0165), (0.012, 0.008, 0.005), 0.002, steps=1))
    return m.add(*plate(foot_outline(), -0.0255, -0.0185, "z", bevel=0.0010, steps=1))


def ankle_roll_rubber():
    """Sole with a tread of bars, and a toe cap."""
    m = Mesh()
    m.add(*plate(foot_outline(0.0012), SOLE + 0.003, -0.0248, "z", bevel=0.0016, steps=2))
    for k in range(13):
        x = -0.050 + 0.0148 * k
        half = 0.022 + 0.010 * min(1.0, max(0.0, (x + 0.05) / 0.11)) - (0.012 if x > 0.12 else 0)
        m.add(*block((x, 0, SOLE + 0.0025), (0.0046, half, 0.0025), 0.0009, steps=1))
    return m


CENTRE = {"pelvis_shell": pelvis_shell, "pelvis_dark": pelvis_dark, "pelvis_steel": pelvis_steel}
LEFT = {"hip_pitch_dark": hip_pitch_dark, "hip_pitch_shell": hip_pitch_shell, "hip_pitch_steel": hip_pitch_steel, "hip_roll_shell": hip_roll_shell,
        "hip_roll_dark": hip_roll_dark, "hip_roll_steel": hip_roll_steel, "hip_yaw_shell": hip_yaw_shell, "hip_yaw_dark": hip_yaw_dark,
        "hip_yaw_steel": hip_yaw_steel,
        "hip_yaw_trim": hip_yaw_trim, "knee_shell": knee_shell, "knee_dark": knee_dark, "knee_steel": knee_steel,
        "ankle_pitch_steel": ankle_pitch_steel,
        "ankle_roll_shell": ankle_roll_shell, "ankle_roll_dark": ankle_roll_dark, "ankle_roll_rubber": ankle_roll_rubber}
