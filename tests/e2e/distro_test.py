"""The script ./gloam on other distributions: which packages it installs, and what it prints. tests/e2e/debian13.py builds on one."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from e2e.support import ROOT

RELEASES = {
    "debian-12": 'PRETTY_NAME="Debian GNU/Linux 12 (bookworm)"\nVERSION_ID="12"\nID=debian\n',
    "debian-13": 'PRETTY_NAME="Debian GNU/Linux 13 (trixie)"\nVERSION_ID="13"\nID=debian\n',
    "ubuntu-24.04": 'PRETTY_NAME="Ubuntu 24.04.1 LTS"\nVERSION_ID="24.04"\nID=ubuntu\nID_LIKE=debian\n',
    "debian testing": 'PRETTY_NAME="Debian GNU/Linux forky/sid"\nID=debian\n',
    "fedora": 'PRETTY_NAME="Fedora Linux 43"\nVERSION_ID=43\nID=fedora\n',
    "none": "",
}


def tool(folder, name, text):
    file = folder / name
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)


def as_on(release, *command):
    """Runs the command with another /etc/os-release, in a mount namespace of its own."""
    script = 'mount --bind "$0" /etc/os-release && exec "$@"'
    return subprocess.run(["unshare", "--mount", "sh", "-c", script, str(release), *map(str, command)], text=True, capture_output=True,
                          stdin=subprocess.DEVNULL, timeout=60)


class Distributions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="gloam_distro_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        can = subprocess.run(["unshare", "--mount", "true"], capture_output=True)
        if os.geteuid() != 0 or can.returncode != 0:
            raise unittest.SkipTest("needs root: another /etc/os-release is mounted")

    def set_up(self, name, has_dpkg=True):
        """`./gloam setup` of a tree with nothing but the script, on a machine without packages. What it prints, and what it installs."""
        place = Path(tempfile.mkdtemp(dir=self.folder))
        (place / "gloam").write_bytes((ROOT / "gloam").read_bytes())
        (place / "gloam").chmod(0o755)
        release, tools, installed = place / "os-release", place / "tools", place / "installed"
        release.write_text(RELEASES[name])
        tools.mkdir()
        (tools / "help.sh").write_bytes((ROOT / "tools" / "help.sh").read_bytes())
        for program in ("bash", "id", "env", "readlink", "dirname", "mkdir", "flock", "sha256sum", "cut", "grep", "cat", "rm", "tail", "find", "sh"):
            (tools / program).symlink_to(subprocess.check_output(["sh", "-c", f"command -v {program}"], text=True).strip())
        if has_dpkg:
            tool(tools, "dpkg-query", "exit 1")
        tool(tools, "apt-get", f'[ "$1" = install ] && echo "$@" >>"{installed}"; exit 0')
        result = as_on(release, "env", "-i", f"PATH={tools}", f"HOME={place}", "bash", place / "gloam", "setup")
        self.assertNotEqual(result.returncode, 0, "there is nothing to build here")
        return result.stderr, installed.read_text().split() if installed.exists() else []

    def test_each_release_gets_its_fast_dds(self):
        for name, package in [("debian-12", "libfastrtps-dev"), ("debian-13", "libfastdds-dev"), ("ubuntu-24.04", "libfastrtps-dev"),
                              ("debian testing", "libfastdds-dev")]:
            _, installed = self.set_up(name)
            self.assertIn(package, installed, name)
            self.assertIn("libembree-dev", installed, name)
            self.assertEqual(len([one for one in installed if one.startswith(("libfastrtps", "libfastdds"))]), 1, name)

    def test_set_up_prints_the_release_and_the_action(self):
        for name, system, action in [
            ("debian-12", "Debian GNU/Linux 12 (bookworm)", "tested here"),
            ("debian-13", "Debian GNU/Linux 13 (trixie)", "supported, tested in a chroot"),
            ("ubuntu-24.04", "Ubuntu 24.04.1 LTS", "not tested here"),
            ("debian testing", "Debian GNU/Linux forky/sid", "trying the package names of Debian 13"),
            ("none", "unknown", "trying the package names of Debian 13"),
        ]:
            printed, _ = self.set_up(name)
            self.assertIn(f"gloam: {system}: ", printed, name)
            self.assertIn(action, printed, name)
            self.assertRegex(printed, r"installing \d+ Debian packages", name)

    def test_without_dpkg_the_packages_are_listed(self):
        printed, installed = self.set_up("fedora", has_dpkg=False)
        self.assertEqual(installed, [])
        self.assertIn("Fedora Linux 43 has no Debian packages; install", printed)
        self.assertIn("libembree-dev", printed)

    def test_doctor_names_the_release(self):
        for name, mark in [("debian-13", "ok  "), ("ubuntu-24.04", "note")]:
            release = self.folder / "os-release"
            release.write_text(RELEASES[name])
            result = as_on(release, ROOT / "gloam", "doctor")
            line = next(line for line in result.stdout.splitlines() if "operating system" in line)
            self.assertTrue(line.startswith(mark), line)


class Warnings(unittest.TestCase):
    def options(self, *arguments):
        """Compile options of a build that is configured with these arguments."""
        with tempfile.TemporaryDirectory(prefix="gloam_warnings_") as folder:
            (Path(folder) / "CMakeLists.txt").write_text(
                "cmake_minimum_required(VERSION 3.25)\nproject(warnings LANGUAGES CXX)\n"
                f"include({ROOT}/cmake/GloamCompiler.cmake)\n"
                "get_directory_property(options COMPILE_OPTIONS)\nmessage(STATUS \"options: ${options};\")\n")
            result = subprocess.run(["cmake", "-G", "Ninja", "-S", folder, "-B", f"{folder}/build", "-DGLOAM_MARCH=x86-64-v3", *arguments],
                                    capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        return next(line for line in result.stdout.splitlines() if "options: " in line)

    def test_warnings_are_errors_in_ci_only(self):
        self.assertNotIn("-Werror", self.options())
        self.assertIn("-Werror;", self.options("-DGLOAM_WERROR=ON"))
        self.assertIn("GLOAM_WERROR=ON", (ROOT / ".ci" / "run").read_text())


if __name__ == "__main__":
    unittest.main()
