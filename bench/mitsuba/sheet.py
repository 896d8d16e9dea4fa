"""One picture of all scenes: Gloam's, Mitsuba's or the closed form, and ten times their relative difference by blocks. Needs numpy and Pillow."""
import json
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

COLUMNS, SCALE, LINE = 2, 2, 14


def read(path):
    head, raw = path.read_bytes().split(b"\n", 1)
    header, values = json.loads(head), np.frombuffer(raw, np.float32)
    size = header["width"] * header["height"] * 3
    return values[-size:].reshape(header["height"], header["width"], 3).astype(float), header["block"]


def shown(radiance, white):
    x = np.clip(radiance / white, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def blocks(picture, size):
    height, width = picture.shape[0] // size, picture.shape[1] // size
    means = picture.reshape(height, size, width, size, 3).mean(axis=(1, 3))
    return means.repeat(size, axis=0).repeat(size, axis=1)


def panel(folder, name, exact):
    """`exact`: means of blocks where there is no picture of Mitsuba's."""
    ours, size = read(folder / f"{name}..gloam")
    if exact:
        theirs = np.reshape(exact, (ours.shape[0] // size, ours.shape[1] // size, 3)).repeat(size, axis=0).repeat(size, axis=1)
    else:
        theirs, _ = read(folder / f"{name}..mitsuba")
    white = 1.1 * np.percentile(theirs, 97)
    a, b = blocks(ours, size), blocks(theirs, size)
    difference = np.clip(0.5 + 10 * (a - b) / np.maximum(b, 0.02 * b.mean()), 0, 1)
    row = np.concatenate([shown(ours, white), shown(theirs, white), difference], axis=1)
    image = Image.fromarray((255 * row + 0.5).astype(np.uint8))
    return image.resize((image.width * SCALE, image.height * SCALE), Image.NEAREST)


def main():
    job = json.loads(sys.argv[1])
    exact = job["exact"]
    panels = [(name, panel(Path(job["folder"]), name, exact.get(name))) for name in job["scenes"]]
    width, height = panels[0][1].width + 8, panels[0][1].height + LINE + 6
    sheet = Image.new("RGB", (width * COLUMNS, height * -(-len(panels) // COLUMNS)), "white")
    for i, (name, image) in enumerate(panels):
        x, y = i % COLUMNS * width, i // COLUMNS * height
        sheet.paste(image, (x + 4, y + LINE))
        ImageDraw.Draw(sheet).text((x + 4, y + 1), f"{name}: Gloam, {'closed form' if name in exact else 'Mitsuba'}, difference x 10", fill="black")
    sheet.save(job["out"], quality=85)


if __name__ == "__main__":
    main()
