"""Mitsuba's pictures as they are kept: means and errors of blocks, a file per scene, with those of its mutations."""
import hashlib
import json
import struct
import zlib
from pathlib import Path

from agreement import Estimate

FOLDER = Path(__file__).resolve().parent / "references"


def digest(scene):
    """Of what a scene says, so that a reference of another one is not compared with."""
    said = [scene.eye, scene.target, scene.fovy, scene.max_depth, scene.shapes, scene.lights, scene.sky_bytes, scene.headlight]
    said += [part for part in (scene.lamps, scene.volumes, scene.environment) if part]
    return hashlib.sha256(repr(said).encode()).hexdigest()[:16]


def keep(name, header, estimates):
    """`estimates`: by what is scaled, "" = nothing. Means are 32-bit, relative errors 16-bit floats."""
    header = {**header, "pictures": list(estimates), "means": [e.picture for e in estimates.values()],
              "errors": [e.picture_error for e in estimates.values()]}
    raw = b""
    for e in estimates.values():
        relative = [error / mean if mean > 0 else 0.0 for mean, error in zip(e.mean, e.error)]
        raw += struct.pack(f"<{len(e.mean)}f{len(e.mean)}e", *e.mean, *relative)
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{name}.reference").write_bytes(json.dumps(header).encode() + b"\n" + zlib.compress(raw, 9))


def read(name):
    """(header, estimates)."""
    head, packed = (FOLDER / f"{name}.reference").read_bytes().split(b"\n", 1)
    header, raw = json.loads(head), zlib.decompress(packed)
    size = len(raw) // len(header["pictures"])
    count, estimates = size // 6, {}
    for i, picture in enumerate(header["pictures"]):
        values = struct.unpack_from(f"<{count}f{count}e", raw, i * size)
        mean = list(values[:count])
        error = [m * r for m, r in zip(mean, values[count:])]
        estimates[picture] = Estimate(mean, error, header["means"][i], header["errors"][i])
    return header, estimates
