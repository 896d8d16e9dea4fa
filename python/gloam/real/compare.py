"""`gloam bench real`: every image is examined once, and the results are kept by its content.

A folder of results holds request.json, the cache, and files that `results.py` and `report.py` write from it. A repeated call reads
each image file for its hash, and examines only images that are new to the cache.
"""

from __future__ import annotations

import hashlib
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam._distribute.manifest import write_json
from gloam.experiments.files import locked, replace_file
from gloam.experiments.request import machine_name

from .cam import eigen_cam, grad_cam
from .images import Listing, list_images, pair_names
from .likeness import compare
from .network import Network, Settings, load_settings
from .sets import ImageSet, Tell, load_image, survey, watched
from .store import Arrays, Store

REQUEST, CACHE = "request.json", "cache"
REAL = "real"


@dataclass(frozen=True)
class Request:
    """real: folder of photographs; others: folders by name, the simulation first, then baselines; networks: TOML files; is_paired:
    whether files of equal names show one view; most: images of a folder that are compared, chosen by a hash of their names;
    temperature, smoothing: of class distributions; class_number: of Grad-CAM, None = the first class of the real image; examples:
    on the page; machine, version, date: text for the page."""

    real: Path
    others: dict[str, Path]
    networks: tuple[Path, ...] = ()
    is_paired: bool = False
    most: int = 10_000
    temperature: float = 1.0
    smoothing: float = 1e-6
    class_number: int | None = None
    examples: int = 6

    def check(self) -> None:
        """Errors: UsageError for numbers out of range and for names of folders that are none."""
        if not 1 <= self.most <= 1_000_000 or not 0 <= self.examples <= 100:
            raise gloam.UsageError("expected 1 to 1000000 images and 0 to 100 examples")
        if not 1e-3 <= self.temperature <= 1e3 or not 0 < self.smoothing <= 1:
            raise gloam.UsageError("expected a temperature of 0.001 to 1000 and a smoothing above 0 up to 1")
        for name in self.others:
            if name == REAL or not name or not all(c.isalnum() or c in "_-. " for c in name) or name.startswith("."):
                raise gloam.UsageError(f"the name of a folder of images cannot be {name!r}", hint="use letters, digits, - and _")


@dataclass(frozen=True)
class Pair:
    """A real image and one of another set, by their places in the sets."""

    real: int
    other: int


@dataclass(frozen=True)
class Comparison:
    """All that was examined. sets: by name, REAL first; pairs: by name of another set."""

    request: Request
    out: Path
    store: Store
    sets: dict[str, ImageSet]
    pairs: dict[str, tuple[Pair, ...]]
    networks: tuple[Network, ...]


def examine(request: Request, out: Path, tell: Tell | None = None) -> Comparison:
    """Examines images that the cache of the folder does not know yet.

    Errors: UsageError as Request.check, and if the folder is in use; IoError, InputError for folders without usable images;
    as Network.
    """
    request.check()
    say = tell or (lambda _: None)
    networks = tuple(Network(load) for load in _settings(request.networks))
    listings = {name: list_images(folder) for name, folder in {REAL: request.real, **request.others}.items()}
    out.mkdir(parents=True, exist_ok=True)
    with locked(out):
        _write_request(request, networks, out)
        store = Store(out / CACHE)
        chosen = _chosen(request, listings)
        sets = {name: survey(listings[name], chosen[name], store, name, say) for name in listings}
        pairs = {name: _pairs(sets[REAL], sets[name]) for name in request.others} if request.is_paired else {}
        found = Comparison(request, out, store, sets, pairs, networks)
        for network in networks:
            _respond(found, network, say)
        for name in pairs:
            for pair in watched(pairs[name], f"{name}: pairs", say):
                likeness(found, name, pair)
    return found


def _settings(files: tuple[Path, ...]) -> list[Settings]:
    settings = [load_settings(file) for file in files]
    names = [one.name for one in settings]
    if len(set(names)) != len(names):
        raise gloam.UsageError(f"two networks have one name: {', '.join(names)}")
    return settings


def _write_request(request: Request, networks: tuple[Network, ...], out: Path) -> None:
    text = json.loads(json.dumps(asdict(request), default=str))
    text |= {"machine": machine_name(), "version": gloam.__version__, "date": time.strftime("%Y-%m-%d")}
    text["networks"] = [
        {**json.loads(json.dumps(asdict(one.settings), default=str)), "classes": len(one.settings.classes), "hash": one.hash,
         "size": one.size} for one in networks
    ]  # fmt: skip
    write_json(out / REQUEST, text)


def _chosen(request: Request, listings: dict[str, Listing]) -> dict[str, tuple[str, ...]]:
    """Names of the images of each set that are compared. Of pairs, real images with a partner come first."""

    def key(name: str) -> bytes:
        return hashlib.sha256(name.encode("utf-8", "surrogateescape")).digest()

    if not request.is_paired:
        return {name: tuple(sorted(sorted(one.names, key=key)[: request.most])) for name, one in listings.items()}
    partners = {name: pair_names(listings[REAL].names, listings[name].names) for name in request.others}
    shared = sorted(set().union(*partners.values()), key=key)[: request.most]
    chosen = {REAL: tuple(sorted(shared))}
    return chosen | {name: tuple(sorted(of[real] for real in shared if real in of)) for name, of in partners.items()}


def _pairs(real: ImageSet, other: ImageSet) -> tuple[Pair, ...]:
    """In the order of the real images."""
    places = [{picture.name: k for k, picture in enumerate(one.pictures)} for one in (real, other)]
    partners = pair_names(tuple(places[0]), tuple(places[1]))
    return tuple(Pair(places[0][mine], places[1][theirs]) for mine, theirs in partners.items())


def response(found: Comparison, network: Network, name: str, place: int, number: int | None = None) -> Arrays:
    """Record of an image: features, (d,) float32; scores, (classes,) or (0,); eigen, (h, w): EigenCAM; with `number`, also
    "grad_NUMBER": Grad-CAM of that class. Taken from the cache, or computed."""
    picture = found.sets[name].pictures[place]
    kind, wanted = f"network-{network.hash[:16]}", f"grad_{number}"
    record = found.store.load(kind, picture.hash)
    if record is not None and "eigen" in record and (number is None or wanted in record):
        return record
    answer = network.run(load_image(found.sets[name], picture))
    scores = np.zeros(0) if answer.scores is None else answer.scores
    made = {"features": answer.features.astype(np.float32), "scores": scores.astype(np.float32), "eigen": eigen_cam(answer.layer)}
    if answer.scores is not None:
        own = int(answer.scores.argmax()) if number is None else number
        if not 0 <= own < len(answer.scores):
            raise gloam.UsageError(f"the network has no class {own}: there are {len(answer.scores)}")
        made[f"grad_{own}"] = grad_cam(answer.layer, network.gradient(answer, own))
    return found.store.save(kind, picture.hash, {**(record or {}), **made})


def class_of(found: Comparison, scores: NDArray[Any]) -> int | None:
    """Class of Grad-CAM for a real image; None for a network without classes."""
    if not len(scores):
        return None
    return int(scores.argmax()) if found.request.class_number is None else found.request.class_number


def features_file(found: Comparison, network: Network, name: str, kind: str) -> Path:
    """File of the "features" or "scores" of a set, one row per image."""
    return found.out / "networks" / network.hash[:16] / f"{name}_{kind}.npy"


def _respond(found: Comparison, network: Network, say: Tell) -> None:
    """Runs a network on all images, and writes the features and scores of each set."""
    kind = f"network-{network.hash[:16]}"
    for name, one in found.sets.items():
        partner = {pair.other: pair.real for pair in found.pairs.get(name, ())}
        for place in watched(range(len(one.pictures)), f"{name}: {network.settings.name}", say):
            number = found.request.class_number if network.tail else None
            if network.tail and number is None and place in partner:
                number = class_of(found, response(found, network, REAL, partner[place])["scores"])
            response(found, network, name, place, number)
        for part in ("features", "scores"):
            file = features_file(found, network, name, part)
            file.parent.mkdir(parents=True, exist_ok=True)
            _write_rows(file, [found.store.file(kind, picture.hash) for picture in one.pictures], part)


def _write_rows(file: Path, records: list[Path], part: str) -> None:
    """A .npy file with a row of each record, by ordinary writes: a mapped file would end the process on a full disk."""

    def write(path: Path) -> None:
        with path.open("wb") as out:
            for k, record in enumerate(records):
                with np.load(record, allow_pickle=False) as arrays:
                    row = arrays[part].astype("<f4")
                if k == 0:
                    np.lib.format.write_array_header_2_0(out, {"descr": "<f4", "fortran_order": False, "shape": (len(records), len(row))})
                out.write(row.tobytes())

    replace_file(file, write)


def likeness(found: Comparison, name: str, pair: Pair) -> Arrays:
    """flip and ssim of a pair (NaN = not defined, with its reason)."""
    mine, other = found.sets[REAL].pictures[pair.real], found.sets[name].pictures[pair.other]
    key = hashlib.sha256((mine.hash + other.hash).encode()).hexdigest()
    record = found.store.load("likeness-1", key)
    if record is None or "ssim" not in record:
        answer, _ = compare(load_image(found.sets[REAL], mine), load_image(found.sets[name], other))
        numbers = [np.nan if value is None else value for value in (answer.flip, answer.ssim)]
        record = found.store.save("likeness-1", key, {"flip": numbers[0], "ssim": numbers[1], "reason": answer.reason})
    return record
