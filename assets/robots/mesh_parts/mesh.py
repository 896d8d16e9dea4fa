"""Meshes made of parts, and their OBJ files. Units: metres."""

import pathlib
import sys

import numpy as np

SHARP = np.cos(np.radians(40))  # edges sharper than this keep separate normals


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

    def write_compact(self, path):
        """As write(), in a third of the bytes: without texture coordinates, equal points and normals listed once."""
        p, n, f = (np.concatenate(a) for a in (self.points, self.normals, self.faces))
        f = f[_areas(p, f) > 1e-12]
        used = np.unique(f)
        points, to_point = np.unique(np.round(p[used] * 1e5).astype(int), axis=0, return_inverse=True)
        normals, to_normal = np.unique(np.round(n[used] * 1e2).astype(int), axis=0, return_inverse=True)
        place = np.searchsorted(used, f)
        a, b = to_point.ravel()[place] + 1, to_normal.ravel()[place] + 1
        whole = (a[:, 0] != a[:, 1]) & (a[:, 1] != a[:, 2]) & (a[:, 2] != a[:, 0])
        lines = [f"# {path.stem}: made by make_meshes.py"]
        lines += ["v %.6g %.6g %.6g" % tuple(v * 1e-5) for v in points]
        lines += ["vn %.6g %.6g %.6g" % tuple(v * 1e-2) for v in normals]
        lines += ["f %d//%d %d//%d %d//%d" % tuple(np.stack([x, y], axis=1).ravel()) for x, y in zip(a[whole], b[whole])]
        path.write_text("\n".join(lines) + "\n")
        return int(whole.sum())


def place(part, at=(0, 0, 0), rotation=np.eye(3)):
    """The part turned by a rotation matrix, or to an axis (see basis), and moved to `at`."""
    p, n, t, f = part
    R = basis(rotation) if isinstance(rotation, str) or np.ndim(rotation) == 1 else np.asarray(rotation, float)
    return p @ R.T + np.array(at, float), n @ R.T, t, f


def turned_by(part, axis, degrees, about=(0, 0, 0)):
    """The part turned about a line through `about`."""
    about = np.array(about, float)
    R = rotation_about(axis, degrees)
    p, n, t, f = part
    return (p - about) @ R.T + about, n @ R.T, t, f


def mirrored(part, axis):
    """The part's mirror image across the plane through the origin, normal to "x", "y" or "z"."""
    p, n, t, f = part
    flip = np.where(np.arange(3) == "xyz".index(axis), -1.0, 1.0)
    return p * flip, n * flip, t, np.asarray(f)[:, ::-1]


def rotation_about(axis, degrees):
    """Rotation matrix about "x", "y", "z" or a vector (Rodrigues)."""
    w = basis(axis)[:, 2]
    a = np.radians(degrees)
    K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    return np.eye(3) + np.sin(a) * K + (1 - np.cos(a)) * K @ K


def _areas(p, f):
    return 0.5 * np.linalg.norm(np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]]), axis=1)


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def basis(axis):
    """Rotation whose third column is the axis ("x", "-y", a vector ...) and first a fixed perpendicular."""
    named = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    if isinstance(axis, str):
        w = np.array(named[axis[-1]], float) * (-1 if axis[0] == "-" else 1)
    else:
        w = unit(np.array(axis, float))
    helper = np.array([0, 0, 1.0]) if abs(w[2]) < 0.9 else np.array([1.0, 0, 0])
    u = unit(np.cross(helper, w))
    return np.stack([u, np.cross(w, u), w], axis=1)


def fillet(points, radius, steps=4):
    """Rounds the inner corners of a 2-D polyline with arcs of at most this radius."""
    p = [np.array(q, float) for q in points]
    out = [p[0]]
    for a, b, c in zip(p, p[1:], p[2:]):
        u, v = unit(a - b), unit(c - b)
        angle = np.arccos(np.clip(np.dot(u, v), -1, 1))
        if angle > np.radians(175):
            out.append(b)
            continue
        cut = min(radius / np.tan(angle / 2), 0.49 * np.linalg.norm(a - b), 0.49 * np.linalg.norm(c - b))
        r = cut * np.tan(angle / 2)
        center = b + unit(u + v) * r / np.sin(angle / 2)
        start, end = b + u * cut - center, b + v * cut - center
        sweep = np.pi - angle
        turn = np.sign(start[0] * end[1] - start[1] * end[0])
        for t in np.linspace(0, sweep * turn, steps + 1):
            out.append(center + np.array([start[0] * np.cos(t) - start[1] * np.sin(t),
                                          start[0] * np.sin(t) + start[1] * np.cos(t)]))
    return np.array(out + [p[-1]])


def write_parts(parts, folder, copies=None):
    """Writes NAME.obj for each {NAME: function that makes its Mesh}, and prints triangles; `copies` counts drawn
    instances of a name where there are several. The first argument of the program replaces the folder."""
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else folder)
    folder.mkdir(parents=True, exist_ok=True)
    total = size = 0
    for name, make in parts.items():
        path = folder / f"{name}.obj"
        count = make().write_compact(path)
        total += count * (copies or {}).get(name, 1)
        size += path.stat().st_size
        print(f"{name:20} {count:6} triangles {path.stat().st_size / 1024:7.0f} KiB")
    print(f"{'whole robot':20} {total:6} triangles {size / 1024:7.0f} KiB")
