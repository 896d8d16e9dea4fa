"""Meshes of the gripper in the frame of its body: x out of the flange, fingers along y, the camera above; and of its left
finger, whose pad touches the plane y = 0 where the gripper is closed."""

from mesh_parts import Mesh, block, bolt, bolt_circle, lathe, lens, pill, plate, rotation_about, rounded, slots, turned_by

SIDES = (1, -1)
CAMERA = (0.028, 0, 0.066)  # centre of the camera's case
TILT = 15  # pitch of the camera [deg]
LENSES = ((0.0175, 0.0046), (-0.0325, 0.0046), (0.0325, 0.0040), (-0.0075, 0.0032))  # y and radius: left, right, colour, projector


def gripper_shell():
    m = Mesh()
    body = rounded([(0.012, -0.036), (0.066, -0.052), (0.066, 0.052), (0.012, 0.036)], [0.008, 0.004, 0.004, 0.008], steps=4)
    m.add(*plate(body, -0.0270, -0.0012, "z", bevel=0.0040, steps=2)).add(*plate(body, 0.0012, 0.0270, "z", bevel=0.0040, steps=2))
    case = block(CAMERA, (0.0118, 0.045, 0.0118), 0.0100, steps=3)
    return m.add(*turned_by(case, "y", TILT, CAMERA))


def gripper_dark():
    m = Mesh()
    m.add(*lathe([(0, 0), (0.0345, 0), (0.0345, 0.006), (0.0315, 0.0085), (0.0295, 0.016), (0, 0.016)], (0, 0, 0), "x", segments=32, bevel=0.0012,
                 steps=1))
    m.add(*plate(rounded([(0.014, -0.0345), (0.0645, -0.0495), (0.0645, 0.0495), (0.014, 0.0345)], 0.004), -0.002, 0.002, "z"))
    for z in (-0.0175, 0.0175):  # rails of the carriages
        m.add(*block((0.0655, 0, z), (0.0045, 0.0510, 0.0042), 0.0015))
    # Bracket of the camera.
    m.add(*plate(rounded([(-0.017, 0.024), (0.017, 0.024), (0.022, 0.058), (-0.022, 0.058)], 0.004), 0.014, 0.0185, "x", bevel=0.0008))
    for z in (0.0268, -0.0268):
        slots(m, (0.036, 0, z), (0, 0.0075, 0), 7, (0.010, 0.0016, 0.0009), 0.0008)
    return m


def gripper_steel():
    m = Mesh()
    bolt_circle(m, (0.0065, 0, 0), "x", 0.0305, 6, 0.0015, segments=8)
    for s in SIDES:
        for x, y in ((0.058, 0.042), (0.020, 0.030)):
            for z, axis in ((0.0267, "z"), (-0.0267, "-z")):
                bolt(m, (x, s * y, z), axis, 0.0022, segments=8)
    for z in (-0.0175, 0.0175):
        m.add(*lathe([(0.0022, -0.050), (0.0022, 0.050)], (0.0690, 0, z), "y", segments=10, bevel=0))
    glass = Mesh()
    for y, r in LENSES:
        _camera_lens(glass, m, y, r)
    return m


def gripper_lens():
    m, ring = Mesh(), Mesh()
    window = block((CAMERA[0] + 0.0112, 0, CAMERA[2]), (0.0012, 0.0405, 0.0066), 0.0011)
    m.add(*turned_by(window, "y", TILT, CAMERA))
    for y, r in LENSES:
        _camera_lens(m, ring, y, r)
    return m


def _camera_lens(glass, ring, y, radius):
    turn = rotation_about("y", TILT)
    lens(glass, ring, turn @ (0.0122, y, 0) + CAMERA, tuple(turn @ (1, 0, 0)), radius, 0.0016, segments=20)


def gripper_light():
    m = Mesh()
    pill(m, (0.0300, 0, 0.0268), (0.0016, 0.012, 0.0009), 0.0008)
    return m


def finger_dark():
    m = Mesh()
    m.add(*block((0.0035, 0.0175, 0), (0.0065, 0.0135, 0.0235), 0.003, steps=1))  # carriage
    side = rounded([(0.004, 0.006), (0.004, 0.030), (0.020, 0.0295), (0.052, 0.0185), (0.079, 0.0145), (0.080, 0.0055), (0.034, 0.0055),
                    (0.030, 0.0085), (0.012, 0.0085)], 0.003, steps=3)
    m.add(*plate(side, -0.0135, -0.0045, "z", bevel=0.0012, steps=1)).add(*plate(side, 0.0045, 0.0135, "z", bevel=0.0012, steps=1))
    return m.add(*block((0.058, 0.0085, 0), (0.0225, 0.0035, 0.0130), 0.0015, steps=1)).add(*block((0.030, 0.0160, 0), (0.0080, 0.0080, 0.0080),
                                                                                                   0.002, steps=1))


def finger_steel():
    m = Mesh()
    for z in (-0.015, 0.015):
        bolt(m, (0.0098, 0.024, z), "x", 0.0021, segments=8)
    for z, axis in ((0.0134, "z"), (-0.0134, "-z")):
        for x, y in ((0.022, 0.019), (0.050, 0.0135)):
            bolt(m, (x, y, z), axis, 0.0018, segments=8)
    return m


def finger_rubber():
    """The pad, with grooves across."""
    m = Mesh()
    m.add(*block((0.058, 0.0036, 0), (0.0210, 0.0022, 0.0125), 0.0010))
    for k in range(8):
        m.add(*block((0.0395 + 0.0053 * k, 0.0012, 0), (0.0020, 0.0013, 0.0122), 0.0006, steps=1))
    return m


PARTS = {"gripper_shell": gripper_shell, "gripper_dark": gripper_dark, "gripper_steel": gripper_steel, "gripper_lens": gripper_lens,
         "gripper_light": gripper_light, "finger_dark": finger_dark, "finger_steel": finger_steel, "finger_rubber": finger_rubber}
