"""Images as the networks of the GNM family were trained on them: GNM (Shah et al. 2022, arXiv:2210.03370), ViNT (Shah et
al. 2023, arXiv:2306.14846) and NoMaD (Sridhar et al. 2023, arXiv:2310.07896).

The steps follow the authors' code (robodhruv/visualnav-transformer, train/vint_train/data/data_utils.py, function
resize_and_aspect_crop): crop about the centre to 4:3, resize with Pillow's `Image.resize`, whose filter for RGB images is
bicubic since Pillow 7, divide by 255, normalise by the statistics of ImageNet.

Signature of an ONNX file of GNM and ViNT, and of Gloam's own policy:

    obs_img   float32 [1, 3 * (context_size + 1), height, width]   oldest image first, the present one last
    goal_img  float32 [1, 3, height, width]
    dist      float32 [1, 1]      steps to the goal image
    action    float32 [1, n, 4]   waypoints x, y, cos, sin; x ahead and y left, in units of top speed / rate
"""

from __future__ import annotations

import math
from collections import deque
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
Floats = NDArray[np.float32]

ASPECT = 4 / 3
MEAN = np.array([0.485, 0.456, 0.406], np.float32)  # of ImageNet's images, red, green, blue
DEVIATION = np.array([0.229, 0.224, 0.225], np.float32)
_CUBIC = -0.5  # Keys 1981, "Cubic convolution interpolation", which Pillow uses as BICUBIC
_BITS = 22  # of the fixed-point weights that Pillow uses for 8-bit images


def check_image(image: object, name: str = "image") -> Image:
    """The image itself. Errors: ValueError unless it is an array of (H, W, 3) uint8 with H and W of 1 … 16384."""
    if not isinstance(image, np.ndarray) or image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3:
        found = f"{image.dtype} {image.shape}" if isinstance(image, np.ndarray) else type(image).__name__
        raise ValueError(f"{name} must be a (H, W, 3) array of uint8, got {found}")
    if not all(1 <= side <= 16384 for side in image.shape[:2]):
        raise ValueError(f"sides of {name} must be 1 … 16384 pixels, got {image.shape[1]} x {image.shape[0]}")
    return image


def crop_to_aspect(image: Image) -> Image:
    """Crops about the centre to 4:3 [(H, W, 3) uint8].

    A wide image keeps its height and gets a width of int(height * 4 / 3); an image that is not wider than high keeps its
    width and gets a height of int(width / (4 / 3)). An image between 1:1 and 4:3 gets black columns at both sides, as
    torchvision's center_crop adds them.
    """
    height, width = check_image(image).shape[:2]
    if width > height:
        new_height, new_width = height, int(height * ASPECT)
    else:
        new_height, new_width = max(int(width / ASPECT), 1), width
    if new_width > width:
        left = (new_width - width) // 2
        padded = np.zeros((height, new_width, 3), np.uint8)
        padded[:, left : left + width] = image
        return padded
    top, left = round((height - new_height) / 2), round((width - new_width) / 2)
    return image[top : top + new_height, left : left + new_width]


def resize(image: Image, size: tuple[int, int]) -> Image:
    """Resizes to (width, height) with the bicubic filter and the rounding of Pillow's Image.resize.

    The filter widens with the reduction, which avoids aliasing. Errors: ValueError for a size below 1 or above 4096.
    """
    check_image(image)
    width, height = size
    if not (1 <= width <= 4096 and 1 <= height <= 4096):
        raise ValueError(f"a size must be 1 … 4096 pixels, got {width} x {height}")
    if image.shape[1] != width:
        image = _resize_rows(image.transpose(1, 0, 2), width).transpose(1, 0, 2)
    return _resize_rows(image, height) if image.shape[0] != height else np.ascontiguousarray(image)


def prepare(image: Image, size: tuple[int, int], crop: bool = True) -> Floats:
    """An image for a network: (3, height, width) float32, normalised.

    image: (H, W, 3) uint8 sRGB; size: (width, height) [px], (85, 64) for GNM and ViNT, (96, 96) for NoMaD; crop: to 4:3
    first, as in training (the authors' deployment/src/navigate.py omits it, for cameras of 4:3). Errors: ValueError.
    """
    resized = resize(crop_to_aspect(image) if crop else image, size)
    normal = (resized.astype(np.float32) / np.float32(255) - MEAN) / DEVIATION
    return np.ascontiguousarray(normal.transpose(2, 0, 1))


class ContextStack:
    """The last images as channels. At the start of an episode the first image fills the missing places."""

    def __init__(self, context_size: int, size: tuple[int, int], crop: bool = True) -> None:
        """context_size: images before the present one, 5 for GNM and ViNT, 3 for NoMaD (train/config/*.yaml of the
        authors); size, crop: as for prepare(). Errors: ValueError for a context_size outside 0 … 64."""
        if not 0 <= context_size <= 64:
            raise ValueError(f"context_size must be 0 … 64, got {context_size}")
        self._size = size
        self._crop = crop
        self._images: deque[Floats] = deque(maxlen=context_size + 1)

    def clear(self) -> None:
        """Begins an episode."""
        self._images.clear()

    def push(self, image: Image) -> Floats:
        """Adds the present image, (H, W, 3) uint8. Returns (1, 3 * (context_size + 1), height, width), oldest first."""
        prepared = prepare(image, self._size, self._crop)
        self._images.append(prepared)
        missing = (self._images.maxlen or 1) - len(self._images)
        for _ in range(missing):
            self._images.append(prepared)
        return np.concatenate(list(self._images))[None]


def _cubic(x: float) -> float:
    x = abs(x)
    if x < 1:
        return ((_CUBIC + 2) * x - (_CUBIC + 3)) * x * x + 1
    return (((x - 5) * x + 8) * x - 4) * _CUBIC if x < 2 else 0.0


@lru_cache(maxsize=32)
def _weights(old: int, new: int) -> NDArray[np.int64]:
    """(new, old) fixed-point weights of the filter, each row normalised to 1 before rounding."""
    scale = old / new
    width = max(scale, 1.0)
    table = np.zeros((new, old), np.int64)
    for i in range(new):
        centre = (i + 0.5) * scale
        first = max(int(centre - 2 * width + 0.5), 0)
        end = min(int(centre + 2 * width + 0.5), old)
        row = np.array([_cubic((x - centre + 0.5) / width) for x in range(first, end)])
        table[i, first:end] = [math.floor(abs(w) * (1 << _BITS) + 0.5) * (1 if w >= 0 else -1) for w in row / row.sum()]
    return table


def _resize_rows(image: Image, height: int) -> Image:
    """Each column of (H, W, 3) uint8, filtered to a height and rounded to uint8 between the passes as Pillow does."""
    table = _weights(image.shape[0], height)
    # Products below 2^53: matrix products of doubles are exact here in any order, and faster than int64.
    flat = image.reshape(image.shape[0], -1).astype(np.float64)
    total = (table.astype(np.float64) @ flat).astype(np.int64) + (1 << (_BITS - 1))
    resized: Image = np.clip(total >> _BITS, 0, 255).astype(np.uint8).reshape(height, *image.shape[1:])
    return resized
