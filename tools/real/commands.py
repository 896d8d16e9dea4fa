#!/usr/bin/env python3
"""`gloam bench real` and `gloam real`. Help is printed without a built program."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent))


def main(arguments: list[str] | None = None) -> int:
    """The command line. Exit codes: 0 ok, 1 failure, 2 usage, 3 some files were left out, 130 interrupted."""
    parser = argparse.ArgumentParser(prog="gloam real", description="Comparison of simulated images with photographs (docs/realism.md).")
    commands = parser.add_subparsers(dest="command", required=True)
    for add in (_add_bench, _add_render, _add_install, _add_convert):
        add(commands)
    commands.add_parser("networks", help="list the installed networks").set_defaults(action=_networks)
    given = parser.parse_args(arguments)
    import gloam

    try:
        return int(given.action(given))
    except gloam.Error as error:
        print(f"gloam: error: {error}", file=sys.stderr)
        return 2 if isinstance(error, gloam.UsageError) else 1
    except KeyboardInterrupt:
        print("gloam: interrupted; the same command continues", file=sys.stderr)
        return 130


_EXAMPLES = """\
Examples:
  gloam real install efficientnet_lite0
  gloam bench real photographs renders --out results/real
  gloam bench real photographs views/gloam --pairs --baseline mujoco=views/mujoco --baseline no_noise=views/no_noise
  gloam bench real photographs renders --network clip.toml --network efficientnet_b0.toml"""


def _add_bench(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "bench",
        prog="gloam bench real",
        help="compare folders of real and simulated images",
        description="Distances between two folders of images by networks and statistics, with the reasons (docs/realism.md). A repeated "
        "call continues.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    option = command.add_argument
    option("real", metavar="REAL_DIR", help="folder of photographs")
    option("sim", metavar="SIM_DIR", help="folder of simulated images")
    option("--pairs", action="store_true", help="images of equal names show one view; default: compare the folders as sets")
    option("--baseline", action="append", default=[], metavar="NAME=DIR", help="a further folder for the same table (repeatable)")
    option(
        "--network",
        action="append",
        default=[],
        metavar="FILE",
        help='TOML of a network (repeatable), or "none"; default: the installed one',
    )
    option("--class", dest="class_number", type=int, metavar="N", help="of Grad-CAM; default: the first class of the real image")
    option("--temperature", type=float, default=1.0, help="of class distributions; default: %(default)s")
    option("--smoothing", type=float, default=1e-6, help="of class distributions; default: %(default)s")
    option("--most", type=int, default=10_000, help="images of a folder that are compared, chosen at random; default: %(default)s")
    option("--examples", type=int, default=6, help="on the page; default: %(default)s")
    option("--out", default="results/real", help="folder of the results; default: %(default)s")
    command.set_defaults(action=_bench)


def _bench(given: argparse.Namespace) -> int:
    import gloam
    from gloam.real.compare import Request, examine
    from gloam.real.report import write_report

    others = {"simulation": Path(given.sim)}
    for text in given.baseline:
        name, separator, folder = text.partition("=")
        if not separator or not folder or name in others:
            raise gloam.UsageError(f"--baseline is NAME=DIR with a name of its own, got {text}")
        others[name] = Path(folder)
    request = Request(
        Path(given.real), others, _chosen_networks(given.network), given.pairs, given.most, given.temperature, given.smoothing,
        given.class_number, given.examples,
    )  # fmt: skip
    found = examine(request, Path(given.out), _tell)
    for file in write_report(found):
        print(file)
    left_out = sum(len(one.left_out) for one in found.sets.values())
    if left_out:
        _tell(f"gloam: {left_out} files were left out; the page names them")
    return 3 if left_out else 0


def _chosen_networks(names: list[str]) -> tuple[Path, ...]:
    import gloam
    from install import LITE0, folder_of

    if names == ["none"]:
        return ()
    if names:
        return tuple(map(Path, names))
    default = folder_of(LITE0) / f"{LITE0}.toml"
    if not default.is_file():
        raise gloam.UsageError("no network is installed", hint=f"./gloam real install {LITE0}, --network FILE, or --network none")
    return (default,)


def _add_render(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "render",
        help="render views of a scene in the variants of the baselines",
        description="Views of a scene with the same cameras: as it is, without indirect light, without textures, without camera noise, "
        "and by MuJoCo's classic renderer (docs/realism.md).",
        epilog="Example: gloam real render examples/bedroom.toml --views 4 --out views",
    )
    option = command.add_argument
    option("scene", help="scene file")
    option("--views", type=int, default=6, help="views at random free places, 0 = the cameras of the scene; default: %(default)s")
    option("--variants", default="gloam,no_indirect,no_textures,no_noise,mujoco", help="default: %(default)s")
    option("--resolution", default="320x240", help="[px]; default: %(default)s")
    option("--height", type=float, default=1.2, help="of the cameras above the floor [m]; default: %(default)s")
    option("--fovy", type=float, default=60.0, help="vertical field of view [deg]; default: %(default)s")
    option("--tier", default="path", choices=("path", "interactive", "direct"), help="default: %(default)s")
    option("--spp", type=int, default=256, help="samples per pixel; default: %(default)s")
    option("--seed", type=int, default=1, help="of places, directions and noise; default: %(default)s")
    option("--out", default="results/views", help="folder of the variants; default: %(default)s")
    command.set_defaults(action=_render)


def _render(given: argparse.Namespace) -> int:
    import gloam
    from gloam.real.views import Shots, render

    width, _, height = given.resolution.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise gloam.UsageError(f"--resolution is WIDTHxHEIGHT, got {given.resolution}")
    shots = Shots(given.views, int(width), int(height), given.height, given.fovy, given.tier, given.spp, given.seed)
    variants = tuple(filter(None, given.variants.split(",")))
    for folder in render(gloam.Scene(given.scene), shots, Path(given.out), variants, _tell):
        print(folder)
    return 0


def _add_install(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser("install", help="install a network or MuJoCo's renderer")
    command.add_argument("parts", nargs="+", metavar="NAME", help="efficientnet_lite0 (17 MB), mujoco (20 MB)")
    command.set_defaults(action=_install)


def _install(given: argparse.Namespace) -> int:
    import gloam
    from install import PARTS, install

    for part in given.parts:
        if part not in PARTS:
            raise gloam.UsageError(f"there is no part '{part}'; there are: {', '.join(PARTS)}")
    for part in given.parts:
        print(install(part))
    return 0


def _add_convert(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "convert",
        help="convert a checkpoint of CLIP or EfficientNet",
        description="Writes an ONNX file and its TOML. Nothing in a checkpoint is executed, and PyTorch is not needed.",
        epilog="Examples: gloam real convert efficientnet_b0 efficientnet-b0-355c32eb.pth -o networks; gloam real convert clip ViT-B-32.pt "
        "-o networks --labels 'cone,hallway,bed' --vocabulary bpe_simple_vocab_16e6.txt.gz",
    )
    option = command.add_argument
    option("kind", choices=("efficientnet_lite0", "efficientnet_b0", "clip"))
    option("checkpoint", help="file of PyTorch (state dict, TorchScript) or safetensors")
    option("-o", "--out", required=True, help="folder for the files")
    option("--prefix", default="", help="of an encoder's names, such as obs_encoder. in a checkpoint of ViNT")
    option("--classes", help="file with a name of a class per line")
    option("--labels", default="", help="of CLIP: class names, separated by commas, for scores and Grad-CAM")
    option("--vocabulary", help="of CLIP: bpe_simple_vocab_16e6.txt.gz, needed for --labels")
    option("--template", default="a photo of a {}.", help="of CLIP: sentence for labels; default: %(default)s")
    option("--gelu", action="store_true", help="of CLIP: exact GELU, as in open_clip's own models, instead of OpenAI's")
    command.set_defaults(action=_convert)


def _convert(given: argparse.Namespace) -> int:
    import gloam
    from checkpoint import CheckpointError
    from convert import Options, convert

    labels = tuple(label.strip() for label in given.labels.split(",") if label.strip())
    vocabulary, classes = (None if text is None else Path(text) for text in (given.vocabulary, given.classes))
    options = Options(given.prefix, labels, vocabulary, given.template, given.gelu, classes)
    try:
        print(convert(given.kind, Path(given.checkpoint), Path(given.out), options))
    except CheckpointError as error:
        raise gloam.InputError(str(error)) from error
    return 0


def _networks(_: argparse.Namespace) -> int:
    from gloam.real.network import load_settings
    from install import LITE0, folder_of

    file = folder_of(LITE0) / f"{LITE0}.toml"
    print(f"{load_settings(file).name}: {file}" if file.is_file() else f"{LITE0}: ./gloam real install {LITE0}")
    return 0


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
