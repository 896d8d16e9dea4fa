"""Sequences whose motion is exact by construction: a camera that slides along textured walls at two depths."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from PIL import Image

WIDTH, HEIGHT, FOCAL, BASELINE = 320, 240, 200.0, 0.06
NEAR, FAR = 2.0, 4.0  # of the walls [m]
SQUARE = 120  # of the near wall and of its holes [px]: large, because features on their edges take the depth of the wrong wall
STEP = 0.04  # per frame to the right [m]: 4 px of the near wall, 2 px of the far one
RATE = 20.0


def texture(random: np.random.Generator, width: int) -> np.ndarray:
    """Blobs of several sizes, with corners for features."""
    image = np.zeros((HEIGHT, width))
    for size in (4, 8, 16):
        rough = random.uniform(0, 255, (HEIGHT // size + 1, width // size + 1))
        image += np.kron(rough, np.ones((size, size)))[:HEIGHT, :width] / 3
    return image


def view(walls: tuple[np.ndarray, np.ndarray, np.ndarray], x: float) -> tuple[np.ndarray, np.ndarray]:
    """Image and depth [m] of a camera at x [m], whose shifts are whole pixels."""
    far, near, holes = walls
    a, b = round(FOCAL * x / FAR), round(FOCAL * x / NEAR)
    is_near = ~holes[:, b : b + WIDTH]
    return np.where(is_near, near[:, b : b + WIDTH], far[:, a : a + WIDTH]), np.where(is_near, NEAR, FAR)


def slide(case: Path, frames: int = 40, dark_from: int | None = None) -> None:
    """Writes CASE/sequence and CASE/truth.tum. dark_from: frame from which the images are black."""
    random = np.random.default_rng(5)
    width = WIDTH + round(FOCAL * STEP * frames / NEAR) + 20
    holes = np.kron(random.random((HEIGHT // SQUARE, width // SQUARE + 1)) < 0.5, np.ones((SQUARE, SQUARE), bool))[:HEIGHT, :width]
    walls = texture(random, width), texture(random, width), holes.astype(bool)
    sequence = case / "sequence"
    for kind in ("rgb", "right", "depth"):
        (sequence / kind).mkdir(parents=True)
    truth, index = [], []
    for k in range(frames):
        stamp, x = 1 + k / RATE, STEP * k
        left, depth = view(walls, x)
        right = view(walls, x + BASELINE)[0]
        shade = 0.0 if dark_from is not None and k >= dark_from else 1.0
        for kind, image in (("rgb", left), ("right", right)):
            Image.fromarray(np.repeat((shade * image)[:, :, None], 3, 2).astype(np.uint8)).save(sequence / kind / f"{k}.png")
        Image.fromarray((1000 * depth).astype(np.uint16)).save(sequence / "depth" / f"{k}.png")
        truth.append(f"{stamp:.9f} {x:.9f} 0 0 0 0 0 1")
        index.append((stamp, k))
    for kind in ("rgb", "right", "depth"):
        (sequence / f"{kind}.txt").write_text("# a\n# b\n# c\n" + "".join(f"{stamp:.9f} {kind}/{k}.png\n" for stamp, k in index))
    camera = {"width": WIDTH, "height": HEIGHT, "fx": FOCAL, "fy": FOCAL, "cx": (WIDTH - 1) / 2, "cy": (HEIGHT - 1) / 2}
    camera |= {"rate": RATE, "distortion": [], "baseline": BASELINE, "depth_scale": 1000}
    (sequence / "calibration.json").write_text(json.dumps({"camera": camera}))
    (case / "truth.tum").write_text("\n".join(truth) + "\n")
