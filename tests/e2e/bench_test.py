"""./gloam bench: every measuring program works on a small model; names, history and Ctrl-C behave."""
import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from e2e.support import PENDULUM, PROGRAM, ROOT, ProgramTest

sys.path.insert(0, str(ROOT / "bench"))
import measure  # noqa: E402
import measure_realistic  # noqa: E402

spec = importlib.util.spec_from_file_location("bench_run", ROOT / "bench" / "run.py")  # tests/ has a run.py, too
bench = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bench)

BENCH = [sys.executable, str(ROOT / "bench" / "run.py")]


def history():
    return sorted((ROOT / "bench" / "history").glob("bench_*"))


class Programs(ProgramTest):
    def call(self, name, *arguments):
        result = subprocess.run([str(PROGRAM.parent / f"bench_{name}"), *map(str, arguments)], capture_output=True, text=True,
                                timeout=120, env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache")})
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_step_rates_compare_the_same_steps(self):
        model = self.write("pendulum.xml", PENDULUM)
        for name in ["sim_step_rate", "sim_beside_cameras"]:  # each fails by itself when the two loops end in different states
            data = json.loads(self.call(name, model, "--json", "--pairs", 10, "--block", 500))
            self.assertEqual(data["pairs"], 10)
            self.assertTrue(0.05 < data["lower_95"] <= data["median_ratio"] < 3, data)

    def test_cameras_load_both_sides_alike(self):
        model = self.write("pendulum.xml", PENDULUM)
        ratios = []
        for _ in range(3):  # a block is a few milliseconds: on a busy machine one run says little
            data = json.loads(self.call("sim_beside_cameras", model, "--json", "--pairs", 10, "--block", 20000))
            ours, bare = data["rendering_beside_simulator"], data["rendering_beside_bare"]
            self.assertGreater(min(ours, bare), 0.2, data)  # both render
            ratios.append(ours / bare)
        self.assertTrue(0.3 < sorted(ratios)[1] < 3, ratios)

    def test_loading_tells_when_it_is_ready(self):
        model, start = self.write("pendulum.xml", PENDULUM), time.monotonic()
        for words in [("bare_load", model), ("load_time", model, "physics"), ("load_time", model, "render")]:
            cpu, ready = map(float, self.call(*words).split())
            self.assertGreater(cpu, 0)
            self.assertTrue(start < ready < time.monotonic(), words)

    def test_direct_picture_is_timed_and_written(self):
        model, picture = self.write("pendulum.xml", PENDULUM), self.folder / "p.png"
        words = self.call("direct_rate", model, "side", "--size", "64x48", "--frames", 3, "--picture", picture).split()
        self.assertGreater(float(words[0]), 0)
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")

    def test_realistic_scene_is_timed_and_its_images_written(self):
        scene, out = ROOT / "bench" / "realistic_scenes" / "plain_room.toml", self.folder / "images"
        data = json.loads(self.call("realistic_rate", scene, "--tier", "interactive", "--device", "cpu", "--size", "32x24", "--frames", 3, "--out", out, "--json"))
        self.assertEqual((data["scene"], data["tier"], data["width"], data["height"], data["frames"]), ("plain_room", "interactive", 32, 24, 3))
        self.assertTrue(0 < data["image_ms"] <= data["image_p95_ms"], data)
        self.assertTrue(0 < data["renderer_ms"] < data["first_ms"], data)
        self.assertGreater(data["load_ms"], 0)
        self.assertAlmostEqual(data["real_time_factor"], 50 / data["physics_ms"], delta=0.01 * data["real_time_factor"])
        self.assertGreater(data["rays"], 32 * 24)
        images = sorted(path.read_bytes() for path in out.iterdir())
        self.assertEqual(len(set(images)), 3)  # the camera moves, the robot too

    def test_realistic_rate_rejects_wrong_arguments(self):
        scene = ROOT / "bench" / "realistic_scenes" / "plain_room.toml"
        interactive = [scene, "--tier", "interactive"]
        for arguments, code, message in [(["--help"], 0, "usage: "), ([scene], 2, "usage: "), (["--tier", "interactive"], 2, "usage: "),
                                         ([*interactive, "--siez", "9x9"], 2, "usage: "), ([*interactive, "--device", "gpu"], 2, "did you mean 'cpu'"),
                                         ([scene, "--tier", "slow"], 2, "path, interactive, direct"), ([*interactive, "--size", "0x5"], 2, "0 x 5"),
                                         ([*interactive, "--camera", "from..two"], 1, "did you mean 'to'"), ([*interactive, "--camera", "from..from"], 1, "same place")]:
            result = subprocess.run([str(PROGRAM.parent / "bench_realistic_rate"), *map(str, arguments)], capture_output=True, text=True, timeout=120,
                                    env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache")})
            self.assertEqual(result.returncode, code, arguments)
            self.assertIn(message, result.stderr if code else result.stdout, arguments)


class Realistic(unittest.TestCase):
    def test_every_row_has_its_scenes(self):
        scenes = {path.stem for path in measure_realistic.SCENES.glob("*.toml")}
        self.assertEqual(len(scenes), 12)
        for members, _ in measure_realistic.IMAGES.values():
            self.assertLessEqual(set(members), scenes)


class Runs(unittest.TestCase):
    def test_a_wrong_name_lists_the_right_ones(self):
        result = subprocess.run([*BENCH, "--only", "nonsense"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stdout, "")
        for subject in bench.ON_CPU:
            self.assertIn(subject.__name__, result.stderr)

    def test_a_partial_run_prints_its_record_and_is_not_kept(self):
        if not (Path(os.environ.get("GLOAM_TEST_DATA", "")) / "mjlab").is_dir():
            self.skipTest("the robots are not fetched")
        before = history()
        result = subprocess.run([*BENCH, "--only", "sim_step", "--quick", "--json"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        record = json.loads(result.stdout)
        self.assertEqual([row["bar"] for row in record["rows"]], [0.97])
        self.assertEqual(record["rows"][0]["met"], record["rows"][0]["value"] >= 0.97)
        self.assertIn("MuJoCo", record["versions"]["gloam"])
        self.assertEqual(history(), before)

    def group_ends(self, group):
        for _ in range(100):  # what stood stopped and was killed stays for a moment until it is reaped
            try:
                os.killpg(group, 0)
            except ProcessLookupError:
                return True
            time.sleep(0.1)
        return False

    def test_ctrl_c_ends_it_and_all_that_it_started(self):
        if not (Path(os.environ.get("GLOAM_TEST_DATA", "")) / "mjlab").is_dir():
            self.skipTest("the robots are not fetched")
        before = history()
        process = subprocess.Popen([*BENCH, "--only", "beside"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True,
                                   # A caller in the background ignores it, and its children would inherit that.
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        time.sleep(3)
        os.killpg(process.pid, signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("not kept", errors)
        self.assertNotIn("Traceback", errors)
        self.assertTrue(self.group_ends(process.pid), "a process of the bench is left")
        self.assertEqual(history(), before)


class History(unittest.TestCase):
    def test_the_newest_run_of_the_same_machine_is_compared_with(self):
        here = {"cpu": "A", "cores": 2}
        with tempfile.TemporaryDirectory() as folder:
            original, bench.HISTORY = bench.HISTORY, Path(folder)
            self.addCleanup(setattr, bench, "HISTORY", original)
            self.assertIsNone(bench.previous_run(here))
            for date, cores, value in [("2026-01-01", 2, 1.0), ("2026-01-02", 2, 2.0), ("2026-01-03", 4, 9.0)]:
                bench.keep({"date": f"{date}T10:00:00+00:00", "machine": {"cpu": "A", "cores": cores}, "versions": {"commit": "c"},
                            "rows": [{"name": "x", "value": value}]})
            before = bench.previous_run(here)
            self.assertEqual(before["date"][:10], "2026-01-02")
            self.assertEqual(bench.change({"name": "x", "value": 1.5}, before), "-25 % since 2026-01-02")
            self.assertEqual(bench.change({"name": "new", "value": 1.5}, before), "")

    def test_bars_are_met_from_their_side(self):
        self.assertTrue(measure.at_least("n", 1.0, 1.0, "")["met"])
        self.assertFalse(measure.at_least("n", 0.99, 1.0, "")["met"])
        self.assertFalse(measure.at_most("n", 1.01, 1.0, "")["met"])


if __name__ == "__main__":
    unittest.main()
