"""The program with less memory than it needs (ulimit -v): exit code 0 or 1 and an error that names memory, never an abort, never a hang.

GLOAM_TEST_FULL=1, as `./gloam test full` sets it: limits in steps of 4 MB.
"""
import os
import resource
import shutil
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from e2e.support import PROGRAM, ROOT

SECONDS = 120  # as a hang counts
SCENE = ROOT / "examples" / "demo.toml"
# Below about 120 MB the system's loader cannot map the program's libraries.
LIMITS = range(140, 1200, 4) if os.environ.get("GLOAM_TEST_FULL") else (180, 267, 400, 560, 720)  # [MB]
SMALL = ["--resolution", "32x24", "--spp", "1"]


class MemoryLimit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="gloam_memory_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.log = cls.folder / "log.mcap"
        cls.warm = cls.folder / "cache"
        result = cls.run_gloam(["record", SCENE, "-o", cls.log, "--duration", "0.1", "--topics", "/clock"], cls.folder, cls.warm)
        assert result.returncode == 0, result.stderr

    @staticmethod
    def run_gloam(arguments, cwd, cache, limit=resource.RLIM_INFINITY):
        bounded = lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))  # noqa: E731
        return subprocess.run([str(PROGRAM), "-q", *map(str, arguments)], cwd=cwd, text=True, capture_output=True, stdin=subprocess.DEVNULL,
                              timeout=SECONDS, preexec_fn=bounded, env={**os.environ, "GLOAM_CACHE": str(cache)})

    def one(self, arguments, megabytes, cold):
        """What is wrong with a run under a limit, "" if nothing."""
        folder = Path(tempfile.mkdtemp(dir=self.folder))
        try:
            result = self.run_gloam(arguments, folder, folder / "cache" if cold else self.warm, megabytes * 1_000_000)
        except subprocess.TimeoutExpired:
            return "hangs"
        finally:
            shutil.rmtree(folder)
        errors = [line for line in result.stderr.splitlines() if "error" in line]
        if result.returncode == 0 or (result.returncode == 1 and errors and "memory" in errors[-1]):
            return ""
        return f"ends with {result.returncode}: {result.stderr[-500:]}"

    def sweep(self, *arguments, cold=False):
        with ThreadPoolExecutor(2) as pool:
            found = list(pool.map(lambda limit: self.one(arguments, limit, cold), LIMITS))
        wrong = {f"{limit} MB": fault for limit, fault in zip(LIMITS, found, strict=True) if fault}
        self.assertEqual(wrong, {}, arguments[0])

    def test_info(self):
        self.sweep("info", SCENE)

    def test_info_of_a_scene_that_is_not_in_the_cache(self):
        self.sweep("info", SCENE, cold=True)

    def test_render(self):
        self.sweep("render", SCENE, *SMALL, "--out", "out")

    def test_render_of_a_scene_that_is_not_in_the_cache(self):
        self.sweep("render", SCENE, *SMALL, "--out", "out", cold=True)

    def test_run(self):
        self.sweep("run", SCENE, "--duration", "0.1", *SMALL, "--out", "out")

    def test_record(self):
        self.sweep("record", SCENE, "-o", "log.mcap", "--duration", "0.1")

    def test_replay(self):
        self.sweep("replay", self.log, "--resolution", "32x24", "--out", "out")

    def test_verification_of_a_log(self):
        self.sweep("replay", self.log, "--verify")


if __name__ == "__main__":
    unittest.main()
