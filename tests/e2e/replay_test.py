"""Replays from the command line: what they accept, what they refuse by name, and files that two recordings want."""
import json
import os
import subprocess
import time
import unittest

from e2e.support import PENDULUM, PROGRAM, ProgramTest

QUICK = ["--tier", "direct", "--spp", "1", "--resolution", "32x24"]


class Replay(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("m.xml", PENDULUM)
        self.write("s.toml", '[environment]\nfile = "m.xml"\n[render]\ntier = "direct"\nspp = 1\n'
                             '[[camera]]\nname = "eye"\nposition = [0, -2, 1]\nlook_at = [0, 0, 1]\nwidth = 32\nheight = 24\nrate = 10\n')
        self.log = self.folder / "r.mcap"
        self.gloam("record", "s.toml", "-o", self.log, "--duration", "0.2", "--topics", "/tf")

    def test_options_of_rendering_are_those_of_run(self):
        self.gloam("replay", self.log, "--out", "a", "--tier", "path", "--spp", "3", "--no-denoise", "--max-depth", "2", "--output", "png")
        settings = json.loads((self.folder / "a/summary.json").read_text())["settings"]
        self.assertEqual((settings["tier"], settings["spp"], settings["denoise"], settings["max_depth"]), ("path", "3", "false", "2"))
        self.gloam("run", "s.toml", "--duration", "0.2", "--out", "b", "--tier", "path", "--spp", "3", "--no-denoise", "--max-depth", "2",
                   "--output", "png")
        for picture in sorted((self.folder / "b/eye/rgb").iterdir()):
            self.assertEqual(picture.read_bytes(), (self.folder / "a/eye/rgb" / picture.name).read_bytes())

    def test_options_without_effect_are_refused_by_name(self):
        self.write("o.toml", "[sky]\nsun_elevation = 4\n")
        for options in (["--verify", "--set", "sky.sun_elevation=4"], ["--verify", "--spp", "2"], ["--verify", "--run", "0"],
                        ["--out", "x", "--seed", "3"], ["--out", "x", "--loop"], ["--out", "x", "--speed", "2"],
                        ["--out", "x", "--randomize", "o.toml"], ["--log", "x.mcap", "--output", "png"], ["--view", "--variants", "2"],
                        ["--view", "--out", "x"]):
            said = self.gloam("replay", self.log, *options, expect=2).stderr
            refused = [word for word in options if word.startswith("--") and f"{word} has no effect" in said]
            self.assertEqual(len(refused), 1, said)
        said = self.gloam("replay", self.log, "--out", "x", "--set", "sim.seed=9", expect=2).stderr
        self.assertIn("'sim.seed' has no effect", said)
        self.assertFalse((self.folder / "x").exists())


class OneWriter(ProgramTest):
    def setUp(self):
        super().setUp()
        self.model = self.write("m.xml", PENDULUM)

    def start(self, *arguments):
        process = subprocess.Popen([str(PROGRAM), *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache")})
        self.addCleanup(process.wait)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, path, size=1):
        deadline = time.time() + 60
        while not (path.exists() and path.stat().st_size >= size) and time.time() < deadline:
            time.sleep(0.02)

    def test_two_logs_of_one_name(self):
        log = self.folder / "r.mcap"
        first = self.start("record", self.model, "-o", log, "--duration", "1e6", "--topics", "/tf")
        self.wait_for(log)
        said = self.gloam("record", self.model, "-o", log, "--overwrite", "--duration", "0.1", "--topics", "/tf", expect=2).stderr
        self.assertIn("is being written by another recording", said)
        first.terminate()
        self.assertEqual(first.wait(timeout=60), 130)
        self.gloam("replay", log, "--verify", timeout=300)
        # Afterwards it may be replaced.
        self.gloam("record", self.model, "-o", log, "--overwrite", "--duration", "0.1", "--topics", "/tf")

    def test_two_results_of_one_name(self):
        out = self.folder / "out"
        first = self.start("run", self.model, "--out", out, "--duration", "1e6", *QUICK)
        self.wait_for(out / "summary.json")
        said = self.gloam("run", self.model, "--out", out, "--overwrite", "--duration", "0.1", *QUICK, expect=2).stderr
        self.assertIn("is being written by another recording", said)
        first.terminate()
        self.assertEqual(first.wait(timeout=60), 130)
        self.assertEqual(json.loads((out / "summary.json").read_text())["state"], "finished")

    def test_a_log_that_is_taken_away_or_cut(self):
        for name, harm, says in (("gone", os.unlink, "was removed"), ("cut", lambda path: os.truncate(path, 10), "was truncated to"),
                                 ("moved", lambda path: os.rename(path, f"{path}.old"), "was moved or replaced")):
            log = self.folder / f"{name}.mcap"
            process = self.start("record", self.model, "-o", log, "--duration", "200" if name == "moved" else "1e6", "--topics", "/tf")
            self.wait_for(log)
            harm(log)
            error = process.communicate(timeout=120)[1]
            self.assertEqual(process.returncode, 3, error)
            self.assertIn(says, error)
            self.assertIn(log.name, error)

    def test_results_that_are_taken_away(self):
        out = self.folder / "out"
        process = self.start("run", self.model, "--out", out, "--duration", "1e6", *QUICK)
        self.wait_for(out / "side" / "poses.csv")
        os.unlink(out / "side" / "poses.csv")
        error = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 3, error)
        self.assertIn("was removed", error)


if __name__ == "__main__":
    unittest.main()
