#!/usr/bin/env python3
"""`gloam match` and `gloam match pick`. Help is printed without a built program."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

_EXAMPLES = """\
Examples:
  gloam match pick photo.jpg room.toml --camera door -o pick.html
  gloam match photo.jpg room.toml --pairs pairs.toml --out results/match
  gloam match photo.jpg room.toml --pairs pairs.toml --solve k1,k2 --write room_matched.toml"""
_PICK_EXAMPLES = """\
Examples:
  gloam match pick photo.jpg room.toml --camera door
  gloam match pick photo.jpg room.toml --position 0.3,1.2,1.6 --look-at 0,4,0.6 --fovy 70 -o pick.html"""
_SOLVED = ("centre", "k1", "k2")


def main(arguments: list[str] | None = None) -> int:
    """The command line. Exit codes: 0 ok, 1 failure, 2 usage, 3 no exposure or a wrong pair, 130 interrupted."""
    words = sys.argv[1:] if arguments is None else arguments
    picks = words[:1] == ["pick"]
    parser = _pick_parser() if picks else _match_parser()
    given = parser.parse_args(words[1:] if picks else words)
    import gloam

    try:
        return _pick(given) if picks else _match(given)
    except gloam.Error as error:
        print(f"gloam: error: {error}", file=sys.stderr)
        return 2 if isinstance(error, gloam.UsageError) else 1
    except OSError as error:
        print(f"gloam: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("gloam: interrupted", file=sys.stderr)
        return 130


def _parser(prog: str, description: str, epilog: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=prog, description=description, epilog=epilog, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("photo", metavar="PHOTO", help="photograph: JPEG, PNG, WebP, TIFF, BMP or PPM")
    parser.add_argument("scene", metavar="SCENE", help="scene (.toml), or a bare MJCF or URDF")
    return parser


def _match_parser() -> argparse.ArgumentParser:
    parser = _parser(
        "gloam match",
        "Solve pose and lens of a photograph's camera from point pairs, fit exposure and white balance, and compare (docs/match.md).\n"
        "`gloam match pick` makes a page on which to pick the pairs.",
        _EXAMPLES,
    )
    option = parser.add_argument
    option("--pairs", required=True, help="TOML file of pixels and scene points, from `gloam match pick`")
    option("--fovy", type=float, help="vertical field of view, if it is known [deg]; default: solved for")
    option("--solve", default="", metavar="LIST", help="more of the lens: centre (the principal point), k1, k2, such as k1,k2")
    option("--out", default="results/match", help="folder of the results; default: %(default)s")
    option("--write", metavar="FILE", help="also write the scene with the camera; FILE may be SCENE itself")
    option("--name", default="photo", help="of the camera in the scene; default: %(default)s")
    option("--mask", help="image of the photograph's size: only white parts count for exposure and white balance")
    option("--longest", type=int, default=960, help="longer side of rendered images [px]; default: %(default)s")
    option("--tier", default="path", choices=("path", "interactive", "direct"), help="of the render; default: %(default)s")
    option("--spp", type=int, default=64, help="samples per pixel; default: %(default)s")
    return parser


def _match(given: argparse.Namespace) -> int:
    import gloam
    from gloam.match.match import Request, match
    from gloam.match.pairs import read_pairs
    from gloam.match.photo import load_mask, load_photo
    from gloam.match.refine import Unknowns
    from gloam.match.view import Quality

    if given.fovy is not None and not (math.isfinite(given.fovy) and 0 < given.fovy < 179):
        raise gloam.UsageError(f"--fovy is an angle between 0 and 179 degrees, got {given.fovy:g}")
    names = [name for name in given.solve.split(",") if name]
    if unknown := [name for name in names if name not in _SOLVED]:
        raise gloam.UsageError(f"--solve takes {', '.join(_SOLVED)}, got '{unknown[0]}'")
    if "k2" in names and "k1" not in names:
        raise gloam.UsageError("--solve k2 needs k1: --solve k1,k2")
    if not 16 <= given.longest <= 8192 or not 1 <= given.spp <= 65536:
        raise gloam.UsageError("--longest is 16 to 8192 pixels, --spp 1 to 65536")
    photo = load_photo(Path(given.photo))
    unknowns = Unknowns.POSE
    for name in names:
        unknowns |= Unknowns[name.upper()]
    request = Request(
        scene=Path(given.scene),
        out=Path(given.out),
        fovy=given.fovy,
        unknowns=unknowns,
        name=given.name,
        mask=load_mask(Path(given.mask), photo) if given.mask else None,
        copy=Path(given.write) if given.write else None,
        quality=Quality(given.longest, given.tier, given.spp),
    )
    made = match(photo, read_pairs(Path(given.pairs)), request, lambda text: print(f"gloam: {text}", file=sys.stderr, flush=True))
    print(made.summary())
    for file in made.files:
        if file.suffix != ".png":
            print(file)
    return 3 if made.problem or not made.solution.used.all() else 0


def _pick_parser() -> argparse.ArgumentParser:
    parser = _parser("gloam match pick", "Make a page on which to pick pairs; it works offline in any browser (docs/match.md).", _PICK_EXAMPLES)
    option = parser.add_argument
    option("--camera", action="append", default=[], metavar="NAME", help="camera of the scene to pick in (repeatable); default: all, else free")
    option("--position", metavar="X,Y,Z", help="instead of --camera: position of a rough camera [m]")
    option("--look-at", metavar="X,Y,Z", help="point that it looks at [m]")
    option("--fovy", type=float, default=60, help="vertical field of view of it [deg]; default: %(default)s")
    option("--pairs", help="file of pairs to continue with")
    option("-o", "--out", default="pick.html", help="page to write; default: %(default)s")
    option("--longest", type=int, default=1280, help="longer side of the renders [px]; default: %(default)s")
    option("--tier", default="path", choices=("path", "interactive", "direct"), help="of the renders; default: %(default)s")
    option("--spp", type=int, default=16, help="samples per pixel; default: %(default)s")
    return parser


def _pick(given: argparse.Namespace) -> int:
    import gloam
    from gloam.match.pairs import read_pairs
    from gloam.match.photo import load_photo
    from gloam.match.pick import Rough, write_pick_page
    from gloam.match.view import Quality

    if (given.position is None) != (given.look_at is None) or (given.position and given.camera):
        raise gloam.UsageError("give --position and --look-at together, and without --camera")
    if not 16 <= given.longest <= 4096 or not 1 <= given.spp <= 65536:
        raise gloam.UsageError("--longest is 16 to 4096 pixels, --spp 1 to 65536")
    rough = None
    if given.position:
        rough = Rough(_vector(given.position, "--position"), _vector(given.look_at, "--look-at"), given.fovy)
    pairs = read_pairs(Path(given.pairs)) if given.pairs else []
    quality = Quality(given.longest, given.tier, given.spp)
    page = write_pick_page(load_photo(Path(given.photo)), Path(given.scene), rough or tuple(given.camera), pairs, quality, Path(given.out))
    print(f"{page}\nOpen it in a browser, pick at least 5 pairs, and save pairs.toml.")
    return 0


def _vector(text: str, option: str) -> tuple[float, float, float]:
    import gloam

    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise gloam.UsageError(f"{option} is three numbers such as 0.3,1.2,1.6, got '{text}'") from None
    if not all(map(math.isfinite, (x, y, z))):
        raise gloam.UsageError(f"{option} must be finite, got '{text}'")
    return x, y, z


if __name__ == "__main__":
    sys.exit(main())
