"""Meshes of the waist, the torso and the head, in the frames of their links."""

import numpy as np
from mesh_parts import Mesh, block, bolt, lathe, lens, loft, pill, plate, rounded, slots, spline, tube
from mesh_parts.joints import SIDES

EYE = (0.0576, 0.0175, 0.4299)  # the camera's own place; its window is farther along the axis
EYE_AXIS = (0.6743, 0, -0.7385)


def waist_yaw_dark():
    m = Mesh()
    m.add(*lathe([(0, 0.012), (0.046, 0.012), (0.046, 0.019), (0.039, 0.023), (0, 0.023)], (0, 0, 0), "z", segments=40, bevel=0.001, steps=1))
    for s in SIDES:  # brackets of the roll axis, ahead and behind
        m.add(*plate(rounded([(-0.024, 0.018), (0.024, 0.018), (0.015, 0.056), (-0.015, 0.056)], 0.010, steps=5), -0.004 + s * 0.026 - 0.005,
                     -0.004 + s * 0.026 + 0.005, "x", bevel=0.0012))
    return m


def waist_roll_steel():
    m = Mesh()
    m.add(*lathe([(0, -0.036), (0.0105, -0.036), (0.0105, 0.036), (0, 0.036)], (0, 0, 0), "x", segments=28, bevel=0.0012, steps=1))
    m.add(*lathe([(0, -0.042), (0.0105, -0.042), (0.0105, 0.042), (0, 0.042)], (0, 0, 0), "y", segments=28, bevel=0.0012, steps=1))
    return m.add(*block((0, 0, 0), (0.016, 0.016, 0.016), 0.004))


def torso_shell():
    m = Mesh()
    m.add(*loft([(0.052, 0.002, 0, 0.050, 0.056, 3.0), (0.080, 0.003, 0, 0.060, 0.066, 3.4), (0.130, 0.004, 0, 0.069, 0.080, 3.4),
                 (0.185, 0.006, 0, 0.076, 0.091, 3.4), (0.235, 0.006, 0, 0.076, 0.091, 3.2),
                 (0.275, 0.003, 0, 0.066, 0.078, 2.8), (0.300, 0.000, 0, 0.050, 0.058, 2.4)], "z", end=(0.010, 0.014), segments=52, rows=14,
                 end_rows=4, seams=(0.118, 0.205)))
    # Skull.
    m.add(*loft([(0.338, -0.006, 0, 0.046, 0.043, 2.3), (0.362, -0.004, 0, 0.064, 0.057, 2.4), (0.405, -0.003, 0, 0.0735, 0.0655, 2.4),
                 (0.445, -0.004, 0, 0.071, 0.064, 2.3),
                 (0.476, -0.006, 0, 0.054, 0.049, 2.1), (0.490, -0.008, 0, 0.030, 0.027, 2.0)], "z", end=(0.010, 0.012), segments=46, rows=12,
                 end_rows=5, seams=(0.456,)))
    for s in SIDES:  # collars of the shoulders
        axis = (0, s * 0.9613, 0.2756)
        m.add(*lathe([(0.048, -0.030), (0.0470, -0.0075), (0.0445, -0.0045), (0.036, -0.0045)], (0.004, s * 0.1002, 0.2478), axis, segments=40,
                     bevel=0.002, steps=2))
    return m


def torso_dark():
    m = Mesh()
    # Waist: bellows and the bracket of the pitch axis.
    rings = [(0, 0.012), (0.034, 0.012)]
    for k in range(4):
        z = 0.014 + 0.0105 * k
        rings += [(0.044 + 0.002 * k, z), (0.044 + 0.002 * k, z + 0.005), (0.039 + 0.002 * k, z + 0.0075)]
    m.add(*lathe(rings + [(0, 0.058)], (0.001, 0, 0), "z", segments=40, bevel=0.0008, steps=1))
    # Battery pack behind: case, door, grille.
    m.add(*loft([(0.090, -0.072, 0, 0.022, 0.058, 4.0), (0.120, -0.078, 0, 0.026, 0.066, 4.6), (0.230, -0.078, 0, 0.026, 0.066, 4.6),
                 (0.258, -0.068, 0, 0.024, 0.056, 4.0)], "z",
                end=0.010, segments=44, rows=8, end_rows=4, seams=(0.135, 0.222)))
    slots(m, (-0.1035, 0, 0.179), (0, 0, 0.009), 7, (0.0016, 0.034, 0.0026), 0.0014)
    m.add(*tube(spline([(-0.078, -0.036, 0.262), (-0.088, -0.034, 0.284), (-0.090, 0, 0.290), (-0.088, 0.034, 0.284), (-0.078, 0.036, 0.262)], 22),
                0.0060, 12))
    # Neck with ribs, and the seats of the shoulder motors.
    neck = [(0.046, 0.292)]
    for k in range(4):
        neck += [(0.044, 0.304 + 0.010 * k), (0.044, 0.310 + 0.010 * k), (0.041, 0.3115 + 0.010 * k), (0.041, 0.3135 + 0.010 * k)]
    m.add(*lathe(neck + [(0.046, 0.350)], (-0.004, 0, 0), "z", segments=36, bevel=0))
    for s in SIDES:
        axis = (0, s * 0.9613, 0.2756)
        m.add(*lathe([(0.042, -0.02), (0.042, -0.0065), (0, -0.0065)], (0.004, s * 0.1002, 0.2478), axis, segments=36, bevel=0.001, steps=1))
        for z in np.linspace(0.138, 0.174, 4):  # gills
            m.add(*block((0.012, s * (0.0770 + 0.2 * (z - 0.130)), z), (0.018, 0.0050, 0.0026), 0.0022, steps=1))
    m.add(*_inlay(0.132, 0.202, 0.0440, 0.0030))
    return m


def torso_steel():
    m = Mesh()
    for s in SIDES:
        for z in (0.128, 0.230):
            bolt(m, (-0.1038, s * 0.054, z), "-x", 0.0023, segments=8)
        m.add(*lathe([(0.0190, 0.000), (0.0190, 0.0035), (0.0160, 0.0045), (0.0150, 0.0020)], (-0.004, s * 0.0625, 0.415), "y" if s > 0 else "-y",
                     segments=32, bevel=0.0005, steps=1))
    glass = Mesh()
    _eyes(glass, m)
    return m


def _eyes(glass, ring):
    """The depth camera in the visor: imagers 50 mm apart, colour camera outside of them, projector between."""
    at = np.array(EYE) + 0.0335 * np.array(EYE_AXIS)
    for y, r in ((0.0175, 0.0044), (-0.0325, 0.0044), (0.0325, 0.0038), (-0.0075, 0.0032)):
        lens(glass, ring, (at[0], y, at[2]), EYE_AXIS, r, 0.0026, segments=22)


def torso_lens():
    m, ring = Mesh(), Mesh()
    m.add(*loft([(0.366, 0.0125, 0, 0.0520, 0.0500, 2.5), (0.385, 0.0130, 0, 0.0635, 0.0590, 2.6), (0.415, 0.0130, 0, 0.0655, 0.0605, 2.6),
                 (0.440, 0.0120, 0, 0.0620, 0.0575, 2.5), (0.452, 0.0115, 0, 0.0555, 0.0500, 2.4)],
                "z", end=(0.006, 0.006), segments=44, rows=9, end_rows=4))
    _eyes(m, ring)
    return m.add(*_inlay(0.140, 0.172, 0.0330, 0.0042))


def _inlay(low, high, half, proud):
    """A panel in the chest that stands out from the shell by `proud`."""
    z = np.linspace(low, high, 4)
    front = np.interp(z, [0.130, 0.185, 0.235], [0.073, 0.082, 0.082])
    return loft([(k, x + proud - 0.030, 0, 0.030, half, 4.5) for k, x in zip(z, front)], "z", end=0.006, segments=32, rows=5, end_rows=4)


def torso_trim():
    m = Mesh()
    m.add(*_inlay(0.128, 0.206, 0.0485, 0.0016))
    m.add(*block((-0.1050, 0, 0.226), (0.0016, 0.024, 0.0036), 0.0014, steps=1))
    return m


def torso_light():
    m = Mesh()
    for s in SIDES:
        m.add(*lathe([(0.0152, 0.0005), (0.0152, 0.0024), (0.0105, 0.0024), (0.0105, 0.0005)], (-0.004, s * 0.0625, 0.415), "y" if s > 0 else "-y",
                     segments=32, bevel=0.0005, steps=1))
    pill(m, (0.0838, 0, 0.186), (0.0024, 0.020, 0.0015), 0.0012)
    return m


CENTRE = {"waist_yaw_dark": waist_yaw_dark, "waist_roll_steel": waist_roll_steel, "torso_shell": torso_shell, "torso_dark": torso_dark,
          "torso_steel": torso_steel,
          "torso_trim": torso_trim, "torso_lens": torso_lens, "torso_light": torso_light}
