"""Procedural, seamless 8-bit textures. Normal maps: tangent space, OpenGL convention (green = up)."""

import struct
import zlib

import numpy as np


def write_png(path, image):
    """(H,W) or (H,W,3) uint8; rows top to bottom."""
    image = np.ascontiguousarray(image, np.uint8)
    h, w = image.shape[:2]
    c = 1 if image.ndim == 2 else image.shape[2]
    rows = image.reshape(h, w, c).astype(np.int16)
    left = np.concatenate([np.zeros((h, 1, c), np.int16), rows[:, :-1]], 1)
    up = np.concatenate([np.zeros((1, w, c), np.int16), rows[:-1]], 0)
    mean = (left + up) // 2
    choices = [
        (k, ((rows - guess) & 255).astype(np.uint8))
        for k, guess in ((0, 0), (1, left), (2, up), (3, mean))
    ]
    cost = np.stack([np.abs(d.astype(np.int8).astype(int)).sum((1, 2)) for _, d in choices])
    raw = b"".join(
        bytes([best]) + choices[best][1][y].tobytes() for y, best in enumerate(cost.argmin(0))
    )

    def chunk(tag, body):
        return (
            struct.pack(">I", len(body))
            + tag
            + body
            + struct.pack(">I", zlib.crc32(tag + body) & 0xFFFFFFFF)
        )

    header = struct.pack(">IIBBBBB", w, h, 8, {1: 0, 3: 2}[c], 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(raw, 9))
        + chunk(b"IEND", b"")
    )


def noise(h, w, lx, ly, rng, power=1.0):
    """Seamless Gaussian noise, unit variance, correlation lengths lx, ly in pixels."""
    fy, fx = np.fft.fftfreq(h)[:, None] * ly, np.fft.rfftfreq(w)[None, :] * lx
    spectrum = np.exp(-0.5 * ((2 * np.pi) ** 2 * (fx**2 + fy**2) * 0.5) ** power)
    out = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(h, w))) * spectrum, (h, w))
    out -= out.mean()
    return out / out.std()


def normal_map(height, pixel):
    """Height field [m] with square pixels of `pixel` metres to RGB."""
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * pixel)
    dy = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) / (2 * pixel)
    n = np.stack([-dx, -dy, np.ones_like(dx)], -1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    return to8(n * 0.5 + 0.5)


def to8(x):
    return np.clip(np.rint(np.asarray(x) * 255), 0, 255).astype(np.uint8)


def mix(a, b, t):
    t = np.asarray(t)[..., None]
    return np.asarray(a) * (1 - t) + np.asarray(b) * t


def wood_figure(h, w, rng, grain=1.0):
    """Growth-ring figure in 0..1 and fine pores; u is along the grain."""
    warp = noise(h, w, 260, 26, rng) * 0.9 + noise(h, w, 90, 10, rng) * 0.3
    v = np.arange(h)[:, None] / h
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (v * 5 + warp * grain))
    streak = noise(h, w, 120, 1.3, rng)
    pores = np.clip(noise(h, w, 14, 0.8, rng) - 1.3, 0, 2)
    return rings, streak, pores


def plank_atlas(rng):
    """Eight oak boards of 2.0 x 0.14 m, one per strip of 128 px; grooves along both long edges."""
    h, w, strips = 1024, 1024, 8
    s = h // strips
    rgb, height, rough = np.empty((h, w, 3)), np.empty((h, w)), np.empty((h, w))
    light, dark = np.array([0.74, 0.61, 0.47]), np.array([0.53, 0.40, 0.285])
    d = np.minimum(np.arange(s) + 0.5, s - np.arange(s) - 0.5)[:, None] * 0.14 / s
    groove = np.clip(1 - d / 0.0028, 0, 1)
    for k in range(strips):
        rings, streak, pores = wood_figure(s, w, rng, 1.0 if k % 3 else 0.35)
        t = np.clip(0.16 + 0.40 * rings + 0.13 * streak + rng.uniform(-0.14, 0.26), 0, 1)
        c = mix(light, dark, t) * (rng.uniform(0.88, 1.06) + rng.uniform(-0.012, 0.012, 3))
        c *= (1 - 0.25 * np.clip(pores, 0, 1))[..., None]
        c *= (1 - 0.62 * groove**0.8)[..., None]
        rows = slice(k * s, (k + 1) * s)
        rgb[rows] = c
        height[rows] = -0.0011 * groove**1.5 - 4e-5 * pores + 2.2e-5 * streak
        rough[rows] = 0.36 + 0.05 * rings + 0.10 * pores + 0.3 * groove + 0.02 * streak
    smear = 0.035 * noise(h, w, 60, 40, rng)
    # Rows are 0.14/128 m, columns 2.0/1024 m: compare slopes at the finer of the two.
    return to8(rgb), normal_map(height, 0.0012), to8(rough + smear)


def furniture_wood(rng):
    """Neutral light wood 0.8 m square; materials tint it."""
    n = 512
    rings, streak, pores = wood_figure(n, n, rng)
    t = np.clip(0.28 + 0.36 * rings + 0.15 * streak, 0, 1)
    c = mix([0.95, 0.93, 0.90], [0.70, 0.64, 0.57], t) * (1 - 0.3 * np.clip(pores, 0, 1))[..., None]
    height = 3e-5 * streak - 8e-5 * pores
    return to8(c), normal_map(height, 0.8 / n), to8(0.38 + 0.07 * rings + 0.12 * pores)


def weave(rng):
    """Plain woven upholstery, 0.16 m square, thread pitch 2.5 mm; neutral colour."""
    n, threads = 512, 64
    y, x = np.mgrid[0:n, 0:n] / n * threads
    u, v = x % 1 - 0.5, y % 1 - 0.5
    warp_up = (np.floor(x) + np.floor(y)) % 2 == 0
    warp = np.sqrt(np.clip(1 - (2 * u) ** 2, 0, 1)) * (0.55 + 0.45 * np.cos(np.pi * v))
    weft = np.sqrt(np.clip(1 - (2 * v) ** 2, 0, 1)) * (0.55 + 0.45 * np.cos(np.pi * u))
    h = np.where(warp_up, warp, weft)
    yarn = np.where(warp_up, noise(n, n, 2, 30, rng), noise(n, n, 30, 2, rng))
    c = 0.80 + 0.13 * h + 0.05 * yarn
    return to8(np.repeat(np.clip(c, 0, 1)[..., None], 3, 2)), normal_map(
        0.00045 * h + 0.00006 * yarn, 0.16 / n
    )


def plaster(rng):
    """Roller-painted wall, 1 m square: faint mottling and an orange-peel normal map."""
    n = 512
    tone = 0.965 + 0.008 * noise(n, n, 70, 70, rng) + 0.005 * noise(n, n, 12, 12, rng)
    height = 1.6e-4 * noise(n, n, 3.2, 3.2, rng) + 1.5e-4 * noise(n, n, 9, 9, rng)
    return to8(np.repeat(np.clip(tone, 0, 1)[..., None], 3, 2)), normal_map(height, 1.0 / n)


def rug(rng):
    """2.4 x 1.7 m flat-woven rug, drawn once (not tiled)."""
    w, h = 1024, 725
    y, x = np.mgrid[0:h, 0:w]
    X, Y = x / w * 2.4 - 1.2, y / h * 1.7 - 0.85
    jitter = noise(h, w, 9, 9, rng) * 0.0014 + noise(h, w, 1.2, 1.2, rng) * 0.0011
    cream, rust = np.array([0.78, 0.73, 0.64]), np.array([0.50, 0.23, 0.17])
    navy, ochre = np.array([0.15, 0.20, 0.28]), np.array([0.68, 0.50, 0.27])
    c = np.broadcast_to(cream, (h, w, 3)).copy()
    edge = np.minimum(1.2 - np.abs(X), 0.85 - np.abs(Y)) + jitter
    # Five by four lozenges fill the field inside the border.
    fx = np.abs((X + jitter + 0.96) / 0.384 % 1 - 0.5) * 2
    fy = np.abs((Y + jitter + 0.61) / 0.305 % 1 - 0.5) * 2
    lozenge = fx + fy
    for lo, hi, colour in (
        (0.0, 0.24, rust),
        (0.36, 0.58, navy),
        (0.80, 0.93, ochre),
        (1.72, 1.88, navy),
    ):
        c[(edge > 0.24) & (lozenge >= lo) & (lozenge < hi)] = colour
    along = np.where(1.2 - np.abs(X) < 0.85 - np.abs(Y), Y, X)
    zigzag = np.abs((along + jitter) % 0.10 - 0.05) * 1.6
    for lo, hi, colour in (
        (0.0, 0.05, navy),
        (0.05, 0.065, cream),
        (0.205, 0.22, rust),
        (0.22, 0.24, navy),
    ):
        c[(edge >= lo) & (edge < hi)] = colour
    band = (edge >= 0.065) & (edge < 0.205)
    c[band] = rust
    c[band & (np.abs(edge - 0.095 - zigzag) < 0.014)] = cream
    c[band & (np.abs(edge - 0.060 - zigzag) < 0.010)] = ochre
    rows = np.sin(2 * np.pi * Y / 0.0094)
    tone = 1 + 0.05 * noise(h, w, 90, 3, rng) + 0.07 * rows + 0.06 * noise(h, w, 2, 1.2, rng)
    height = 0.0006 * rows + 0.0005 * noise(h, w, 2.2, 1.5, rng)
    # Coarser steps halve the files; the eye cannot tell in a fibre pattern.
    return (
        to8(c * np.clip(tone, 0.6, 1.3)[..., None]) // 3 * 3,
        (np.minimum(normal_map(height, 2.4 / w), 253) + 2) // 4 * 4,
    )


def cardboard(rng):
    n = 256
    c = (
        np.array([0.66, 0.48, 0.31])
        * (1 + 0.03 * noise(n, n, 60, 2, rng) + 0.025 * noise(n, n, 2, 2, rng))[..., None]
    )
    flute = np.sin(2 * np.pi * np.arange(n) / 8)[None, :] * np.ones((n, 1))
    return to8(c), normal_map(2.5e-5 * flute + 1.5e-5 * noise(n, n, 3, 3, rng), 0.25 / n)


def leaf(rng):
    """One leaf: u across, v from stem to tip; veins."""
    h, w = 256, 128
    y, x = np.mgrid[0:h, 0:w]
    u, v = np.abs(x / w - 0.5) * 2, 1 - y / h
    vein = np.exp(-((u / 0.05) ** 2)) + 0.55 * np.exp(
        -(((((v - 0.55 * u) * 9) % 1 - 0.5) / 0.09) ** 2)
    )
    tone = np.clip(0.5 + 0.12 * noise(h, w, 30, 30, rng) - 0.25 * u * u, 0, 1)
    c = mix([0.06, 0.17, 0.05], [0.17, 0.36, 0.10], tone)
    return to8(mix(c, [0.36, 0.50, 0.20], np.clip(vein * 0.4, 0, 1)))


def book_cloth(rng):
    """Spine cloth: u across the thickness, v up the spine; pale bands that the tint colours."""
    h, w = 256, 64
    c = 0.72 + 0.05 * noise(h, w, 1.2, 1.2, rng)
    v = np.arange(h) / h
    for lo, hi, tone in (
        (0.08, 0.10, 1.0),
        (0.115, 0.12, 1.0),
        (0.30, 0.52, 0.98),
        (0.86, 0.88, 1.0),
    ):
        c[(v >= lo) & (v < hi)] = tone
    glyph = rng.random((20, 5)) > 0.45
    for r in range(20):
        y0 = int(h * 0.315) + int(r * 2.6)
        for k in range(5):
            if glyph[r, k]:
                c[y0 : y0 + 2, 20 + 5 * k : 24 + 5 * k] = 0.22
    return to8(np.repeat(np.clip(c, 0, 1)[..., None], 3, 2))


def art(rng, palette, kind):
    """Abstract painting, 512 x 640."""
    h, w = 640, 512
    y, x = np.mgrid[0:h, 0:w]
    X, Y = x / w, y / h
    wob = lambda s, a: a * noise(h, w, s, s, rng)
    c = np.broadcast_to(np.array(palette[0]), (h, w, 3)).copy()
    if kind == "hills":
        sun = np.hypot(X - 0.64 + wob(30, 0.003), (Y - 0.30) * 1.25) < 0.17
        c[sun] = palette[1]
        for k, colour in enumerate(palette[2:]):
            line = (
                0.42 + 0.14 * k + 0.07 * np.sin(2 * np.pi * (X * (0.7 + 0.25 * k) + 0.37 * k * k))
            )
            c[Y > line + wob(9, 0.002)] = colour
    elif kind == "discs":
        for k, colour in enumerate(palette[1:]):
            cx, cy, r = rng.uniform(0.22, 0.78), 0.16 + 0.19 * k, rng.uniform(0.13, 0.27)
            d = np.hypot(X - cx + wob(40, 0.004), (Y - cy) * 1.25 + wob(40, 0.004))
            inside = d < r
            if k % 2:
                inside &= (X - cx) * 0.6 + (Y - cy) > -0.02
            c[inside] = 0.12 * c[inside] + 0.88 * np.array(colour)
    else:
        for k, colour in enumerate(palette[1:]):
            lo, hi = 0.1 + 0.19 * k, 0.24 + 0.2 * k
            inside = (Y > lo + wob(50, 0.006)) & (Y < hi + wob(50, 0.006))
            inside &= (X > 0.10 + wob(25, 0.006)) & (X < 0.90 + wob(25, 0.006))
            c[inside] = colour
    brush = 1 + 0.05 * noise(h, w, 40, 2.0, rng) + 0.02 * noise(h, w, 1.5, 1.5, rng)
    border = np.minimum(np.minimum(X, 1 - X) * 0.8, np.minimum(Y, 1 - Y)) < 0.045
    c = c * brush[..., None]
    c[border] = np.array([0.93, 0.92, 0.89])
    return to8(c) // 3 * 3


FONT = {
    "G": "01110 10001 10000 10111 10001 10001 01110",
    "L": "10000 10000 10000 10000 10000 10000 11111",
    "O": "01110 10001 10001 10001 10001 10001 01110",
    "A": "01110 10001 10001 11111 10001 10001 10001",
    "M": "10001 11011 10101 10101 10001 10001 10001",
}


def toy_block(rng, letter, colour):
    """One face of a wooden letter block, 128 px: painted frame and letter on bare wood."""
    n = 128
    rings, streak, _ = wood_figure(n, n, rng)
    c = mix([0.84, 0.70, 0.50], [0.72, 0.55, 0.36], np.clip(0.3 + 0.4 * rings + 0.1 * streak, 0, 1))
    y, x = np.mgrid[0:n, 0:n]
    e = np.minimum(np.minimum(x, n - 1 - x), np.minimum(y, n - 1 - y))
    c[(e > 5) & (e < 17)] = colour
    bits = np.array([[int(b) for b in row] for row in FONT[letter].split()])
    big = np.kron(bits, np.ones((10, 10))).astype(bool)
    y0, x0 = (n - 70) // 2, (n - 50) // 2
    c[y0 : y0 + 70, x0 : x0 + 50][big] = colour
    return to8(c * (1 + 0.02 * noise(n, n, 1.5, 1.5, rng))[..., None])


def ball(rng):
    """u around, v from pole to pole: six coloured gores, white caps."""
    h, w = 256, 512
    y, x = np.mgrid[0:h, 0:w]
    gores = np.array(
        [
            [0.80, 0.10, 0.08],
            [0.93, 0.90, 0.84],
            [0.10, 0.28, 0.62],
            [0.95, 0.70, 0.10],
            [0.93, 0.90, 0.84],
            [0.12, 0.48, 0.26],
        ]
    )
    c = gores[(x * 6 // w) % 6]
    c[(y < h * 0.09) | (y > h * 0.91)] = [0.93, 0.90, 0.84]
    return to8(c * (1 + 0.012 * noise(h, w, 2, 2, rng))[..., None])


def lawn(rng):
    n = 256
    t = np.clip(0.5 + 0.25 * noise(n, n, 2, 2, rng) + 0.2 * noise(n, n, 25, 25, rng), 0, 1)
    return to8(mix([0.20, 0.27, 0.15], [0.46, 0.52, 0.32], t))


HILLS = (
    [0.90, 0.80, 0.66],
    [0.86, 0.42, 0.20],
    [0.62, 0.68, 0.62],
    [0.30, 0.46, 0.46],
    [0.13, 0.26, 0.30],
    [0.70, 0.36, 0.20],
)
DISCS = (
    [0.92, 0.88, 0.80],
    [0.12, 0.18, 0.30],
    [0.82, 0.34, 0.22],
    [0.88, 0.66, 0.26],
    [0.30, 0.44, 0.38],
)
BANDS = (
    [0.88, 0.84, 0.76],
    [0.16, 0.30, 0.40],
    [0.80, 0.52, 0.36],
    [0.86, 0.74, 0.50],
    [0.34, 0.22, 0.20],
)
NIGHT = (
    [0.78, 0.80, 0.80],
    [0.93, 0.90, 0.80],
    [0.52, 0.60, 0.66],
    [0.33, 0.41, 0.50],
    [0.20, 0.26, 0.36],
    [0.60, 0.52, 0.42],
)
BLOCK_COLOURS = {
    "G": [0.74, 0.12, 0.09],
    "L": [0.09, 0.30, 0.62],
    "O": [0.92, 0.62, 0.08],
    "A": [0.10, 0.46, 0.26],
    "M": [0.50, 0.20, 0.52],
}


def make_all(folder):
    """Writes every texture; returns {name: size in bytes}."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(2026)
    images = {}
    images["floor_rgb"], images["floor_normal"], images["floor_roughness"] = plank_atlas(rng)
    images["wood_rgb"], images["wood_normal"], images["wood_roughness"] = furniture_wood(rng)
    images["weave_rgb"], images["weave_normal"] = weave(rng)
    images["plaster_rgb"], images["plaster_normal"] = plaster(rng)
    images["rug_rgb"], images["rug_normal"] = rug(rng)
    images["cardboard_rgb"], images["cardboard_normal"] = cardboard(rng)
    images["leaf_rgb"] = leaf(rng)
    images["book_rgb"] = book_cloth(rng)
    images["art_hills"] = art(rng, HILLS, "hills")
    images["art_discs"] = art(rng, DISCS, "discs")
    images["art_bands"] = art(rng, BANDS, "bands")
    images["art_night"] = art(rng, NIGHT, "hills")
    images["ball_rgb"] = ball(rng)
    images["lawn_rgb"] = lawn(rng)
    for letter, colour in BLOCK_COLOURS.items():
        images[f"block_{letter.lower()}"] = toy_block(rng, letter, colour)
    for name, image in images.items():
        write_png(folder / f"{name}.png", image)
    return {name: (folder / f"{name}.png").stat().st_size for name in images}
