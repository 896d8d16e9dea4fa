#!/usr/bin/env python3
"""Measures what the C++ build costs: CPU seconds of each compile, run alone, in `build/release`.

    python3 tests/build_time.py                         all that `./gloam setup` compiles: targets, and the dearest files
    python3 tests/build_time.py --only 'render|scene'   objects whose path matches the expression
    python3 tests/build_time.py --save before.json      keeps the figures; later, in another state of the source:
    python3 tests/build_time.py --against before.json   compares with them, file by file

Nothing in the build folder changes: objects are written to a temporary folder. Precompiled headers must be there, so
build first. User and system seconds are added up; beside other work they are up to half as many again.
"""
import argparse
import json
import re
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def commands(folder, what):
    """(object, command) of each compile that the target `what` takes."""
    listed = subprocess.run(["ninja", "-C", str(folder), "-t", "commands", what], check=True, text=True, capture_output=True)
    for line in listed.stdout.splitlines():
        found = re.search(r" -o (\S+)", line)
        if found and " -c " in line:
            yield found.group(1), line


def cpu_seconds(command, folder, name, scratch):
    """CPU seconds of one command; what it writes goes to `scratch`."""
    outputs = {name: f"{scratch}/output", f"{name}.d": f"{scratch}/depends"}
    words = [outputs.get(word, word) for word in shlex.split(command)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if result.returncode != 0:
        sys.exit(f"build_time: {name} does not compile; build first\n{result.stdout[-2000:]}")
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def target_of(name):
    found = re.search(r"CMakeFiles/([^/]+)\.dir/", name)
    return found.group(1) if found else "others"


def print_table(title, rows, before):
    print(f"\n{title}")
    for name, seconds in sorted(rows.items(), key=lambda row: -row[1]):
        then = f"{before[name]:8.1f} ->" if name in before else " " * 11
        print(f"{then} {seconds:7.1f} s  {name}")


def sums(seconds):
    per_target = {}
    for name, value in seconds.items():
        per_target[target_of(name)] = per_target.get(target_of(name), 0) + value
    return per_target


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--preset", default="release")
    parser.add_argument("--target", default="all", help="of ninja's")
    parser.add_argument("--only", default="", metavar="REGEX", help="objects whose path matches")
    parser.add_argument("--dearest", type=int, default=25, help="files that are listed")
    parser.add_argument("--save", type=Path, metavar="FILE")
    parser.add_argument("--against", type=Path, metavar="FILE")
    args = parser.parse_args()
    folder, seconds = ROOT / "build" / args.preset, {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, command in commands(folder, args.target):
            if re.search(args.only, name):
                seconds[name] = cpu_seconds(command, folder, name, scratch)
                print(f"{seconds[name]:7.1f} s  {name}", file=sys.stderr, flush=True)
    before = json.loads(args.against.read_text()) if args.against else {}
    before = {name: value for name, value in before.items() if re.search(args.only, name)}
    if args.save:
        args.save.write_text(json.dumps(seconds, indent=1))
    dearest = dict(sorted(seconds.items(), key=lambda row: -row[1])[:args.dearest])
    print_table("per target", sums(seconds), sums(before))
    print_table(f"the {len(dearest)} dearest", dearest, before)
    then = f"{sum(before.values()):.1f} -> " if before else ""
    print(f"\ntotal {then}{sum(seconds.values()):.1f} s of CPU, {len(seconds)} compiles")


if __name__ == "__main__":
    main()
