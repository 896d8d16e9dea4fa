#!/usr/bin/env python3
"""Runs Gloam's tests: `./gloam test [fast|full] [--only NAME]`.

fast  the quick tests: about six minutes once built
      (no tier) the checks of CI: format, lint of changed files, all tests, and 15 seconds of fuzzing with sanitizers for each of the main
      readers; the other tests with sanitizers, and the bundle, are part of full
full  the same plus lint of all files, all tests with every sanitizer, 10 000 damaged files for every reader, five minutes of fuzzing per
      target and sweeps over 200 seeds: an hour or more, but resumable: build/full_state.json lists passed parts until the source changes
"""
import argparse
import contextlib
import fcntl
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import fetch_data  # noqa: E402
import labels  # noqa: E402

BUILD = ROOT / "build"
CLANG = "-19"
AS_BUILT = {"GLOAM_AS_BUILT": "1"}  # ./gloam in a test builds nothing: others run the program that it would link anew
UNIT = ["base", "trajectory", "ros", "mcap", "geometry", "places", "scene", "world", "sim", "render", "sensors", "control", "metrics", "topics", "record", "runtime",
        "report", "web", "bridge", "studio", "teleop"]


class Tally:
    """Counts of what ran, and what broke in plain words."""

    def __init__(self):
        self.passed, self.failed, self.skipped, self.broken, self.seconds = 0, 0, 0, [], {}

    def add(self, name, passed, failed, skipped, seconds, detail="", broken=()):
        """One line of the report; `broken` names the tests that failed, for the last lines, which survive where a long report is cut."""
        self.seconds[name] = seconds
        self.passed += passed
        self.failed += failed
        self.skipped += skipped
        mark = "ok  " if not failed else "FAIL"
        counts = f"{passed} passed" + (f", {failed} failed" if failed else "") + (f", {skipped} skipped" if skipped else "")
        print(f"{mark} {name:<34} {counts:<34} {seconds:6.1f} s", flush=True)
        if failed:
            self.broken += [f"{name}: {test}" for test in broken] or [name]
            if detail:
                print(detail, flush=True)


def environment():
    env = dict(os.environ)
    env.setdefault("GLOAM_TEST_DATA", str(fetch_data.default_folder()))
    env.setdefault("ASAN_OPTIONS", "detect_leaks=1:abort_on_error=0:allocator_may_return_null=1")
    env.setdefault("LSAN_OPTIONS", f"suppressions={ROOT}/tests/lsan.supp:print_suppressions=0")
    env.setdefault("TSAN_OPTIONS", f"suppressions={ROOT}/tests/tsan.supp:ignore_noninstrumented_modules=1:halt_on_error=1")
    return env


def run(command, text_in="", timeout=None, **variables):
    return subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          input=text_in, timeout=timeout, env=environment() | variables)


def tail(text, lines=40):
    return "\n".join("    " + line for line in text.splitlines()[-lines:])


def broken_tests(text):
    """Names in the summaries of unittest ("FAIL: test …") and pytest ("FAILED file::test - …"), without unittest's last line
    ("FAILED (failures=1)")."""
    return re.findall(r"^(?:FAIL:|FAILED|ERROR:?) ([^(].*)", text, re.M)


def first_lines(text, lines=6):
    return "\n    ".join(text.strip().splitlines()[:lines])


@contextlib.contextmanager
def build_folder(preset):
    """Alone in a preset's build folder: ./gloam builds there, too, under the same lock."""
    with open(BUILD / f".lock-{preset}", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def build(tally, preset, targets=()):
    with build_folder(preset):
        return build_alone(tally, preset, targets)


def build_alone(tally, preset, targets):
    start = time.time()
    folder, presets = BUILD / preset, ROOT / "CMakePresets.json"
    rules, result = folder / "build.ninja", None
    warnings = os.environ.get("GLOAM_WERROR")  # as in ./gloam: a folder that was set up otherwise is configured again, once
    options = [f"-DGLOAM_WERROR={warnings}"] if warnings else []
    # Afresh: where a preset has come to name another compiler, CMake would forget all else that it sets.
    if not rules.exists() or rules.stat().st_mtime < presets.stat().st_mtime:
        result = run(["cmake", "--fresh", "--preset", preset, *options])
    elif warnings and f"GLOAM_WERROR:BOOL={warnings}" not in (folder / "CMakeCache.txt").read_text().splitlines():
        result = run(["cmake", "--preset", preset, *options])
    if result is None or result.returncode == 0:
        result = run(["ninja", "-C", str(folder), *targets])
    ok = result.returncode == 0
    tally.add(f"build {preset}", int(ok), int(not ok), 0, time.time() - start, "" if ok else tail(result.stdout))
    return ok


def gtest(tally, preset, module, only=None, shard_filter=None, shard=None):
    """Runs one module's unit tests under one build; its own output is shown only for what fails."""
    program = BUILD / preset / "bin" / f"gloam_{module}_test"
    if not program.exists():
        return
    number, of = shard or (0, 1)
    report = BUILD / preset / f"{module}_tests{'_' + str(number + 1) if shard else ''}.json"
    report.unlink(missing_ok=True)
    command = [str(program), f"--gtest_output=json:{report}", "--gtest_brief=1"]
    if only or shard_filter:
        command.append(f"--gtest_filter={only or shard_filter}")
    if only and "DISABLED_" in only:
        command.append("--gtest_also_run_disabled_tests")
    start = time.time()
    result = run(command, timeout=3600, GTEST_SHARD_INDEX=str(number), GTEST_TOTAL_SHARDS=str(of))
    name = f"{module} ({preset})" + (f" part {number + 1} of {of}" if shard else "")
    seconds = time.time() - start
    if not report.exists():
        tally.add(name, 0, 1, 0, seconds, f"    crashed with status {result.returncode}\n" + tail(result.stdout))
        return
    data = json.loads(report.read_text())
    cases = [case for suite in data.get("testsuites", []) for case in suite.get("testsuite", [])]
    skipped = sum(case.get("result") == "SKIPPED" for case in cases)
    broken = [f"{case['classname']}.{case['name']}: {first_lines(case['failures'][0]['failure'])}" for case in cases if "failures" in case]
    failed = len(broken)
    ran = sum(case.get("status") == "RUN" for case in cases)
    if result.returncode != 0 and failed == 0:
        failed = 1  # a sanitizer spoke after the last test
    tally.add(name, max(ran - failed - skipped, 0), failed, skipped, seconds, "" if not failed else tail(result.stdout, 80), broken)


MUTATIONS = 10_000  # damaged files per reader; without GLOAM_MUTATIONS the tests take 200


def mutations(tally, module):
    """The readers of one module on damaged files, under the address sanitizer."""
    if build(tally, "asan", [f"gloam_{module}_test"]):
        os.environ["GLOAM_MUTATIONS"] = str(MUTATIONS)
        try:
            gtest(tally, "asan", module, shard_filter="*Mutations*")
        finally:
            del os.environ["GLOAM_MUTATIONS"]


def python_tests(tally, file, only=None, **variables):
    """One file of Python tests, in a process of its own."""
    start = time.time()
    module = str(Path(file).relative_to("tests").with_suffix("")).replace("/", ".")
    result = subprocess.run([sys.executable, "-m", "unittest", "-v", *(["-k", only] if only else []), module], cwd=ROOT / "tests",
                            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment() | AS_BUILT | variables)
    count = re.search(r"^Ran (\d+) test", result.stdout, re.M)
    counted = {what: int(n) for what, n in re.findall(r"(failures|errors|skipped)=(\d+)", result.stdout.splitlines()[-1])}
    failed = counted.get("failures", 0) + counted.get("errors", 0)
    if not count or (result.returncode not in (0, 5) and not failed):  # 5: none has the name asked for
        failed = 1
    ran = int(count.group(1)) if count else failed
    if ran or not only:
        tally.add(file, ran - failed - counted.get("skipped", 0), failed, counted.get("skipped", 0), time.time() - start,
                  "" if not failed else tail(result.stdout, 80), broken_tests(result.stdout))


def api_python(tally):
    """The interpreter for tests of `import gloam`, with the module built for it; None where that fails."""
    start = time.time()
    result = run(["./gloam", "python", "tests/python/env.py"])
    lines = result.stdout.splitlines()
    ok = result.returncode == 0 and bool(lines)
    tally.add("build gloam_python", int(ok), int(not ok), 0, time.time() - start, "" if ok else tail(result.stdout))
    return lines[-1] if ok else None


def api_tests(tally, python, file, mark, only=None, preset="release", **variables):
    """One file of tests of `import gloam`, in a pytest of its own."""
    start, report = time.time(), BUILD / preset / f"{Path(file).stem}.xml"
    report.unlink(missing_ok=True)
    result = run([python, "-m", "pytest", "-q", "-m", mark, f"--junitxml={report}", *(["-k", only] if only else []), file], timeout=3600,
                 **{"GLOAM_BUILT": str(BUILD / preset / "python" / "gloam"), "PYTHONPATH": str(ROOT / "python"), **AS_BUILT, **variables})
    suite = ElementTree.parse(report).getroot().find("testsuite").attrib if report.exists() else {}
    ran, skipped = int(suite.get("tests", 0)), int(suite.get("skipped", 0))
    failed = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
    if result.returncode not in (0, 5) and not failed:  # 5: none of this mark and name
        failed = ran = 1
    if ran:
        name = file if preset == "release" else f"{Path(file).stem} ({preset})"
        tally.add(name, ran - failed - skipped, failed, skipped, time.time() - start, "" if not failed else tail(result.stdout, 80),
                  broken_tests(result.stdout))


def slow_api_tests(tally):
    """Those that take over ten seconds each or fetch a package for themselves."""
    if python := api_python(tally):
        for file in api_files():
            api_tests(tally, python, file, "slow")


def sanitized_api_tests(tally):
    """The memory tests of `import gloam` against a module with the address sanitizer."""
    sys.path.insert(0, str(ROOT / "tests" / "python"))
    import asan
    start = time.time()
    result = run(["./gloam", "setup", "gloam_python"], GLOAM_PRESET="asan")
    tally.add("build asan gloam_python", int(result.returncode == 0), int(result.returncode != 0), 0, time.time() - start,
              "" if result.returncode == 0 else tail(result.stdout))
    python = api_python(tally)
    for file in asan.FILES if python and result.returncode == 0 else []:
        api_tests(tally, python, file, "slow or not slow", preset="asan", **asan.variables())


def api_files():
    return sorted(str(file.relative_to(ROOT)) for file in (ROOT / "tests" / "python").glob("test_*.py"))


def e2e_tests(tally, only=None):
    """Two files at a time, longest first."""
    longest = ["gallery_test", "cli_test", "docs_test"]
    files = sorted((ROOT / "tests" / "e2e").glob("*_test.py"), key=lambda f: (longest + [f.stem]).index(f.stem))
    parts = [lambda f=file: python_tests(tally, str(f.relative_to(ROOT)), only) for file in files]
    if python := api_python(tally):
        mark = "slow or not slow" if only else "not slow"
        parts += [lambda f=file: api_tests(tally, python, f, mark, only) for file in api_files()]
        build(tally, "release")  # CMake was told of Python: what that has changed must not be linked under the hands of tests
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda part: part(), parts))


def tracked(*patterns):
    listed = run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]).stdout.split()
    return [name for name in listed if (ROOT / name).exists()]


def check_format(tally):
    start = time.time()
    files = tracked("*.h", "*.cc", "*.cu", "*.cuh")
    result = run([f"clang-format{CLANG}", "--dry-run", "--Werror", *files])
    ok = result.returncode == 0
    bad = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", result.stdout, re.M)))
    tally.add("format", int(ok), int(not ok), 0, time.time() - start,
              "" if ok else "    not formatted (clang-format-19 -i FILE): " + " ".join(bad))


def check_lint_of_changes(tally):
    """clang-tidy on the sources that changed last: the whole tree would take half an hour."""
    check_lint(tally, [name for name in changed("src/*.cc", "apps/*.cc") if (ROOT / name).exists()], at_most=16)


LANDING = 30  # commits
SLOWEST = 20  # parts that the last lines name


def base_commit():
    """Where this work branched off from its upstream; on the upstream itself some landing before. "" in a clone without history."""
    upstream = run(["git", "merge-base", "HEAD", "origin/main"]).stdout.strip()
    head = run(["git", "rev-parse", "HEAD"]).stdout.strip()
    if re.fullmatch("[0-9a-f]{40}", upstream) and upstream != head:
        return upstream
    older = run(["git", "rev-list", "--first-parent", f"--skip={LANDING}", "-n", "1", "HEAD"]).stdout.strip()
    return older if re.fullmatch("[0-9a-f]{40}", older) else ""


def changed(*patterns):
    """Files that changed since base_commit(), also those that have gone; newest first. In a clone without history, all."""
    base = base_commit()
    if not base:
        return tracked(*patterns)
    return list(dict.fromkeys(run(["git", "log", "--name-only", "--pretty=", f"{base}..HEAD", "--", *patterns]).stdout.split()))


def commands_of_each_file():
    """The folder of a compile_commands.json with an entry for every source, also for those that are compiled several as one."""
    entries = json.loads((BUILD / "release" / "compile_commands.json").read_text())
    for entry in [entry for entry in entries if "/Unity/" in entry["file"]]:
        for source in re.findall(r'#include "(.*)"', Path(entry["file"]).read_text()):
            entries.append(entry | {"file": source, "command": entry["command"].replace(entry["file"], source)})
    folder = BUILD / "release" / "lint"
    folder.mkdir(exist_ok=True)
    (folder / "compile_commands.json").write_text(json.dumps(entries))
    return folder


def check_lint(tally, files, at_most=None):
    start = time.time()
    files = [name for name in files if not re.search("/(fuzz|test|cuda)/", name)][:at_most]
    if not files:
        tally.add("lint", 1, 0, 0, time.time() - start)
        return
    result = run(["xargs", "-P2", "-n4", f"clang-tidy{CLANG}", "-p", str(commands_of_each_file()), "--quiet",
                  # The compile commands are GCC's: what only Clang warns of, or does not know, is not looked for.
                  *("--extra-arg=-Wno-" + name for name in ("unknown-warning-option", "unused-command-line-argument",
                                                            "deprecated-declarations", "bitwise-instead-of-logical"))],
                 text_in="\n".join(files))
    errors = [line for line in result.stdout.splitlines() if re.search(r"(error|warning): .*\[", line)]
    ok = result.returncode == 0
    tally.add(f"lint ({len(files)} files)", int(ok), int(not ok), 0, time.time() - start,
              "" if ok else "\n".join("    " + line for line in errors[:30]) or tail(result.stdout))


def fuzz(tally, seconds, targets):
    if not build(tally, "asan", targets):
        return
    for program in [BUILD / "asan" / "bin" / name for name in targets]:
        start = time.time()
        corpus = BUILD / "asan" / "corpus" / program.name
        corpus.mkdir(parents=True, exist_ok=True)
        seeds = ROOT / "tests" / "fuzz" / program.name
        folders = [str(corpus)] + ([str(seeds)] if seeds.is_dir() else [])
        result = run([str(program), f"-max_total_time={seconds}", "-timeout=5", "-rss_limit_mb=1024", "-print_final_stats=1",
                      f"-artifact_prefix={corpus}/", *folders])
        executions = re.search(r"stat::number_of_executed_units:\s*(\d+)", result.stdout)
        ok = result.returncode == 0
        tally.add(f"fuzz {program.name} ({executions.group(1) if executions else 0} runs)", int(ok), int(not ok), 0,
                  time.time() - start, "" if ok else tail(result.stdout))


def main():
    parser = argparse.ArgumentParser(prog="./gloam test", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tier", nargs="?", choices=["fast", "full"], help="default: the checks of CI")
    parser.add_argument("--only", metavar="NAME", help="run only tests whose name contains NAME (unit and end-to-end tests, release build)")
    args = parser.parse_args()
    BUILD.mkdir(exist_ok=True)
    if args.tier != "fast" and not args.only:  # what CI runs; a user's build has warnings that are no errors
        os.environ.setdefault("GLOAM_WERROR", "ON")
    started, tally = time.time(), Tally()
    if build(tally, "release"):
        if args.only:
            for module in UNIT:
                gtest(tally, "release", module, f"*{args.only}*")
            e2e_tests(tally, args.only)
        else:
            tiers = {"fast": fast, None: ci, "full": full}
            tiers[args.tier](tally)
    total = time.time() - started
    if tally.broken:
        print("failed:\n" + "\n".join(f"  {name}" for name in tally.broken))
    slowest = sorted(tally.seconds.items(), key=lambda part: -part[1])[:SLOWEST]
    print("slowest (often two at a time): " + ", ".join(f"{Path(name).stem if '.py' in name else name} {t:.0f} s" for name, t in slowest))
    print(f"total {total / 60:.1f} min")
    print(f"{tally.passed} passed, {tally.failed} failed" + (f", {tally.skipped} skipped" if tally.skipped else ""))
    return 1 if tally.failed or not tally.passed else 0


def units(tally, preset, shard_filter, modules=UNIT):
    """Modules' unit tests but the slow ones: two programs at a time, longest first (the page's tests mostly wait), world in two halves."""
    longest = ["studio", "render", "control", "world"]
    by_length = sorted(modules, key=lambda module: (longest + [module]).index(module))
    parts = [(module, shard) for module in by_length for shard in ([(0, 2), (1, 2)] if module == "world" else [None])]
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda part: gtest(tally, preset, part[0], shard_filter=shard_filter, shard=part[1]), parts))


def slow_units(tally, chosen):
    """Tests that take seconds each: two programs at a time, the places of all generators in two halves."""
    modules = ["scene", "sim", "runtime", "geometry", "render", "sensors", "control", "record", "studio"]
    parts = [("world", (0, 2)), ("world", (1, 2))] + [(module, None) for module in modules]
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda part: gtest(tally, "release", part[0], shard_filter=chosen, shard=part[1]), parts))


def rules(tally):
    """Rules that the source and the documents keep."""
    for file in ("tests/folder_rule.py", "tests/comments_rule.py", "tests/language_rule.py", "tests/extending.py", "tests/labels_test.py"):
        python_tests(tally, file)


def fast(tally):
    rules(tally)
    units(tally, "release", labels.without(labels.SLOW, labels.FULL))
    python_tests(tally, "tests/e2e/cli_test.py")


def ci(tally):
    run([sys.executable, "tests/fetch_data.py"])
    check_format(tally)
    rules(tally)
    units(tally, "release", labels.without(labels.SLOW, labels.FULL))
    slow_units(tally, labels.only(labels.SLOW, but=labels.FULL))
    e2e_tests(tally)
    check_lint_of_changes(tally)
    run(["cmake", "--preset", "release"])  # it may have been set up before nvcc was there
    if build(tally, "release", ["gloam_cuda_test", "gloam_gas_cuda_test"]):  # without a card this shows that the card's source compiles
        gtest(tally, "release", "cuda")
        gtest(tally, "release", "gas_cuda")
    fuzz(tally, 15, ["scene_toml_fuzz", "robot_entry_fuzz", "model_path_fuzz", "model_xml_fuzz"])


def pack(tally):
    """The bundle is made, is small enough, and denoises (tools/pack.py looks)."""
    start = time.time()
    result = run(["./gloam", "pack"])
    ok = result.returncode == 0
    tally.add("pack", int(ok), int(not ok), 0, time.time() - start, "" if ok else tail(result.stdout))


def full(tally):
    """Everything; parts that passed on this very source are not run again. The record of what passed goes to bench/history."""
    version = source_version()
    state_file = BUILD / "full_state.json"
    state = json.loads(state_file.read_text()) if state_file.exists() else {}
    if state.get("source") != version:
        state = {"source": version, "passed": {}}
    parts = {
        "ci": ci,
        "lint of all": lambda t: check_lint(t, tracked("src/*.cc", "apps/*.cc")),
        "slow and rare": lambda t: slow_units(t, labels.only(labels.FULL)),
        "sweeps": lambda t: gtest(t, "release", "control", labels.only(labels.SWEEPS)),
        "sweeps of places": lambda t: gtest(t, "release", "world", labels.only(labels.SWEEPS)),
        "sweeps of meshes": lambda t: gtest(t, "release", "geometry", labels.only(labels.SWEEPS)),
        "sweeps of logs": lambda t: gtest(t, "release", "mcap", labels.only(labels.SWEEPS)),
        "sweeps of running scenes": lambda t: gtest(t, "release", "runtime", labels.only(labels.SWEEPS)),
        "pack": pack,
        "first look at models": lambda t: python_tests(t, "tests/e2e/gallery_models.py"),
        "slow commands of documents": lambda t: python_tests(t, "tests/e2e/docs_test.py", "weather", GLOAM_TEST_FULL="1"),
        "slow tests of Python": slow_api_tests,
        "memory over 200 changes by ZeroMQ": lambda t: python_tests(t, "tests/e2e/zmq_test.py", "keep_no_world", GLOAM_TEST_FULL="1"),
        "memory over 200 changes by ROS 2": lambda t: python_tests(t, "tests/e2e/ros2_services_test.py", "keep_no_world", GLOAM_TEST_FULL="1"),
        "memory of Python under asan": sanitized_api_tests,
        "limits of memory": lambda t: python_tests(t, "tests/e2e/memory_limit_test.py", GLOAM_TEST_FULL="1"),
        "Debian 13": lambda t: python_tests(t, "tests/e2e/debian13.py", GLOAM_AS_BUILT=""),
        "recipes": lambda t: python_tests(t, "tests/e2e/recipes.py", GLOAM_AS_BUILT=""),
        "agreement with Mitsuba": lambda t: python_tests(t, "tests/e2e/mitsuba_scenes.py"),
        "Mitsuba's mutations": lambda t: python_tests(t, "tests/e2e/mitsuba_mutations.py"),
    }
    for module in modules_with("Mutations"):
        parts[f"{MUTATIONS} mutations {module}"] = lambda t, m=module: mutations(t, m)
    for preset in ("asan", "tsan"):
        for module in [m for m in UNIT if (ROOT / "src" / m / "test").is_dir()]:
            parts[f"{preset} {module}"] = lambda t, p=preset, m=module: build(t, p, [f"gloam_{m}_test"]) and gtest(t, p, m)
    for target in sorted(path.stem for path in (ROOT / "src").glob("*/fuzz/*_fuzz.cc")):
        parts[f"fuzz {target}"] = lambda t, name=target: fuzz(t, 300, [name])
    for name, part in parts.items():
        if name not in state["passed"]:
            own, start = Tally(), time.time()
            part(own)
            tally.failed, tally.broken = tally.failed + own.failed, tally.broken + own.broken
            if own.failed:
                continue
            state["passed"][name] = {"tests": own.passed, "skipped": own.skipped, "seconds": round(time.time() - start)}
            state_file.write_text(json.dumps(state, indent=1))
        else:
            print(f"skipped {name}: already passed on this source")
        tally.passed += state["passed"][name]["tests"]
        tally.skipped += state["passed"][name]["skipped"]
    state["not_passed"] = [name for name in parts if name not in state["passed"]]
    history = ROOT / "bench" / "history"
    history.mkdir(parents=True, exist_ok=True)
    (history / f"full_tests_{time.strftime('%F')}_{version}.json").write_text(json.dumps(state, indent=1))


def modules_with(word):
    """Those that have a suite whose name holds it: "Mutations" is a reader's."""
    return [m for m in UNIT if any(word in path.read_text() for path in (ROOT / "src" / m / "test").glob("*_test.cc"))]


def source_version():
    """Of all that a test can see."""
    files = [name for name in tracked("*") if not name.startswith(("bench/history/", "CHANGELOG"))]
    listing = run(["git", "hash-object", "--stdin-paths"], text_in="\n".join(files)).stdout
    return hashlib.sha256(("\n".join(files) + listing).encode()).hexdigest()[:12]


if __name__ == "__main__":
    sys.exit(main())
