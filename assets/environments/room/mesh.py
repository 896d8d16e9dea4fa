"""Small mesh kit: bevelled boxes, lathes, tubes, cushions, sheets, and an OBJ writer.

All lengths in metres, Z up, counter-clockwise faces seen from outside. Texture coordinates are in
metres too (u along the grain or weave); `Mesh.textured` divides them by a texture's real size.
"""

import numpy as np


class Mesh:
    """Indexed triangles: p, n (V,3), uv (V,2) [m], f (F,3)."""

    def __init__(self, p, n, uv, f):
        self.p = np.asarray(p, float).reshape(-1, 3)
        self.n = np.asarray(n, float).reshape(-1, 3)
        self.uv = np.asarray(uv, float).reshape(-1, 2)
        self.f = np.asarray(f, int).reshape(-1, 3)

    def moved(self, x=0.0, y=0.0, z=0.0):
        return Mesh(self.p + [x, y, z], self.n, self.uv, self.f)

    def turned(self, axis, degrees):
        R = rotation(axis, degrees)
        return Mesh(self.p @ R.T, self.n @ R.T, self.uv, self.f)

    def textured(self, tile_u, tile_v=None, offset=(0.0, 0.0)):
        """Metre coordinates to repeats of a texture that is tile_u by tile_v metres large."""
        uv = (self.uv + offset) / [tile_u, tile_v or tile_u]
        return Mesh(self.p, self.n, uv, self.f)

    def box_uv(self, grain="x"):
        """Projects along each face's main axis; u runs along `grain` wherever it is not that axis."""
        q, nq = self.p[self.f], self.n[self.f].mean(1)
        p, n = q.reshape(-1, 3), self.n[self.f].reshape(-1, 3)
        g = "xyz".index(grain)
        uv = np.empty((len(q), 3, 2))
        for axis in range(3):
            a, b = [i for i in range(3) if i != axis]
            if b == g:
                a, b = b, a
            chosen = np.abs(nq).argmax(1) == axis
            uv[chosen] = q[chosen][:, :, [a, b]] + 0.37 * axis
        return weld(p, n, uv.reshape(-1, 2))

    def write(self, path):
        lines = ["o " + path.stem]
        for letter, rows, digits in (("v", self.p, 4), ("vt", self.uv, 4), ("vn", self.n, 3)):
            values, index = np.unique(rows.round(digits) + 0.0, axis=0, return_inverse=True)
            lines += [
                letter + " " + " ".join(f"{c:.{digits}f}".rstrip("0").rstrip(".") for c in row)
                for row in values
            ]
            if letter == "v":
                iv = index.ravel() + 1
            elif letter == "vt":
                it = index.ravel() + 1
            else:
                im = index.ravel() + 1
        lines += ["f " + " ".join(f"{iv[k]}/{it[k]}/{im[k]}" for k in t) for t in self.f]
        path.write_text("\n".join(lines) + "\n")


def rotation(axis, degrees):
    a = np.radians(degrees)
    c, s = np.cos(a), np.sin(a)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def weld(p, n, uv):
    """Triangle soup (3F rows) to indexed triangles."""
    key = np.hstack([p.round(6), n.round(5), uv.round(6)])
    _, first, index = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return Mesh(p[first], n[first], uv[first], index.reshape(-1, 3))


def join(*meshes):
    base, faces = 0, []
    for m in meshes:
        faces.append(m.f + base)
        base += len(m.p)
    return Mesh(
        np.vstack([m.p for m in meshes]),
        np.vstack([m.n for m in meshes]),
        np.vstack([m.uv for m in meshes]),
        np.vstack(faces),
    )


def normalized(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def smooth_normals(p, f):
    """Area-weighted vertex normals; vertices at one place share theirs."""
    face = np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]])
    _, place = np.unique(p.round(6), axis=0, return_inverse=True)
    place = place.ravel()
    n = np.zeros((place.max() + 1, 3))
    for k in range(3):
        np.add.at(n, place[f[:, k]], face)
    return normalized(n)[place]


def grid_faces(rows, cols):
    i = np.arange(rows * cols).reshape(rows, cols)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return np.vstack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def sheet(points, uv=None, smooth=True):
    """Grid (R,C,3) of points, front side towards d/dcol x d/drow; uv defaults to arc lengths."""
    rows, cols = points.shape[:2]
    f = grid_faces(rows, cols)
    if uv is None:
        du = np.linalg.norm(np.diff(points, axis=1), axis=2).mean(0)
        dv = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(1)
        u, v = np.concatenate([[0], du.cumsum()]), np.concatenate([[0], dv.cumsum()])
        uv = np.stack(np.meshgrid(u, v), -1)
    p = points.reshape(-1, 3)
    return Mesh(p, smooth_normals(p, f) if smooth else np.zeros_like(p), uv, f)


def box(size, radius=0.004, steps=2, grain="x", middle=0):
    """Bevelled box centred at the origin; `size` full extents; `middle` extra cuts per face."""
    half = np.asarray(size, float) / 2
    radius = min(radius, half.min() * 0.999)
    t = np.tan(np.linspace(-np.pi / 4, 0, steps + 1))
    cuts = np.linspace(-1, 1, middle + 2)[1:-1]
    side = np.concatenate([np.full(steps + 1, -1.0), cuts, np.full(steps + 1, 1.0)])
    tilt = np.concatenate([t, np.zeros(middle), -t[::-1]])
    parts = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            A, B = np.meshgrid(np.arange(len(side)), np.arange(len(side)))
            d = np.empty(A.shape + (3,))
            d[..., axis], d[..., a], d[..., b] = sign, tilt[A], tilt[B]
            n = normalized(d)
            p = radius * n
            for k, s in ((axis, sign), (a, side[A]), (b, side[B])):
                p[..., k] += s * (half[k] - radius)
            f = grid_faces(*A.shape)
            parts.append(Mesh(p, n, np.zeros(p.shape[:2] + (2,)), f if sign > 0 else f[:, ::-1]))
    return join(*parts).box_uv(grain)


def slab(lo, hi, radius=0.0, grain="x", steps=2, seamless=False):
    """Box from corner lo to corner hi; radius 0 = sharp. Each gets its own piece of the texture,
    unless seamless: then coordinates run on between neighbours (walls)."""
    lo, hi = np.asarray(lo, float), np.asarray(hi, float)
    m = box(hi - lo, radius, steps, grain) if radius > 0 else sharp_box(hi - lo, grain)
    m = m.moved(*((lo + hi) / 2)).box_uv(grain)
    if not seamless:
        m.uv = m.uv + np.sin((lo + 2 * hi) @ [[12.9, 39.4], [78.2, 26.7], [45.1, 94.6]]) * 7
    return m


def sharp_box(size, grain="x"):
    h = np.asarray(size, float) / 2
    parts = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sign in (-1, 1):
            p = np.zeros((4, 3))
            p[:, axis] = sign * h[axis]
            p[:, a] = np.array([-1, 1, 1, -1]) * h[a]
            p[:, b] = np.array([-1, -1, 1, 1]) * h[b]
            n = np.zeros((4, 3))
            n[:, axis] = sign
            f = np.array([[0, 1, 2], [0, 2, 3]])
            parts.append(Mesh(p, n, np.zeros((4, 2)), f if sign > 0 else f[:, ::-1]))
    return join(*parts).box_uv(grain)


def lathe(profile, segments=32, smooth=True):
    """Revolves (r, z) points, listed from the bottom outwards and up, about z."""
    prof = np.asarray(profile, float)
    angle = np.linspace(0, 2 * np.pi, segments + 1)
    parts = []
    runs = [prof] if smooth else [prof[i : i + 2] for i in range(len(prof) - 1)]
    length = 0.0
    for run in runs:
        d = np.gradient(run, axis=0) if len(run) > 2 else np.repeat(run[1:] - run[:1], 2, 0)
        n2 = normalized(np.stack([d[:, 1], -d[:, 0]], 1))
        arc = np.concatenate([[0], np.linalg.norm(np.diff(run, axis=0), axis=1).cumsum()])
        c, s = np.cos(angle), np.sin(angle)
        p = np.stack([run[:, :1] * c, run[:, :1] * s, np.repeat(run[:, 1:], len(c), 1)], -1)
        n = np.stack([n2[:, :1] * c, n2[:, :1] * s, np.repeat(n2[:, 1:], len(c), 1)], -1)
        uv = np.stack(np.meshgrid(angle * run[:, 0].max(), length + arc), -1)
        length += arc[-1]
        m = Mesh(p, n, uv, grid_faces(len(run), len(c)))
        area = np.linalg.norm(
            np.cross(m.p[m.f[:, 1]] - m.p[m.f[:, 0]], m.p[m.f[:, 2]] - m.p[m.f[:, 0]]), axis=1
        )
        m.f = m.f[area > 1e-12]
        parts.append(m)
    return join(*parts)


def rounded_profile(corners, radius, steps=3):
    """Replaces inner corners of a polyline by arcs (quadratic curves) of about that radius."""
    c = [np.asarray(q, float) for q in corners]
    out = [c[0]]
    for a, b, d in zip(c, c[1:], c[2:]):
        ra = min(radius, 0.49 * np.linalg.norm(a - b))
        rd = min(radius, 0.49 * np.linalg.norm(d - b))
        s, e = b + ra * normalized(a - b), b + rd * normalized(d - b)
        for t in np.linspace(0, 1, steps + 1):
            out.append((1 - t) ** 2 * s + 2 * t * (1 - t) * b + t * t * e)
    return np.array(out + [c[-1]])


def cylinder(radius, z0, z1, radius_top=None, bevel=0.003, segments=24):
    rt = radius if radius_top is None else radius_top
    prof = rounded_profile([(0, z0), (radius, z0), (rt, z1), (0, z1)], bevel)
    return lathe(prof, segments)


def leg(bottom, top, r_bottom, r_top, segments=14):
    """Tapered round leg between two points."""
    bottom, top = np.asarray(bottom, float), np.asarray(top, float)
    d = top - bottom
    m = cylinder(r_bottom, 0, np.linalg.norm(d), r_top, 0.002, segments)
    m = Mesh(m.p, m.n, m.uv[:, ::-1], m.f)
    z = normalized(d)
    x = normalized(np.cross([0, 1, 0], z))
    R = np.stack([x, np.cross(z, x), z], 1)
    return Mesh(m.p @ R.T + bottom, m.n @ R.T, m.uv, m.f)


def tube(path, radius, segments=10):
    """Round tube along a polyline (N,3), open ends."""
    path = np.asarray(path, float)
    tangent = normalized(np.gradient(path, axis=0))
    side = normalized(np.cross(tangent, [0.3, 0.1, 1.0]))
    up = np.cross(side, tangent)
    a = np.linspace(0, 2 * np.pi, segments + 1)
    n = side[:, None] * np.cos(a)[None, :, None] + up[:, None] * np.sin(a)[None, :, None]
    p = path[:, None] + radius * n
    arc = np.concatenate([[0], np.linalg.norm(np.diff(path, axis=0), axis=1).cumsum()])
    uv = np.stack(np.meshgrid(a * radius, arc), -1)
    return Mesh(p, n, uv, grid_faces(len(path), len(a))[:, ::-1])


def smooth_path(points, steps=8):
    """Catmull-Rom curve through points (N,3)."""
    q = np.asarray(points, float)
    q = np.vstack([2 * q[0] - q[1], q, 2 * q[-1] - q[-2]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    out = []
    for a, b, c, d in zip(q, q[1:], q[2:], q[3:]):
        out.append(
            0.5
            * (
                2 * b
                + (c - a) * t
                + (2 * a - 5 * b + 4 * c - d) * t**2
                + (3 * b - a - 3 * c + d) * t**3
            )
        )
    return np.vstack(out + [q[-2:-1]])


def cushion(size, bulge=0.35, radius=0.05, cuts=5, seed=0, wrinkle=0.004, edge=1.0):
    """Soft box: faces swell towards their middle, corners pull in, a little uneven; its rim is `edge`
    times as thick as `size` says (thrown pillows: thin seams)."""
    m = box(size, radius, 2, "x", cuts)
    half = np.asarray(size, float) / 2
    q = m.p / half
    hollow = 0.03 + 0.07 * (edge < 1)
    p = m.p.copy()
    thin = int(np.argmin(half))
    a, b = [i for i in range(3) if i != thin]
    dome = (1 - np.clip(np.abs(q[:, a]), 0, 1) ** 2.4) * (1 - np.clip(np.abs(q[:, b]), 0, 1) ** 2.4)
    p[:, thin] *= 1 + bulge * dome - 0.22 * (1 - dome) * (np.abs(q[:, a] * q[:, b]) ** 3)
    p[:, thin] *= edge + (1 - edge) * np.clip(dome, 0, 1) ** 0.55
    pinch = 1 - hollow * (1 - q[:, a] ** 2) * np.abs(q[:, b]) ** 6
    p[:, b] *= pinch
    pinch = 1 - hollow * (1 - q[:, b] ** 2) * np.abs(q[:, a]) ** 6
    p[:, a] *= pinch
    rng = np.random.default_rng(seed)
    for _ in range(5):
        k = rng.normal(0, 2.2, 3)
        p[:, thin] += wrinkle * np.sin(q @ k + rng.uniform(0, 6.3)) * dome
    return Mesh(p, smooth_normals(p, m.f), m.uv, m.f)
