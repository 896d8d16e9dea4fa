"""The script ./gloam: what it waits for, and what it does not."""
import contextlib
import fcntl
import os
import subprocess
import time
import unittest

from e2e.support import ROOT


COMMAND = ("cache", "--json")  # a quick one; --help and --version build nothing
OWN = {**os.environ, "GLOAM_PRESET": "release", "GLOAM_AS_BUILT": ""}


def start(*arguments):
    return subprocess.run([str(ROOT / "gloam"), *arguments], cwd=ROOT, text=True, capture_output=True, stdin=subprocess.DEVNULL,
                          timeout=600, env=OWN)


class Locks(unittest.TestCase):
    def test_a_built_program_waits_for_no_set_up(self):
        """Somebody installs packages or builds, in this preset or another: what is built runs at once."""
        self.assertEqual(start(*COMMAND).returncode, 0)  # builds if anything is newer than the program
        held = [open(ROOT / "build" / f".lock-{name}", "w") for name in ("packages", "release", "cuda")]
        try:
            for lock in held:
                fcntl.flock(lock, fcntl.LOCK_EX)
            result = start(*COMMAND)
        finally:
            for lock in held:
                lock.close()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('"kinds"', result.stdout)
        self.assertNotIn("waiting", result.stderr)

    @contextlib.contextmanager
    def newer_source_while_another_builds(self):
        """A source that the program was not built of, and the build folder's lock in somebody's hands."""
        new = ROOT / "src" / "base" / ".newer"
        new.touch()
        self.addCleanup(new.unlink)
        with open(ROOT / "build" / ".lock-release", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            yield

    def test_a_source_newer_than_the_program_is_built_under_the_lock(self):
        self.assertEqual(start(*COMMAND).returncode, 0)
        with self.newer_source_while_another_builds():
            waiting = subprocess.Popen([str(ROOT / "gloam"), *COMMAND], cwd=ROOT, text=True, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, env=OWN)
            self.addCleanup(waiting.kill)
            printed = waiting.stderr.readline() + waiting.stderr.readline()  # the distribution comes first
            self.assertIn("waiting for another set-up (release)", printed)
        out, _ = waiting.communicate(timeout=300)
        self.assertEqual(waiting.returncode, 0)
        self.assertIn('"kinds"', out)

    def test_tests_run_what_was_built(self):
        self.assertEqual(start(*COMMAND).returncode, 0)
        with self.newer_source_while_another_builds():
            result = subprocess.run([str(ROOT / "gloam"), *COMMAND], cwd=ROOT, text=True, capture_output=True, timeout=60,
                                    env={**OWN, "GLOAM_AS_BUILT": "1"})
        self.assertIn('"kinds"', result.stdout)
        self.assertNotIn("waiting", result.stderr)


class Python(unittest.TestCase):
    def test_a_second_start_takes_no_second(self):
        code = "import gloam, sys; print(gloam.__version__, sys.argv[1:])"
        self.assertEqual(start("python", "-c", code).returncode, 0)  # builds if anything is newer than the module
        times = []
        for _ in range(3):
            begin = time.monotonic()
            result = start("python", "-c", code, "a b", "c")
            times.append(time.monotonic() - begin)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stdout, r"^\d+\.\d+\.\d+ \['a b', 'c'\]\n$")
        self.assertLess(min(times), 1.0)

    def test_the_folder_that_it_is_called_in_stays(self):
        result = subprocess.run([str(ROOT / "gloam"), "python", "-c", "import os; print(os.getcwd())"], cwd="/", text=True, capture_output=True,
                                stdin=subprocess.DEVNULL, timeout=60)
        self.assertEqual(result.stdout, "/\n")
        failed = start("python", "-c", "raise SystemExit(7)")
        self.assertEqual(failed.returncode, 7)
