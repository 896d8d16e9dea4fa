"""What `cmake --install` puts down works on its own: the program, and the library for a project that finds it."""
import json
import os
import re
import subprocess
import tempfile
import tomllib
import unittest
from pathlib import Path

from e2e.support import PENDULUM, ROOT

BUILD = ROOT / "build" / "release"


def run(command, cwd, expect=0, **env):
    result = subprocess.run([str(part) for part in command], cwd=cwd, text=True, capture_output=True, stdin=subprocess.DEVNULL, timeout=300,
                            env={**{k: v for k, v in os.environ.items() if not k.startswith(("GLOAM_", "LD_"))}, **env})
    assert result.returncode == expect, f"{command} ends with {result.returncode}\n{result.stdout}\n{result.stderr}"
    return result.stdout


def hidden(command):
    """The command in a world without the source tree, its build folder and the wheels, where that can be had (root)."""
    places = {str(ROOT), str((ROOT / ".venv").resolve())}
    script = " && ".join(f"mount -t tmpfs tmpfs '{place}'" for place in sorted(places)) + ' && exec "$@"'
    wrapped = ["unshare", "--mount", "sh", "-c", script, "sh"]
    can = subprocess.run([*wrapped, "true"], capture_output=True, cwd="/")
    return [*wrapped, *command] if can.returncode == 0 else command


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory(prefix="gloam_install_")
        cls.addClassCleanup(cls._folder.cleanup)
        cls.folder = Path(cls._folder.name)
        run(["cmake", "--install", BUILD, "--prefix", cls.folder / "first"], "/")
        cls.prefix = cls.folder / "moved"  # nothing may remember where it was put first
        (cls.folder / "first").rename(cls.prefix)
        cls.elsewhere = cls.folder / "elsewhere"
        cls.elsewhere.mkdir()
        cls.model = cls.elsewhere / "pendulum.xml"
        cls.model.write_text(PENDULUM)

    def test_nothing_points_back(self):
        for file in [self.prefix / "bin" / "gloam", self.prefix / "lib" / "libgloam.so"]:
            libraries = run(["ldd", file], "/")
            self.assertNotIn("not found", libraries)
            for line in libraries.splitlines():
                self.assertNotIn(str(ROOT), line)
                self.assertNotIn(str((ROOT / ".venv").resolve()), line)
            mujoco = re.search(r"libmujoco\S+ => (\S+)", libraries).group(1)
            self.assertEqual(Path(mujoco).resolve().parent, (self.prefix / "lib" / "gloam").resolve())

    def test_no_library_is_sought_in_the_current_folder(self):
        for file in [BUILD / "bin" / "gloam", BUILD / "bin" / "gloam_base_test", self.prefix / "bin" / "gloam", self.prefix / "lib" / "libgloam.so"]:
            for path in re.findall(r"(?:RUNPATH|RPATH).*\[(.*)\]", run(["readelf", "-d", file], "/")):
                for folder in path.split(":"):
                    self.assertTrue(folder.startswith(("/", "$ORIGIN")), f"{file} looks for libraries in '{folder}', whose owner may be a stranger")

    def test_the_program_runs_a_scene_from_elsewhere(self):
        gloam = self.prefix / "bin" / "gloam"
        cache = {"GLOAM_CACHE": str(self.folder / "cache")}
        here = json.loads(run([BUILD / "bin" / "gloam", "run", self.model, "--duration", "1", "--json"], self.elsewhere, **cache))
        there = json.loads(run(hidden([gloam, "run", self.model, "--duration", "1", "--json"]), self.elsewhere, **cache))
        self.assertEqual(here["state_hash"], there["state_hash"])
        for program, out in [(BUILD / "bin" / "gloam", "here"), (gloam, "there")]:
            still = [program, "render", self.model, "--resolution", "64x48", "--spp", "1", "--out", out]
            run(hidden(still) if out == "there" else still, self.elsewhere, **cache)
        pictures = [(self.elsewhere / out / "side.png").read_bytes() for out in ["here", "there"]]
        self.assertEqual(*pictures, "the same picture, so the same denoiser")
        demo = self.prefix / "share" / "gloam" / "examples" / "demo.toml"
        run(hidden([gloam, "run", demo, "--duration", "0.1", "--resolution", "64x48", "--spp", "1", "--out", "out"]), self.elsewhere, **cache)
        summary = json.loads((self.elsewhere / "out" / "summary.json").read_text())
        self.assertEqual(summary["exit_reason"], "completed")
        self.assertTrue((self.elsewhere / "out" / "contact_sheet.png").exists())

    def program_of(self, page):
        """The program that a page shows, built as library.md says."""
        project = self.folder / page
        project.mkdir()
        for language, source, name in [("cmake", "library.md", "CMakeLists.txt"), ("cpp", page, "main.cc")]:
            text = (ROOT / "docs" / source).read_text()
            (project / name).write_text(re.search(rf"^```{language}\n(.*?)^```", text, re.M | re.S).group(1))
        run(["cmake", "-S", project, "-B", project / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror"], "/")
        run(["cmake", "--build", project / "build"], "/")
        return project / "build" / "consumer"

    def test_the_page_of_models_makes_the_model_that_it_shows(self):
        program = self.program_of("models.md")
        run(hidden([program, "made.toml"]), self.elsewhere)
        page = (ROOT / "docs" / "models.md").read_text()
        shown = tomllib.loads(re.search(r"^```toml\n(.*?)^```", page, re.M | re.S).group(1))
        self.assertEqual(tomllib.loads((self.elsewhere / "made.toml").read_text()), shown)
        run(hidden([program, "made.xml"]), self.elsewhere)
        ran = json.loads(run([BUILD / "bin" / "gloam", "run", "made.xml", "--duration", "0.1", "--json"], self.elsewhere))
        self.assertEqual(ran["steps"], 100)

    def test_the_examples_in_cpp_build_and_run(self):
        build = self.folder / "examples"
        include = ROOT / ".venv" / "wheels" / "mujoco" / "include"  # a controller sees MuJoCo's own structures
        run(["cmake", "-S", ROOT / "examples" / "cpp", "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             f"-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror -isystem {include}"], "/")
        run(["cmake", "--build", build], "/")
        cache = {"GLOAM_CACHE": str(self.folder / "cache")}
        model = self.model
        said = run([build / "run_and_read", model], self.elsewhere, **cache)
        program = json.loads(run([BUILD / "bin" / "gloam", "run", model, "--duration", "1", "--json"], self.elsewhere))
        self.assertIn(f"t = 1.000 s, state hash {program['state_hash']}", said)
        self.assertIn("1 actuators", said)
        said = run([build / "subscribe", model], self.elsewhere, **cache)
        self.assertIn("camera side (side_optical_frame)", said)
        self.assertRegex(said, r"26 snapshots, 1[01] frames")
        self.assertIn("most control 0.50", run([build / "drive", model], self.elsewhere, **cache))
        said = run([build / "branch", model], self.elsewhere, **cache)
        ends = re.findall(r"control [+-]0\.5: step 300, first joint at ([+-]\d\.\d+)", said)
        self.assertEqual(len(ends), 2, said)
        self.assertNotEqual(*ends, "two ways on from one instant")
        said = run([build / "render_a_snapshot", model], self.elsewhere, **cache)
        self.assertRegex(said, r"t = 0\.\d+ s: [1-9]\d* of 3072 pixels show something")
        for name in ("run_and_read", "drive"):
            failed = subprocess.run([build / name, "missing.xml"], capture_output=True, text=True, env={**os.environ, **cache})
            self.assertEqual(failed.returncode, 1)
            self.assertIn("missing.xml", failed.stderr)

    def test_the_page_of_the_library_builds_and_runs(self):
        consumer = self.program_of("library.md")
        said = run(hidden([consumer, self.model]), self.elsewhere, GLOAM_CACHE=str(self.folder / "cache"))
        program = json.loads(run([BUILD / "bin" / "gloam", "run", self.model, "--duration", "1", "--json"], self.elsewhere))
        self.assertIn(f"1.000 s, state hash {program['state_hash']}", said)
        run([BUILD / "bin" / "gloam", "render", self.model, "--camera", "free", "--time", "1", "--spp", "4", "--resolution", "64x48",
             "--out", "same"], self.elsewhere)
        pictures = [(self.elsewhere / name).read_bytes() for name in ["picture.png", "same/free.png"]]
        self.assertEqual(*pictures, "the library found its denoiser, too")
        failed = subprocess.run([consumer, "missing.xml"], capture_output=True, text=True)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("missing.xml", failed.stderr)


if __name__ == "__main__":
    unittest.main()
