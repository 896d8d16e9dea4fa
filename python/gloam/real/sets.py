"""Sets of images that can be used: survey of a folder, with the statistics of every image."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from numpy.typing import NDArray

import gloam
from gloam.experiments.words import Remaining

from . import appearance
from .images import Image, Listing, UnusableImage, content_hash, decode, read_bytes
from .store import Store

Tell = Callable[[str], None]
Item = TypeVar("Item")
_REPORT_EVERY = 10.0  # [s]
_HISTOGRAMS = ("lightness", "gradient")


@dataclass(frozen=True)
class Picture:
    """An image that can be used. name: relative path; hash: of the file's content; width, height: upright [px]; numbers: of
    appearance.describe()."""

    name: str
    hash: str
    width: int
    height: int
    numbers: dict[str, float]


@dataclass(frozen=True)
class ImageSet:
    """Images of a folder that are compared. histograms: means of appearance.describe(); left_out: (name, reason); skipped: number
    of further images beyond `Request.most`."""

    folder: Path
    pictures: tuple[Picture, ...]
    histograms: dict[str, NDArray[Any]]
    left_out: tuple[tuple[str, str], ...]
    skipped: int


def watched(items: Iterable[Item], what: str, say: Tell) -> Iterator[Item]:
    """The items, with reports of the progress and of the time that is left."""
    every = list(items)
    last, remaining = time.monotonic(), Remaining(len(every))
    for done, item in enumerate(every):
        now = time.monotonic()
        if done and now - last > _REPORT_EVERY:
            say(f"{what}: {done} of {len(every)}{remaining.after(done)}")
            last = now
        yield item


def survey(listing: Listing, names: tuple[str, ...], store: Store, what: str, say: Tell) -> ImageSet:
    """Reads all files of a set and describes new ones."""
    pictures, left_out = [], list(listing.left_out)
    sums: dict[str, NDArray[Any]] = {}
    kind = f"appearance-{appearance.VERSION}"
    for name in watched(names, f"{what}: images", say):
        try:
            data = read_bytes(listing.folder / name)
            digest = content_hash(data)
            record = store.load(kind, digest)
            if record is None or set(record) != {"size", "names", "numbers", *_HISTOGRAMS}:
                record = store.save(kind, digest, _described(decode(data)))
        except UnusableImage as error:
            left_out.append((name, str(error)))
            continue
        width, height = (int(side) for side in record["size"])
        pictures.append(Picture(name, digest, width, height, dict(zip(record["names"].tolist(), record["numbers"].tolist(), strict=True))))
        for kept in _HISTOGRAMS:
            sums[kept] = sums.get(kept, 0.0) + record[kept]
    if not pictures:
        problem = f"none of its {len(names)} images can be used; {left_out[-1][0]!r}: {left_out[-1][1]}"
        raise gloam.InputError(problem, str(listing.folder))
    means = {kept: total / len(pictures) for kept, total in sums.items()}
    return ImageSet(listing.folder, tuple(pictures), means, tuple(sorted(left_out)), len(listing.names) - len(names))


def _described(image: Image) -> dict[str, Any]:
    numbers, histograms = appearance.describe(image)
    return {"size": image.shape[1::-1], "names": list(numbers), "numbers": list(numbers.values()), **histograms}


def load_image(one: ImageSet, picture: Picture) -> Image:
    """Decodes an image again. Errors: gloam.IoError if it has changed meanwhile."""
    try:
        data = read_bytes(one.folder / picture.name)
        if content_hash(data) == picture.hash:
            return decode(data)
    except UnusableImage as error:
        raise gloam.IoError(str(error), str(one.folder / picture.name)) from error
    raise gloam.IoError("the image has changed since the comparison began", str(one.folder / picture.name), hint="repeat the command")
