"""Meshes of the trunk: a wide middle, two hubs ahead and behind, between them the hips."""

from mesh_parts import (Mesh, block, bolt, bolt_circle, cable_gland, lathe, lens, loft, mirrored, pill, plate, rounded, slots,
                        socket_screw, spline, tube)

HIP_X, HIP_Y = 0.3455, 0.072
INNER, OUTER = 0.2555, 0.4345  # faces between which a hip turns
SIDES = (1, -1)
LENSES = ((0.0475, 0.0085), (-0.0475, 0.0085), (0.012, 0.0060), (-0.014, 0.0045))  # y, radius: a stereo pair; ahead also colour, projector


def trunk_shell():
    m = Mesh()
    m.add(*loft([(-0.250, 0, 0.040, 0.121, 0.050, 4.6), (-0.20, 0, 0.0415, 0.1315, 0.0535, 5.2), (0.20, 0, 0.0415, 0.1315, 0.0535, 5.2),
                 (0.250, 0, 0.040, 0.121, 0.050, 4.6)], "x", end=0.016, segments=40, rows=6, end_rows=4, seams=(-0.150, -0.02, 0.090)))
    for s in SIDES:  # hubs, and the roof over the hips
        hub = loft([(0.440, 0, 0.020, 0.104, 0.056, 4.0), (0.470, 0, 0.021, 0.103, 0.055, 4.2), (0.513, 0, 0.022, 0.088, 0.044, 4.2)],
                   "x", end=(0.006, 0.020), segments=34, rows=4, end_rows=4, seams=(0.462,))
        roof = loft([(0.244, 0, 0.0655, 0.064, 0.0245, 4.5), (HIP_X, 0, 0.0630, 0.048, 0.0225, 4.5), (0.446, 0, 0.0560, 0.064, 0.0205, 4.5)],
                    "x", end=0.003, segments=28, rows=5, end_rows=3, seams=(0.3455,))
        for part in (hub, roof):
            m.add(*(part if s > 0 else mirrored(part, "x")))
    return m


def trunk_graphite():
    """The tub below, hoods of the hips' motors, doors in the flanks."""
    m = Mesh()
    m.add(*loft([(-0.252, 0, -0.034, 0.108, 0.040, 5), (-0.20, 0, -0.036, 0.124, 0.044, 5.5), (0.20, 0, -0.036, 0.124, 0.044, 5.5),
                 (0.252, 0, -0.034, 0.108, 0.040, 5)], "x", end=0.012, segments=32, rows=4, end_rows=4, seams=(-0.10, 0.10)))
    for sx in SIDES:
        m.add(*loft([(sx * 0.348 - 0.100, 0, -0.012, 0.032, 0.052, 4.5), (sx * 0.348 + 0.100, 0, -0.012, 0.032, 0.052, 4.5)], "x", end=0.003,
                    segments=24, rows=3, end_rows=4))
        lower = loft([(0.438, 0, -0.050, 0.096, 0.026, 4.2), (0.480, 0, -0.048, 0.092, 0.025, 4.2), (0.505, 0, -0.044, 0.078, 0.019, 4.0)], "x",
                     end=(0.004, 0.010), segments=32, rows=3, end_rows=3)
        m.add(*(lower if sx > 0 else mirrored(lower, "x")))
        for sy in SIDES:
            m.add(*loft([(sx * 0.196 - 0.056, sy * 0.078, -0.004, 0.058, 0.066, 2.8), (sx * 0.196, sy * 0.082, -0.004, 0.064, 0.070, 2.6),
                         (sx * 0.196 + 0.056, sy * 0.078, -0.004, 0.058, 0.066, 2.8)], "x", end=0.012, segments=26, rows=3, end_rows=3))
    return m


def trunk_dark():
    m = Mesh()
    for sx in SIDES:
        for sy in SIDES:  # flanges that carry the axle of the hip
            ahead, back = ("x", "-x") if sx > 0 else ("-x", "x")
            m.add(*lathe([(0.060, -0.006), (0.060, 0.0065), (0.046, 0.0085), (0.044, 0.0060), (0.036, 0.0060), (0.034, 0.010), (0, 0.010)],
                         (sx * (INNER - 0.006), sy * HIP_Y, 0), ahead, segments=32, bevel=0.0012, steps=1))
            m.add(*lathe([(0.050, -0.006), (0.050, 0.0085), (0, 0.0085)], (sx * (OUTER + 0.012), sy * HIP_Y, 0), back, segments=32, steps=1))
    # Deck: mounting plate of the arm, of the LiDAR, and rails for a payload.
    m.add(*plate(rounded([(0.115, -0.068), (0.247, -0.068), (0.247, 0.068), (0.115, 0.068)], 0.014), 0.090, 0.1, "z", bevel=0.0015, steps=1))
    m.add(*plate(rounded([(-0.222, -0.058), (-0.098, -0.058), (-0.098, 0.058), (-0.222, 0.058)], 0.012), 0.090, 0.1015, "z", bevel=0.0015, steps=1))
    for sy in SIDES:
        for dy in (-0.0075, 0.0075):  # two lips of a T slot
            m.add(*block((-0.005, sy * 0.0935 + dy, 0.0985), (0.205, 0.0045, 0.0045), 0.0016, steps=1))
        m.add(*block((-0.005, sy * 0.0935, 0.0940), (0.205, 0.0125, 0.0035), 0.0015, steps=1))
    # Heat sinks in the flanks.
    for sy in SIDES:
        _comb(m, sy)
        m.add(*block((0.0, sy * 0.1245, -0.0345), (0.124, 0.0050, 0.030), 0.003, steps=1))
    # LiDAR: foot and cap; the window is of the lens.
    m.add(*lathe([(0.046, 0.0), (0.046, 0.020), (0.0435, 0.026), (0.0390, 0.026)], (-0.16, 0, 0.1012), "z", segments=36, bevel=0.0014, steps=1))
    m.add(*lathe([(0.0390, 0.060), (0.0440, 0.060), (0.0440, 0.069), (0.0405, 0.0745), (0, 0.0755)], (-0.16, 0, 0.1012), "z", segments=36,
                 bevel=0.002, steps=2))
    return m


def _comb(m, side, count=40, pitch=0.0060, tooth=0.0022):
    """Upright cooling fins along a flank, as one comb."""
    low, high = side * 0.1215, side * 0.1365
    outline = []
    for k in range(count):
        x = (k - (count - 1) / 2) * pitch
        outline += [(x - tooth / 2, low + side * 0.004), (x - tooth / 2, high), (x + tooth / 2, high), (x + tooth / 2, low + side * 0.004)]
    outline += [(outline[-1][0], low), (outline[0][0], low)]
    return m.add(*plate(outline, -0.0585, -0.0105, "z", bevel=0.0003, steps=1))


def trunk_steel():
    m = Mesh()
    for sx in SIDES:
        for sy in SIDES:
            axis = "x" if sx > 0 else "-x"
            bolt_circle(m, (sx * (INNER + 0.0020), sy * HIP_Y, 0), axis, 0.0525, 6, 0.0028, segments=8)
    for x in (0.128, 0.234):
        for y in (-0.055, 0.055):
            socket_screw(m, (x, y, 0.0999), "z", 0.0034, segments=14)
    for x in (-0.212, -0.108):
        for y in (-0.048, 0.048):
            bolt(m, (x, y, 0.1014), "z", 0.0028, segments=8)
    for sy in SIDES:
        for x in (-0.19, 0, 0.18):
            bolt(m, (x, sy * 0.0935, 0.0972), "z", 0.0026, segments=8)
        for x in (-0.236, 0.236):
            bolt(m, (x, sy * 0.100, 0.0775), (0, sy * 0.45, 1), 0.0026, segments=8)
    # Connectors behind: two round plugs and the charging socket's rim.
    for y in (-0.048, 0.048):
        cable_gland(m, (-0.5095, y, 0.006), "-x", 0.019)
    m.add(*lathe([(0.0150, -0.002), (0.0150, 0.0035), (0.0125, 0.0045), (0.0118, 0.0015)], (-0.5115, 0, 0.006), "-x", segments=24, bevel=0.0006,
                 steps=1))
    return m


def trunk_rubber():
    m = Mesh()
    for sx in SIDES:  # bumpers with ribs
        m.add(*loft([(-0.094, -0.040, sx * 0.4860, 0.015, 0.018, 3.2), (-0.06, -0.038, sx * 0.5080, 0.017, 0.018, 3.2),
                     (0.06, -0.038, sx * 0.5080, 0.017, 0.018, 3.2),
                     (0.094, -0.040, sx * 0.4860, 0.015, 0.018, 3.2)], "y", end=0.012, segments=20, rows=8, end_rows=3))
        slots(m, (sx * 0.5255, 0, -0.038), (0, 0.011, 0), 9, (0.0016, 0.0030, 0.0125), 0.0014)
        # Handles to carry it by.
        arc = spline([(sx * 0.462, -0.060, 0.070), (sx * 0.468, -0.058, 0.094), (sx * 0.470, -0.040, 0.103), (sx * 0.470, 0, 0.1035),
                      (sx * 0.470, 0.040, 0.103),
                      (sx * 0.468, 0.058, 0.094), (sx * 0.462, 0.060, 0.070)], 20)
        m.add(*tube(arc, 0.0072, 10))
    for x in (-0.17, 0.17):  # skids
        m.add(*block((x, 0, -0.0835), (0.030, 0.085, 0.007), 0.005, steps=1))
    # The arm's cable, from a gland on the deck.
    m.add(*tube(spline([(0.085, 0.045, 0.094), (0.085, 0.045, 0.115), (0.098, 0.040, 0.128), (0.120, 0.026, 0.122), (0.145, 0.010, 0.118)], 26),
                0.0038, 8))
    return m


def trunk_lens():
    m, ring = Mesh(), Mesh()
    for sx in SIDES:
        bar = loft([(-0.072, 0.035, 0.5000, 0.018, 0.0105, 3.4), (-0.055, 0.035, 0.5050, 0.0195, 0.0125, 3.8),
                    (0.055, 0.035, 0.5050, 0.0195, 0.0125, 3.8),
                    (0.072, 0.035, 0.5000, 0.018, 0.0105, 3.4)], "y", end=0.009, segments=26, rows=7, end_rows=4)
        m.add(*(bar if sx > 0 else mirrored(bar, "x")))
        for y, r in LENSES[:4 if sx > 0 else 2]:
            lens(m, ring, (sx * 0.5165, y, 0.035), "x" if sx > 0 else "-x", r, 0.0035, segments=20)
    m.add(*lathe([(0.0415, 0.026), (0.0405, 0.043), (0.0415, 0.060)], (-0.16, 0, 0.1012), "z", segments=38, bevel=0))
    m.add(*lathe([(0.0118, 0.0005), (0, 0.0005)], (-0.5125, 0, 0.006), "-x", segments=20, bevel=0))
    return m


def trunk_rings():
    """Barrels of the lenses."""
    glass, m = Mesh(), Mesh()
    for sx in SIDES:
        for y, r in LENSES[:4 if sx > 0 else 2]:
            lens(glass, m, (sx * 0.5165, y, 0.035), "x" if sx > 0 else "-x", r, 0.0035, segments=20)
    return m


def trunk_trim():
    m = Mesh()
    for sy in SIDES:
        m.add(*block((0, sy * 0.1318, 0.0165), (0.185, 0.0016, 0.0030), 0.0014, steps=1))
        m.add(*block((-0.20, sy * 0.1297, 0.046), (0.012, 0.0016, 0.016), 0.0014, steps=1))
    # Emergency stop behind the LiDAR.
    return m.add(*lathe([(0.0135, 0.010), (0.0165, 0.0125), (0.0165, 0.0185), (0.0125, 0.0215), (0, 0.0220)], (-0.238, 0.085, 0.0820), "z",
                        segments=24, bevel=0.0016, steps=2))


def trunk_light():
    m = Mesh()
    for sx in SIDES:
        pill(m, (sx * (0.5135 if sx > 0 else 0.5085), 0, 0.0030 if sx > 0 else 0.0575), (0.0022, 0.050, 0.0018), 0.0016, steps=1)
    for sy in SIDES:
        pill(m, (0.175, sy * 0.1315, 0.046), (0.020, 0.0018, 0.0018), 0.0016, steps=1)
    return m


PARTS = {"trunk_shell": trunk_shell, "trunk_graphite": trunk_graphite, "trunk_dark": trunk_dark, "trunk_steel": trunk_steel,
         "trunk_rings": trunk_rings,
         "trunk_rubber": trunk_rubber, "trunk_lens": trunk_lens, "trunk_trim": trunk_trim, "trunk_light": trunk_light}
