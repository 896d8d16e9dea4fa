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

SHARP = np.cos(np.radians(40))


class Mesh:
    """Triangles with normals and texture coordinates, grown part by part."""

    def __init__(self):
        self.points, self.normals, self.uvs, self.faces = [], [], [], []
        self.count = 0

    def add(self, points, normals, uvs, faces):
        self.points.append(points)
        self.normals.append(normals)
        self.uvs.append(uvs)
        self.faces.append(np.asarray(faces) + self.count)
        self.count += len(points)
        return self

    def write(self, path):
        p, n, t, f = (np.concatenate(a) for a in (self.points, self.normals, self.uvs, self.faces))
        f = f[_areas(p, f) > 1e-12] + 1
        lines = [f"# {path.stem}: made by make_meshes.py"]
        lines += ["v %.5f %.5f %.5f" % tuple(v) for v in p]
        lines += ["vt %.3f %.3f" % tuple(v) for v in t]
        lines += ["vn %.3f %.3f %.3f" % tuple(v) for v in n]
        lines += ["f %d/%d/%d %d/%d/%d %d/%d/%d" % (a, a, a, b, b, b, c, c, c) for a, b, c in f]
        path.write_text("\n".join(lines).replace("-0.00000", "0.00000") + "\n")
        return len(f)


def _areas(p, f):
    return 0.5 * np.linalg.norm(np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]]), axis=1)


def _unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def basis(axis):
    """Rotation whose third column is the axis ("x", "-y", a vector ...) and first a fixed perpendicular."""
    named = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    if isinstance(axis, str):
        w = np.array(named[axis[-1]], float) * (-1 if axis[0] == "-" else 1)
    else:
        w = _unit(np.array(axis, float))
    helper = np.array([0, 0, 1.0]) if abs(w[2]) < 0.9 else np.array([1.0, 0, 0])
    u = _unit(np.cross(helper, w))
    return np.stack([u, np.cross(w, u), w], axis=1)


def fillet(points, radius, steps=4):
    """Rounds the inner corners of a 2-D polyline with arcs of at most this radius."""
    p = [np.array(q, float) for q in points]
    out = [p[0]]
    for a, b, c in zip(p, p[1:], p[2:]):
        u, v = _unit(a - b), _unit(c - b)
        angle = np.arccos(np.clip(np.dot(u, v), -1, 1))
        if angle > np.radians(175):
            out.append(b)
            continue
        cut = min(radius / np.tan(angle / 2), 0.49 * np.linalg.norm(a - b), 0.49 * np.linalg.norm(c - b))
        r = cut * np.tan(angle / 2)
        center = b + _unit(u + v) * r / np.sin(angle / 2)
        start, end = b + u * cut - center, b + v * cut - center
        sweep = np.pi - angle
        turn = np.sign(start[0] * end[1] - start[1] * end[0])
        for t in np.linspace(0, sweep * turn, steps + 1):
            out.append(center + np.array([start[0] * np.cos(t) - start[1] * np.sin(t),
                                          start[0] * np.sin(t) + start[1] * np.cos(t)]))
    return np.array(out + [p[-1]])


def lathe(profile, at, axis, segments=40, bevel=0.0015, steps=2):
    """Turns a profile of (radius, height) points about the axis; height runs along it. Listed from the bottom of the
    outside up, the surface faces outwards."""
    profile = fillet(profile, bevel, steps) if bevel > 0 else np.array(profile, float)
    d = np.diff(profile, axis=0)
    keep = np.linalg.norm(d, axis=1) > 1e-7
    profile = np.concatenate([profile[:1], profile[1:][keep]])
    d = _unit(np.diff(profile, axis=0))
    side = np.stack([d[:, 1], -d[:, 0]], axis=1)  # outward normal of each piece
    # One ring per piece end, shared where the edge is smooth.
    rings, normals, pieces = [profile[0]], [side[0]], []
    for i in range(len(d)):
        start = len(rings) - 1
        last = i + 1 == len(d)
        smooth = not last and np.dot(side[i], side[i + 1]) > SHARP
        rings.append(profile[i + 1])
        normals.append(_unit(side[i] + side[i + 1]) if smooth else side[i])
        pieces.append((start, start + 1))
        if not last and not smooth:
            rings.append(profile[i + 1])
            normals.append(side[i + 1])
    rings, normals = np.array(rings), np.array(normals)
    angle = np.linspace(0, 2 * np.pi, segments + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    R = basis(axis)
    local = np.concatenate([rings[:, None, :1] * ring, np.broadcast_to(rings[:, None, 1:], (len(rings), segments + 1, 1))], axis=2)
    bent = np.concatenate([normals[:, None, :1] * ring, np.broadcast_to(normals[:, None, 1:], (len(rings), segments + 1, 1))], axis=2)
    u, v = np.meshgrid(angle / (2 * np.pi), np.linspace(0, 1, len(rings)))
    faces = []
    for a, b in pieces:
        for j in range(segments):
            q = (a * (segments + 1) + j, a * (segments + 1) + j + 1, b * (segments + 1) + j + 1, b * (segments + 1) + j)
            faces += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    return (local.reshape(-1, 3) @ R.T + np.array(at), bent.reshape(-1, 3) @ R.T,
            np.stack([u.ravel(), v.ravel()], axis=1), faces)


def grid_surface(points):
    """A smooth closed-around grid (rows x columns x 3, last column equals the first) with its ends capped flat."""
    rows, cols = points.shape[:2]
    along = np.gradient(points, axis=0)
    around = np.empty_like(points)
    around[:, 1:-1] = points[:, 2:] - points[:, :-2]
    around[:, 0] = around[:, -1] = points[:, 1] - points[:, -2]
    normals = _unit(np.cross(around, along))
    u, v = np.meshgrid(np.linspace(0, 1, cols), np.linspace(0, 1, rows))
    faces = []
    for i in range(rows - 1):
        for j in range(cols - 1):
            a, b = i * cols + j, (i + 1) * cols + j
            faces += [(a, a + 1, b + 1), (a, b + 1, b)]
    p, n, t = points.reshape(-1, 3), normals.reshape(-1, 3), np.stack([u.ravel(), v.ravel()], axis=1)
    for row, flip in ((0, True), (rows - 1, False)):
        ring = points[row]
        out = _unit(ring.mean(axis=0) - points[1 if flip else rows - 2].mean(axis=0))
        base = len(p)
        p = np.concatenate([p, ring, ring[:-1].mean(axis=0)[None]])
        n = np.concatenate([n, np.broadcast_to(out, (cols + 1, 3))])
        t = np.concatenate([t, np.full((cols + 1, 2), 0.5)])
        for j in range(cols - 1):
            tri = (base + j, base + j + 1, base + cols)
            faces.append(tri[::-1] if flip else tri)
    return p, n, t, faces


def loft(stations, axis, end=0.01, segments=56, rows=40, end_rows=7, seams=()):
    """Skins superellipse sections. A station is (s, cu, cv, a, b, n): position along the axis, centre and half sizes
    in the other two directions, and squareness (2 = ellipse, 5 = rounded box). `end` = fillet of both ends, or a pair.
    `seams` = positions of panel gaps cut 0.7 mm deep."""
    st = np.array(stations, float)
    end = (end, end) if np.isscalar(end) else end
    s0, s1 = st[0, 0], st[-1, 0]
    s = [np.linspace(s0 + end[0], s1 - end[1], rows)]
    depth = {}
    for x in seams:
        for offset, cut in ((-0.0011, 0), (-0.0005, 0.0007), (0.0005, 0.0007), (0.0011, 0)):
            s.append([x + offset])
            depth[x + offset] = cut
    q = np.linspace(0, np.pi / 2, end_rows)
    s.append(s0 + end[0] * (1 - np.cos(q)))
    s.append(s1 - end[1] * (1 - np.cos(q)))
    s = np.unique(np.round(np.concatenate(s), 6))
    smooth = np.stack([_smooth(st[:, 0], st[:, k], s) for k in range(1, 6)], axis=1)
    cu, cv, a, b, n = smooth.T
    shrink = np.zeros_like(s)
    for e, edge in ((end[0], s - s0), (end[1], s1 - s)):
        inside = edge < e
        x = np.clip(1 - edge[inside] / max(e, 1e-9), 0, 1)
        shrink[inside] = e * (1 - np.sqrt(np.maximum(0, 1 - x * x)))
    for x, cut in depth.items():
        shrink[np.abs(s - x) < 1e-5] += cut
    a, b = np.maximum(a - shrink, 1e-4), np.maximum(b - shrink, 1e-4)
    t = np.linspace(0, 2 * np.pi, segments + 1)
    c, d = np.cos(t), np.sin(t)
    # Spread samples evenly along the outline of a square-ish section.
    e = 2 / n[:, None]
    x = cu[:, None] + a[:, None] * np.sign(c) * np.abs(c) ** e
    y = cv[:, None] + b[:, None] * np.sign(d) * np.abs(d) ** e
    w = np.broadcast_to(s[:, None], x.shape)
    order = {"x": (w, x, y), "y": (y, w, x), "z": (x, y, w)}[axis]
    return grid_surface(np.stack(order, axis=2))


def _smooth(x, y, at):
    """Monotone cubic interpolation (Fritsch and Carlson 1980)."""
    if len(x) == 2:
        return np.interp(at, x, y)
    h, d = np.diff(x), np.diff(y) / np.diff(x)
    m = np.zeros_like(y)
    for i in range(1, len(x) - 1):
        if d[i - 1] * d[i] > 0:
            w1, w2 = 2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]
            m[i] = (w1 + w2) / (w1 / d[i - 1] + w2 / d[i])
    m[0], m[-1] = d[0], d[-1]
    i = np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2)
    t = np.clip((at - x[i]) / h[i], 0, 1)
    return ((1 + 2 * t) * (1 - t) ** 2 * y[i] + t * (1 - t) ** 2 * h[i] * m[i] + t * t * (3 - 2 * t) * y[i + 1] +
            t * t * (t - 1) * h[i] * m[i + 1])


def block(center, half, radius, steps=2):
    """A box with rounded edges."""
    half = np.array(half, float)
    radius = min(radius, half.min() * 0.999)
    inner = half - radius
    parts = Mesh()
    q = np.tan(np.linspace(0, np.pi / 4, steps + 1))
    q = np.concatenate([-q[::-1], q])  # the middle twice: the flat of the face lies between
    side = np.repeat([-1.0, 1.0], steps + 1)
    u, v = np.meshgrid(q, q, indexing="ij")
    su, sv = np.meshgrid(side, side, indexing="ij")
    for axis in range(3):
        for sign in (1, -1):
            d = np.empty(u.shape + (3,))
            d[..., axis] = sign
            d[..., (axis + 1) % 3] = u * sign
            d[..., (axis + 2) % 3] = v
            n = _unit(d)
            p = n * radius
            p[..., axis] += sign * inner[axis]
            p[..., (axis + 1) % 3] += inner[(axis + 1) % 3] * su * sign
            p[..., (axis + 2) % 3] += inner[(axis + 2) % 3] * sv
            faces, m = [], len(q)
            for i in range(m - 1):
                for j in range(m - 1):
                    a = i * m + j
                    faces += [(a, a + m, a + m + 1), (a, a + m + 1, a + 1)]
            uv = np.stack([(u + 1) / 2, (v + 1) / 2], axis=-1)
            parts.add(p.reshape(-1, 3), n.reshape(-1, 3), uv.reshape(-1, 2), faces)
    p, n, t = (np.concatenate(a) for a in (parts.points, parts.normals, parts.uvs))
    return p + np.array(center), n, t, np.concatenate(parts.faces)


def bolt(mesh, at, axis, radius=0.0028):
    """A button-head socket screw standing on `at`."""
    r = radius
    return mesh.add(*lathe([(r * 1.0, -0.2 * r), (r, 0.25 * r), (0.72 * r, 0.62 * r), (0.45 * r, 0.62 * r), (0.45 * r, 0.1 * r),
                            (0, 0.1 * r)], at, axis, segments=10, bevel=0))


def bolt_circle(mesh, at, axis, circle, count, radius=0.0028, phase=0.0):
    R = basis(axis)
    for k in range(count):
        t = 2 * np.pi * k / count + phase
        bolt(mesh, np.array(at) + R @ np.array([circle * np.cos(t), circle * np.sin(t), 0]), axis, radius)


def pill(mesh, center, half, radius):
    return mesh.add(*block(center, half, radius, steps=2))


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
