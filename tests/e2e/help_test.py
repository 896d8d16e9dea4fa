"""./gloam help, --help, --version and doctor in a copy of the repository in which nothing is built: they write nothing."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from e2e.support import ROOT

COPIED = ["gloam", "tools", "tests", "bench", "apps", "CMakeLists.txt", "requirements.txt", "requirements-python.txt", "requirements-cuda.txt"]


def files_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


class HelpWithoutABuild(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.home = cls.folder / "home"
        cls.copy = cls.folder / "copy"
        cls.home.mkdir()
        cls.copy.mkdir()
        skipped = shutil.ignore_patterns("__pycache__", "node_modules", "history", "*.png")
        for name in COPIED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, cls.copy / name, ignore=skipped)
            else:
                shutil.copy2(source, cls.copy / name)

    def ask(self, *arguments, **variables):
        before = files_below(self.folder)
        env = {"PATH": os.environ["PATH"], "HOME": str(self.home), **variables}
        result = subprocess.run([str(self.copy / "gloam"), *arguments], cwd=self.copy, text=True, capture_output=True, timeout=60,
                                stdin=subprocess.DEVNULL, env=env)
        self.assertEqual(files_below(self.folder), before, f"{arguments} makes files")
        self.assertNotIn("installing", result.stderr)
        self.assertNotIn("building", result.stderr)
        return result

    def test_the_program_s_commands_are_listed(self):
        for words in (["--help"], ["-h"]):
            result = self.ask(*words)
            self.assertEqual(result.returncode, 0, result.stderr)
            for name in ("run", "render", "replay", "setup", "doctor"):
                self.assertRegex(result.stdout, rf"(?m)^ +(\./gloam )?{name}\b")

    def test_the_version_is_that_of_the_sources(self):
        self.assertRegex(self.ask("--version").stdout, r"^gloam \d+\.\d+\.\d+ \(not built yet\)\n$")

    def test_a_command_tells_its_options(self):
        result = self.ask("run", "--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("--duration", result.stdout)
        self.assertIn("Duration in seconds of simulation time", result.stdout)
        self.assertIn("./gloam setup", result.stdout)
        self.assertEqual(self.ask("run", "scene.toml", "-h").returncode, 0)

    def test_commands_of_the_script(self):
        for command in ("setup", "test", "bench", "pack", "wheel", "mitsuba", "gallery", "docs", "doctor"):
            result = self.ask(command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertRegex(result.stdout.lower(), rf"usage: \./gloam {command}", command)
            self.assertEqual(self.ask("help", command).stdout, result.stdout)

    def test_help_is_a_command_too(self):
        self.assertEqual(self.ask("help").stdout, self.ask("--help").stdout)
        self.assertEqual(self.ask("help", "run").stdout, self.ask("run", "--help").stdout)

    def test_no_command_is_a_usage_error(self):
        result = self.ask()
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, self.ask("--help").stdout)

    def test_doctor_reports_a_machine_without_a_build(self):
        result = self.ask("doctor", "--json")
        self.assertEqual(result.returncode, 1)
        found = {item["name"]: item for item in json.loads(result.stdout)}
        self.assertEqual(found["Gloam"]["found"], re.search(r"gloam VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1])
        self.assertRegex(found["compiler"]["found"], r"^g\+\+ \d+")
        for name in ("MuJoCo 4.0.1", "build"):
            self.assertFalse(found[name]["ok"])
            self.assertIn("./gloam setup", found[name]["fix"])
        for item in found.values():
            self.assertEqual(item["ok"], not item["fix"], item)

    def test_doctor_names_missing_packages_and_their_command(self):
        query = self.home / "dpkg-query"
        query.write_text("#!/bin/sh\necho 'cmake installed'\n")
        query.chmod(0o755)
        result = self.ask("doctor", PATH=f"{self.home}:{os.environ['PATH']}")
        self.assertRegex(result.stdout, r"MISS Debian packages .*ninja-build")
        self.assertRegex(result.stdout, r"-> .*apt-get install .*ninja-build")
        self.assertNotRegex(result.stdout, r"apt-get install .*\bcmake\b")

    def test_answers_take_no_second(self):
        for words in (["--help"], ["--version"], ["help", "test"], ["doctor"]):
            times = []
            for _ in range(3):
                begin = time.monotonic()
                self.ask(*words)
                times.append(time.monotonic() - begin)
            self.assertLess(min(times), 1.0, words)

    def test_what_comes_after_two_dashes_is_no_question(self):
        result = subprocess.run(["bash", "-c", f'source {self.copy}/tools/help.sh; asks_for_help check -- --help'], timeout=10)
        self.assertEqual(result.returncode, 1)


if __name__ == "__main__":
    unittest.main()
