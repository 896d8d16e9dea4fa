"""Pictures of what sensors put out that is no picture: raw numbers, measured depth, temperatures, events."""
import array
import csv

import pixels

# Colours from cold to hot, and from near to far; between them straight lines.
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


def sensor_depth(shot, size):
    values = grey16(f"{shot}_sensor_depth.png")
    seen = sorted(value for value in values if value) or [1]
    low, high = seen[len(seen) // 50], seen[-1 - len(seen) // 50] + 1
    return b"".join(color((value - low) / (high - low), RANGE) if value else bytes(3) for value in values)


def thermal(shot, size):
    values = grey16(f"{shot}_thermal.png")
    low, high = min(values), max(values) + 1
    return b"".join(color((value - low) / (high - low), HEAT) for value in values)


def events(folder, size):
    """Brighter red, darker blue, on grey."""
    out = bytearray([90] * 3 * size[0] * size[1])
    with open(folder / "events.csv") as file:
        for row in csv.DictReader(file):
            i = 3 * (int(row["y_px"]) * size[0] + int(row["x_px"]))
            out[i:i + 3] = (255, 90, 60) if row["brighter"] == "1" else (60, 120, 255)
    return bytes(out)


def write_ppm(path, size, rgb):
    path.write_bytes(f"P6 {size[0]} {size[1]} 255\n".encode() + rgb)
    return path
