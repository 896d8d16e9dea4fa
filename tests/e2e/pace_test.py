"""The pace of a run on the command line and in scenes, and what is told of its sensors."""
import json
import unittest

from e2e.support import PENDULUM, ProgramTest

SMALL = ("--camera", "side", "--resolution", "16x12", "--spp", "1", "--no-denoise", "--tier", "direct", "--duration", "0.2")


class Pace(ProgramTest):
    def setUp(self):
        super().setUp()
        self.model = self.write("pendulum.xml", PENDULUM)

    def test_sensors_of_a_run_are_told(self):
        result = self.gloam("run", self.model, *SMALL, "--pace", "sensors", "--output", "png", "--out", "out", "--json")
        report = json.loads(result.stdout)
        [camera] = report["sensors"]
        self.assertEqual(camera["name"], "camera 'side'")
        self.assertEqual((camera["rate_hz"], camera["messages"], camera["dropped"]), (20, 5, 0))
        self.assertAlmostEqual(camera["achieved_hz"], 20, places=6)
        self.assertLess(report["realtime_factor"], 1.1)
        table = self.gloam("run", self.model, *SMALL, "--output", "png", "--out", "again").stdout
        self.assertRegex(table, r"(?m)^  stream +target Hz +achieved Hz .*waiting$")
        self.assertRegex(table, r"(?m)^  camera 'side' +20 +20\.00 +5 +0 ")

    def test_states_do_not_depend_on_the_pace(self):
        hashes = {json.loads(self.gloam("run", self.model, *SMALL, "--pace", pace, "--output", "png", "--out", pace, "--json").stdout)["state_hash"]
                  for pace in ("fast", "realtime", "sensors")}
        self.assertEqual(len(hashes), 1)

    def test_a_scene_names_it(self):
        text = '[environment]\nfile = "pendulum.xml"\n[sim]\nduration = 0.3\npace = "{}"\n[record]\noutputs = ["metrics"]\n'
        scene = self.write("scene.toml", text.format("realtime"))
        report = json.loads(self.gloam("run", scene, "--out", "paced", "--json").stdout)
        self.assertLess(report["realtime_factor"], 1.1)
        wrong = self.write("wrong.toml", text.format("sensor"))
        self.assertIn("sensors", self.gloam("run", wrong, "--out", "no", expect=1).stderr)
        self.gloam("run", scene, "--pace", "sensor", expect=2)


if __name__ == "__main__":
    unittest.main()
