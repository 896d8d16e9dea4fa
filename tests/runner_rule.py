"""The test runner: the summary names each failure with its place and reason, and no failure gets lost."""
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import runner
from runner import Results

GOOGLE = """<testsuites name="AllTests"><testsuite name="Box">
<testcase name="IsClosed" file="/x/box_test.cc" line="8" status="run" result="completed" time="0.5" classname="Box"/>
<testcase name="NeedsACard" status="run" result="skipped" time="0" classname="Box"><skipped message="no card"/></testcase>
<testcase name="DISABLED_Sweep" status="notrun" result="suppressed" time="0" classname="Box"/>
<testcase name="IsOpen" file="/x/box_test.cc" line="20" status="run" result="completed" time="1.25" classname="Box">
<failure message="{root}/src/base/test/box_test.cc:23&#x0A;Value of: open&#x0A;  Actual: false&#x0A;Expected: true" type=""/></testcase>
</testsuite></testsuites>"""
PASSES = '<testsuites><testcase name="IsClosed" status="run" result="completed" time="0.5" classname="Box"/></testsuites>'
PYTEST = """<testsuites><testsuite name="pytest">
<testcase classname="tests.e2e.log_test.Log" name="test_ends" file="tests/e2e/log_test.py" line="4" time="2"><failure
message="AssertionError: 1 != 2">    def test_ends(self):
tests/e2e/support.py:40: in gloam
tests/e2e/log_test.py:12: in helper
/usr/lib/python3/subprocess.py:571: AssertionError</failure></testcase>
<testcase classname="tests.e2e.log_test.Log" name="test_set_up" file="tests/e2e/log_test.py" line="4" time="1"><error
message="failed on setup">tests/e2e/log_test.py:7: RuntimeError</error></testcase>
<testcase classname="tests.folder_rule" name="test_x" file="tests/folder_rule.py" line="4" time="1"/>
</testsuite></testsuites>"""
# Tests as ctest has them: one passes, one fails in Google Test, one crashes, one fails after its last test, one never ends.
CMAKE = """cmake_minimum_required(VERSION 3.25)
project(few NONE)
enable_testing()
foreach(name passes fails crashes leaks hangs)
  add_test(NAME ${name} COMMAND sh ${CMAKE_SOURCE_DIR}/${name}.sh)
  set_tests_properties(${name} PROPERTIES LABELS fast TIMEOUT 2)
endforeach()
"""


class Reports(unittest.TestCase):
    def read(self, text, name=""):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "report.xml"
            file.write_text(text.replace("{root}", str(runner.ROOT)))
            return runner.read_report(file, name)

    def test_of_google_test(self):
        found = self.read(GOOGLE, "base")
        self.assertEqual((found.passed, found.skipped, found.seconds), (1, 1, {"base": 1.75}))
        self.assertEqual(len(found.failures), 1)
        self.assertRegex(found.failures[0], r"^base: Box\.IsOpen: src/base/test/box_test\.cc:23: .*\n +Value of: open\n +Actual: false")

    def test_of_pytest(self):
        found = self.read(PYTEST)
        self.assertEqual((found.passed, found.seconds), (1, {"log_test": 3, "folder_rule": 1}))
        self.assertEqual(found.failures, ["log_test: tests.e2e.log_test.Log.test_ends: tests/e2e/log_test.py:12: AssertionError: 1 != 2",
                                          "log_test: tests.e2e.log_test.Log.test_set_up: tests/e2e/log_test.py:7: failed on setup"])

    def test_the_summary_ends_with_failures_and_slow_parts(self):
        results = self.read(PYTEST)
        details, counts = results.summary()
        self.assertEqual(details.splitlines()[0], "failed:")
        self.assertIn("slowest (often two at a time): log_test 3 s, folder_rule 1 s", details)
        self.assertEqual(counts, "1 passed, 2 failed")


class Ctest(unittest.TestCase):
    def test_crashes_and_time_limits_are_failures(self):
        scripts = {
            "passes": f"echo '{PASSES}' > reports/passes.xml",
            "fails": f"echo '{GOOGLE}' > reports/fails.xml; exit 1",
            "crashes": "echo '[ RUN      ] Box.Opens'; seq 9000; echo last words; kill -SEGV $$",
            "leaks": "echo '<testsuites/>' > reports/leaks.xml; echo LeakSanitizer: detected; exit 1",
            "hangs": "sleep 60",
        }
        with tempfile.TemporaryDirectory() as scratch, mock.patch.object(runner, "BUILD", Path(scratch)):
            folder = Path(scratch) / "release"
            folder.mkdir()
            (folder / "CMakeLists.txt").write_text(CMAKE)
            for name, script in scripts.items():
                (folder / f"{name}.sh").write_text(f"mkdir -p reports\n{script}\n")
            with mock.patch.object(runner, "call", quiet(runner.call)):
                runner.call(["cmake", "-S", folder, "-B", folder])
                results = Results()
                each = runner.unit_tests(results, "fast")
        self.assertEqual(sorted(each), sorted(scripts))
        self.assertEqual(each["passes"].failures, [])
        texts = "\n".join(results.failures)
        self.assertEqual(len(results.failures), 4, texts)
        for words in (r"fails: Box\.IsOpen: ", r"crashes: .*Box\.Opens\n( +\d+\n)+ +last words", r"leaks: .*LeakSanitizer: detected", r"hangs: "):
            self.assertRegex(texts, words)


def quiet(call):
    """`call` without its output."""
    return lambda command, **options: call(command, **{**options, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL})


if __name__ == "__main__":
    unittest.main()
