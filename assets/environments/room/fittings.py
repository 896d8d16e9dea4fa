"""Lamps, window dressing, radiator, pictures, toys and other small things."""

import numpy as np

from furniture import BOOKS, book, leaf
from mesh import Mesh, box, cylinder, join, lathe, rounded_profile, sheet, slab, smooth_path, tube
from piece import Collider, Piece, Visual


def lamp_shade(r0, r1, z0, z1):
    return lathe(rounded_profile([(0, z0), (r0, z0), (r1, z1), (0, z1)], 0.004, 1), 36)


def floor_lamp(pos):
    f = Piece("floor_lamp", pos)
    f.show(
        "stand",
        "black_metal",
        cylinder(0.14, 0, 0.022, bevel=0.006, segments=36),
        cylinder(0.011, 0.02, 1.34, segments=16),
        cylinder(0.02, 1.28, 1.33, 0.014, segments=16),
    )
    f.show(
        "shade_rings",
        "black_metal",
        *[
            cylinder(r, z, z + 0.008, bevel=0.002, segments=36)
            for r, z in ((0.203, 1.328), (0.153, 1.606))
        ],
    )
    f.show("shade", "warm_shade", lamp_shade(0.20, 0.15, 1.337, 1.605))
    f.collide_cylinder(0.14, 0, 0.022)
    f.collide_cylinder(0.02, 0.022, 1.6)
    return f


def table_lamp(pos):
    t = Piece("table_lamp", pos)
    foot = lathe(
        rounded_profile(
            [
                (0, 0),
                (0.07, 0),
                (0.085, 0.08),
                (0.03, 0.17),
                (0.014, 0.20),
                (0.012, 0.24),
                (0, 0.24),
            ],
            0.04,
            5,
        ),
        32,
    )
    t.show("foot", "glazed_rust", foot)
    t.show("shade", "warm_shade", lamp_shade(0.13, 0.10, 0.225, 0.40))
    t.collide_cylinder(0.12, 0, 0.40)
    return t


def pendant_lamp(pos, drop, radius):
    """Paper lantern: a sphere that glows evenly. pos is on the ceiling."""
    p = Piece("pendant_lamp", pos)
    p.show(
        "cord",
        "white_plastic",
        cylinder(0.05, -0.025, 0, bevel=0.006),
        cylinder(0.0035, radius - drop, -0.02, bevel=0.001, segments=8),
    )
    p.visuals.append(
        Visual("lantern", "paper_lantern", primitive="sphere", size=(radius,), pos=(0, 0, -drop))
    )
    ribs = []
    for z in np.linspace(-0.88, 0.88, 11) * radius:
        r, a = np.sqrt(radius**2 - z**2) + 0.0005, np.linspace(0, 2 * np.pi, 41)
        ribs.append(
            tube(np.stack([r * np.cos(a), r * np.sin(a), np.full(41, z - drop)], 1), 0.0011, 5)
        )
    p.show("ribs", "rattan", *ribs)
    p.show(
        "ring",
        "white_plastic",
        *[
            lathe([(radius * 0.24, z - 0.006), (radius * 0.27, z), (radius * 0.24, z + 0.006)], 24)
            for z in (-drop - 0.97 * radius, -drop + 0.97 * radius)
        ],
    )
    return p


def curtain(name, pos, width, height, seed):
    """Hangs from z = height down, along x; folds deepen towards the floor."""
    c = Piece(name, pos)
    rng = np.random.default_rng(seed)
    u, v = np.linspace(0, 1, 81), np.linspace(0, 1, 10)
    folds = 7.5
    phase = 2 * np.pi * folds * u + 0.7 * np.sin(2 * np.pi * 2 * u + rng.uniform(0, 6))
    depth = 0.030 + 0.014 * np.sin(2 * np.pi * 3 * u + rng.uniform(0, 6))
    grid = np.empty((10, 81, 3))
    for r, t in enumerate(v):
        low = 1 - t  # 1 at the floor
        grid[r, :, 0] = (u - 0.5) * width * (1 + 0.05 * low) + 0.010 * np.sin(2 * phase) * (
            0.4 + 0.6 * low
        )
        grid[r, :, 1] = depth * np.sin(phase + 0.25 * np.sin(5 * t + 3 * u)) * (0.75 + 0.35 * low)
        grid[r, :, 2] = 0.02 + t * (height - 0.02)
    front = sheet(grid)
    back = Mesh(front.p - 0.003 * front.n, -front.n, front.uv, front.f[:, ::-1])
    c.show("cloth", "curtain_linen", front, back)
    return c


def curtain_rod(pos, length):
    r = Piece("curtain_rod", pos)
    bar = tube([(-length / 2, 0, 0), (length / 2, 0, 0)], 0.011, 12)
    ends = [
        lathe(
            rounded_profile([(0, -0.025), (0.024, -0.02), (0.024, 0.02), (0, 0.025)], 0.015, 4), 16
        )
        .turned("y", 90)
        .moved(s * (length / 2 + 0.012))
        for s in (-1, 1)
    ]
    holders = [
        slab((x - 0.008, -0.10, -0.012), (x + 0.008, 0.006, 0.012), 0.003)
        for x in (-length * 0.46, length * 0.46)
    ]
    r.show("bar", "black_metal", bar, *ends, *holders)
    return r


def radiator(pos, yaw, width=1.2):
    r = Piece("radiator", pos, yaw)
    count = int(width / 0.06)
    columns = []
    for k in range(count):
        y = (k - (count - 1) / 2) * 0.06
        for x in (-0.028, 0.028):
            columns.append(box((0.036, 0.046, 0.50), 0.016, 1, "z").moved(x, y, 0.40))
        for z in (0.175, 0.625):
            columns.append(box((0.09, 0.054, 0.05), 0.018, 1).moved(0, y, z))
    r.show("columns", "radiator_white", *columns)
    y0 = -count * 0.03
    pipe = smooth_path(
        [(0, y0, 0.18), (0, y0 - 0.05, 0.18), (0, y0 - 0.075, 0.15), (0, y0 - 0.08, 0.0)], 5
    )
    valve = cylinder(0.02, 0, 0.07, 0.016, 0.005, 18).turned("x", 90).moved(0, y0 - 0.05, 0.625)
    r.show(
        "pipes",
        "steel",
        tube(pipe, 0.009, 10),
        tube([(0, y0 + 0.01, 0.625), (0, y0 - 0.06, 0.625)], 0.009, 10),
        tube([(0, -y0, 0.18), (0, -y0 + 0.03, 0.18), (0, -y0 + 0.04, 0.0)], 0.009, 10),
    )
    r.show("valve", "white_plastic", valve)
    r.collide_box((-0.05, -width / 2 - 0.1, 0), (0.05, width / 2 + 0.05, 0.65))
    return r


def picture(name, art, pos, yaw, width, height, frame_material):
    """Hangs on a wall: back at x = 0, looks along +x; pos is the middle."""
    p = Piece(name, pos, yaw)
    w, h, b = width / 2, height / 2, 0.022
    rails = [
        slab(
            (0, -w, s * h - (b if s > 0 else 0)),
            (0.024, w, s * h + (0 if s > 0 else b)),
            0.003,
            "y",
        )
        for s in (-1, 1)
    ]
    rails += [
        slab(
            (0, s * w - (b if s > 0 else 0), -h + b),
            (0.024, s * w + (0 if s > 0 else b), h - b),
            0.003,
            "z",
        )
        for s in (-1, 1)
    ]
    p.show("frame", frame_material, *rails)
    canvas = slab((0.003, -w + 0.01, -h + 0.01), (0.013, w - 0.01, h - 0.01), 0)
    canvas.uv = np.stack([(canvas.p[:, 1] + w) / width, (canvas.p[:, 2] + h) / height], 1)
    p.show("canvas", art, canvas)
    return p


def toy_block(letter, pos, yaw):
    side = 0.06
    b = Piece(f"toy_block_{letter.lower()}", (pos[0], pos[1], pos[2] + side / 2), yaw, mass=0.09)
    m = box((side,) * 3, 0.004, 2)
    p, n = m.p[m.f].reshape(-1, 3), np.repeat(m.n[m.f].mean(1), 3, 0)
    right = {0: ((0, 1, 0), (0, 0, 1)), 1: ((-1, 0, 0), (0, 0, 1)), 2: ((1, 0, 0), (0, 1, 0))}
    uv = np.empty((len(p), 2))
    for axis, (u, v) in right.items():
        on = np.abs(n).argmax(1) == axis
        flip = np.sign(n[on, axis])
        uv[on] = np.stack([p[on] @ u * flip, p[on] @ v], 1) / side + 0.5
    m = Mesh(p, m.n[m.f].reshape(-1, 3), uv, np.arange(len(p)).reshape(-1, 3))
    b.show("wood", f"block_{letter.lower()}", m, asset="toy_block")
    b.colliders.append(Collider("box", (side / 2,) * 3, friction="0.6 0.005 0.0001"))
    return b


def toy_ball(pos, radius):
    b = Piece("ball", (pos[0], pos[1], radius), 25, mass=0.25)
    t = np.linspace(-np.pi / 2, np.pi / 2, 25)
    a = np.linspace(0, 2 * np.pi, 49)
    d = np.stack(
        [
            np.outer(np.cos(t), np.cos(a)),
            np.outer(np.cos(t), np.sin(a)),
            np.repeat(np.sin(t)[:, None], 49, 1),
        ],
        -1,
    )
    m = sheet(radius * d, np.stack(np.meshgrid(np.linspace(0, 1, 49), np.linspace(0, 1, 25)), -1))
    m.n = d.reshape(-1, 3)
    area = np.linalg.norm(
        np.cross(m.p[m.f[:, 1]] - m.p[m.f[:, 0]], m.p[m.f[:, 2]] - m.p[m.f[:, 0]]), axis=1
    )
    m.f = m.f[area > 1e-10]
    b.show("skin", "ball", m.turned("x", 62))
    b.colliders.append(Collider("sphere", (radius,), friction="0.7 0.005 0.002"))
    return b


def cardboard_box(pos, yaw):
    """Open removal box 0.42 x 0.32 x 0.30 m with four flaps."""
    w, d, h, t = 0.21, 0.16, 0.30, 0.004
    c = Piece("cardboard_box", (pos[0], pos[1], h / 2), yaw, mass=1.4)
    z = -h / 2
    walls = [
        slab((-w, s * d - (t if s > 0 else 0), z), (w, s * d + (0 if s > 0 else t), z + h), 0, "x")
        for s in (-1, 1)
    ]
    walls += [
        slab((s * w - (t if s > 0 else 0), -d, z), (s * w + (0 if s > 0 else t), d, z + h), 0, "y")
        for s in (-1, 1)
    ]
    walls.append(slab((-w, -d, z), (w, d, z + t), 0))
    flaps = []
    for s, tilt in ((-1, 48), (1, 30)):
        flap = slab((-w, 0, 0), (w, 0.15, t), 0).turned("x", -tilt)
        flaps.append((flap if s > 0 else flap.turned("z", 180)).moved(0, s * d, z + h - t))
    for s, tilt in ((-1, 62), (1, 20)):
        flap = slab((0, -d, 0), (0.15, d, t), 0, "y").turned("y", tilt)
        flaps.append((flap if s > 0 else flap.turned("z", 180)).moved(s * w, 0, z + h - t))
    c.show("board", "cardboard", *walls, *flaps)
    tape = [
        slab(
            (s * (w + 0.0004) - 0.0003, -0.025, z),
            (s * (w + 0.0004) + 0.0003, 0.025, z + h * 0.45),
            0,
        )
        for s in (-1, 1)
    ]
    c.show("tape", "parcel_tape", *tape)
    c.colliders.append(Collider("box", (w, d, h / 2), friction="0.6 0.005 0.0001"))
    return c


def mug(name, pos, material):
    m = Piece(name, pos)
    cup = lathe(
        rounded_profile(
            [(0, 0), (0.036, 0), (0.041, 0.09), (0.038, 0.09), (0.034, 0.008), (0, 0.008)], 0.006, 4
        ),
        28,
    )
    grip = tube(
        smooth_path([(0.038, 0, 0.072), (0.062, 0, 0.07), (0.066, 0, 0.04), (0.037, 0, 0.022)], 6),
        0.005,
        8,
    )
    m.show("cup", material, cup, grip)
    return m


def fruit_bowl(pos):
    b = Piece("fruit_bowl", pos)
    b.show(
        "bowl",
        "ceramic_white",
        lathe(
            rounded_profile(
                [(0, 0), (0.06, 0), (0.15, 0.075), (0.143, 0.077), (0.055, 0.01), (0, 0.01)],
                0.014,
                4,
            ),
            36,
        ),
    )
    spots = [
        (0.05, 0.02, 0.065),
        (-0.04, 0.05, 0.067),
        (-0.03, -0.05, 0.066),
        (0.045, -0.055, 0.067),
        (0.005, 0.0, 0.118),
    ]
    for k, spot in enumerate(spots):
        b.visuals.append(
            Visual(
                f"fruit_{k + 1}",
                "orange_peel" if k % 2 else "apple_red",
                primitive="ellipsoid",
                size=(0.04, 0.04, 0.037),
                pos=spot,
            )
        )
    return b


def lying_book(name, pos, yaw, size, rgba):
    x, y, z = size
    b = Piece(name, pos, yaw)
    cover = join(
        slab((-x / 2, -y / 2, 0), (x / 2, y / 2, 0.003), 0.001),
        slab((-x / 2, -y / 2, z - 0.003), (x / 2, y / 2, z), 0.001),
        slab((-x / 2, -y / 2, 0), (-x / 2 + 0.003, y / 2, z), 0.001),
    )
    cover.uv = np.full_like(cover.uv, 0.02)
    b.visuals.append(Visual("cover", "book_cloth", cover, rgba=rgba + (1,)))
    b.collide_box((-x / 2, -y / 2, 0), (x / 2, y / 2, z))
    b.show(
        "pages",
        "paper",
        slab((-x / 2 + 0.003, -y / 2 + 0.004, 0.003), (x / 2 - 0.004, y / 2 - 0.004, z - 0.003), 0),
    )
    return b


def toy_car(pos, yaw):
    """Wooden toy car 0.18 m long, along x."""
    c = Piece("toy_car", pos, yaw)
    side = np.array(
        [
            (-0.09, 0.02),
            (0.09, 0.02),
            (0.09, 0.045),
            (0.045, 0.055),
            (0.02, 0.085),
            (-0.05, 0.085),
            (-0.085, 0.055),
        ]
    )
    outline = rounded_profile(np.vstack([side, side[:1]]), 0.012, 3)
    mid = outline.mean(0)
    grid = np.stack(
        [
            np.stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]], 1)
            for y in (0.035, -0.035)
        ]
    )
    cap = [
        sheet(
            np.stack(
                [
                    grid[k] if k else grid[0],
                    np.tile([mid[0], grid[k, 0, 1], mid[1]], (len(outline), 1)),
                ][:: 1 if k else -1]
            )
        )
        for k in (0, 1)
    ]
    c.show("body", "toy_paint", sheet(grid), *cap)
    wheels = [
        cylinder(0.022, -0.008, 0.008, bevel=0.004, segments=20).turned("x", 90).moved(x, y, 0.022)
        for x in (-0.055, 0.055)
        for y in (-0.044, 0.044)
    ]
    c.show("wheels", "oak", *wheels)
    c.collide_box((-0.09, -0.05, 0), (0.09, 0.05, 0.085))
    return c


def remote(pos, yaw):
    r = Piece("remote_control", pos, yaw)
    keys = [
        slab((x - 0.006, y - 0.005, 0.017), (x + 0.006, y + 0.005, 0.0195), 0.001)
        for x in np.arange(-0.055, 0.06, 0.022)
        for y in (-0.013, 0.0, 0.013)
    ]
    r.show("case", "black_plastic", slab((-0.085, -0.022, 0), (0.085, 0.022, 0.018), 0.006))
    return r.show("keys", "white_plastic", *keys)


def wall_shelf(pos, yaw, rng):
    """Floating board 1.0 m long (along y) with a few things on it; back at x = 0."""
    s = Piece("wall_shelf", pos, yaw)
    s.show("board", "oak", slab((0, -0.50, -0.014), (0.20, 0.50, 0.014), 0.003, "y"))
    s.show(
        "brackets",
        "black_metal",
        *[slab((0, y - 0.012, -0.10), (0.006, y + 0.012, -0.014), 0.001) for y in (-0.38, 0.38)],
        *[slab((0, y - 0.012, -0.02), (0.17, y + 0.012, -0.014), 0.001) for y in (-0.38, 0.38)],
    )
    y = -0.44
    for k, rgba in enumerate(
        (
            (0.62, 0.62, 0.60),
            (0.45, 0.10, 0.08),
            (0.10, 0.22, 0.34),
            (0.72, 0.52, 0.16),
            (0.2, 0.3, 0.22),
        )
    ):
        thin = BOOKS[(2 * k + 1) % 6][0]
        book(s, f"shelf_book_{k + 1}", (2 * k + 1) % 6, (0.10, y + thin / 2, 0.0145), 0, rgba)
        y += thin + 0.001
    s.show(
        "jar",
        "glazed_rust",
        lathe(
            rounded_profile(
                [
                    (0, 0),
                    (0.05, 0),
                    (0.06, 0.10),
                    (0.034, 0.13),
                    (0.038, 0.15),
                    (0.03, 0.15),
                    (0, 0.12),
                ],
                0.02,
                5,
            ),
            28,
        ).moved(0.10, 0.02, 0.0145),
    )
    s.show(
        "pot",
        "ceramic_white",
        lathe(
            rounded_profile([(0, 0), (0.05, 0), (0.062, 0.10), (0.055, 0.10), (0, 0.09)], 0.008, 4),
            28,
        ).moved(0.10, 0.33, 0.0145),
    )
    leaves = []
    for k in range(26):
        leaves.append(
            leaf(rng.uniform(0.06, 0.11), rng)
            .turned("y", -rng.uniform(5, 75))
            .turned("z", 137.5 * k)
            .moved(0.10, 0.33, 0.105)
        )
    s.show("leaves", "leaf", *leaves)
    return s


def pouf(pos):
    p = Piece("pouf", pos)
    a = np.linspace(0, 2 * np.pi, 61)
    prof = rounded_profile(
        [(0.0, 0.0), (0.22, 0.0), (0.27, 0.17), (0.22, 0.35), (0.0, 0.355)], 0.12, 4
    )
    grid = np.empty((len(prof), 61, 3))
    rib = 1 + 0.018 * np.cos(12 * a) * (prof[:, :1] > 0.02)
    grid[..., 0], grid[..., 1] = prof[:, :1] * np.cos(a) * rib, prof[:, :1] * np.sin(a) * rib
    grid[..., 2] = prof[:, 1:]
    m = sheet(grid)
    area = np.linalg.norm(
        np.cross(m.p[m.f[:, 1]] - m.p[m.f[:, 0]], m.p[m.f[:, 2]] - m.p[m.f[:, 0]]), axis=1
    )
    m.f = m.f[area > 1e-9]
    p.show("cover", "rust_fabric", m)
    p.collide_cylinder(0.26, 0, 0.35)
    return p


def basket(pos):
    """Waste-paper basket."""
    b = Piece("waste_basket", pos)
    b.show(
        "shell",
        "rattan",
        lathe(
            rounded_profile(
                [(0, 0), (0.11, 0), (0.14, 0.30), (0.132, 0.30), (0.104, 0.008), (0, 0.008)],
                0.008,
                3,
            ),
            32,
        ),
    )
    b.collide_cylinder(0.135, 0, 0.30)
    return b


def cable(name, points):
    return Piece(name).show("wire", "black_plastic", tube(smooth_path(points, 8), 0.0035, 7))


def socket(name, pos, yaw):
    """Wall plate, looks along +x."""
    s = Piece(name, pos, yaw)
    s.show("plate", "white_plastic", slab((0, -0.04, -0.04), (0.009, 0.04, 0.04), 0.004))
    s.show(
        "holes",
        "black_plastic",
        *[
            cylinder(0.0035, 0, 0.0006, bevel=0.0001, segments=10)
            .turned("y", 90)
            .moved(0.009, y, 0)
            for y in (-0.0095, 0.0095)
        ],
    )
    return s
