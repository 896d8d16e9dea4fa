"""Boxes with rounded edges."""

import numpy as np

from .mesh import Mesh, unit


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
            n = unit(d)
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


def pill(mesh, center, half, radius, steps=2):
    return mesh.add(*block(center, half, radius, steps))
