"""`./gloam test full`: all parts of the tests. A part that passed on this very source is not run again."""
import hashlib
import json
import subprocess
import time

import runner
from runner import BUILD, ROOT, Results

STATE = BUILD / "full_state.json"
FULL = {"GLOAM_TEST_FULL": "1"}
BUILDS = {"GLOAM_AS_BUILT": ""}  # tests that build
# Files of tests for which `./gloam test` has no time: name, file, expression of pytest -k, variables.
FILES = [
    ("lint of all", "source_checks.py", "tidy", FULL),
    ("first look at models", "e2e/gallery_models.py", "", {}),
    ("slow commands of documents", "e2e/docs_test.py", "weather", FULL),
    ("memory over 200 changes by ZeroMQ", "e2e/zmq_test.py", "keep_no_world", FULL),
    ("memory over 200 changes by ROS 2", "e2e/ros2_services_test.py", "keep_no_world", FULL),
    ("limits of memory", "e2e/memory_limit_test.py", "", FULL),
    ("Debian 13", "e2e/debian13.py", "", BUILDS),
    ("recipes", "e2e/recipes.py", "", BUILDS),
    ("agreement with Mitsuba", "e2e/mitsuba_scenes.py", "", {}),
    ("Mitsuba's mutations", "e2e/mitsuba_mutations.py", "", {}),
]


def source_version():
    """A hash of all files that a test can read."""
    listed = subprocess.check_output(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, text=True).splitlines()
    files = [name for name in listed if (ROOT / name).exists() and not name.startswith(("bench/history/", "CHANGELOG"))]
    hashes = subprocess.check_output(["git", "hash-object", "--stdin-paths"], cwd=ROOT, text=True, input="\n".join(files))
    return hashlib.sha256(("\n".join(files) + hashes).encode()).hexdigest()[:12]


class State:
    """The parts that passed, in a file that outlives the run."""

    def __init__(self, results):
        self.results, self.names, self.version = results, [], source_version()
        saved = json.loads(STATE.read_text()) if STATE.exists() else {}
        self.passed = saved["passed"] if saved.get("source") == self.version else {}

    def skip(self, name):
        """True if the part has passed before."""
        self.names.append(name)
        if name not in self.passed:
            return False
        print(f"skipped {name}: already passed on this source")
        self.results.passed += self.passed[name]["tests"]
        self.results.skipped += self.passed[name]["skipped"]
        return True

    def record(self, name, found, seconds):
        if not found.failures:
            self.passed[name] = {"tests": found.passed, "skipped": found.skipped, "seconds": round(seconds)}
        self.save(STATE)

    def save(self, file):
        missing = [name for name in self.names if name not in self.passed]
        file.write_text(json.dumps({"source": self.version, "passed": self.passed, "not_passed": missing}, indent=1))

    def part(self, name, run):
        """Runs a part unless it has passed. run: function of Results."""
        if self.skip(name):
            return
        found, start = Results(), time.monotonic()
        run(found)
        self.results.add(found)
        self.record(name, found, time.monotonic() - start)

    def unit_tests(self, label, preset, jobs):
        """The tests of CTest with a label in a build folder, each of which is a part."""
        parts = {name: f"{preset} {name}" for name in runner.unit_test_names(label, preset)}
        left = [name for name, part in parts.items() if not self.skip(part)]
        for name, found in runner.unit_tests(self.results, label, preset, only=left, jobs=jobs).items():
            self.record(parts[name], found, sum(found.seconds.values()))


def slow_python(found):
    if python := runner.python_for_gloam(found):
        runner.python_tests(found, python, [ROOT / "tests" / "python"], "-m", "slow", minutes=60)


def sanitized_python(found):
    """The memory tests of `import gloam` against a module with the address sanitizer."""
    import asan
    python = runner.python_for_gloam(found)
    if python and runner.build(found, "asan", "gloam_python"):
        runner.python_tests(found, python, asan.FILES, minutes=60, **asan.variables())


def full(results, ci):
    state = State(results)
    state.part("ci", ci)
    for label in ("full", "sweeps"):
        state.unit_tests(label, "release", jobs=2)
    for name, file, words, variables in FILES:
        options = ["-k", words] if words else []
        state.part(name, lambda found, f=file, o=options, v=variables: runner.python_tests(
            found, runner.python_for_rules(), [ROOT / "tests" / f], *o, minutes=180, **v))
    state.part("slow tests of Python", slow_python)
    state.part("memory of Python under asan", sanitized_python)
    state.part("pack", lambda found: runner.run_command(found, "pack", ROOT / "gloam", "pack", GLOAM_AS_BUILT=""))
    for preset, targets, labels in (("asan", ("unit_tests", "fuzzers"), ("unit", "mutations", "fuzz")), ("tsan", ("unit_tests",), ("unit",))):
        if runner.build(results, preset, *targets):
            for label in labels:
                state.unit_tests(label, preset, jobs=2 if label == "fuzz" else 1)
    history = ROOT / "bench" / "history"
    history.mkdir(parents=True, exist_ok=True)
    state.save(history / f"full_tests_{time.strftime('%F')}_{state.version}.json")
