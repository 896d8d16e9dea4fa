"""Metrics that a scene declares, as a user meets them on the command line."""
import csv
import json
import unittest

from e2e.support import ProgramTest

CART = """<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='x' type='slide' axis='1 0 0'/>
<geom size='0.1' mass='2' contype='0' conaffinity='0'/></body></worldbody><actuator><motor name='m' joint='x'/></actuator>
<keyframe><key name='go' qvel='1' ctrl='4'/></keyframe></mujoco>"""
SCENE = """[[robot]]
name = 'r'
file = 'cart.xml'
keyframe = 'go'
[[goal]]
robot = 'r'
position = [1, 0, 0]
radius = 0.1
[[metric]]
name = 'momentum'
value = '{}'
unit = 'kg m/s'
robots = '*'
reduce = ['last', 'min']
[sim]
duration = 1
"""


class Metrics(ProgramTest):
    def scene(self, value):
        self.write("cart.xml", CART)
        return self.write("s.toml", SCENE.format(value))

    def test_a_run_writes_what_the_scene_declares(self):
        scene = self.scene("robot.mass * robot.velocity.x")
        self.gloam("run", scene, "--output", "metrics", "--out", "run")
        with open(self.folder / "run/metrics.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 101)
        for row in rows:
            self.assertAlmostEqual(float(row["r.momentum_kgmps"]), 2 + 4 * float(row["time_s"]), places=6)
        results = json.loads((self.folder / "run/summary.json").read_text())["results"]
        self.assertAlmostEqual(results["r.momentum_last_kgmps"], 6, places=6)
        self.assertAlmostEqual(results["r.momentum_min_kgmps"], 2, places=6)
        self.assertAlmostEqual(results["r.energy_J"], 0.5 * 2 * (9 - 1), places=3)  # gained: 3 m/s against 1 m/s
        self.assertEqual(results["r.success"], 1)
        self.assertGreater(results["r.spl"], 0.99)

    def test_info_lists_them(self):
        scene = self.scene("time")
        listing = json.loads(self.gloam("info", scene, "--metrics", "--json").stdout)["metrics"]
        self.assertEqual(listing[-1], {"name": "r.momentum_kgmps", "unit": "kg m/s", "robot": "r", "declared": True})
        self.assertIn("r.goal_distance_m", [metric["name"] for metric in listing])
        self.assertIn("declared", self.gloam("info", scene, "--metrics").stdout)

    def test_what_does_not_parse_has_a_place(self):
        scene = self.scene("robot.mass * robot.velocty.x")
        for command in (["info", scene], ["info", scene, "--metrics"], ["run", scene, "--out", "run"]):
            result = self.gloam(*command, expect=1)
            self.assertIn("s.toml:9", result.stderr)
            self.assertIn("column 20: this robot has no 'velocty' (did you mean 'velocity'?)", result.stderr)
            self.assertFalse((self.folder / "run").exists())


if __name__ == "__main__":
    unittest.main()
