"""A photograph: its pixels as light, upright, within limits."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, ImageOps, UnidentifiedImageError

import gloam
from gloam.real.flip import linear as from_srgb

from .camera import Array

MOST_PIXELS = 80_000_000  # below the 89 megapixels at which Pillow suspects a decompression bomb
_FORMATS = ("JPEG", "PNG", "WEBP", "TIFF", "BMP", "PPM")
LONGEST_SIDE = 16384  # as of a [[camera]] [px]


@dataclass(frozen=True)
class Photo:
    """image: upright, 8-bit sRGB (height, width, 3); path: its file."""

    image: NDArray[np.uint8]
    path: Path

    @property
    def width(self) -> int:
        return int(self.image.shape[1])

    @property
    def height(self) -> int:
        return int(self.image.shape[0])

    def resized(self, width: int, height: int) -> NDArray[np.uint8]:
        """The image at another size, averaged."""
        return np.asarray(Image.fromarray(self.image).resize((width, height), Image.Resampling.BOX, reducing_gap=3.0))

    def light(self, width: int, height: int) -> tuple[Array, NDArray[np.bool_]]:
        """Linear light (height, width, 3), 1 = white, averaged over blocks of pixels, and whether no pixel of a block is clipped."""
        levels = self.image.max(axis=2)
        clipped = Image.fromarray(((levels >= 253) | (levels <= 4)).astype(np.uint8) * 255)
        share = np.asarray(clipped.resize((width, height), Image.Resampling.BOX))
        made = np.empty((height, width, 3))
        for c in range(3):
            plane = Image.fromarray(_TO_LIGHT[self.image[:, :, c]])
            made[:, :, c] = np.asarray(plane.resize((width, height), Image.Resampling.BOX))
        return made, share == 0


def to_srgb(light: Array) -> NDArray[np.uint8]:
    """8-bit sRGB of linear light 0 … 1; other values are clipped."""
    light = np.clip(light, 0, 1)
    values = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.asarray(np.rint(255 * values), dtype=np.uint8)


_TO_LIGHT = from_srgb(np.arange(256) / 255).astype(np.float32)


def load_photo(path: Path) -> Photo:
    """A photograph, turned upright as its EXIF orientation requires, with its colour profile converted to sRGB.

    Errors: gloam.IoError; InputError if the file is not an image, has more than MOST_PIXELS, or a side longer than LONGEST_SIDE.
    """
    image = _open(path, "photograph")
    if image.mode.startswith(("I", "F")):
        raise gloam.InputError(f"the photograph has pixels of type {image.mode}", str(path), hint="convert it to 8 bits per channel")
    return Photo(np.asarray(_in_srgb(image)), path)


def _in_srgb(image: Image.Image) -> Image.Image:
    profile = image.info.get("icc_profile")
    image = image if image.mode == "CMYK" else image.convert("RGB")
    if profile:
        try:
            made = ImageCms.profileToProfile(image, io.BytesIO(profile), ImageCms.createProfile("sRGB"), outputMode="RGB")
        except (ImageCms.PyCMSError, OSError):
            made = None  # a damaged profile: the pixels are taken as sRGB, as browsers do
        if made is not None:
            return made
    return image.convert("RGB")


def load_mask(path: Path, photo: Photo) -> NDArray[np.bool_]:
    """A mask of the photograph's size: white = use. Errors: as load_photo(); InputError for another size."""
    image = _open(path, "mask").convert("L")
    if image.size != (photo.width, photo.height):
        raise gloam.InputError(f"the mask has {image.width} x {image.height} pixels, the photograph {photo.width} x {photo.height}", str(path))
    return np.asarray(image) >= 128


def _open(path: Path, kind: str) -> Image.Image:
    try:
        with warnings.catch_warnings(), path.open("rb") as file:
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            image = Image.open(file, formats=_FORMATS)
            size = f"{image.width} x {image.height} pixels"
            if image.width * image.height > MOST_PIXELS or max(image.size) > LONGEST_SIDE:
                limit = f"at most {MOST_PIXELS // 1_000_000} megapixels and {LONGEST_SIDE} per side"
                raise gloam.InputError(f"the {kind} has {size}; {limit} are accepted", str(path))
            image.load()
            return ImageOps.exif_transpose(image)
    except gloam.InputError:
        raise
    except UnidentifiedImageError:
        raise gloam.InputError(f"the {kind} is not an image; formats: {', '.join(_FORMATS)}", str(path)) from None
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise gloam.InputError(f"the {kind} is too large: {error}", str(path)) from None
    except (FileNotFoundError, PermissionError, IsADirectoryError) as error:
        raise gloam.IoError(f"cannot read the {kind}: {error.strerror}", str(path)) from error
    except (OSError, ValueError, SyntaxError, EOFError) as error:
        raise gloam.InputError(f"the {kind} is damaged: {error}", str(path)) from None
