#!/usr/bin/env python3
"""Measures Gloam against peers and limits, as ratios in one run: `./gloam bench [--only NAME] [--json]`.

Prints one line per figure with its bar. A complete run is kept in bench/history and compared with the one before on
the same kind of machine. Peers are installed on first use into .cache/bench_venv (300 MB). See docs/bench.md.
"""
import argparse
import datetime
import json
import os
import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import measure
import measure_card
import measure_realistic
from measure import ROOT, say

HISTORY = ROOT / "bench" / "history"
# With the seconds that each takes.
ON_CPU = {**measure.ALL, **measure_realistic.ALL}
ON_CARD = {**measure_card.ALL, **measure_realistic.CARD}
SUBJECTS = {**ON_CPU, **ON_CARD}


class Progress:
    """A line on the terminal that tells what is measured and how long it will still take; elsewhere a line per subject."""

    def __init__(self, expected):
        self._left, self._live = dict(expected), sys.stderr.isatty()
        self._stop = threading.Event()

    def start(self, subject):
        self._subject, self._began, self._expected = subject.__name__, time.monotonic(), self._left.pop(subject)
        text = f"measuring {self._subject}: {subject.__doc__}"
        say(text if self._live else f"{text} (about {self._expected:.0f} s, then {sum(self._left.values()):.0f} s)")
        self._stop.clear()
        self._thread = threading.Thread(target=self._tick, daemon=True)
        self._thread.start()

    def end(self):
        self._stop.set()
        self._thread.join()
        return time.monotonic() - self._began

    def _tick(self):
        while self._live and not self._stop.wait(1):
            passed = time.monotonic() - self._began
            left = max(self._expected - passed, 1) + sum(self._left.values())
            share = min(passed / self._expected, 0.99)
            sys.stderr.write(f"\r\033[K{share:4.0%} of {self._subject}, about {left:.0f} s left in all")
            sys.stderr.flush()
        if self._live:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()


def machine():
    names = re.findall(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.M)
    return {"cpu": names[0] if names else os.uname().machine, "cores": os.cpu_count()}


def commit():
    try:
        return measure.run("git", "-C", ROOT, "describe", "--always", "--dirty").strip()
    except (RuntimeError, OSError):
        return "unknown"  # sources without their history, or a machine without git


def versions():
    listed = re.findall(r"^(mujoco|mitsuba)==(\S+)$", (ROOT / "bench" / "requirements.txt").read_text(), re.M)
    return {"gloam": measure.run(measure.BIN / "gloam", "--version").strip().replace("\n", ", "),
            "commit": commit(),
            "peers": ", ".join(f"{name} {version}" for name, version in listed)}


def previous_run(here):
    """The newest complete run on the same kind of machine, or None."""
    runs = []
    for path in HISTORY.glob("bench_*.json"):
        record = json.loads(path.read_text())
        if record["machine"] == here:
            runs.append(record)
    return max(runs, key=lambda record: record["date"], default=None)


def change(row, before):
    """Since the previous run, in words; empty when there is nothing to compare with."""
    old = next((r["value"] for r in before["rows"] if r["name"] == row["name"]), 0) if before else 0
    return f"{100 * (row['value'] / old - 1):+.0f} % since {before['date'][:10]}" if old else ""


def number(value):
    return f"{value:.3f}" if value == 0 or abs(value) >= 0.01 else f"{value:.2g}"


def print_row(row, before):
    sign = ">=" if row["better"] == "higher" else "<="
    mark = "ok  " if row["met"] else "MISS"
    print(f"{mark} {row['name']:<58} {number(row['value']):>7}  (bar {sign} {row['bar']:g})  {change(row, before)}", flush=True)
    print(f"     {row['note']}", flush=True)


def keep(record):
    """One file per day and commit: a repeated run replaces the earlier one."""
    HISTORY.mkdir(exist_ok=True)
    path = HISTORY / f"bench_{record['date'][:10]}_{record['versions']['commit']}.json"
    path.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n")
    return path


def choose(only, subjects):
    chosen = [subject for subject in subjects if only in subject.__name__]
    if not chosen:
        names = ", ".join(subject.__name__ for subject in subjects)
        say(f"error: nothing that is measured has '{only}' in its name; there are: {names}")
        sys.exit(2)
    return chosen


def measure_all(chosen, before, args):
    """Rows, seconds by subject, and the names of the subjects that could not be measured."""
    expected = {subject: (before or {}).get("seconds", {}).get(subject.__name__, SUBJECTS[subject]) for subject in chosen}
    if args.quick:
        expected = {subject: seconds / 4 for subject, seconds in expected.items()}
    rows, seconds, failed, progress = [], {}, [], Progress(expected)
    for subject in chosen:
        progress.start(subject)
        try:
            found, error = list(subject(args.quick)), None
        except (RuntimeError, OSError, ValueError, KeyError) as problem:
            found, error = [], problem
        finally:
            seconds[subject.__name__] = round(progress.end(), 1)
        if error is not None:
            failed.append(subject.__name__)
            say(f"error: {subject.__name__} could not be measured: {error}")
        for row in found:
            rows.append(row)
            if not args.json:
                print_row(row, before)
    return rows, seconds, failed


def main():
    parser = argparse.ArgumentParser(prog="./gloam bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Measured: " + ", ".join(s.__name__ for s in ON_CPU) +
                                            "\nExample: ./gloam bench --only sim")
    parser.add_argument("--only", metavar="NAME", default="", help="only what has NAME in its name; not kept in the history")
    parser.add_argument("--quick", action="store_true", help="few repetitions, rough figures: to see that it works; not kept")
    parser.add_argument("--json", action="store_true", help="print the record of the run as JSON")
    parser.add_argument("--device", choices=["cpu", "cuda"], default="cpu", help="cuda: what an NVIDIA card does; not kept")
    args = parser.parse_args()
    chosen = choose(args.only, ON_CARD if args.device == "cuda" else ON_CPU)
    here = machine()
    before = previous_run(here)
    busy = os.getloadavg()[0]
    if busy > 0.5 * here["cores"]:
        say(f"warning: the machine is busy (load {busy:.1f} on {here['cores']} cores): expect a scatter of 30 %")
    rows, seconds, failed = measure_all(chosen, before, args)
    record = {"date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), "machine": here,
              "load": round(busy, 2), "versions": versions(), "rows": rows, "seconds": seconds}
    if args.json:
        print(json.dumps(record, indent=1, ensure_ascii=False))
    if failed:
        return 3 if rows else 1
    if not (args.only or args.quick or args.device == "cuda"):
        say(f"kept in {os.path.relpath(keep(record))}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        say("stopped; a run that is not complete is not kept")
        sys.exit(130)
