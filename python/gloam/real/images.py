"""Folders of images: safe listing and reading, content hashes, pairs by file name, and the size that a network needs."""

from __future__ import annotations

import hashlib
import io
import os
import stat
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.experiments.optional import require

Image = NDArray[np.uint8]  # (height, width, 3), sRGB
Fit = Literal["crop", "stretch", "pad"]

SUFFIXES = {".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tif", ".tiff"}
SMALLEST = 16  # side of an image [px], for the window of SSIM and for a spectrum
MOST_PIXELS = 1 << 26  # checked before an image is decoded
MOST_BYTES = 1 << 28  # of a file
_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TIFF")


class UnusableImage(Exception):
    """The reason for which a file is left out."""


@dataclass(frozen=True)
class Listing:
    """Files of a folder. names: relative paths of images, sorted; left_out: (name, reason)."""

    folder: Path
    names: tuple[str, ...]
    left_out: tuple[tuple[str, str], ...]


def list_images(folder: Path) -> Listing:
    """Images of a folder and its subfolders, without hidden ones, whose names begin with a dot; links are not followed.

    Errors: gloam.IoError if it is not a folder that can be read; InputError if it holds no image.
    """
    names: list[str] = []
    left_out: list[tuple[str, str]] = []
    if not folder.is_dir():
        raise gloam.IoError("there is no such folder", str(folder))
    for name, entry in _walk(folder, ""):
        if entry.is_symlink():
            left_out.append((name, "a link, which is not followed"))
        elif not entry.is_file(follow_symlinks=False):
            left_out.append((name, "not a regular file"))
        else:
            names.append(name)
    if not names:
        raise gloam.InputError("the folder has no images", str(folder), hint=f"of the types {', '.join(sorted(SUFFIXES))}")
    return Listing(folder, tuple(sorted(names)), tuple(sorted(left_out)))


def _walk(folder: Path, prefix: str) -> Iterator[tuple[str, os.DirEntry[str]]]:
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError as error:
        raise gloam.IoError(f"cannot read the folder: {error.strerror}", str(folder)) from error
    for entry in entries:
        name = prefix + entry.name
        if entry.name.startswith("."):
            continue
        if entry.is_dir(follow_symlinks=False):
            yield from _walk(folder / entry.name, name + "/")
        elif Path(entry.name).suffix.lower() in SUFFIXES:
            yield name, entry


def shown(name: str) -> str:
    """A file name as text: bytes that are not UTF-8 and control characters are replaced."""
    text = os.fsencode(name).decode("utf-8", "replace")
    return "".join(c if c.isprintable() else "\ufffd" for c in text)


def read_bytes(path: Path) -> bytes:
    """Contents of a regular file. Errors: UnusableImage."""
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with open(handle, "rb") as file:
            info = os.fstat(handle)
            if not stat.S_ISREG(info.st_mode):
                raise UnusableImage("not a regular file")
            if info.st_size > MOST_BYTES:
                raise UnusableImage(f"larger than {MOST_BYTES >> 20} MiB")
            return file.read(MOST_BYTES)
    except OSError as error:
        raise UnusableImage(f"cannot be read: {error.strerror}") from error


def content_hash(data: bytes) -> str:
    """SHA-256 in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def decode(data: bytes) -> Image:
    """The first frame of an image file in its upright orientation. Profiles are not applied: values are taken as sRGB.

    Transparent pixels are shown on black, 16-bit images keep their 8 upper bits. Errors: UnusableImage.
    """
    pillow, operations = require("PIL.Image"), require("PIL.ImageOps")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # size is checked below
            with pillow.open(io.BytesIO(data), formats=_FORMATS) as file:
                width, height = file.size
                if width * height > MOST_PIXELS:
                    raise UnusableImage(f"has {width} x {height} pixels, more than {MOST_PIXELS >> 20} Mi")
                if min(width, height) < SMALLEST:
                    raise UnusableImage(f"has {width} x {height} pixels; sides must have {SMALLEST} or more")
                image = operations.exif_transpose(file)
                return _rgb(image, pillow)
    except UnusableImage:
        raise
    except pillow.DecompressionBombError as error:  # Pillow's own limit is higher
        raise UnusableImage(f"has more than {MOST_PIXELS >> 20} Mi pixels") from error
    except Exception as error:  # damaged files end in exceptions of many kinds
        raise UnusableImage(
            f"not an image that can be read: {str(error).splitlines()[0] if str(error) else type(error).__name__}"
        ) from error


def _rgb(image: Any, pillow: Any) -> Image:
    if image.mode.startswith("I"):  # 16 bits of grey
        grey = (np.asarray(image, np.int64) >> 8).clip(0, 255).astype(np.uint8)
        return np.repeat(grey[:, :, None], 3, axis=2)
    if image.mode == "F":
        raise UnusableImage("floating-point images are not supported")
    if image.has_transparency_data:
        with_alpha = image.convert("RGBA")
        image = pillow.alpha_composite(pillow.new("RGBA", image.size, (0, 0, 0, 255)), with_alpha)
    return np.asarray(image.convert("RGB"), np.uint8)


def fitted(image: Image, size: tuple[int, int], fit: Fit, bicubic: bool = True) -> Image:
    """An image at the size (width, height) of a network.

    fit: "crop" about the centre to its aspect ratio, "stretch" without regard to it, "pad" with black. Filters of Pillow, which
    widen with the reduction.
    """
    pillow = require("PIL.Image")
    height, width = image.shape[:2]
    wanted = size[0] / size[1]
    if fit == "crop":
        kept_width, kept_height = min(width, max(1, round(height * wanted))), min(height, max(1, round(width / wanted)))
        left, top = (width - kept_width) // 2, (height - kept_height) // 2
        image = image[top : top + kept_height, left : left + kept_width]
    elif fit == "pad":
        wide, high = max(width, round(height * wanted)), max(height, round(width / wanted))
        canvas = np.zeros((high, wide, 3), np.uint8)
        canvas[(high - height) // 2 :, (wide - width) // 2 :][:height, :width] = image
        image = canvas
    resample = pillow.Resampling.BICUBIC if bicubic else pillow.Resampling.BILINEAR
    return np.asarray(pillow.fromarray(np.ascontiguousarray(image)).resize(size, resample))


def pair_names(real: Sequence[str], other: Sequence[str]) -> dict[str, str]:
    """Partners of names of `real`: equal relative paths without their suffixes. Errors: UsageError if two files of a folder have
    one such path, or if no file has a partner."""

    def by_stem(names: Sequence[str]) -> dict[str, str]:
        found: dict[str, str] = {}
        for name in names:
            stem = str(Path(name).with_suffix(""))
            if stem in found:
                raise gloam.UsageError(f"pairs need one image per name, but there are {shown(found[stem])} and {shown(name)}")
            found[stem] = name
        return found

    mine, theirs = by_stem(real), by_stem(other)
    pairs = {mine[stem]: theirs[stem] for stem in mine if stem in theirs}
    if not pairs:
        raise gloam.UsageError(
            f"no file names match, such as {shown(real[0])} and {shown(other[0])}", hint="omit --pairs to compare the folders as sets"
        )
    return pairs
