"""Pictures of LiDAR scans: from above, along the sensor's axis, or as range images.

A picture's `panels` stand side by side, each {lidar, view = above | ahead | range, color = intensity | height | distance | medium | return,
scans = [first, last], span = [m] across (above), [deg] across (ahead)}.
"""
import ast
import math
import struct
import subprocess

LETTERS = {"<f4": "f", "<u4": "I", "<u2": "H", "|u1": "B"}
STOPS = [(70, 60, 160), (70, 110, 220), (36, 160, 170), (110, 205, 90), (250, 215, 60), (255, 110, 50)]   # dark to light
INK = (14, 15, 20)
MARKS = {"medium": lambda point: point["part"] == 0, "return": lambda point: point["return_number"] > 0}   # marked red


def read_npy(path):
    """Rows of a structured .npy file, as dictionaries."""
    data = path.read_bytes()
    start = 10 + struct.unpack_from("<H", data, 8)[0]
    fields = ast.literal_eval(data[10:start].decode())["descr"]
    row = struct.Struct("<" + "".join(LETTERS[kind] for _, kind in fields))
    names = [name for name, _ in fields]
    return [dict(zip(names, values)) for values in row.iter_unpack(data[start:])]


def shade(value):
    """A colour for a value in 0 … 1."""
    x = min(max(value, 0), 1) * (len(STOPS) - 1)
    i = min(int(x), len(STOPS) - 2)
    return tuple(round(a + (b - a) * (x - i)) for a, b in zip(STOPS[i], STOPS[i + 1]))


def color_of(point, kind, low, high):
    if kind in MARKS:
        return (255, 90, 60) if MARKS[kind](point) else (150, 190, 235)
    return shade((value_of(point, kind) - low) / (high - low))


def value_of(point, kind):
    if kind == "intensity":
        return point["intensity"] ** 0.5
    return point["z"] if kind == "height" else math.log(point["range"])


class Panel:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.rgb = bytearray(bytes(INK) * (width * height))

    def dot(self, x, y, color, size):
        left, top = math.floor(x) - (size - 1) // 2, math.floor(y) - (size - 1) // 2
        for v in range(top, top + size):
            for u in range(left, left + size):
                if 0 <= u < self.width and 0 <= v < self.height:
                    at = 3 * (v * self.width + u)
                    self.rgb[at:at + 3] = bytes(color)


def draw(panel, spec, points):
    kind = spec.get("color", "intensity")
    if not points:
        raise ValueError(f"lidar '{spec['lidar']}' sees nothing")
    values = sorted(value_of(p, kind) for p in points) if kind not in MARKS else [0, 1]
    low, high = values[len(values) // 50], max(values[-1 - len(values) // 50], values[len(values) // 50] + 1e-6)
    middle_x, middle_y = panel.width / 2, panel.height / 2
    if spec["view"] == "range":
        columns = sorted({p["column"] for p in points})
        first, last, rings = columns[0], columns[-1], 1 + max(p["ring"] for p in points)
        for p in points:
            x = (p["column"] - first) * panel.width // (last - first + 1)
            y0, y1 = ((rings - 1 - p["ring"] + k) * panel.height // rings for k in (0, 1))
            for y in range(y0, max(y1, y0 + 1)):
                panel.dot(x, y, color_of(p, kind, low, high), math.ceil(panel.width / (last - first + 1)))
        return
    scale = panel.width / spec["span"]
    for p in sorted(points, key=lambda p: p["z"]):
        if spec["view"] == "above":   # x ahead is up
            x, y = middle_x - scale * p["y"], middle_y + scale * (spec.get("ahead", 0) - p["x"])
        else:
            x = middle_x - scale * math.degrees(math.atan2(p["y"], p["x"]))
            y = middle_y - scale * math.degrees(math.atan2(p["z"], p["x"]))
        panel.dot(x, y, color_of(p, kind, low, high), spec.get("dot", 1))
    if spec["view"] == "above":
        panel.dot(middle_x, middle_y + scale * spec.get("ahead", 0), (255, 255, 255), 5)


def jpeg(results, panels, size):
    """Draws the panels from a recording in the folder `results`."""
    gap = 6
    width, height = (size[0] - gap * (len(panels) - 1)) // len(panels), size[1]
    rows = [bytearray() for _ in range(height)]
    for k, spec in enumerate(panels):
        panel = Panel(width, height)
        first, last = spec.get("scans", [0, 0])
        draw(panel, spec, [p for scan in range(first, last + 1) for p in read_npy(results / spec["lidar"] / "npy" / f"{scan:06}.npy")])
        for y, row in enumerate(rows):
            row += (b"\xff" * 3 * gap if k else b"") + panel.rgb[3 * width * y:3 * width * (y + 1)]
    ppm = f"P6 {len(rows[0]) // 3} {height} 255\n".encode() + b"".join(rows)
    return subprocess.run(["ffmpeg", "-v", "error", "-f", "ppm_pipe", "-i", "-", "-pix_fmt", "yuv444p", "-q:v", "4", "-flags", "+bitexact",
                           "-f", "mjpeg", "-"], input=ppm, check=True, capture_output=True).stdout
