"""Floor, walls, ceiling, door, window, and what is seen through it."""

import numpy as np

from mesh import Mesh, box, cylinder, lathe, rounded_profile, sheet, slab, smooth_path, tube
from piece import Piece

HALF_X, HALF_Y, HEIGHT, WALL = 3.2, 2.6, 2.6, 0.2  # inner half extents, height, wall thickness [m]
WINDOW = (-1.2, 0.6, 0.85, 2.15)  # x from, to, z from, to; in the wall at -y
DOOR = (1.85, 2.75, 2.08)  # x from, to, height; in the wall at +y


def floor(rng):
    """Oak boards 0.14 m wide, each with its own cut out of the atlas; z = 0 is the walking surface."""
    f = Piece("floor")
    width, strips, gap = 0.14, 8, 0.0010
    p, uv = [], []
    y, last = -HALF_Y, -1
    while y < HALF_Y:
        y1 = min(y + width, HALF_Y)
        x = -HALF_X - rng.uniform(0, 1.6)
        while x < HALF_X:
            x1 = x + rng.uniform(1.1, 1.95)
            a, b = max(x, -HALF_X), min(x1, HALF_X)
            if b - a > 0.002:
                k = int(rng.integers(strips))
                k, last = (k if k != last else (k + 3) % strips), k
                u0 = rng.uniform(0, 1)
                u = np.array([u0, u0 + (b - a) / 2.0])
                v = 1 - np.array([k + (y1 - y) / width, k]) / strips
                if rng.random() < 0.5:
                    u, v = u[::-1], v[::-1]
                b -= gap
                p += [(a, y, 0), (b, y, 0), (b, y1, 0), (a, y1, 0)]
                uv += [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])]
            x = x1
        y = y1
    quads = np.arange(len(p)).reshape(-1, 4)
    faces = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    f.show("boards", "floor_oak", Mesh(p, np.tile([0, 0, 1.0], (len(p), 1)), uv, faces))
    f.show(
        "underlay",
        "gap",
        slab((-HALF_X - WALL, -HALF_Y - WALL, -0.2), (HALF_X + WALL, HALF_Y + WALL, -0.0015), 0),
    )
    return f


def walls():
    X, Y, H, T = HALF_X, HALF_Y, HEIGHT, WALL
    x0, x1, z0, z1 = WINDOW
    d0, d1, dh = DOOR
    low, top = -0.05, H + 0.05

    def wall(name, paint, slabs, colliders=None):
        w = Piece(name)
        w.show("plaster", paint, *[slab(a, b, 0, seamless=True) for a, b in slabs])
        for a, b in colliders or slabs:
            w.collide_box(a, b)
        return w

    south = [
        ((-X - T, -Y - T, low), (x0, -Y, top)),
        ((x1, -Y - T, low), (X + T, -Y, top)),
        ((x0, -Y - T, low), (x1, -Y, z0)),
        ((x0, -Y - T, z1), (x1, -Y, top)),
    ]
    # The door stands in a niche: the outer half of the wall goes on behind it.
    north = [
        ((-X - T, Y, low), (d0, Y + T, top)),
        ((d1, Y, low), (X + T, Y + T, top)),
        ((d0, Y, dh), (d1, Y + T, top)),
        ((d0, Y + T / 2, low), (d1, Y + T, dh)),
    ]
    return [
        wall("wall_south", "wall_paint", south),
        wall("wall_north", "wall_paint", north, [((-X - T, Y, low), (X + T, Y + T, top))]),
        wall("wall_west", "accent_paint", [((-X - T, -Y - 0.01, low), (-X, Y + 0.01, top))]),
        wall("wall_east", "wall_paint", [((X, -Y - 0.01, low), (X + T, Y + 0.01, top))]),
        Piece("ceiling").show(
            "plaster",
            "ceiling_paint",
            slab((-X - T, -Y - T, H), (X + T, Y + T, H + T), 0, seamless=True),
        ),
    ]


def skirting():
    X, Y, h, t = HALF_X, HALF_Y, 0.085, 0.014
    d0, d1, _ = DOOR
    runs = [
        ((-X, -Y, 0), (X, -Y + t, h), "x"),
        ((-X, Y - t, 0), (d0 - 0.075, Y, h), "x"),
        ((d1 + 0.075, Y - t, 0), (X, Y, h), "x"),
        ((-X, -Y, 0), (-X + t, Y, h), "y"),
        ((X - t, -Y, 0), (X, Y, h), "y"),
    ]
    return Piece("skirting").show(
        "boards", "painted_white", *[slab(a, b, 0.005, g) for a, b, g in runs]
    )


def door():
    d0, d1, dh = DOOR
    Y = HALF_Y
    d = Piece("door", ((d0 + d1) / 2, Y, 0), 0)
    w = (d1 - d0) / 2
    trim = [
        slab(
            (s * (w + 0.03) - 0.04, -0.018, 0), (s * (w + 0.03) + 0.04, 0.0, dh + 0.07), 0.005, "z"
        )
        for s in (-1, 1)
    ]
    trim.append(slab((-w - 0.07, -0.0175, dh - 0.01), (w + 0.07, 0.0, dh + 0.07), 0.005))
    trim += [
        slab((s * (w - 0.012) - 0.014, -0.002, 0), (s * (w - 0.012) + 0.014, 0.10, dh), 0.002, "z")
        for s in (-1, 1)
    ]
    trim.append(slab((-w, -0.002, dh - 0.026), (w, 0.10, dh), 0.002))
    d.show("frame", "painted_white", *trim)
    x0, x1, z0, z1 = -w + 0.005, w - 0.005, 0.006, dh - 0.006
    f0, f1 = 0.020, 0.06
    bars = [
        slab((x0, f0, z0), (x0 + 0.13, f1, z1), 0.003, "z"),
        slab((x1 - 0.13, f0, z0), (x1, f1, z1), 0.003, "z"),
    ]
    for a, b in ((z0, 0.22), (0.90, 1.06), (z1 - 0.13, z1)):
        bars.append(slab((x0 + 0.13, f0, a), (x1 - 0.13, f1, b), 0.003, "x"))
    for a, b in ((0.22, 0.90), (1.06, z1 - 0.13)):
        bars.append(slab((x0 + 0.12, f0 + 0.018, a - 0.01), (x1 - 0.12, f1 - 0.01, b + 0.01), 0))
        bars.append(
            slab(
                (x0 + 0.185, f0 + 0.006, a + 0.055),
                (x1 - 0.185, f1 - 0.01, b - 0.055),
                0.012,
                "x",
                3,
            )
        )
    d.show("leaf", "painted_white", *bars)
    lever = smooth_path(
        [
            (x0 + 0.065, f0, 1.03),
            (x0 + 0.065, f0 - 0.035, 1.03),
            (x0 + 0.075, f0 - 0.05, 1.03),
            (x0 + 0.11, f0 - 0.052, 1.03),
            (x0 + 0.19, f0 - 0.05, 1.03),
        ],
        6,
    )
    knob = lathe(
        rounded_profile([(0, 0), (0.0095, 0), (0.0095, 0.006), (0, 0.008)], 0.003), 14
    ).turned("y", 90)
    d.show(
        "handle",
        "brass",
        tube(lever, 0.0085, 14),
        knob.moved(x0 + 0.188, f0 - 0.05, 1.03),
        cylinder(0.024, 0, 0.008, bevel=0.003).turned("x", 90).moved(x0 + 0.065, f0, 1.03),
        cylinder(0.024, 0, 0.006, bevel=0.003).turned("x", 90).moved(x0 + 0.065, f0, 0.945),
    )
    return d


def window():
    x0, x1, z0, z1 = WINDOW
    y = -HALF_Y - WALL
    w = Piece("window")
    b, d0, d1 = 0.055, y + 0.03, y + 0.09
    bars = [
        slab((x0, d0, z0), (x0 + b, d1, z1), 0.006, "z"),
        slab((x1 - b, d0, z0), (x1, d1, z1), 0.006, "z"),
        slab((x0, d0, z0), (x1, d1, z0 + b), 0.006),
        slab((x0, d0, z1 - b), (x1, d1, z1), 0.006),
    ]
    mid = (x0 + x1) / 2
    for a, c in ((x0 + b, mid), (mid, x1 - b)):
        e0, e1, s = d0 + 0.008, d1 + 0.014, 0.045
        bars += [
            slab((a, e0, z0 + b), (a + s, e1, z1 - b), 0.006, "z"),
            slab((c - s, e0, z0 + b), (c, e1, z1 - b), 0.006, "z"),
            slab((a, e0, z0 + b), (c, e1, z0 + b + s), 0.006),
            slab((a, e0, z1 - b - s), (c, e1, z1 - b), 0.006),
        ]
    w.show("frame", "painted_white", *bars)
    w.show(
        "sill",
        "painted_white",
        slab(
            (x0 - 0.06, -HALF_Y - 0.11, z0 - 0.012),
            (x1 + 0.06, -HALF_Y + 0.12, z0 + 0.02),
            0.009,
            "x",
            3,
        ),
    )
    w.show(
        "handles",
        "steel",
        *[
            slab(
                (mid + s * 0.022 - 0.009, d1 + 0.01, 1.45),
                (mid + s * 0.022 + 0.009, d1 + 0.045, 1.57),
                0.006,
            )
            for s in (-1, 1)
        ]
    )
    return w


def rug():
    r = Piece("rug", (0.0, 0.0, 0.0), 2.5)
    w, d, h = 1.2, 0.85, 0.006
    m = box((2 * w, 2 * d, 0.012), 0.005, 3).moved(0, 0, h - 0.006)
    m.uv = np.stack([m.p[:, 0] / (2 * w) + 0.5, m.p[:, 1] / (2 * d) + 0.5], 1)
    r.show("pile", "rug", m)
    rng = np.random.default_rng(5)
    fringe = []
    for side in (-1, 1):
        for y in np.arange(-d + 0.012, d - 0.005, 0.019):
            bend, reach = rng.normal(0, 0.006), rng.uniform(0.045, 0.06)
            fringe.append(
                tube(
                    [
                        (side * (w - 0.01), y, 0.003),
                        (side * (w + 0.5 * reach), y + bend, 0.0035),
                        (side * (w + reach), y + 2 * bend + rng.normal(0, 0.003), 0.002),
                    ],
                    0.0022,
                    5,
                )
            )
    return r.show("fringe", "cream_fabric", *fringe)


def woods(rng, y, height, step):
    """A far line of tree tops, seen from the room as a hazy silhouette."""
    x = np.arange(-40, 40.01, step)
    crown = np.convolve(rng.normal(size=len(x) + 24), np.hanning(24), "valid")[: len(x)]
    fine = np.convolve(rng.normal(size=len(x) + 4), np.hanning(4), "valid")[: len(x)]
    top = height * (1 + 0.10 * crown + 0.05 * fine)
    grid = np.empty((2, len(x), 3))
    grid[..., 0], grid[..., 1] = x[::-1], y
    grid[0, :, 2], grid[1, :, 2] = -1.0, top
    return sheet(grid)


def outdoors(rng):
    o = Piece("garden")
    o.show("lawn", "lawn", slab((-40, -60, -0.7), (40, -HALF_Y - WALL, -0.5), 0))
    o.show("woods_far", "woods_far", woods(rng, -58, 4.8, 0.5))
    o.show("woods_middle", "woods_middle", woods(rng, -44, 2.6, 0.4))
    o.show("woods_near", "woods_near", woods(rng, -30, 0.9, 0.3))
    return o
