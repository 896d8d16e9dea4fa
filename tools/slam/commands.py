#!/usr/bin/env python3
"""`gloam bench slam` and `gloam slam`. Help is printed without a built program."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ENVIRONMENTS = {file.stem: file for file in sorted(HERE.glob("*.txt"))}
_LICENCES = {"orb_slam3": "GPL-3.0: ORB-SLAM3 runs as a program of its own"}


def main(arguments: list[str] | None = None) -> int:
    """The command line. Exit codes: 0 ok, 1 failure, 2 usage, 3 runs failed or videos are missing, 130 interrupted."""
    parser = argparse.ArgumentParser(prog="gloam slam", description="SLAM methods on sequences of Gloam (docs/slam.md).")
    commands = parser.add_subparsers(dest="command", required=True)
    _add_bench(commands)
    _add_install(commands)
    _add_vocabulary(commands)
    commands.add_parser("methods", help="list the methods and whether they can start").set_defaults(action=_methods)
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
  gloam slam install opencv
  gloam bench slam --methods odometry_mono,odometry_rgbd --scenes house --runs 1 --out results/slam
  gloam bench slam --methods orb_slam3_mono,my_method.toml --levels none,minor,major,dark
  gloam bench slam --log run.mcap --camera go/front --out results/my_run"""


def _add_bench(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "bench",
        prog="gloam bench slam",
        help="the benchmark of SLAM methods",
        description="Methods x scenes x adversity levels on the same motion (docs/slam.md). A repeated call continues.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    option = command.add_argument
    option("--methods", default="odometry_mono,odometry_rgbd", help="names of `gloam slam methods`, or TOML files; default: %(default)s")
    option("--scenes", help="of house, warehouse, office, tunnel, mine and terrain; default: house,warehouse")
    option("--log", help="log of a run (MCAP) whose motion and scene replace the tours")
    option("--camera", default="", help="of the log's robot; default: its stereo pair, or its first camera")
    option("--levels", default="none,minor,major", help="also dark; default: %(default)s")
    option("--runs", "--n", type=int, default=10, help="of each method, scene and level; default: %(default)s")
    option("--seed", type=int, default=1, help="default: %(default)s")
    option("--legs", type=int, default=3, help="of a tour: 1 to the goal, 2 and back, 3 and to the goal again; default: %(default)s")
    option("--duration", type=float, help="of the sequences [s]; default: the whole tour")
    option("--tier", default="interactive", choices=("interactive", "path", "direct"), help="of images; default: %(default)s")
    option("--resolution", default="640x480", help="of images [px]; default: %(default)s")
    option("--rate", type=float, default=20, help="of images [Hz]; default: %(default)s")
    option("--limit", type=float, default=20, help="time of a run per second of its sequence; default: %(default)s")
    option("--vocabulary", default="", help="file for ORB-SLAM; default: made from the images in clear air")
    option("--workers", type=int, default=1, help="methods at a time; more than one disturbs times per frame; default: %(default)s")
    option("--out", default="results/slam", help="folder of the results; default: %(default)s")
    option("--no-videos", action="store_true", help="do not render the median and the worst run of each cell")
    option("--no-report", action="store_true", help="run the methods only")
    command.set_defaults(action=_bench)


def _bench(given: argparse.Namespace) -> int:
    import gloam
    from gloam.slam.benchmark import Request, run
    from gloam.slam.report import write_report
    from gloam.slam.videos import render_videos

    if given.log and given.scenes:
        raise gloam.UsageError("--log names the only scene; leave out --scenes")
    if given.camera and not given.log:
        raise gloam.UsageError("--camera is the camera of a --log")
    names = [tuple(filter(None, text.split(","))) for text in (given.methods, given.scenes or "house,warehouse", given.levels)]
    width, _, height = given.resolution.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise gloam.UsageError(f"--resolution is WIDTHxHEIGHT, got {given.resolution}")
    request = Request(
        *names, given.runs, given.seed, given.legs, given.duration, given.tier, int(width), int(height), given.rate, given.limit,
        given.vocabulary,
    )  # fmt: skip
    if given.log:
        request = request.of_log(Path(given.log), given.camera)
    if given.workers < 1:
        raise gloam.UsageError("--workers must be at least 1")
    out = Path(given.out)
    rows = run(request, out, given.workers, _tell)
    problems = [] if given.no_report or given.no_videos else render_videos(out, _tell)
    for file in [] if given.no_report else write_report(out):
        print(file)
    failed = [row for row in rows if row["state"] != "ok"]
    for message in dict.fromkeys(f"{row['method']}, {row['scene']}, {row['level']}: {row['state']}: {row['message']}" for row in failed):
        problems.append(message)
    for problem in problems:
        _tell(f"gloam: {problem}")
    return 3 if problems else 0


def _add_install(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser("install", help="install the packages of methods into an environment of their own")
    command.add_argument("environments", nargs="+", choices=sorted(ENVIRONMENTS), metavar="NAME", help=", ".join(sorted(ENVIRONMENTS)))
    command.set_defaults(action=_install)


def _install(given: argparse.Namespace) -> int:
    import gloam
    from gloam.slam.methods import python_of

    for name in given.environments:
        python = python_of(name)
        folder = python.parent.parent
        if name in _LICENCES:
            _tell(f"{name}: {_LICENCES[name]}")
        steps = [
            [sys.executable, "-m", "venv", "--without-pip", "--clear", str(folder)],
            ["python3", "-m", "pip", "--python", str(python), "install", "--quiet", "--no-deps", "--require-hashes",
             "--disable-pip-version-check", "--only-binary=:all:", "-r", str(ENVIRONMENTS[name])],
        ]  # fmt: skip
        for step in steps:
            done = subprocess.run(step, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                lines = (done.stderr or done.stdout).strip().splitlines() or ["no output"]
                raise gloam.Error(f"cannot install {name}: {lines[-1]}", hint="the machine needs access to a Python package index")
        print(f"{name}: {folder}")
    return 0


def _add_vocabulary(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser("vocabulary", help="make a vocabulary of ORB features from images, for ORB-SLAM")
    command.add_argument("folders", nargs="+", help="folders of PNG or JPEG images, searched with their subfolders")
    command.add_argument("-o", "--out", required=True, help="text file to write")
    command.set_defaults(action=_vocabulary)


def _vocabulary(given: argparse.Namespace) -> int:
    from gloam.slam import adapters
    from gloam.slam.methods import opencv_python

    script = Path(adapters.__path__[0]) / "vocabulary.py"
    return subprocess.run([str(opencv_python()), str(script), given.out, *given.folders], check=False).returncode


def _methods(_: argparse.Namespace) -> int:
    import gloam
    from gloam.slam.methods import METHODS

    for name, method in METHODS.items():
        try:
            method.words({"sequence": "", "out": "", "truth": "", "seed": "", "vocabulary": ""})
            state = "ready"
        except gloam.UsageError as error:
            state = error.hint or error.message
        print(f"{name:22} {method.sensors:12} {state}")
    return 0


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
