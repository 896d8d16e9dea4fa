"""The files of Gloam's scenes: text, meshes, pictures, grids. Needs nothing but Python."""
import struct
import zlib


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


def toml_value(value):
    if isinstance(value, bool):
        return str(value).lower()
    return str(list(map(float, value))) if isinstance(value, (tuple, list)) else repr(float(value))


def write_obj(path, corners):
    lines = []
    for position, normal, uv in corners:
        lines += [f"v {numbers(position)}", f"vn {numbers(normal)}", f"vt {numbers(uv)}"]
    for i in range(0, len(corners), 3):
        lines.append("f " + " ".join(f"{j}/{j}/{j}" for j in range(i + 1, i + 4)))
    path.write_text("\n".join(lines) + "\n")


def write_png(path, rows):
    """8-bit texels, row by row from the top, each a tuple of 1, 3 or 4 channels."""
    kind = {1: 0, 3: 2, 4: 6}[len(rows[0][0])]
    raw = b"".join(b"\0" + bytes(value for texel in row for value in texel) for row in rows)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, kind, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def write_exr(path, rows):
    """Linear texels of three floats, row by row from the top: OpenEXR's plainest kind, without compression."""
    height, width = len(rows), len(rows[0])

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    head += b"\0"
    size = 12 * width
    table = b"".join(struct.pack("<Q", len(head) + 8 * height + y * (8 + size)) for y in range(height))
    lines = (struct.pack("<ii", y, size) + b"".join(struct.pack(f"<{width}f", *(texel[c] for texel in row)) for c in (2, 1, 0))
             for y, row in enumerate(rows))
    path.write_bytes(head + table + b"".join(lines))


def write_npy(path, grid):
    """float32, of [z][y][x]."""
    shape = (len(grid), len(grid[0]), len(grid[0][0]))
    head = repr({"descr": "<f4", "fortran_order": False, "shape": shape}).encode()
    head += b" " * (-(10 + len(head) + 1) % 64) + b"\n"
    values = [value for plane in grid for row in plane for value in row]
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + struct.pack(f"<{len(values)}f", *values))


def write_ies(path, profile, multiplier):
    """LM-63-2002, type C, without the last horizontal angle: it is the first again."""
    around, down = len(profile), len(profile[0])
    vertical = [90 * i / (down - 1) for i in range(down)]
    horizontal = [360 * i / around for i in range(around + 1)]
    path.write_text("\n".join(["IESNA:LM-63-2002", "TILT=NONE", f"1 -1 {float(multiplier)!r} {down} {around + 1} 1 2 0 0 0", "1 1 0",
                               numbers(vertical), numbers(horizontal), *(numbers(row) for row in [*profile, profile[0]]), ""]))
