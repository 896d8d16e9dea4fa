"""Generates the files used by the gallery's sets: the test object, skies, maps and a photometric file.

Run it from anywhere; the files in tools/gallery/props are its output, byte for byte.
"""
import math
import struct
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from make_lantern import Glb, png  # noqa: E402

PROPS = HERE / "props"


def turned(profile, sides=64):
    """Revolves (radius, height) points about +Y, smooth where the profile bends by less than 40 degrees."""
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(profile, profile[1:])]
    outward = [(dy / math.hypot(dx, dy), -dx / math.hypot(dx, dy)) for dx, dy in steps]
    length = sum(math.hypot(*step) for step in steps)
    positions, normals, uvs, indices = [], [], [], []
    along = 0.0

    def at_corner(i, j):
        if not 0 <= j < len(outward) or sum(a * b for a, b in zip(outward[i], outward[j])) < math.cos(math.radians(40)):
            return outward[i]
        n = (outward[i][0] + outward[j][0], outward[i][1] + outward[j][1])
        return n[0] / math.hypot(*n), n[1] / math.hypot(*n)

    for i, step in enumerate(steps):
        first = len(positions)
        ends = ((profile[i], at_corner(i, i - 1), along), (profile[i + 1], at_corner(i, i + 1), along + math.hypot(*step)))
        for k in range(sides + 1):
            c, s = math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)
            for (r, y), (out, up), v in ends:
                positions.append((r * c, y, -r * s))
                normals.append((out * c, up, -out * s))
                uvs.append((k / sides, 1 - v / length))
        for k in range(sides):
            a = first + 2 * k
            if profile[i][0] > 0:
                indices += [a, a + 2, a + 1]
            if profile[i + 1][0] > 0:
                indices += [a + 1, a + 2, a + 3]
        along += math.hypot(*step)
    return positions, normals, uvs, indices


def arc(x, y, radius, begin, end, count):
    """Points of a circle, angles in degrees from +x."""
    return [(x + radius * math.cos(math.radians(begin + (end - begin) * i / count)),
             y + radius * math.sin(math.radians(begin + (end - begin) * i / count))) for i in range(count + 1)]


def test_object():
    """A ball of 0.2 m with a groove, on a neck and a round foot: curved, flat, sharp and hollow parts in one closed surface."""
    foot = [(0, 0), (0.088, 0), *arc(0.088, 0.008, 0.008, -90, 0, 5), *arc(0.086, 0.024, 0.010, 0, 90, 5), (0.05, 0.034)]
    neck = [*arc(0.05, 0.046, 0.012, 270, 180, 5)]
    lower = arc(0, 0.152, 0.1, -68, 22, 24)
    upper = arc(0, 0.152, 0.1, 30, 90, 16)
    groove = [(lower[-1][0] - 0.012, lower[-1][1] + 0.002), (upper[0][0] - 0.012, upper[0][1] - 0.002)]
    top = upper[:-1] + [(0, 0.252)]
    g = Glb("gallery/make_props.py")
    paint = g.add("materials", {"name": "paint", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}})
    profile = foot + neck + lower + groove + top
    g.node("object", g.mesh(turned([p for p, q in zip(profile, [None, *profile]) if q is None or math.dist(p, q) > 1e-6]), paint))
    return g.bytes()


def sheet():
    """A square of 0.3 m that stands on its lower edge and faces -Y (here +Z, as glTF has Y up)."""
    g = Glb("gallery/make_props.py")
    paint = g.add("materials", {"name": "paint", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}})
    corners = [(-0.15, 0, 0), (0.15, 0, 0), (0.15, 0.3, 0), (-0.15, 0.3, 0)]
    g.node("sheet", g.mesh((corners, [(0, 0, 1)] * 4, [(0, 1), (1, 1), (1, 0), (0, 0)], [0, 1, 2, 0, 2, 3]), paint))
    return g.bytes()


def rgbe(color):
    most = max(color)
    if most < 1e-32:
        return b"\0\0\0\0"
    mantissa, exponent = math.frexp(most)
    return bytes([*(int(c * mantissa * 256 / most) for c in color), exponent + 128])


def packed(values):
    """One channel of a row in Radiance's run-length code."""
    out, i = b"", 0
    while i < len(values):
        run = 1
        while i + run < len(values) and run < 127 and values[i + run] == values[i]:
            run += 1
        if run >= 3:
            out, i = out + bytes([128 + run, values[i]]), i + run
            continue
        end = i + 1
        while end < len(values) and end - i < 128 and values[end:end + 3] != values[end:end + 1] * 3:
            end += 1
        out, i = out + bytes([end - i]) + values[i:end], end
    return out


def hdr(width, color_at):
    """Equirectangular; color_at(azimuth, elevation) in degrees, azimuth counter-clockwise from +X, the picture's middle."""
    height, rows, step = width // 2, b"", 360 / width

    def texel(x, y):
        parts = [color_at(180 - step * (x + i), 90 - step * (y + j)) for i in (0.25, 0.75) for j in (0.25, 0.75)]
        return rgbe([sum(c) / 4 for c in zip(*parts)])

    for y in range(height):
        row = [texel(x, y) for x in range(width)]
        rows += bytes([2, 2, width >> 8, width & 255]) + b"".join(packed(bytes(t[c] for t in row)) for c in range(4))
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode() + rows


def within(azimuth, elevation, at, size):
    """1 inside a soft-edged window of `size` degrees about `at`, 0 outside."""
    turn = (azimuth - at[0] + 180) % 360 - 180
    edge = max(abs(turn) / (size[0] / 2), abs(elevation - at[1]) / (size[1] / 2))
    return min(max((1.08 - edge) / 0.16, 0), 1)


# (azimuth, elevation) and size [deg], light
SOFT_BOXES = [((-140, 46), (34, 24), (3.0, 2.9, 2.75)), ((-30, 32), (18, 36), (1.6, 1.75, 2.0)), ((155, 30), (8, 50), (2.4, 2.4, 2.4))]


def studio(azimuth, elevation):
    """A grey room with two soft boxes and a strip, in arbitrary units."""
    shade = 0.055 + 0.045 * max(elevation, 0) / 90
    color = [shade * 1.02, shade, shade * 0.97]
    for at, size, light in SOFT_BOXES:
        share = within(azimuth, elevation, at, size)
        color = [c + share * (l - c) for c, l in zip(color, light)]
    return color


def evening(azimuth, elevation):
    """A low sun over hills and a row of houses with lit windows, in arbitrary units."""
    hills = 5 + 3 * math.sin(math.radians(2 * azimuth + 40)) + 1.5 * math.sin(math.radians(5 * azimuth))
    if elevation < 0:
        return [0.05, 0.055, 0.04]
    house = 200 <= azimuth % 360 < 320
    if house and elevation < 9 + 3 * (int(azimuth % 360 / 20) % 3):
        lit = azimuth % 5 > 3 and elevation % 3 > 1.2 and (int(azimuth % 360 / 5) * 7 + int(elevation / 3) * 5) % 3 == 0
        return [1.6, 1.0, 0.45] if lit else [0.09, 0.08, 0.085]
    if elevation < hills:
        return [0.03, 0.05, 0.045]
    low = math.exp(-elevation / 14)
    color = [0.22 + 0.75 * low, 0.3 + 0.32 * low, 0.55 + 0.02 * low]
    turn = (azimuth - 130 + 180) % 360 - 180
    off = math.hypot(turn * math.cos(math.radians(elevation)), elevation - 12)
    glow = 3 * math.exp(-off / 9)
    sun = 900 if off < 1.6 else 0
    return [color[0] + glow + sun, color[1] + 0.6 * glow + 0.62 * sun, color[2] + 0.25 * glow + 0.3 * sun]


def dimples(size=128, cells=4):
    """A normal map: round bosses in rows."""
    def slope(x, y):
        u, v = (x + 0.5) / size * cells % 1 - 0.5, (y + 0.5) / size * cells % 1 - 0.5
        r = math.hypot(u, v)
        tilt = 0.75 * math.sin(math.pi * min(r / 0.42, 1)) / max(r, 1e-6)
        n = (tilt * u, -tilt * v, 1)
        return [round(127.5 + 127.5 * c / math.hypot(*n)) for c in n]
    return png(size, size, 3, [[c for x in range(size) for c in slope(x, y)] for y in range(size)])


def holes(size=128, cells=4):
    """An opacity map: round holes, staggered."""
    def solid(x, y):
        v = (y + 0.5) / size * cells
        u = (x + 0.5) / size * cells + 0.5 * (int(v) % 2)
        return 255 if math.hypot(u % 1 - 0.5, v % 1 - 0.5) > 0.36 else 0
    return png(size, size, 1, [[solid(x, y) for x in range(size)] for y in range(size)])


def downlight():
    """LM-63: a wall washer's two lobes and a narrow beam, rotationally symmetric."""
    angles = range(0, 92, 2)
    def candela(a):
        beam = 900 * math.exp(-(a / 12) ** 2)
        lobe = 520 * math.exp(-((a - 34) / 9) ** 2)
        return beam + lobe if a < 78 else 0
    lines = ["IESNA:LM-63-2002", "[TEST] by formula, tools/gallery/make_props.py", "[MANUFAC] Gloam", "[LUMINAIRE] downlight with a ring",
             "TILT=NONE", f"1 -1 1 {len(angles)} 1 1 2 0 0 0", "1 1 10", " ".join(map(str, angles)), "0",
             " ".join(f"{candela(a):.1f}" for a in angles)]
    return ("\r\n".join(lines) + "\r\n").encode()


def main():
    PROPS.mkdir(parents=True, exist_ok=True)
    for name, data in {"object.glb": test_object(), "sheet.glb": sheet(), "studio.hdr": hdr(512, studio), "evening.hdr": hdr(1024, evening),
                       "dimples.png": dimples(), "holes.png": holes(), "downlight.ies": downlight()}.items():
        (PROPS / name).write_bytes(data)


if __name__ == "__main__":
    main()
