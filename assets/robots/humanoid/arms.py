"""Meshes of the left arm and hand, in the frames of their links; the right ones are mirrored in the MJCF. The upper arm
hangs down, the forearm and the hand point ahead."""

import numpy as np
from mesh_parts import Mesh, block, bolt, bolt_circle, lathe, loft, plate, rounded, spline, tube
from mesh_parts.joints import SIDES, cap, cheeks, end_bolts, housing

ROLL = (0, 0.038, -0.013831)  # axis of the roll joint in the frame of shoulder_pitch
ELBOW = (0.015783, 0, -0.080518)  # in the frame of shoulder_yaw
FOREARM = -0.010  # height of the forearm's axis in the frame of the elbow
HAND = 0.046  # from the wrist's pitch axis to its yaw axis


def shoulder_pitch_dark():
    m = Mesh()
    m.add(*lathe([(0, -0.004), (0.038, -0.004), (0.040, -0.002), (0.040, 0.009), (0.036, 0.013), (0, 0.013)], (0, 0, 0), "y", segments=38,
                 bevel=0.0008, steps=1))
    return housing(m, ROLL, "x", -0.040, 0.040, 0.0345, ribs=4, segments=36)


def shoulder_pitch_shell():
    """A pauldron around the roll motor."""
    m = Mesh()
    return m.add(*loft([(0.006, 0, 0, 0.034, 0.034, 2.2), (0.020, -0.006, 0, 0.038, 0.0300, 3.0), (0.038, -0.0135, 0, 0.0370, 0.0310, 3.2),
                        (0.058, -0.0145, 0, 0.0300, 0.0270, 2.8)], "y", end=(0.004, 0.010),
                       segments=40, rows=8, end_rows=4, seams=(0.030,)))


def shoulder_roll_shell():
    m = Mesh()
    face = [(-0.030, 0.014), (-0.014, 0.034), (0.018, 0.034), (0.036, 0.014), (0.040, -0.030), (0.038, -0.058), (-0.028, -0.058), (-0.032, -0.030)]
    for low, high in ((0.0415, 0.0510), (-0.0510, -0.0415)):
        m.add(*plate(rounded(face, 0.015, steps=5), low, high, "x", bevel=0.0022))
    return m.add(*loft([(-0.096, 0, 0.0062, 0.0385, 0.0370, 2.3), (-0.078, 0, 0.0060, 0.0430, 0.0370, 2.8), (-0.055, 0, 0.005, 0.0475, 0.0350, 3.8),
                        (-0.040, 0, 0.004, 0.0475, 0.0340, 4.2)], "z",
                       end=(0.003, 0.005), segments=40, rows=8, end_rows=4, seams=(-0.086,)))


def shoulder_roll_dark():
    m = Mesh()
    for s in SIDES:
        cap(m, (s * 0.0500, 0, 0), "x" if s > 0 else "-x", 0.0265, 0.0065, segments=28)
    return m.add(*lathe([(0, -0.1032), (0.0355, -0.1032), (0.0355, -0.095), (0, -0.095)], (0, 0.0062, 0), "z", segments=36, bevel=0.0008, steps=1))


def shoulder_roll_steel():
    m = Mesh()
    for s in SIDES:
        bolt_circle(m, (s * 0.0560, 0, 0), "x" if s > 0 else "-x", 0.0200, 5, 0.0016, segments=8)
        for y in (-0.018, 0.026):
            bolt(m, (s * 0.0508, y, -0.046), "x" if s > 0 else "-x", 0.0018, segments=8)
    return m


def shoulder_yaw_shell():
    m = Mesh()
    return m.add(*loft([(-0.066, 0.011, 0, 0.0330, 0.0290, 3.4), (-0.045, 0.007, 0, 0.0350, 0.0310, 3.0), (-0.020, 0.002, 0, 0.0360, 0.0350, 2.4),
                        (-0.005, 0, 0, 0.0365, 0.0365, 2.1)], "z",
                       end=(0.006, 0.003), segments=40, rows=8, end_rows=4, seams=(-0.033,)))


def shoulder_yaw_dark():
    return housing(Mesh(), ELBOW, "y", -0.0325, 0.0325, 0.0330, ribs=3, segments=36)


def shoulder_yaw_trim():
    m = Mesh()
    return m.add(*lathe([(0.0355, -0.0035), (0.0374, -0.0030), (0.0374, -0.0005), (0.0355, 0.0)], (0, 0, 0), "z", segments=40, bevel=0.0004, steps=1))


def elbow_shell():
    m = Mesh()
    side = [(-0.032, -0.016), (-0.026, 0.020), (0.0, 0.034), (0.034, 0.018), (0.060, 0.012), (0.060, -0.032), (0.030, -0.034), (0.0, -0.036)]
    cheeks(m, side, 0.014, 0.0340, 0.0090)
    return m.add(*loft([(0.038, 0, FOREARM, 0.0420, 0.0240, 4.0), (0.056, 0.001, FOREARM, 0.0410, 0.0270, 3.4),
                        (0.078, 0.0018, FOREARM, 0.0340, 0.0300, 2.6), (0.0945, 0.0019, FOREARM, 0.0300, 0.0300, 2.1)], "x",
                       end=(0.008, 0.003), segments=40, rows=9, end_rows=4, seams=(0.066,)))


def elbow_dark():
    m = Mesh()
    for s in SIDES:
        cap(m, (0, s * 0.0425, 0), "y" if s > 0 else "-y", 0.0255, 0.0065, segments=28)
    m.add(*block((0.058, 0.0015, 0.0165), (0.014, 0.012, 0.0030), 0.002, steps=1))
    return m.add(*lathe([(0, 0.0925), (0.0275, 0.0925), (0.0275, 0.0995), (0, 0.0995)], (0, 0.0019, FOREARM), "x", segments=34, bevel=0.0008,
                        steps=1))


def elbow_steel():
    m = end_bolts(Mesh(), (0, 0, 0), 0.0485, 0.0190, 5, 0.0016)
    for s in SIDES:
        for x, z in ((0.050, 0.004), (0.050, -0.024)):
            bolt(m, (x, s * 0.0428, z), "y" if s > 0 else "-y", 0.0018, segments=8)
    return m


def wrist_roll_dark():
    m = Mesh()
    m.add(*lathe([(0, 0.001), (0.0285, 0.001), (0.0300, 0.0025), (0.0300, 0.0085), (0.0270, 0.0115), (0, 0.0115)], (0, 0, 0), "x", segments=36,
                 bevel=0.0008, steps=1))
    return cheeks(m, [(0.006, -0.020), (0.006, 0.020), (0.034, 0.021), (0.054, 0.012), (0.054, -0.012), (0.034, -0.021)], 0.010, 0.0275, 0.0060,
                  bevel=0.0012)


def wrist_pitch_shell():
    m = Mesh()
    housing(m, (0, 0, 0), "y", -0.0260, 0.0260, 0.0240, segments=34)
    return m.add(*loft([(0.006, 0, 0, 0.0225, 0.0205, 3.2), (0.030, 0, 0, 0.0235, 0.0195, 3.2), (0.046, 0, 0, 0.0215, 0.0195, 2.4)], "x", end=0.004,
                       segments=36, rows=6, end_rows=4, seams=(0.020,)))


def wrist_pitch_dark():
    m = Mesh()
    for s in SIDES:
        cap(m, (0, s * 0.0325, 0), "y" if s > 0 else "-y", 0.0185, 0.0050, segments=26)
    return housing(m, (HAND, 0, 0), "z", -0.0250, 0.0250, 0.0215, segments=32)


def wrist_yaw_dark():
    """Fork of the wrist, and fingers, slightly bent."""
    m = Mesh()
    for s in SIDES:
        low, high = sorted((s * 0.0250, s * 0.0305))
        m.add(*plate(rounded([(-0.016, -0.014), (-0.016, 0.014), (0.0, 0.020), (0.034, 0.017), (0.034, -0.017), (0.0, -0.020)][::-1], 0.008,
                             steps=4), low, high, "z", bevel=0.001))
    for k, (z, reach) in enumerate(((0.0290, 0.150), (0.0100, 0.158), (-0.0090, 0.155), (-0.0275, 0.146))):
        path = _finger(z, reach)
        m.add(*tube(path[:8], 0.0082, 12)).add(*tube(path[8:15], 0.0076, 12))
        for at, r in ((path[0], 0.0096), (path[8], 0.0086), (path[15], 0.0078)):  # knuckles
            m.add(*lathe([(0, -0.0086), (r, -0.0080), (r, 0.0080), (0, 0.0086)], at, "z", segments=14, bevel=0.001, steps=1))
    thumb = _thumb()
    m.add(*tube(thumb[:9], 0.0080, 14))
    return m.add(*lathe([(0, -0.010), (0.0105, -0.010), (0.0105, 0.010), (0, 0.010)], thumb[0], (0.5, 0.5, 0.7), segments=20, bevel=0.001, steps=1))


def _finger(z, reach):
    return spline([(0.088, 0.003, z), (0.108, 0.004, z), (0.128, -0.002, z), (reach - 0.006, -0.016, z), (reach - 0.002, -0.030, z)], 22)


def _thumb():
    return spline([(0.050, -0.012, 0.036), (0.068, -0.026, 0.046), (0.086, -0.036, 0.046), (0.102, -0.042, 0.040)], 16)


def wrist_yaw_shell():
    """Back of the hand and the palm's frame."""
    m = Mesh()
    m.add(*loft([(0.024, 0.002, 0, 0.0170, 0.0240, 3.4), (0.045, 0.002, 0, 0.0175, 0.0330, 3.6), (0.075, 0.003, 0.0005, 0.0160, 0.0385, 3.8),
                 (0.090, 0.003, 0.0008, 0.0125, 0.0375, 3.4)], "x",
                end=(0.006, 0.006), segments=44, rows=10, end_rows=4, seams=(0.036,)))
    return m


def wrist_yaw_rubber():
    """Pads of the palm and of the finger tips."""
    m = Mesh()
    m.add(*block((0.064, -0.0130, 0), (0.0180, 0.0035, 0.0270), 0.0030, steps=2))
    for z, reach in ((0.0290, 0.150), (0.0100, 0.158), (-0.0090, 0.155), (-0.0275, 0.146)):
        path = _finger(z, reach)
        r = np.full(7, 0.0080)
        r[-2:] = 0.0070, 0.0045
        m.add(*tube(path[15:], r, 12))
    thumb = _thumb()
    r = np.full(8, 0.0078)
    r[-2:] = 0.0068, 0.0045
    return m.add(*tube(thumb[8:], r, 14))


LEFT = {"shoulder_pitch_dark": shoulder_pitch_dark, "shoulder_pitch_shell": shoulder_pitch_shell, "shoulder_roll_shell": shoulder_roll_shell,
        "shoulder_roll_dark": shoulder_roll_dark,
        "shoulder_roll_steel": shoulder_roll_steel, "shoulder_yaw_shell": shoulder_yaw_shell, "shoulder_yaw_dark": shoulder_yaw_dark,
        "shoulder_yaw_trim": shoulder_yaw_trim,
        "elbow_shell": elbow_shell, "elbow_dark": elbow_dark, "elbow_steel": elbow_steel, "wrist_roll_dark": wrist_roll_dark,
        "wrist_pitch_shell": wrist_pitch_shell,
        "wrist_pitch_dark": wrist_pitch_dark, "wrist_yaw_dark": wrist_yaw_dark, "wrist_yaw_shell": wrist_yaw_shell,
        "wrist_yaw_rubber": wrist_yaw_rubber}
