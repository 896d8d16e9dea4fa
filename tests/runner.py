"""Builds Gloam and runs its tests: C++ by CTest, Python by pytest. Both write JUnit's XML, from which the summary is made."""
import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "python")]
import env  # noqa: E402
import fetch_data  # noqa: E402

JOBS = 2
SLOWEST = 20  # parts that the summary names
CPP_REASON = 4  # lines of a failure in the summary


def environment(**variables):
    """Of tests. GLOAM_AS_BUILT: ./gloam in a test builds nothing, because other tests run the program that it would link."""
    defaults = {
        "GLOAM_TEST_DATA": str(fetch_data.default_folder()),
        "ASAN_OPTIONS": "detect_leaks=1:abort_on_error=0:allocator_may_return_null=1",
        "LSAN_OPTIONS": f"suppressions={ROOT}/tests/lsan.supp:print_suppressions=0",
        "TSAN_OPTIONS": f"suppressions={ROOT}/tests/tsan.supp:ignore_noninstrumented_modules=1:halt_on_error=1",
    }
    return defaults | os.environ | {"GLOAM_AS_BUILT": "1"} | variables


@dataclass
class Results:
    """Counts, failures with their place and reason, and the seconds of each part."""

    passed: int = 0
    skipped: int = 0
    failures: list[str] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)

    def add(self, other):
        self.passed += other.passed
        self.skipped += other.skipped
        self.failures += other.failures
        for part, seconds in other.seconds.items():
            self.seconds[part] = self.seconds.get(part, 0) + seconds

    def add_command(self, name, ok, seconds, reason=""):
        """A command that is one test."""
        self.passed += ok
        self.failures += [] if ok else [f"{name}: {reason}"]
        self.seconds[name] = self.seconds.get(name, 0) + seconds

    def summary(self):
        slowest = sorted(self.seconds.items(), key=lambda part: -part[1])[:SLOWEST]
        lines = ["failed:", *(f"  {failure}" for failure in self.failures)] if self.failures else []
        lines += ["slowest (often two at a time): " + ", ".join(f"{name} {seconds:.0f} s" for name, seconds in slowest)]
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        return "\n".join(lines), f"{self.passed} passed, {len(self.failures)} failed{skipped}"


def place(case, failure):
    """FILE:LINE of a failure, or the test's file."""
    lines = (failure.text or "") + "\n" + failure.get("message", "")
    found = [name.removeprefix(f"{ROOT}/") for name in re.findall(r"^(\S+\.(?:cc|h|py):\d+)(?::| *$)", lines, re.M)]
    own = [name for name in found if not name.startswith("/")]  # not of the standard library
    return (own or found or [case.get("file", "")])[-1]


def read_report(file, name=""):
    """Results of a report. name: of its part; "" if each case has the file that is its part (pytest)."""
    results = Results()
    for case in ElementTree.parse(file).iter("testcase"):
        if case.get("result") == "suppressed" or case.get("status") == "notrun":  # disabled, or left out by a filter
            continue
        part = name or Path(case.get("file") or case.get("classname", "").replace(".", "/")).stem
        results.seconds[part] = results.seconds.get(part, 0) + float(case.get("time", 0))
        failure = next((found for kind in ("failure", "error") if (found := case.find(kind)) is not None), None)
        if failure is not None:
            reason = "\n    ".join(failure.get("message", "").strip().splitlines()[:CPP_REASON])
            results.failures.append(f"{part}: {case.get('classname')}.{case.get('name')}: {place(case, failure)}: {reason}")
        elif case.find("skipped") is not None or case.get("result") == "skipped":
            results.skipped += 1
        else:
            results.passed += 1
    return results


def call(command, **options):
    """Runs a command with its output on ours. (exit code, seconds)"""
    sys.stdout.flush()
    start = time.monotonic()
    process = subprocess.Popen([str(part) for part in command], cwd=ROOT, stdin=subprocess.DEVNULL, **options)
    try:
        process.wait()
    except KeyboardInterrupt:  # the terminal has interrupted the command, too: it ends its own processes
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(30)
        process.kill()
        raise
    return process.returncode, time.monotonic() - start


def run_command(results, name, *command, **variables):
    """A command as one test, whose output is printed. True if it succeeds."""
    code, seconds = call(command, env=environment(**variables), stderr=subprocess.STDOUT)
    results.add_command(name, code == 0, seconds, f"exit code {code}")
    print(f"{'ok  ' if code == 0 else 'FAIL'} {name:<44} {'':<34} {seconds:6.1f} s", flush=True)
    return code == 0


def build(results, preset="release", *targets):
    """Builds as ./gloam does, under its lock, into the folder of the preset."""
    return run_command(results, f"build {' '.join([preset, *targets])}", ROOT / "gloam", "setup", *(targets or ["all"]),
                       GLOAM_PRESET=preset, GLOAM_AS_BUILT="")


def unit_tests(results, label, preset="release", only=None, jobs=JOBS, **variables):
    """The tests of CTest with a label; `only`: names. Returns the results of each."""
    folder = BUILD / preset
    if only is not None and not only:
        return {}
    shutil.rmtree(folder / "reports", ignore_errors=True)
    own = folder / "ctest.xml"
    own.unlink(missing_ok=True)
    names = ["-R", f"^({'|'.join(map(re.escape, only))})$"] if only else []
    code, seconds = call(["ctest", "--test-dir", folder, "-j", jobs, "-L", f"^{label}$", *names, "--output-on-failure", "--output-junit", own,
                          "--test-output-size-failed", "1000000", "--test-output-truncation", "head"], env=environment(**variables))
    each = {}
    for case in ElementTree.parse(own).iter("testcase") if own.exists() else []:
        name, report = case.get("name"), folder / "reports" / f"{case.get('name')}.xml"
        part = name if preset == "release" else f"{name} ({preset})"
        found = Results()
        if report.exists():
            with contextlib.suppress(ElementTree.ParseError):  # it crashed while it wrote
                found = read_report(report, part)
        elif case.get("status") == "run":
            found.passed = 1  # a fuzzer
        if case.get("status") != "run" and not found.failures:  # a crash, a time limit, or a sanitizer after the last test
            text = (case.findtext("system-out") or "").strip()
            output = [*re.findall(r"^\[ RUN +\] .*", text, re.M)[-1:], *text.splitlines()[-CPP_REASON:]]
            reason = (case.find("failure") if case.find("failure") is not None else case).get("message", case.get("status"))
            found.failures.append(f"{part}: {reason}: " + "\n    ".join(output))
        found.seconds = {part: float(case.get("time", 0))}
        each[name] = found
        results.add(found)
    if not each:
        results.add_command(f"ctest {label} ({preset})", False, seconds, f"no test ran; exit code {code}")
    return each


def unit_test_names(label, preset="release"):
    listed = subprocess.run(["ctest", "--test-dir", str(BUILD / preset), "-L", f"^{label}$", "--show-only=json-v1"], capture_output=True, text=True)
    return [test["name"] for test in json.loads(listed.stdout)["tests"]]


def python_for_rules():
    """An interpreter with pytest, made once."""
    return env.python_env(ROOT / "tests" / "requirements.txt", base=sys.executable)


def python_for_gloam(results):
    """An interpreter with the packages of tests/python/requirements.txt; builds the module. None if that fails."""
    start = time.monotonic()
    done = subprocess.run([str(ROOT / "gloam"), "python", "tests/python/env.py"], cwd=ROOT, text=True, stdout=subprocess.PIPE,
                          env={**environment(), "GLOAM_AS_BUILT": ""})
    python = done.stdout.strip().splitlines()[-1] if done.returncode == 0 and done.stdout.strip() else None
    results.add_command("build gloam_python", python is not None, time.monotonic() - start, f"exit code {done.returncode}")
    return python


def python_tests(results, python, files, *options, minutes=20, **variables):
    """Files of tests under pytest, two at a time. minutes: time limit of a test. Returns the results."""
    report = BUILD / "pytest.xml"
    report.unlink(missing_ok=True)
    code, seconds = call([python, "-m", "pytest", "-q", "-n", JOBS, "--no-loadscope-reorder", "--progress", f"--timeout={60 * minutes}",
                          "-o", "junit_family=xunit1", f"--junitxml={report}", *options, *files], env=environment(**variables))
    found = read_report(report) if report.exists() else Results()
    if code not in (0, 1, 5) or (code == 1 and not found.failures):  # 5: no test has the name asked for
        found.add_command(f"pytest {' '.join(map(str, files))}"[:80], False, seconds, f"exit code {code}")
    results.add(found)
    return found
