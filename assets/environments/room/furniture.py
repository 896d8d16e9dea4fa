"""The large pieces. Each maker returns a Piece whose origin lies on the floor below its middle.

Pieces that stand at a wall look along their own +x (their back is at -x).
"""

import numpy as np

from mesh import (
    Mesh,
    box,
    cushion,
    cylinder,
    join,
    lathe,
    leg,
    rounded_profile,
    sheet,
    slab,
    smooth_path,
    tube,
)
from piece import Piece, Visual


def sofa(pos, yaw):
    s = Piece("sofa", pos, yaw)
    frame = [
        slab((-0.40, -0.92, 0.13), (0.40, 0.92, 0.29), 0.025, "y"),
        box((0.17, 1.60, 0.60), 0.06, 3, "y").turned("y", -7).moved(-0.335, 0, 0.47),
    ]
    for side in (-1, 1):
        frame.append(box((0.82, 0.19, 0.46), 0.06, 3).moved(0, 0.865 * side, 0.36))
    s.show("frame", "sofa_fabric", *frame)
    seats, backs = [], []
    for k, side in enumerate((-1, 1)):
        seats.append(
            cushion((0.66, 0.765, 0.17), 0.16, 0.05, 5, 11 + k).moved(0.08, 0.386 * side, 0.365)
        )
        back = cushion((0.17, 0.74, 0.42), 0.30, 0.05, 5, 21 + k).turned("y", -14)
        backs.append(back.moved(-0.155, 0.386 * side, 0.635))
    s.show("seat_cushions", "sofa_fabric", *seats)
    s.show("back_cushions", "sofa_fabric", *backs)
    pillow = (
        cushion((0.15, 0.46, 0.46), 0.25, 0.03, 9, 31, 0.006, 0.12).turned("y", -24).turned("z", 16)
    )
    s.show("pillow_mustard", "mustard_fabric", pillow.moved(0.05, -0.56, 0.66))
    pillow = (
        cushion((0.14, 0.42, 0.42), 0.25, 0.03, 9, 32, 0.006, 0.12)
        .turned("y", -20)
        .turned("z", -22)
    )
    s.show("pillow_rust", "rust_fabric", pillow.moved(0.06, 0.58, 0.64))
    s.show("blanket", "cream_fabric", blanket())
    s.show(
        "legs",
        "walnut",
        *[
            leg((x * 0.36, y * 0.84, 0), (x * 0.33, y * 0.82, 0.135), 0.015, 0.024)
            for x in (-1, 1)
            for y in (-1, 1)
        ],
    )
    s.collide_box((-0.42, -0.96, 0.12), (0.42, 0.96, 0.46))
    s.collide_box((-0.42, -0.80, 0.46), (-0.10, 0.80, 0.84))
    for side in (-1, 1):
        s.collide_box((-0.41, 0.865 * side - 0.095, 0.46), (0.41, 0.865 * side + 0.095, 0.59))
    for x in (-1, 1):
        for y in (-1, 1):
            s.collide_cylinder(0.022, 0, 0.12, x * 0.35, y * 0.83)
    return s


def blanket():
    """Throw laid over the arm at -y, with soft folds."""
    arm, top, bend, gap = (-0.96, -0.77), 0.59, 0.06, 0.009
    turn = np.linspace(0, np.pi / 2, 7)
    inner = np.stack(
        [arm[1] - bend + (bend + gap) * np.cos(turn), top - bend + (bend + gap) * np.sin(turn)], 1
    )
    outer = np.stack(
        [arm[0] + bend - (bend + gap) * np.sin(turn), top - bend + (bend + gap) * np.cos(turn)], 1
    )
    fall = np.stack([np.full(5, arm[0] - gap), np.linspace(0.48, 0.25, 5)], 1)
    over = np.vstack([[(arm[1] + gap, 0.47)], inner, outer, fall])
    x = np.linspace(-0.02, 0.33, 33)
    grid = np.empty((len(over), len(x), 3))
    hang = np.clip((0.53 - over[:, 1]) / 0.3, 0, 1)[:, None]
    outside = over[:, :1] < sum(arm) / 2
    grid[..., 0] = x + 0.012 * hang * np.sin(x * 30)
    grid[..., 1] = over[:, :1] - 0.014 * hang * (1 + np.sin(x * 46 + 1)) * outside
    grid[..., 2] = over[:, 1:] + 0.002 * (1 + np.sin(x * 52)) * (1 - hang)
    return rimmed(grid[:, ::-1], 0.006)


def coffee_table(pos, yaw):
    t = Piece("coffee_table", pos, yaw)
    t.show("top", "oak", slab((-0.215, -0.475, 0.372), (0.215, 0.475, 0.40), 0.009, "y", 3))
    t.show("shelf", "oak", slab((-0.18, -0.43, 0.13), (0.18, 0.43, 0.145), 0.004, "y"))
    t.show(
        "legs",
        "black_metal",
        *[
            slab(
                (x * 0.185 - 0.012, y * 0.435 - 0.012, 0),
                (x * 0.185 + 0.012, y * 0.435 + 0.012, 0.372),
                0.003,
            )
            for x in (-1, 1)
            for y in (-1, 1)
        ],
    )
    t.collide_box((-0.215, -0.475, 0.372), (0.215, 0.475, 0.40))
    t.collide_box((-0.19, -0.445, 0), (0.19, 0.445, 0.145))
    return t


def dining_table(pos, yaw):
    t = Piece("dining_table", pos, yaw)
    t.show("top", "walnut", slab((-0.375, -0.62, 0.712), (0.375, 0.62, 0.74), 0.008, "y", 3))
    apron = [
        slab((x * 0.31 - 0.01, -0.54, 0.635), (x * 0.31 + 0.01, 0.54, 0.712), 0.002, "y")
        for x in (-1, 1)
    ]
    apron += [
        slab((-0.31, y * 0.55 - 0.01, 0.635), (0.31, y * 0.55 + 0.01, 0.712), 0.002)
        for y in (-1, 1)
    ]
    legs = [
        leg((x * 0.325, y * 0.565, 0), (x * 0.30, y * 0.54, 0.712), 0.017, 0.030, 18)
        for x in (-1, 1)
        for y in (-1, 1)
    ]
    t.show("frame", "walnut", *apron, *legs)
    t.collide_box((-0.375, -0.62, 0.635), (0.375, 0.62, 0.74))
    for x in (-1, 1):
        for y in (-1, 1):
            t.collide_cylinder(0.028, 0, 0.635, x * 0.315, y * 0.555)
    return t


def chair(index, pos, yaw):
    """Looks along +x; all chairs share their meshes."""
    c = Piece(f"chair_{index}", pos, yaw)
    legs = [
        leg((x * 0.205, y * 0.19, 0), (x * 0.165, y * 0.165, 0.435), 0.011, 0.018)
        for x in (-1, 1)
        for y in (-1, 1)
    ]
    posts = [
        leg((-0.168, y * 0.172, 0.43), (-0.225, y * 0.182, 0.80), 0.017, 0.012) for y in (-1, 1)
    ]
    rungs = [tube([(-0.185, y * 0.178, 0.2), (0.185, y * 0.178, 0.2)], 0.008) for y in (-1, 1)]
    angle = np.linspace(-1, 1, 13)
    rails = []
    for z, tall in ((0.76, 0.085), (0.63, 0.045)):
        lean = -0.168 - (z - 0.43) * 0.154
        grid = np.empty((4, 13, 3))
        for r, dz in enumerate(np.linspace(-tall / 2, tall / 2, 4)):
            grid[r, :, 0] = lean - 0.035 * (1 - angle**2) + 0.012 - dz * 0.154
            grid[r, :, 1] = angle * 0.195
            grid[r, :, 2] = z + dz
        rails.append(rimmed(grid, 0.014))
    seat = box((0.42, 0.41, 0.028), 0.012, 3).moved(0, 0, 0.449)
    c.show("wood", "oak", seat, *legs, *posts, *rungs, *rails, asset="chair_wood")
    pad = cushion((0.38, 0.37, 0.035), 0.25, 0.015, 5, 5).moved(0.005, 0, 0.474)
    c.show("pad", "teal_fabric", pad, asset="chair_pad")
    c.collide_box((-0.21, -0.205, 0.43), (0.21, 0.205, 0.48))
    c.collide_box((-0.26, -0.20, 0.48), (-0.16, 0.20, 0.81))
    for x in (-1, 1):
        for y in (-1, 1):
            c.collide_cylinder(0.016, 0, 0.43, x * 0.19, y * 0.18)
    return c


def rimmed(grid, thickness):
    """Thin bent board: both faces of a grid and its rim."""
    front = sheet(grid)
    back_points = (front.p - thickness * front.n).reshape(grid.shape)
    loops = [
        (grid[0], back_points[0]),
        (grid[:, -1], back_points[:, -1]),
        (grid[-1][::-1], back_points[-1][::-1]),
        (grid[::-1, 0], back_points[::-1, 0]),
    ]
    rim = [sheet(np.stack([b, a])) for a, b in loops]
    back = Mesh(back_points, -front.n, front.uv, front.f[:, ::-1])
    return join(front, back, *rim)


def bookshelf(pos, yaw, rng):
    """1.2 m wide (along y), 0.30 deep, 1.86 high, five bays high, with books and a few things."""
    s = Piece("bookshelf", pos, yaw)
    boards = [
        slab((-0.15, y - 0.011, 0), (0.15, y + 0.011, 1.86), 0.003, "z") for y in (-0.589, 0, 0.589)
    ]
    levels = [0.06, 0.42, 0.78, 1.14, 1.50]
    for z in levels + [1.849]:
        boards.append(slab((-0.149, -0.578, z - 0.011), (0.145, 0.578, z + 0.011), 0.002, "y"))
    boards.append(slab((0.11, -0.578, 0), (0.125, 0.578, 0.05), 0.001, "y"))
    s.show("boards", "oak", *boards)
    s.show("back", "oak", slab((-0.15, -0.578, 0.02), (-0.144, 0.578, 1.85), 0, "z"))
    s.collide_box((-0.15, -0.60, 0), (0.15, 0.60, 1.86))
    tints = [
        (0.45, 0.10, 0.08),
        (0.08, 0.19, 0.32),
        (0.72, 0.52, 0.16),
        (0.15, 0.30, 0.20),
        (0.80, 0.76, 0.66),
        (0.10, 0.10, 0.11),
        (0.55, 0.27, 0.13),
        (0.25, 0.40, 0.45),
        (0.62, 0.62, 0.60),
        (0.34, 0.14, 0.24),
    ]
    number = 0
    bays = [(z, lo, hi) for z in levels[:5] for lo, hi in ((-0.575, -0.014), (0.014, 0.575))]
    gaps = {3: 0.28, 4: 0.26, 7: 0.30, 8: 0.18, 1: 0.22, 0: 0.10}
    for k, (z, lo, hi) in enumerate(bays):
        y, end = lo + 0.006, hi - gaps.get(k, 0.04)
        while True:
            kind = int(rng.integers(len(BOOKS)))
            thin, tall, deep = BOOKS[kind]
            if y + thin > end:
                break
            number += 1
            book(
                s,
                f"book_{number:02d}",
                kind,
                (0.115 - deep / 2 + rng.uniform(-0.01, 0.012), y + thin / 2, z + 0.0115),
                0.0,
                tints[rng.integers(len(tints))],
            )
            y += thin + 0.0012
        if k in (1, 4, 8):
            number += 1
            book(s, f"book_{number:02d}", 3, (0.03, y + 0.052, z + 0.0105), 17.0, tints[k % 10])
    vase = lathe(
        rounded_profile(
            [
                (0, 0),
                (0.045, 0),
                (0.075, 0.09),
                (0.03, 0.17),
                (0.036, 0.20),
                (0.030, 0.20),
                (0.024, 0.16),
                (0, 0.15),
            ],
            0.03,
            5,
        ),
        28,
    )
    s.show("vase", "glazed_blue", vase.moved(0.0, 0.46, 0.791 + 0.36))
    crate = [slab((-0.10, 0.33, 0.4315), (0.11, 0.56, 0.61), 0.008)]
    s.show("basket", "rattan", *crate)
    bowl = lathe(
        rounded_profile(
            [(0, 0), (0.04, 0), (0.10, 0.07), (0.094, 0.07), (0.036, 0.012), (0, 0.012)], 0.012, 4
        ),
        28,
    )
    s.show("bowl", "ceramic_white", bowl.moved(0.01, -0.16, 0.791 + 0.72))
    return s


BOOKS = (
    (0.018, 0.21, 0.14),
    (0.024, 0.24, 0.16),
    (0.030, 0.22, 0.15),
    (0.028, 0.22, 0.16),
    (0.038, 0.27, 0.19),
    (0.045, 0.25, 0.17),
    (0.022, 0.29, 0.21),
    (0.033, 0.30, 0.20),
)  # thin, tall, deep [m]


def book(piece, name, kind, pos, lean, rgba):
    """Standing book of one of the sizes; spine towards +x, leaning by `lean` degrees about x."""
    thin, tall, deep = BOOKS[kind]
    x, y, z = pos
    cover = [
        slab((-deep / 2, -thin / 2, 0), (deep / 2, -thin / 2 + 0.0025, tall), 0),
        slab((-deep / 2, thin / 2 - 0.0025, 0), (deep / 2, thin / 2, tall), 0),
    ]
    a = np.linspace(-np.pi / 2, np.pi / 2, 7)
    spine = np.empty((2, 7, 3))
    spine[..., 0] = deep / 2 + 0.22 * thin * np.cos(a)
    spine[..., 1] = thin / 2 * np.sin(a)
    spine[0, :, 2], spine[1, :, 2] = 0, tall
    back = sheet(spine, np.stack(np.meshgrid(np.linspace(0, 1, 7), [0.0, 1.0]), -1))
    for m in cover:
        m.uv = np.full_like(m.uv, 0.02)
    mesh = join(*cover, back)
    piece.visuals.append(
        Visual(
            name,
            "book_cloth",
            mesh,
            f"book_cover_{kind}",
            pos=(x, y, z),
            euler=(lean, 0, 0),
            rgba=rgba + (1,),
        )
    )
    up = np.array([0, -np.sin(np.radians(lean)), np.cos(np.radians(lean))]) * tall / 2
    piece.visuals.append(
        Visual(
            name + "_pages",
            "paper",
            primitive="box",
            size=(deep / 2 - 0.002, thin / 2 - 0.002, tall / 2 - 0.003),
            pos=(x + 0.0015, y + up[1], z + up[2]),
            euler=(lean, 0, 0),
        )
    )


def tv_stand(pos, yaw):
    """1.5 m wide (along y) sideboard with a television."""
    s = Piece("tv_stand", pos, yaw)
    body = [
        slab((-0.20, -0.75, 0.505), (0.20, 0.75, 0.53), 0.004, "y"),
        slab((-0.20, -0.75, 0.13), (0.20, 0.75, 0.15), 0.003, "y"),
        slab((-0.20, -0.75, 0.15), (0.20, -0.73, 0.505), 0.002, "z"),
        slab((-0.20, 0.73, 0.15), (0.20, 0.75, 0.505), 0.002, "z"),
        slab((-0.20, -0.73, 0.15), (-0.19, 0.73, 0.505), 0, "y"),
    ]
    s.show("body", "walnut", *body)
    doors = [
        slab((0.176, lo + 0.002, 0.153), (0.196, hi - 0.002, 0.502), 0.003, "z")
        for lo, hi in ((-0.73, -0.25), (0.25, 0.73))
    ]
    drawers = [
        slab((0.176, -0.248, z0 + 0.002), (0.196, 0.248, z1 - 0.002), 0.003, "y")
        for z0, z1 in ((0.151, 0.327), (0.327, 0.504))
    ]
    s.show("fronts", "painted_white", *doors, *drawers)
    pulls = [
        slab((0.196, y - 0.006, 0.29), (0.214, y + 0.006, 0.40), 0.004) for y in (-0.285, 0.285)
    ]
    pulls += [
        slab((0.196, -0.06, z - 0.006), (0.214, 0.06, z + 0.006), 0.004) for z in (0.275, 0.455)
    ]
    s.show("pulls", "brass", *pulls)
    s.show(
        "legs",
        "black_metal",
        *[
            leg((x * 0.16, y * 0.66, 0), (x * 0.15, y * 0.64, 0.13), 0.010, 0.016)
            for x in (-1, 1)
            for y in (-1, 1)
        ],
    )
    s.collide_box((-0.20, -0.75, 0.13), (0.214, 0.75, 0.53))
    for y in (-1, 1):
        s.collide_box((-0.17, y * 0.65 - 0.03, 0), (0.17, y * 0.65 + 0.03, 0.13))
    return s


def television(pos, yaw):
    t = Piece("television", pos, yaw)
    t.show(
        "case",
        "black_plastic",
        slab((-0.03, -0.50, 0.045), (0.012, 0.50, 0.615), 0.006),
        slab((-0.09, -0.16, 0), (0.09, 0.16, 0.012), 0.005),
        slab((-0.02, -0.04, 0.01), (-0.005, 0.04, 0.06), 0.002),
    )
    t.show("screen", "screen_glass", slab((0.0115, -0.49, 0.06), (0.0128, 0.49, 0.605), 0))
    t.collide_box((-0.09, -0.50, 0), (0.09, 0.50, 0.615))
    return t


def plant(name, pos, rng, height=1.25, leaves=34):
    p = Piece(name, pos)
    pot = lathe(
        rounded_profile(
            [
                (0, 0.0),
                (0.125, 0.0),
                (0.165, 0.28),
                (0.17, 0.30),
                (0.150, 0.30),
                (0.145, 0.255),
                (0, 0.255),
            ],
            0.012,
            4,
        ),
        36,
    )
    p.show("pot", "terracotta", pot)
    p.show("soil", "soil", cylinder(0.147, 0.20, 0.258, bevel=0.004))
    stems, foliage = [], []
    for k in range(3):
        a = 2.1 * k + 0.4
        top = height * (1 - 0.17 * k)
        lean = np.array([np.cos(a), np.sin(a)])
        path = smooth_path(
            [
                (*(0.03 * lean), 0.25),
                (*(0.06 * lean), 0.25 + 0.4 * (top - 0.25)),
                (*(0.15 * lean), top),
            ],
            6,
        )
        stems.append(tube(path, 0.009, 8))
        count = leaves // 3
        for j in range(count):
            t = 0.22 + 0.78 * (j + 1) / count
            base = path[min(int(t * (len(path) - 1)), len(path) - 1)]
            turn = np.degrees(2.4 * j + a) + rng.uniform(-15, 15)
            size = rng.uniform(0.21, 0.30) * (1.12 - 0.35 * t)
            lift = rng.uniform(18, 42) + 30 * (t > 0.93)
            foliage.append(leaf(size, rng).turned("y", -lift).turned("z", turn).moved(*base))
    p.show("stems", "bark", *stems)
    p.show("leaves", "leaf", *foliage)
    p.collide_cylinder(0.165, 0, 0.30)
    p.collide_cylinder(0.05, 0.30, height)
    return p


def leaf(length, rng):
    """Along +x, folded at the midrib and drooping towards its tip; about 1 mm thick."""
    t, s = np.linspace(0, 1, 8), np.linspace(-1, 1, 5)
    width = 0.34 * length * np.sin(np.pi * np.clip(t, 0, 1) ** 0.75) ** 0.85 + 0.002
    droop = rng.uniform(0.25, 0.6)
    grid = np.empty((8, 5, 3))
    stalk = 0.04
    grid[..., 0] = (stalk + length * (t - 0.12 * t**3))[:, None]
    grid[..., 1] = -width[:, None] * s
    grid[..., 2] = (
        (-droop * length * t**2)[:, None]
        + 0.35 * width[:, None] * np.abs(s)
        + 0.02 * length * np.sin(t * 14)[:, None] * s**2
    )
    uv = np.stack(np.meshgrid((s + 1) / 2, t), -1)
    front = sheet(grid[:, ::-1], uv[:, ::-1])
    back = Mesh(front.p - 0.001 * front.n, -front.n, front.uv, front.f[:, ::-1])
    stem = tube([(0, 0, 0), (stalk + 0.01, 0, 0)], 0.0025, 5)
    stem.uv = np.full_like(stem.uv, 0.5)
    return join(front, back, stem)
