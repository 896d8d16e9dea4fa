#!/usr/bin/env python3
"""Runs Gloam's tests: `./gloam test [fast|full|NAME…]`.

fast   the rules of sources and documents, the unit tests without a label in tests/labels.txt, the command line: six minutes once built
       (no tier) the checks of CI: all of that, format, lint of changed files, slow unit tests, end-to-end tests, tests of
       `import gloam`, and 15 seconds of fuzzing for each of the main readers
full   everything: sanitizers, 10,000 damaged files for every reader, five minutes of fuzzing per target and sweeps over 200 seeds:
       hours, but resumable: build/full_state.json lists passed parts until the source changes
NAME   modules with this name, and tests of C++ and Python whose name contains it

Unit tests run under ctest (`ctest --test-dir build/release -L fast -j2`), tests of Python under pytest.
"""
import argparse
import os
import re
import subprocess
import sys
import time

import full
import runner
from runner import BUILD, ROOT, Results

RULES = sorted((ROOT / "tests").glob("*_rule.py")) + [ROOT / "tests" / "extending.py"]
E2E = sorted((ROOT / "tests" / "e2e").glob("*_test.py"))
PYTHON = [ROOT / "tests" / "python"]


def fast(results):
    if runner.build(results):
        runner.python_tests(results, runner.python_for_rules(), [*RULES, ROOT / "tests" / "e2e" / "cli_test.py"])
        runner.unit_tests(results, "fast")


def ci(results):
    runner.run_command(results, "data of tests", sys.executable, "tests/fetch_data.py")
    python = runner.python_for_gloam(results)  # first: its build configures the folder for Python
    # Without a card, the tests of CUDA show that its sources compile.
    if not runner.build(results) or not runner.build(results, "release", "cuda_tests"):
        return
    checks = [ROOT / "tests" / "source_checks.py"]
    runner.python_tests(results, runner.python_for_rules(), [*checks, *RULES, *E2E])
    runner.unit_tests(results, "(fast|slow|cuda)")
    if python:
        runner.python_tests(results, python, PYTHON, "-m", "not slow")
    if runner.build(results, "asan", "main_fuzzers"):
        runner.unit_tests(results, "fuzz_main", "asan")


def has_tests(module, patterns):
    program = BUILD / "release" / "bin" / f"gloam_{module}_test"
    listed = subprocess.run([program, "--gtest_list_tests", f"--gtest_filter={patterns}"], text=True, capture_output=True).stdout
    return any(line.startswith("  ") for line in listed.splitlines())


def named(results, names):
    """Modules and tests whose names contain one of `names`."""
    if not runner.build(results):
        return
    modules = set(runner.unit_test_names("unit"))
    runner.unit_tests(results, "unit", only=[name for name in names if name in modules])
    parts = [name for name in names if name not in modules]
    patterns = ":".join(f"*{name}*" for name in parts)
    having = [module for module in modules if parts and has_tests(module, patterns)]
    disabled = {"GTEST_ALSO_RUN_DISABLED_TESTS": "1"} if "DISABLED" in patterns else {}
    runner.unit_tests(results, "unit", only=having, GTEST_FILTER=patterns, **disabled)
    words = [name for name in names if re.fullmatch(r"[\w.\-\[\]]+", name)]
    for files, python in ((RULES + E2E, lambda: runner.python_for_rules()),
                          (sorted(PYTHON[0].glob("test_*.py")), lambda: runner.python_for_gloam(results))):
        files = [file for file in files if any(word.lower() in file.stem + file.read_text().lower() for word in words)]
        if files and (interpreter := python()):
            runner.python_tests(results, interpreter, files, "-k", " or ".join(words))


def main():
    parser = argparse.ArgumentParser(prog="./gloam test", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", metavar="fast|full|NAME", help="default: the checks of CI")
    args = parser.parse_args()
    BUILD.mkdir(exist_ok=True)
    tier = args.what[0] if args.what in (["fast"], ["full"]) else "names" if args.what else "ci"
    if tier in ("ci", "full"):  # a user's build has warnings that are no errors
        os.environ.setdefault("GLOAM_WERROR", "ON")
    results, start = Results(), time.monotonic()
    try:
        {"fast": fast, "ci": ci, "full": lambda r: full.full(r, ci), "names": lambda r: named(r, args.what)}[tier](results)
    except KeyboardInterrupt:
        return 130
    except RuntimeError as error:  # packages of tests cannot be installed
        print(f"gloam: error: {error}", file=sys.stderr)
        return 1
    details, counts = results.summary()
    print(f"{details}\ntotal {(time.monotonic() - start) / 60:.1f} min\n{counts}")
    return 1 if results.failures or not results.passed else 0


if __name__ == "__main__":
    sys.exit(main())
