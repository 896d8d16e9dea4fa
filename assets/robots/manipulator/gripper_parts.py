"""Parts of the manipulator's gripper and wrist camera. Frames: the gripper (origin at the flange, z out of it, fingers move
along x) and a finger (origin on the gripper's axis with x away from the face of its pad)."""

import numpy as np

from mesh_parts import (Mesh, block, bolt, bolt_circle, cable_gland, lathe, lens, loft, pill, place, plate, rotation_about, rounded, slots,
                        socket_screw, spline, tube)

CAMERA, TILT = np.array([0.0, 0.0660, 0.0420]), 15.0  # middle of the camera; it leans towards the fingers [degrees]


def at_camera(part):
    """From the camera's own frame (z ahead, x along its bar)."""
    return place(part, CAMERA, rotation_about("x", TILT))


def gripper_shell():
    m = Mesh()
    m.add(*loft([(0.0150, 0, 0, 0.0375, 0.0350, 2.4), (0.0400, 0, 0, 0.0470, 0.0345, 3.0), (0.0640, 0, 0, 0.0690, 0.0310, 3.8), (0.0930, 0, 0, 0.0735, 0.0290, 4.2)],
                "z", end=(0.003, 0.005), segments=52, rows=12, end_rows=4, seams=(0.0560,)))
    m.add(*at_camera(loft([(-0.0460, -0.0010, 0, 0.0115, 0.0115, 3.6), (0.0460, -0.0010, 0, 0.0115, 0.0115, 3.6)], "x", end=0.010, segments=40, rows=4, end_rows=6)))
    return m


def gripper_dark():
    m = Mesh()
    # Adapter on the flange, and the ring that carries the camera.
    m.add(*lathe([(0.0300, 0.0), (0.0375, 0.0), (0.0375, 0.0080), (0.0350, 0.0095), (0.0350, 0.0110), (0.0375, 0.0125), (0.0375, 0.0180), (0.0300, 0.0180)], (0, 0, 0),
                 "z", segments=60, bevel=0.0008))
    arm = rounded([(-0.0220, 0.0280), (0.0220, 0.0280), (0.0260, 0.0560), (0.0180, 0.0720), (-0.0180, 0.0720), (-0.0260, 0.0560)], 0.005)
    m.add(*plate(arm, 0.0120, 0.0160, bevel=0.0008))
    for x in (0.0170, -0.0170):
        rib = rounded([(0.0520, 0.0150), (0.0560, 0.0340), (0.0680, 0.0340), (0.0700, 0.0150)], 0.003)
        m.add(*plate(rib, x - 0.0016, x + 0.0016, "x", bevel=0.0006))
    # Face with the slot of the slides, and cooling slots on both sides.
    face = rounded([(-0.0700, -0.0255), (0.0700, -0.0255), (0.0700, 0.0255), (-0.0700, 0.0255)], 0.006)
    m.add(*plate(face, 0.0915, 0.0955, bevel=0.0010))
    for y in (0.0322, -0.0322):
        slots(m, (0, y, 0.0770), (0.0075, 0, 0), 9, (0.0020, 0.0024, 0.0062), 0.0014)
    return m


def gripper_metal():
    m = Mesh()
    for y in (0.0150, -0.0150):  # guide rails
        m.add(*lathe([(0, -0.0680), (0.0036, -0.0680), (0.0036, 0.0680), (0, 0.0680)], (0, y, 0.0990), "x", segments=20, bevel=0.0006))
    for x in (0.0690, -0.0690):
        m.add(*block((x, 0, 0.0990), (0.0028, 0.0205, 0.0048), 0.0012, steps=1))
        for y in (0.0150, -0.0150):
            bolt(m, (x + np.sign(x) * 0.0028, y, 0.0990), "x" if x > 0 else "-x", 0.0022)
    m.add(*lathe([(0, -0.0660), (0.0028, -0.0660), (0.0028, 0.0660), (0, 0.0660)], (0, 0, 0.0985), "x", segments=16, bevel=0.0004))  # drive screw
    for k in range(6):
        t = np.radians(30 + 60 * k)
        out = np.array([np.cos(t), np.sin(t), 0])
        socket_screw(m, out * 0.0370 + (0, 0, 0.0045), out, 0.0018)
    for x in (0.0180, -0.0180):
        bolt(m, (x, 0.0400, 0.0160), "z", 0.0024)
    cable_gland(m, (0.0, -0.0335, 0.0300), "-y", 0.0095)
    glass = Mesh()
    front, rim = Mesh(), Mesh()
    for x, r in ((0.0350, 0.0042), (0.0150, 0.0042), (-0.0120, 0.0050), (-0.0320, 0.0042)):
        lens(front, rim, (x, 0, 0.0118), "z", r, 0.0022)
    for source, target in ((rim, m), (front, glass)):
        for part in zip(source.points, source.normals, source.uvs, _own(source)):
            target.add(*at_camera(part))
    m.glass = glass
    return m


def _own(mesh):
    """Triangles of each part of a mesh, counted from its own first point."""
    first = np.cumsum([0] + [len(p) for p in mesh.points])
    return [f - start for f, start in zip(mesh.faces, first)]


def gripper_lens():
    m = gripper_metal().glass
    m.add(*at_camera(block((0, 0, 0.0098), (0.0440, 0.0094, 0.0024), 0.0020)))
    return m


def gripper_rubber():
    m = Mesh()
    # Cables of the gripper and of the camera back to the wrist.
    m.add(*tube(spline([(0.0, -0.0430, 0.0300), (0.0, -0.0520, 0.0240), (0.0, -0.0540, 0.0050), (0.0, -0.0500, -0.0150), (0.0, -0.0440, -0.0255)], 30), 0.0028, 12))
    m.add(*tube(spline([CAMERA + (-0.030, 0.004, -0.010), CAMERA + (-0.034, 0.002, -0.024), (-0.0400, 0.0420, 0.0080), (-0.0400, 0.0100, 0.0040), (-0.0380, -0.0080, 0.0045)], 34),
                0.0020, 10))
    return m


def gripper_light():
    m = Mesh()
    pill(m, (0, -0.0300, 0.0878), (0.0120, 0.0022, 0.0010), 0.0009)
    pill(m, (0, 0.0300, 0.0878), (0.0120, 0.0022, 0.0010), 0.0009)
    return m


def gripper_trim():
    m = Mesh()
    m.add(*lathe([(0.0352, 0.0092), (0.0360, 0.0096), (0.0360, 0.0109), (0.0352, 0.0113)], (0, 0, 0), "z", segments=56, bevel=0.0002, steps=1))
    return m


# ---------------------------------------------------------------------------------------------------- finger

def finger_dark():
    m = Mesh()
    m.add(*block((0.0135, 0, 0.1040), (0.0140, 0.0225, 0.0085), 0.0022))  # carriage on the rails
    web = rounded([(0.1080, 0.0260), (0.1220, 0.0250), (0.1500, 0.0150), (0.1640, 0.0120), (0.1640, 0.0058), (0.1220, 0.0058), (0.1080, 0.0030)], 0.003, 4)
    hole = rounded([(0.1180, 0.0200), (0.1340, 0.0155), (0.1340, 0.0105), (0.1180, 0.0105)], 0.002)
    m.add(*plate(web, -0.0112, 0.0112, "y", bevel=0.0014, holes=[hole]))
    return m


def finger_metal():
    m = Mesh()
    for y in (0.0150, -0.0150):
        socket_screw(m, (0.0170, y, 0.1122), "z", 0.0024)
    bolt_circle(m, (0.0150, 0.0112, 0.1450), "y", 0.0, 1, 0.0018)
    bolt_circle(m, (0.0150, -0.0112, 0.1450), "-y", 0.0, 1, 0.0018)
    m.add(*block((0.0052, 0, 0.1430), (0.0012, 0.0108, 0.0200), 0.0008, steps=1))  # backing of the pad
    return m


def finger_rubber():
    m = Mesh()
    m.add(*block((0.0026, 0, 0.1430), (0.0021, 0.0110, 0.0195), 0.0014))
    for k in range(9):  # ridges of the pad
        m.add(*block((0.0010, 0, 0.1430 + (k - 4) * 0.0043), (0.0010, 0.0106, 0.0014), 0.0007, steps=1))
    return m


PARTS = {
    "gripper_shell": gripper_shell, "gripper_dark": gripper_dark, "gripper_metal": gripper_metal, "gripper_lens": gripper_lens,
    "gripper_rubber": gripper_rubber, "gripper_light": gripper_light, "gripper_trim": gripper_trim, "finger_dark": finger_dark,
    "finger_metal": finger_metal, "finger_rubber": finger_rubber,
}
