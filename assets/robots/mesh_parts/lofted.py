"""Skins over sections."""

import numpy as np

from .mesh import unit


def grid_surface(points):
    """A smooth closed-around grid (rows x columns x 3, last column equals the first) with its ends capped flat."""
    rows, cols = points.shape[:2]
    along = np.gradient(points, axis=0)
    around = np.empty_like(points)
    around[:, 1:-1] = points[:, 2:] - points[:, :-2]
    around[:, 0] = around[:, -1] = points[:, 1] - points[:, -2]
    normals = unit(np.cross(around, along))
    u, v = np.meshgrid(np.linspace(0, 1, cols), np.linspace(0, 1, rows))
    faces = []
    for i in range(rows - 1):
        for j in range(cols - 1):
            a, b = i * cols + j, (i + 1) * cols + j
            faces += [(a, a + 1, b + 1), (a, b + 1, b)]
    p, n, t = points.reshape(-1, 3), normals.reshape(-1, 3), np.stack([u.ravel(), v.ravel()], axis=1)
    for row, flip in ((0, True), (rows - 1, False)):
        ring = points[row]
        out = unit(ring.mean(axis=0) - points[1 if flip else rows - 2].mean(axis=0))
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
