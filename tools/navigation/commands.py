#!/usr/bin/env python3
"""`gloam navigate`, `gloam map` and `gloam bench nav`. Help is printed without a built program."""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gloam.navigation.benchmark.request import Request


def main(arguments: list[str] | None = None) -> int:
    """The command line. Exit codes: 0 ok, 1 failure, 2 usage, 3 videos are missing, 130 interrupted."""
    parser = argparse.ArgumentParser(prog="gloam", description="Visual navigation (docs/navigation.md).")
    commands = parser.add_subparsers(dest="command", required=True)
    _add_navigate(commands)
    _add_map(commands)
    _add_bench(commands)
    given = parser.parse_args(arguments)
    import gloam

    try:
        return int(given.action(given))
    except gloam.Error as error:
        print(f"gloam: error: {error}", file=sys.stderr)
        return 2 if isinstance(error, gloam.UsageError) else 1
    except KeyboardInterrupt:
        print("gloam: interrupted", file=sys.stderr)
        return 130


def _add_navigate(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "navigate",
        help="run a scene with its [planner]",
        epilog="Example:\n  gloam navigate examples/planner.toml --log run.mcap",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add_argument("scene", help="scene with a [planner]")
    command.add_argument("--duration", type=float, help="[s]; default: the scene's")
    command.add_argument("--seed", type=int, help="default: the scene's")
    command.add_argument("--plugin", action="append", default=[], help="Python file or module that registers planners; repeatable")
    command.add_argument("--log", help="file of a log to record (MCAP)")
    command.add_argument("--topics", default="/clock,/tf*", help="topics of the log beside states and inputs; default: %(default)s")
    command.add_argument("--overwrite", action="store_true", help="replace an existing log")
    command.add_argument(
        "--allow-programs",
        action="store_true",
        help="let the scene's planner start a program, load a library or connect to another machine",
    )
    command.set_defaults(action=_navigate)


def _navigate(given: argparse.Namespace) -> int:
    import gloam
    from gloam.navigation.plugins import load_plugin
    from gloam.navigation.scene import drive

    for plugin in given.plugin:
        load_plugin(plugin)
    with gloam.load(given.scene, seed=given.seed) as sim:
        until = given.duration if given.duration is not None else sim.scene.duration
        if given.log:
            with sim.record(given.log, given.topics.split(","), overwrite=given.overwrite):
                driver = drive(sim, until, given.allow_programs)
        else:
            driver = drive(sim, until, given.allow_programs)
        stats = driver.stats
        robot = sim.robots[driver.rig.robot]
        print(f"time {sim.time:.2f} s, position {robot.pose.p[0]:.2f} {robot.pose.p[1]:.2f} m, arrived {str(driver.has_arrived).lower()}")
        print(f"{stats.plans} plans, {stats.late} late, {stats.invalid} invalid{': ' + stats.error if stats.error else ''}")
    return 0


def _add_map(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "map",
        help="make a topological map from a log",
        epilog="Example:\n  gloam map run.mcap --camera go/front --spacing distance=0.5 -o map",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add_argument("log", help="log of a demonstration (MCAP)")
    command.add_argument("-o", "--out", required=True, help="folder of the map; must not exist")
    command.add_argument("--robot", default="", help="default: the first one")
    command.add_argument("--camera", default="", help="default: the first camera of the robot")
    command.add_argument("--spacing", default="time=1", help="of nodes: time=SECONDS, distance=METRES or change=MEAN (of 255); default: %(default)s")
    command.add_argument("--size", default="160x120", help="of images [px]; default: %(default)s")
    command.set_defaults(action=_map)


def _map(given: argparse.Namespace) -> int:
    import gloam
    from gloam.navigation import Spacing
    from gloam.navigation.recorded import map_of_log

    rule, _, value = given.spacing.partition("=")
    width, _, height = given.size.partition("x")
    if Path(given.out).exists():
        raise gloam.UsageError(f"{given.out} already exists", hint="choose another folder")
    try:
        spacing = Spacing(rule, float(value))
        size = (int(width), int(height))
    except ValueError as error:
        raise gloam.UsageError(str(error)) from None
    with tempfile.TemporaryDirectory(prefix="gloam-map-") as work:
        made = map_of_log(Path(given.log), Path(work), spacing, size, (given.robot, given.camera))
    made.save(given.out)
    print(f"{given.out}: {len(made)} nodes of {size[0]} x {size[1]} pixels")
    return 0


_BENCH_EXAMPLES = """\
Examples:
  gloam bench nav --n 5 --planners route,lidar
  gloam bench nav --planners gnm,nomad --set gnm.weights=gnm.onnx --set nomad.weights=FOLDER
  gloam bench nav --planners clear,hazy --set clear.type=gnm --set clear.weights=clear.onnx \\
      --set hazy.type=gnm --set hazy.weights=hazy.onnx
  gloam bench nav --planners route,follow --plugin FILE --scenes house --levels none,major --out nav"""


def _add_bench(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    command = commands.add_parser(
        "bench",
        prog="gloam bench nav",
        help="the benchmark of visual navigation",
        description="Planners x scenes x adversity levels (docs/navigation.md). A repeated call continues.",
        epilog=_BENCH_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    option = command.add_argument
    option("--planners", help="names, separated by commas; default: straight,replay,lidar,route, and gloam if its network exists")
    option("--set", action="append", default=[], metavar="PLANNER.OPTION=VALUE", help="option of a planner, see below; repeatable")
    option("--plugin", action="append", default=[], help="Python file or module that registers planners; repeatable")
    option("--scenes", default="house,warehouse", help="also office, tunnel, mine and terrain; default: %(default)s")
    option("--levels", default="none,minor,major", help="also dark; default: %(default)s")
    option("--n", type=int, default=100, help="episodes of each planner, scene and level; default: %(default)s")
    option("--seed", type=int, default=1, help="default: %(default)s")
    option("--tier", default="interactive", choices=("interactive", "path", "direct"), help="of images; default: %(default)s")
    option("--check-tier", type=int, default=0, metavar="N", help="compare the first N episodes of each cell with the path tier")
    option("--out", default="results/navigation", help="folder of the results; default: %(default)s")
    option("--workers", type=int, default=0, help="processes; default: one for two processors")
    option("--ray", default="", metavar="ADDRESS", help='Ray cluster that runs episodes: "auto" or ray://HOST:PORT')
    option("--no-log", action="store_true", help="do not record a log of each episode")
    option("--no-videos", action="store_true", help="do not render the median and the worst episode of each cell")
    option("--no-report", action="store_true", help="run the episodes only")
    command.set_defaults(action=_bench)


def _bench(given: argparse.Namespace) -> int:
    request, out = _request(given), Path(given.out)
    try:
        return _run(given, request, out)
    except KeyboardInterrupt:
        done = sum(1 for _ in out.glob("episodes/*/*/*/[!.]*/episode.json"))
        _tell(f"gloam: {done} episodes are complete in {out}; the same command continues")
        raise


def _run(given: argparse.Namespace, request: Request, out: Path) -> int:
    from gloam.experiments.request import machine_name
    from gloam.navigation.benchmark.cost import cost_lines
    from gloam.navigation.benchmark.report import write_report
    from gloam.navigation.benchmark.runner import Workers, run
    from gloam.navigation.benchmark.tiers import FOLDER, tier_lines, tier_request, write_tiers
    from gloam.navigation.benchmark.videos import render_videos

    begin, workers = time.monotonic(), Workers(given.workers, given.ray)
    path_request = tier_request(request, given.check_tier) if given.check_tier else None
    results = run(request, out, workers, _tell)
    if path_request is not None:
        results += run(path_request, out / FOLDER, workers, _tell)
    for line in cost_lines(results, time.monotonic() - begin, machine_name()):
        _tell(line)
    if path_request is not None:
        for line in tier_lines(write_tiers(out), request.tier):
            print(line)
    problems = [] if given.no_report or given.no_videos else render_videos(out, _tell)
    for file in [] if given.no_report else write_report(out):
        print(file)
    for problem in problems:
        _tell(f"gloam: {problem}")
    return 3 if problems else 0


def _request(given: argparse.Namespace) -> Request:
    from gloam.navigation.benchmark.options import completed, parse_options, plugin_files
    from gloam.navigation.benchmark.request import Request
    from gloam.navigation.planners.goal_image import own_weights

    planners = given.planners
    if planners is None:
        planners = "straight,replay,lidar,route"
        if own_weights().is_file():
            planners += ",gloam"
        else:
            _tell(f"planner gloam is left out: its network {own_weights()} does not exist yet")
    names, scenes, levels = (tuple(filter(None, text.split(","))) for text in (planners, given.scenes, given.levels))
    plugins = plugin_files(given.plugin)
    options = completed(names, parse_options(given.set))
    return Request(names, scenes, levels, given.n, given.seed, given.tier, not given.no_log, options, plugins)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
