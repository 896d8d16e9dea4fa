"""Plates of any outline, with rounded edges and holes."""

import numpy as np

from .mesh import SHARP, unit

# Axes of an outline's two coordinates, then of its depth.
PLANES = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}


def rounded(points, radius, steps=4):
    """A closed outline with its corners rounded by arcs of at most this radius, or one radius per corner."""
    p = np.array(points, float)
    radii = np.broadcast_to(radius, len(p))
    out = []
    for a, b, c, r in zip(np.roll(p, 1, axis=0), p, np.roll(p, -1, axis=0), radii):
        u, v = unit(a - b), unit(c - b)
        angle = np.arccos(np.clip(np.dot(u, v), -1, 1))
        if r <= 0 or angle > np.radians(175):
            out.append(b)
            continue
        cut = min(r / np.tan(angle / 2), 0.49 * np.linalg.norm(a - b), 0.49 * np.linalg.norm(c - b))
        r = cut * np.tan(angle / 2)
        center = b + unit(u + v) * r / np.sin(angle / 2)
        start = np.arctan2(*(b + u * cut - center)[::-1])
        turn = np.sign(u[1] * v[0] - u[0] * v[1]) * (np.pi - angle)
        for t in np.linspace(start, start + turn, steps + 1):
            out.append(center + r * np.array([np.cos(t), np.sin(t)]))
    return np.array(out)


def circle(radius, at=(0, 0), segments=32):
    t = np.arange(segments) * 2 * np.pi / segments
    return np.array(at) + radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def plate(outline, low, high, axis="z", bevel=0.0006, steps=2, holes=()):
    """Extrudes a closed 2-D outline from `low` to `high` along the axis, with rounded edges. The outline's coordinates
    are (x, y) for axis "z", (y, z) for "x" and (z, x) for "y"."""
    loops = [_counterclockwise(outline)] + [_counterclockwise(h)[::-1] for h in holes]
    q = np.linspace(0, np.pi / 2, steps + 1)
    # Rings from the bottom up: inset, height, and how far the normal points outwards and up.
    levels = [(bevel * (1 - np.sin(a)), low + bevel * (1 - np.cos(a)), np.sin(a), -np.cos(a)) for a in q]
    levels += [(bevel * (1 - np.sin(a)), high - bevel * (1 - np.cos(a)), np.sin(a), np.cos(a)) for a in q[::-1]]
    points, normals, faces, caps = [], [], [], []
    count = 0
    for loop in loops:
        start_n, end_n, miter = _edge_normals(loop)
        n = len(loop)
        base = count
        for inset, height, out, up in levels:
            ring = loop - miter * inset
            for corner, side in ((ring, start_n), (np.roll(ring, -1, axis=0), end_n)):
                points.append(np.column_stack([corner, np.full(n, height)]))
                normals.append(np.column_stack([side * out, np.full(n, up)]))
                count += n
        for k in range(len(levels) - 1):
            a = base + 2 * n * k
            for j in range(n):
                quad = (a + j, a + n + j, a + 3 * n + j, a + 2 * n + j)
                faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
        caps.append(loop - miter * bevel)
    flat, triangles = triangulate(caps)
    for height, up in ((low, -1.0), (high, 1.0)):
        points.append(np.column_stack([flat, np.full(len(flat), height)]))
        normals.append(np.tile([0, 0, up], (len(flat), 1)))
        faces += [tuple(count + i for i in (t if up > 0 else t[::-1])) for t in triangles]
        count += len(flat)
    p, m = np.concatenate(points), np.concatenate(normals)
    order = np.argsort(PLANES[axis])
    return p[:, order], m[:, order], p[:, :2] * 10, faces


def _counterclockwise(loop):
    p = np.array(loop, float)
    q = np.roll(p, -1, axis=0)
    return p if np.sum(p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]) > 0 else p[::-1]


def _edge_normals(loop):
    """Outward normals at the start and the end of each edge, averaged where the outline is smooth, and the offset of
    each corner for an outline one unit larger."""
    d = unit(np.roll(loop, -1, axis=0) - loop)
    side = np.stack([d[:, 1], -d[:, 0]], axis=1)
    before = np.roll(side, 1, axis=0)
    dots = np.sum(side * before, axis=1, keepdims=True)
    mean = unit(side + before)
    start = np.where(dots > SHARP, mean, side)
    end = np.roll(np.where(dots > SHARP, mean, before), -1, axis=0)
    return start, end, mean / np.maximum(np.sum(mean * side, axis=1, keepdims=True), 0.3)


def triangulate(loops):
    """Points and triangles of a polygon (counterclockwise) with holes (clockwise), by ear clipping."""
    points = np.concatenate(loops)
    starts = np.cumsum([0] + [len(a) for a in loops])
    ring = list(range(starts[1]))
    holes = [list(range(starts[i], starts[i + 1])) for i in range(1, len(loops))]
    for hole in sorted(holes, key=lambda h: -points[h][:, 0].max()):
        far = hole.index(max(hole, key=lambda i: points[i, 0]))
        hole = hole[far:] + hole[:far]
        at = _bridge(points, ring, holes, points[hole[0]])
        ring = ring[:at + 1] + hole + [hole[0]] + ring[at:]
    triangles = []
    while len(ring) > 3:
        k = _ear(points, ring)
        triangles.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
        del ring[k]
    return points, triangles + [tuple(ring)]


def _cross(o, a, b):
    return (a[..., 0] - o[..., 0]) * (b[..., 1] - o[..., 1]) - (a[..., 1] - o[..., 1]) * (b[..., 0] - o[..., 0])


def _bridge(points, ring, holes, p):
    """Index in the ring of the nearest corner that p sees past the ring and the holes."""
    q = np.concatenate([points[loop] for loop in [ring] + holes])
    r = np.concatenate([np.roll(points[loop], -1, axis=0) for loop in [ring] + holes])
    for k in np.argsort(np.linalg.norm(points[ring] - p, axis=1), kind="stable"):
        c = points[ring[k]]
        cut = (_cross(p, c, q) * _cross(p, c, r) < 0) & (_cross(q, r, p[None]) * _cross(q, r, c[None]) < 0)
        if not cut.any():
            return int(k)
    raise ValueError("a hole lies outside of its plate")


def _ear(points, ring):
    """Index in the ring of the widest corner among those that can be cut off."""
    q = points[ring]
    a, c = np.roll(q, 1, axis=0), np.roll(q, -1, axis=0)
    area = _cross(a, q, c)
    for k in np.argsort(-_quality(a, q, c), kind="stable"):
        if area[k] <= 1e-14:
            continue
        inside = (_cross(a[k], q[k], q) > 1e-13) & (_cross(q[k], c[k], q) > 1e-13) & (_cross(c[k], a[k], q) > 1e-13)
        same = (np.abs(q - a[k]).sum(1) < 1e-12) | (np.abs(q - q[k]).sum(1) < 1e-12) | (np.abs(q - c[k]).sum(1) < 1e-12)
        if not (inside & ~same).any():
            return int(k)
    return int(np.argmax(area))


def _quality(a, b, c):
    edges = np.sum((a - b) ** 2, axis=1) + np.sum((b - c) ** 2, axis=1) + np.sum((c - a) ** 2, axis=1)
    return _cross(a, b, c) / np.maximum(edges, 1e-18)
