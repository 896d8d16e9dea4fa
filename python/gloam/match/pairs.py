"""Pairs of a pixel in the photograph and a point in the scene, and the file that holds them (docs/match.md)."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam import _core, _toml
from gloam.experiments.files import replace_file

from .camera import Array

ELEMENTS = ("geom", "body", "site")
_KEYS = {"name", "pixel", "point", "corner", *ELEMENTS}
_LARGEST = 1 << 20  # of a file of pairs [bytes]
_MOST = 500  # pairs
_BOX, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER = 6, 2, 3, 4, 5  # mjtGeom
_HEADER = "# Pairs for gloam match: pixel x right, y down from the corner of the top left pixel; point in the world [m].\n\n"


@dataclass(frozen=True)
class Pair:
    """name: shown in reports; pixel: (x, y), x right, y down, the corner of the top left pixel is (0, 0) [px]; point: in the world [m],
    or None with the name of an element: kind of ELEMENTS, and for a geom signs of a place on it, such as "++0"."""

    name: str
    pixel: tuple[float, float]
    point: tuple[float, float, float] | None = None
    kind: str = ""
    element: str = ""
    corner: str = "000"


def read_pairs(path: Path) -> list[Pair]:
    """Pairs of a file. Errors: gloam.IoError; InputError with the pair's number."""
    try:
        if path.stat().st_size > _LARGEST:
            raise gloam.InputError(f"a file of pairs has at most {_LARGEST >> 20} MiB", str(path))
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise gloam.IoError(f"cannot read the pairs: {error.strerror}", str(path)) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise gloam.InputError(f"the pairs are not valid TOML: {error}", str(path)) from None
    rows = table.get("pair")
    if set(table) - {"pair"} or not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise gloam.InputError("a file of pairs consists of [[pair]] tables", str(path), hint="gloam match pick makes one")
    if len(rows) > _MOST:
        raise gloam.InputError(f"the file has {len(rows)} pairs; at most {_MOST} are accepted", str(path))
    return [_pair(row, number, str(path)) for number, row in enumerate(rows, 1)]


def _pair(row: Mapping[str, Any], number: int, file: str) -> Pair:
    def fail(text: str) -> gloam.InputError:
        return gloam.InputError(f"pair {number}: {text}", file)

    if unknown := sorted(set(row) - _KEYS):
        raise fail(f"unknown key '{unknown[0]}'; there are: {', '.join(sorted(_KEYS))}")
    given = [key for key in ("point", *ELEMENTS) if key in row]
    if len(given) != 1:
        raise fail(f"give one of point, {', '.join(ELEMENTS)}, got {' and '.join(given) or 'none'}")
    pixel = _numbers(row.get("pixel"), 2)
    if pixel is None:
        raise fail(f"pixel must be two finite numbers, got {row.get('pixel')!r}")
    name = row.get("name", "")
    if not isinstance(name, str) or len(name) > 200 or not name.isprintable():
        raise fail("name must be a text of at most 200 printable characters")
    if given == ["point"]:
        point = _numbers(row["point"], 3)
        if point is None:
            raise fail(f"point must be three finite numbers, got {row['point']!r}")
        if "corner" in row:
            raise fail("corner belongs to a geom")
        return Pair(name or str(number), (pixel[0], pixel[1]), (point[0], point[1], point[2]))
    kind, corner = given[0], row.get("corner", "000")
    if not isinstance(row[kind], str) or not row[kind].isprintable():
        raise fail(f"{kind} must be a name of printable characters")
    if "corner" in row and (kind != "geom" or not isinstance(corner, str) or len(corner) != 3 or set(corner) - set("+-0")):
        raise fail(f"corner has three signs, such as \"++-\" or \"00+\", and belongs to a geom, got {corner!r}")
    return Pair(name or row[kind], (pixel[0], pixel[1]), None, kind, row[kind], corner)


def _numbers(value: Any, count: int) -> list[float] | None:
    if not isinstance(value, list) or len(value) != count or any(isinstance(v, bool) or not isinstance(v, (int, float)) for v in value):
        return None
    numbers = [float(v) for v in value]
    return numbers if all(math.isfinite(v) and abs(v) < 1e9 for v in numbers) else None


def write_pairs(path: Path, pairs: Sequence[Pair]) -> Path:
    """Writes a file of pairs. Errors: gloam.IoError."""
    return replace_file(path, lambda file: file.write_text(_HEADER + pairs_text(pairs), encoding="utf-8"))


def pairs_text(pairs: Sequence[Pair]) -> str:
    """Pairs as TOML."""
    tables = []
    for pair in pairs:
        table: dict[str, Any] = {"name": pair.name, "pixel": list(pair.pixel)}
        if pair.point is not None:
            table["point"] = list(pair.point)
        else:
            table[pair.kind] = pair.element
            if pair.corner != "000":
                table["corner"] = pair.corner
        tables.append(_toml.table_text({"pair": [table]}))
    return "\n".join(tables)


def scene_points(sim: gloam.Simulation, pairs: Sequence[Pair]) -> Array:
    """World points (n, 3) of pairs, at the simulation's present instant. Errors: NotFoundError for an unknown element."""
    return np.array([pair.point if pair.point is not None else _place(sim, pair) for pair in pairs], dtype=np.float64).reshape(-1, 3)


def _place(sim: gloam.Simulation, pair: Pair) -> Array:
    info = sim.world.info
    known = {"geom": info.geoms, "body": info.bodies, "site": info.sites}[pair.kind]
    if pair.element not in known:
        raise gloam.NotFoundError(f"pair '{pair.name}': the scene has no {pair.kind} '{pair.element}'",
                                  hint=_core.suggest_name(pair.element, [name for name in known if name]))  # fmt: skip
    index = known.index(pair.element)
    array = sim.memory.array
    if pair.kind == "geom":
        return _on_geom(pair, array, index)
    return np.array(array("xpos" if pair.kind == "body" else "site_xpos")[index], dtype=np.float64)


def _on_geom(pair: Pair, array: Any, index: int) -> Array:
    signs = np.array([{"-": -1.0, "0": 0.0, "+": 1.0}[sign] for sign in pair.corner])
    a, b, c = (float(v) for v in array("geom_size")[index])
    halves = {_BOX: (a, b, c), _SPHERE: (a, a, a), _CAPSULE: (a, a, a + b), _ELLIPSOID: (a, b, c), _CYLINDER: (a, a, b)}
    half = halves.get(int(array("geom_type")[index]))
    if signs.any():
        if half is None:
            raise gloam.InputError(f"pair '{pair.name}': the geom '{pair.element}' has no corners", hint="give a point instead")
        if half is not halves[_BOX] and np.count_nonzero(signs) > 1:
            raise gloam.InputError(f"pair '{pair.name}': the geom '{pair.element}' is round: its corner has one sign, such as \"00+\"")
        signs = signs * np.array(half)
    R = np.array(array("geom_xmat")[index], dtype=np.float64).reshape(3, 3)
    return np.asarray(np.array(array("geom_xpos")[index], dtype=np.float64) + R @ signs)
