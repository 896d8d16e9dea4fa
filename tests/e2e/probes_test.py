"""Probes as a user meets them on the command line: tables that others open, lists, logs and replays."""
import csv
import json
import math
import unittest

from e2e.support import ProgramTest

SCENE = """[environment]
file = 'nothing.xml'
[sky]
sun_elevation = 40
[weather]
wind = 6
gusts = 0.2
[[water]]
name = 'pool'
position = [0, 0, 0.5]
[[probe]]
name = 'mast'
quantity = 'wind'
position = [0, 0, 10]
rate = 20
[[probe]]
name = 'gauge'
quantity = 'water_height'
position = [1, 1, 0]
[sim]
duration = 2
[record]
outputs = ['sensors']
mcap = true
"""


class Probes(ProgramTest):
    def scene(self, more=""):
        self.write("nothing.xml", "<mujoco/>")
        return self.write("s.toml", SCENE + more)

    def rows(self, file):
        with open(self.folder / file, newline="") as opened:
            return list(csv.DictReader(opened))

    def test_a_run_writes_tables_and_a_log_and_its_replay_says_the_same(self):
        self.gloam("run", self.scene(), "--out", "run")
        mast = self.rows("run/sensors/mast.csv")
        self.assertEqual(len(mast), 41)
        for n, row in enumerate(mast):
            self.assertAlmostEqual(float(row["time_s"]), n / 20, places=9)
        mean = sum(float(row["x_mps"]) for row in mast) / len(mast)
        self.assertTrue(3 < mean < 9, mean)  # from the west
        self.assertEqual({row["height_m"] for row in self.rows("run/sensors/gauge.csv")}, {"0.5"})
        topic = ["export", self.folder / "run/run.mcap", "--to", "csv", "--topic", "/mast", "--out"]
        self.gloam(*topic, "mast.csv")
        logged = self.rows("mast.csv")
        self.assertEqual(len(logged), 41)
        for row, sample in zip(logged, mast, strict=True):
            self.assertTrue(math.isclose(float(row["vector.x"]), float(sample["x_mps"]), rel_tol=1e-9))
        self.gloam("replay", self.folder / "run/run.mcap", "--output", "sensors", "--out", "again")
        self.assertEqual(self.rows("again/sensors/mast.csv")[:40], mast[:40])

    def test_info_lists_them(self):
        streams = json.loads(self.gloam("info", self.scene(), "--streams", "--json").stdout)["says"]
        mast = next(stream for stream in streams if stream["name"] == "mast")
        self.assertEqual((mast["kind"], mast["unit"], mast["outputs"]), ("sensor", "m/s", ["x", "y", "z"]))
        self.assertIn("/gauge", self.gloam("info", self.scene(), "--topics").stdout)

    def test_what_cannot_be_read_has_a_place_and_a_remedy(self):
        scene = self.scene("[[probe]]\nname = 'e'\nquantity = 'exposure'\nposition = [0, 0, 1]\n")
        said = self.gloam("info", scene, expect=1).stderr
        self.assertIn("s.toml:25:", said)
        self.assertIn("specify 'camera'", said)


if __name__ == "__main__":
    unittest.main()
