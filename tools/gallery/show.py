"""Visualizes outputs that are not colour images: depth, ids, normals, flow, raw values, temperatures, events."""
import array
import colorsys
import csv
import json
import math
from pathlib import Path

import exr
import pixels
import plot

# Colours from cold to hot and from near to far, interpolated linearly.
HEAT = [(30, 20, 90), (87, 16, 110), (188, 55, 84), (249, 142, 9), (252, 255, 164)]
RANGE = [(122, 4, 3), (249, 98, 20), (225, 220, 55), (70, 248, 132), (40, 140, 240), (48, 18, 59)]


def color(share, stops):
    place = min(max(share, 0), 1) * (len(stops) - 1)
    i = min(int(place), len(stops) - 2)
    return bytes(round(a + (b - a) * (place - i)) for a, b in zip(stops[i], stops[i + 1]))


def grey16(path):
    return array.array("H", pixels.raw(path, "gray16le"))


def raw(shot, size):
    values = grey16(f"{shot}_raw.png")
    top = max(max(values), 1)
    return bytes(level for value in values for level in [round(255 * (value / top) ** (1 / 2.2))] * 3)


def depth(shot, size):
    return ranges(grey16(f"{shot}_depth.png"))


def sensor_depth(shot, size):
    return ranges(grey16(f"{shot}_sensor_depth.png"))


def ranges(values):
    seen = sorted(value for value in values if value) or [1]
    low, high = seen[len(seen) // 50], seen[-1 - len(seen) // 50] + 1
    return b"".join(color(math.log(value / low) / math.log(high / low), RANGE) if value else bytes(3) for value in values)


def colour_of(number):
    """Hues a golden angle apart, so that neighbours in the list look unlike each other."""
    if number == 0:
        return bytes(3)
    share = (0.1 + number * 0.381966) % 1
    return bytes(round(255 * c) for c in colorsys.hsv_to_rgb(share, 0.55 + 0.3 * (number % 2), 0.95))


def distance(shot, size):
    return ranges([value if value < math.inf else 0 for value in exr.read(Path(f"{shot}_distance.exr"))["distance"]])


def segmentation(shot, size):
    return b"".join(map(colour_of, grey16(f"{shot}_instance.png")))


def parts(shot, size):
    return b"".join(map(colour_of, grey16(f"{shot}_part.png")))


def classes(shot, size):
    return b"".join(map(colour_of, grey16(f"{shot}_semantic.png")))


def normal(shot, size):
    planes = exr.read(Path(f"{shot}_normal.exr"))
    return bytes(round(127.5 + 127.5 * value) for xyz in zip(planes["X"], planes["Y"], planes["Z"]) for value in xyz)


def albedo(shot, size):
    planes = exr.read(Path(f"{shot}_albedo.exr"))
    return bytes(round(255 * min(max(value, 0), 1) ** (1 / 2.2)) for rgb in zip(planes["R"], planes["G"], planes["B"]) for value in rgb)


def motion(shot, size):
    """Hue is direction; saturation and value are speed relative to the fastest pixel. Grey is no motion."""
    planes = exr.read(Path(f"{shot}_motion.exr"))
    flow = list(zip(planes["U"], planes["V"]))
    most = max(math.hypot(u, v) for u, v in flow) or 1
    polar = ((math.atan2(v, u) / (2 * math.pi) % 1, math.hypot(u, v) / most) for u, v in flow)
    shades = (colorsys.hsv_to_rgb(whereto, far, 0.35 + 0.65 * far) for whereto, far in polar)
    return bytes(round(255 * c) for shade in shades for c in shade)


def scene_flow(shot, size):
    """Red, green and blue are displacement along X, Y and Z relative to the fastest pixel."""
    planes = exr.read(Path(f"{shot}_scene_flow.exr"))
    most = max(abs(value) for name in "XYZ" for value in planes[name]) or 1
    return bytes(round(127.5 + 127.5 * value / most) for xyz in zip(planes["X"], planes["Y"], planes["Z"]) for value in xyz)


def boxes(shot, size):
    """Rectangles around the visible part of each object, except objects that fill the picture."""
    out = bytearray(pixels.raw(f"{shot}.png", "rgb24"))
    for thing in json.loads(Path(f"{shot}_boxes.json").read_text())["objects"]:
        if not thing["box_px"] or thing["pixels"] > 0.2 * size[0] * size[1]:
            continue
        u0, v0, u1, v1 = thing["box_px"]
        rim = [(u, v) for u in range(u0, u1) for v in (v0, v1 - 1)] + [(u, v) for v in range(v0, v1) for u in (u0, u1 - 1)]
        for u, v in rim:
            out[3 * (v * size[0] + u):3 * (v * size[0] + u) + 3] = colour_of(thing["instance"])
    return bytes(out)


def thermal(shot, size):
    values = grey16(f"{shot}_thermal.png")
    low, high = min(values), max(values) + 1
    return b"".join(color((value - low) / (high - low), HEAT) for value in values)


def events(folder, size):
    """Red where brightness rises, blue where it falls, on grey."""
    out = bytearray([90] * 3 * size[0] * size[1])
    with open(folder / "events.csv") as file:
        for row in csv.DictReader(file):
            i = 3 * (int(row["y_px"]) * size[0] + int(row["x_px"]))
            out[i:i + 3] = (255, 90, 60) if row["brighter"] == "1" else (60, 120, 255)
    return bytes(out)


def signals(folder, name, size, axis):
    """Plots the component that changes most: white for the sensor NAME, red for its noisy twin NAME_…."""
    tables = {path.stem: [[float(x) for x in row[2:]] for row in list(csv.reader(open(path)))[1:]] for path in sorted(folder.glob(f"sensors/{name}*.csv"))}
    first = 2                       # time, delivery, then the values
    column = max(range(first, len(tables[name][0])), key=lambda k: max(row[k] for row in tables[name]) - min(row[k] for row in tables[name]))
    rows = [row for table in tables.values() for row in table]
    picture = plot.Plot(size, [row[0] for row in rows], [row[column] for row in rows], axis)
    for key, color in zip(sorted(tables, reverse=True), ((255, 90, 60), (255, 255, 255))):
        picture.series(key, [row[0] for row in tables[key]], [row[column] for row in tables[key]], color)
    return bytes(picture.rgb)


def write_ppm(path, size, rgb):
    path.write_bytes(f"P6 {size[0]} {size[1]} 255\n".encode() + rgb)
    return path
