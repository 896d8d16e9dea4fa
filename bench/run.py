#!/usr/bin/env python3
"""Measures Gloam against peers and limits, as ratios in one run: `./gloam bench [--only NAME] [--json]`.

Prints one line per measurement with its bar and keeps the figures in bench/history. Peers are installed on first use
into .cache/bench_venv (about 300 MB). Ratios above 1 mean that Gloam is better unless the line says otherwise.
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = ROOT / "build" / "release" / "bin"
CACHE = ROOT / ".cache"
PEER_PACKAGES = ["libllvm19", "libegl1", "libgles2", "libgl1-mesa-dri", "mesa-vulkan-drivers"]

sys.path.insert(0, str(ROOT / "tests"))
import fetch_data  # noqa: E402


def say(text):
    print(f"gloam: {text}", file=sys.stderr, flush=True)


def run(command, **env):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, env={**os.environ, **env})
    if result.returncode != 0:
        raise RuntimeError(f"{Path(str(command[0])).name} failed: {(result.stderr or result.stdout).strip().splitlines()[-1:]}")
    return result.stdout


def cpu_seconds(command, **env):
    """User and system seconds of one run of a command."""
    before = os.times()
    run(command, **env)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def robot(name):
    data = Path(os.environ.get("GLOAM_TEST_DATA") or fetch_data.default_folder())
    if not (data / "mjlab").exists():
        say("fetching the robots to measure with")
        run([sys.executable, ROOT / "tests" / "fetch_data.py", data])
    found = sorted((data / "mjlab").glob(f"**/{name}.xml"))
    if not found:
        raise RuntimeError(f"{name}.xml is not in the test data")
    return found[0]


def peer_python():
    python = CACHE / "bench_venv" / "bin" / "python"
    if not python.exists():
        say("installing the peers (MuJoCo's renderers, Mitsuba) into .cache/bench_venv")
        missing = [p for p in PEER_PACKAGES if subprocess.run(["dpkg", "-s", p], capture_output=True).returncode != 0]
        if missing:
            run((["sudo"] if os.geteuid() else []) + ["apt-get", "install", "-y", "--no-install-recommends", *missing])
        run([sys.executable, "-m", "venv", CACHE / "bench_venv"])
        run([python, "-m", "pip", "install", "-q", "-r", ROOT / "bench" / "requirements.txt"])
    return python


def row(name, value, bar, better, note=""):
    return {"name": name, "value": round(value, 4), "bar": bar, "met": value >= bar if better == "higher" else value <= bar,
            "better": better, "note": note}


def sim_step_rate():
    """CPU time of the sim thread against a bare mj_step loop, alternate blocks in one process."""
    data = json.loads(run([BIN / "bench_sim_step_rate", robot("go1"), "--json"]))
    low = data["lower_95"]
    yield row("sim: step rate / bare mj_step loop, lower 95 % bound", low, 0.97, "higher", f"median {data['median_ratio']:.3f}, {data['pairs']} pairs")


def path_tier():
    """Paths per second of CPU time against Mitsuba 3.9 (llvm_ad_rgb) on the same meshes and lights."""
    folder = CACHE / "bench_room"
    folder.mkdir(parents=True, exist_ok=True)
    own = run([BIN / "bench_path_rate", "--plain", "--spp", "4", "--runs", "5", "--export", folder])
    own_rate = float(re.search(r"([\d.]+) Mpaths/s", own).group(1))
    library = next(Path("/usr/lib").glob("*/libLLVM*19*.so*"))
    theirs = run([peer_python(), ROOT / "bench" / "peers" / "mitsuba_room.py", folder, "--spp", "4", "--runs", "5"],
                 DRJIT_LIBLLVM_PATH=str(library))
    their_rate = float(re.search(r"([\d.]+) Mpaths/s", theirs).group(1))
    yield row("path tier: paths per second / Mitsuba 3.9", own_rate / their_rate, 1.0, "higher", own.strip().splitlines()[-1])


def direct_tier():
    """One RGB picture with shadows against MuJoCo's own renderers on the same model."""
    scene = CACHE / "bench_boxes.xml"
    boxes = "".join(f'<geom type="box" size=".1 .1 .1" pos="{-1.5 + 0.75 * (i % 5)} {-1.5 + (i // 5)} 0.1" rgba=".{3 + i % 6} .4 .5 1"/>'
                    for i in range(20))
    CACHE.mkdir(exist_ok=True)
    include = robot("go1")
    scene = include.parent / "gloam_bench_boxes.xml"
    scene.write_text(f'<mujoco><include file="{include.name}"/><worldbody><light type="spot" pos="1 1 3" dir="-.3 -.3 -1" castshadow="true"/>'
                     f'<geom type="plane" size="5 5 .1"/>{boxes}<camera name="c" pos="1.2 -1.2 .8" xyaxes=".7 .7 0 -.3 .3 .9"/></worldbody></mujoco>')
    times = []
    for spp in (1, 9):
        samples = []
        for _ in range(5):
            start = time.perf_counter()
            run([BIN / "gloam", "render", scene, "--camera", "c", "--tier", "direct", "--no-denoise", "--spp", spp, "--resolution", "640x480",
                 "--out", CACHE / "bench_pictures"])
            samples.append(time.perf_counter() - start)
        times.append(statistics.median(samples))
    own = 1e3 * (times[1] - times[0]) / 8
    for kind in ("classic", "filament"):
        theirs = float(run([peer_python(), ROOT / "bench" / "peers" / "mujoco_render.py", scene, kind, 640, 480, 10]).split()[-1])
        yield row(f"direct tier: MuJoCo {kind} time / ours, 640x480", theirs / own, 3.0, "higher", f"{theirs:.0f} ms against {own:.0f} ms")


def first_picture():
    """Start of the program to a written picture, warm."""
    command = [BIN / "gloam", "render", ROOT / "examples" / "demo.toml", "--camera", "chase", "--spp", "1", "--out", CACHE / "bench_pictures"]
    run(command)
    samples = []
    for _ in range(5):
        start = time.perf_counter()
        run(command)
        samples.append(time.perf_counter() - start)
    yield row("first picture after a warm start [s]", statistics.median(samples), 3.0, "lower")


MEASUREMENTS = [sim_step_rate, path_tier, direct_tier, first_picture]


def main():
    parser = argparse.ArgumentParser(prog="./gloam bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Example: ./gloam bench --only sim")
    parser.add_argument("--only", metavar="NAME", default="", help="only measurements whose name contains NAME")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    args = parser.parse_args()
    rows, failed = [], []
    for measure in MEASUREMENTS:
        if args.only not in measure.__name__:
            continue
        say(f"measuring {measure.__name__}: {measure.__doc__}")
        try:
            for line in measure():
                rows.append(line)
                if not args.json:
                    sign = ">=" if line["better"] == "higher" else "<="
                    print(f"{'ok  ' if line['met'] else 'MISS'} {line['name']:<58} {line['value']:8.3f}  (bar {sign} {line['bar']})  {line['note'][:90]}", flush=True)
        except (RuntimeError, OSError, AttributeError, StopIteration, TypeError) as error:
            failed.append(measure.__name__)
            say(f"error: {measure.__name__} could not be measured: {error}")
    version = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    if rows:
        history = ROOT / "bench" / "history"
        history.mkdir(exist_ok=True)
        (history / f"bench_{version}.json").write_text(json.dumps({"version": version, "cpus": os.cpu_count(), "rows": rows}, indent=1))
    if args.json:
        print(json.dumps(rows, indent=1))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
