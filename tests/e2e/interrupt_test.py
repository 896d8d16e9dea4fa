"""The first signal ends every command within two seconds, with exit code 130, whatever it does."""
import json
import math
import os
import signal
import subprocess
import time
import unittest

from e2e.support import PENDULUM, PROGRAM, ProgramTest

# One picture of this takes minutes: 64 Mpx samples in a room that light leaves late.
HEAVY = ["--tier", "path", "--spp", "4096", "--resolution", "640x480", "--no-denoise"]
QUICK = ["--tier", "direct", "--spp", "1", "--resolution", "32x24"]
LIMIT = 2.0  # [s]
SLACK = 3.0  # [s] for a machine that does other work


def star(teeth):
    """An OBJ of a star-shaped prism, whose parts CoACD seeks for a long time."""
    lines, faces, n = [], [], 4 * teeth
    for i in range(n):
        radius, angle = (1.0 if i % 4 < 2 else 0.5), 2 * math.pi * i / n
        for z in (0, 0.3):
            lines.append(f"v {radius * math.cos(angle)} {radius * math.sin(angle)} {z}")
    lines += ["v 0 0 0", "v 0 0 0.3"]
    for i in range(n):
        a, b, c, d = 2 * i + 1, 2 * ((i + 1) % n) + 1, 2 * ((i + 1) % n) + 2, 2 * i + 2
        faces += [(a, b, c), (a, c, d), (2 * n + 1, b, a), (2 * n + 2, d, c)]
    return "\n".join(lines + [f"f {a} {b} {c}" for a, b, c in faces]) + "\n"


class Interrupt(ProgramTest):
    def setUp(self):
        super().setUp()
        self.model = self.write("m.xml", PENDULUM)

    def stopped(self, number, *arguments, started=None, after=1.5):
        """Starts the program, sends the signal once started() holds, or after some seconds; returns what it said on stderr."""
        with open(self.folder / "stderr.txt", "w") as stderr:
            process = subprocess.Popen([str(PROGRAM), *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=stderr,
                                       env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache")})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.time() + 60
        begin = time.time()
        while process.poll() is None and time.time() < deadline:
            if started() if started else time.time() > begin + after:
                break
            time.sleep(0.05)
        self.assertIsNone(process.poll(), "it ended by itself: " + (self.folder / "stderr.txt").read_text())
        process.send_signal(number)
        signalled = time.time()
        code = process.wait(timeout=60)
        took = time.time() - signalled
        said = (self.folder / "stderr.txt").read_text()
        self.assertEqual(code, 130, (arguments, said))
        self.assertLess(took, LIMIT + SLACK, (arguments, said))
        self.assertEqual(len([line for line in said.splitlines() if "error" in line]), 1, said)
        return said

    def test_a_still(self):
        self.stopped(signal.SIGTERM, "render", self.model, "--camera", "side", *HEAVY)

    def test_a_run_in_the_middle_of_a_picture(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            out = self.folder / f"out{int(number)}"
            self.stopped(number, "run", self.model, "--duration", "10", "--out", out, *HEAVY,
                         started=lambda: (out / "summary.json").exists())
            summary = json.loads((out / "summary.json").read_text())
            self.assertEqual((summary["state"], summary["cameras"][0]["frames"]), ("finished", 0))

    def test_a_log_of_pictures(self):
        log = self.folder / "r.mcap"
        self.stopped(signal.SIGTERM, "record", self.model, "-o", log, "--duration", "10", "--topics", "/side/*", *HEAVY,
                     started=lambda: log.exists() and log.stat().st_size > 0)
        self.gloam("info", log)

    def test_replays(self):
        log = self.folder / "r.mcap"
        self.gloam("record", self.model, "-o", log, "--duration", "0.2", "--topics", "/tf")
        out = self.folder / "again"
        self.stopped(signal.SIGTERM, "replay", log, "--out", out, *HEAVY, started=lambda: (out / "summary.json").exists())
        self.assertEqual(json.loads((out / "summary.json").read_text())["state"], "finished")

    def test_a_verification(self):
        # Ten thousand steps between two states.
        scene = self.write("s.toml", '[environment]\nfile = "m.xml"\n[record]\nstate_rate = 0.05\n')
        log = self.folder / "r.mcap"
        self.gloam("record", scene, "-o", log, "--duration", "4000", "--topics", "/clock", timeout=300)
        self.stopped(signal.SIGTERM, "replay", log, "--verify", after=0.7)

    def test_a_conversion(self):
        mesh = self.write("star.obj", star(72))
        self.stopped(signal.SIGTERM, "convert", mesh, "--colliders", "hulls", "--concavity", "0.01", "--max-hulls", "256",
                     started=lambda: "building colliders" in (self.folder / "stderr.txt").read_text(), after=2)


if __name__ == "__main__":
    unittest.main()
