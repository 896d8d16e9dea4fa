"""`gloam evaluate` against PyPI's evo, on the KITTI, TUM and EuRoC trajectories of its own tests, and on a stranger's log."""
import csv
import json
import math
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import fetch_data
from e2e.support import ProgramTest

DATA = fetch_data.default_folder()
TOLERANCE = 1e-9
FILES = {"KITTI": ("KITTI_00_gt.txt", "KITTI_00_ORB.txt"), "TUM": ("fr2_desk_groundtruth.txt", "fr2_desk_ORB.txt"),
         "EuRoC": ("V102_groundtruth.csv", "V102.txt")}


class Evaluate(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if not fetch_data.packages(DATA).is_dir() or not fetch_data.trajectories(DATA).is_dir():
            raise unittest.SkipTest("the packages and trajectories of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(fetch_data.packages(DATA)))

    def theirs(self, file):
        """A trajectory as evo holds it."""
        import numpy as np
        from evo.core.trajectory import PosePath3D, PoseTrajectory3D
        with (fetch_data.trajectories(DATA) / file).open() as stream:
            divider = "," if file.endswith(".csv") else " "
            rows = np.array([row for row in csv.reader((r for r in stream if not r.startswith("#")), delimiter=divider)]).astype(float)
        if rows.shape[1] == 12:
            return PosePath3D(poses_se3=[np.vstack([r.reshape(3, 4), [0, 0, 0, 1]]) for r in rows])
        if divider == ",":
            return PoseTrajectory3D(rows[:, 1:4], rows[:, 4:8], rows[:, 0] / 1e9)
        return PoseTrajectory3D(rows[:, 1:4], np.roll(rows[:, 4:], 1, axis=1), rows[:, 0])

    def their_errors(self, reference, estimate, align, rpe):
        """Statistics of ATE and RPE by evo."""
        import copy
        from evo.core import metrics, sync
        from evo.core.units import Unit
        if hasattr(reference, "timestamps"):
            reference, estimate = sync.associate_trajectories(reference, estimate)
        estimate = copy.deepcopy(estimate)
        if align == "origin":
            estimate.align_origin(reference)
        elif align != "none":
            estimate.align(reference, correct_scale=align == "sim3", correct_only_scale=align == "scale")
        parts = {"translation_m": metrics.PoseRelation.translation_part, "angle_rad": metrics.PoseRelation.rotation_angle_rad,
                 "full": metrics.PoseRelation.full_transformation}
        units = {"m": Unit.meters, "f": Unit.frames, "deg": Unit.degrees, "rad": Unit.radians}
        out = {"ate": {}, "rpe": {}}
        for name, relation in parts.items():
            ape = metrics.APE(relation)
            ape.process_data((reference, estimate))
            delta, unit, all_pairs = rpe
            relative = metrics.RPE(relation, delta=delta, delta_unit=units[unit], all_pairs=all_pairs)
            relative.process_data((reference, estimate))
            out["ate"][name] = ape.get_all_statistics() | {"count": len(ape.error)}
            out["rpe"][name] = relative.get_all_statistics() | {"count": len(relative.error)}
        return out

    def compare(self, name, align, rpe):
        reference, estimate = FILES[name]
        delta, unit, all_pairs = rpe
        folder = fetch_data.trajectories(DATA)
        ours = json.loads(self.gloam("evaluate", folder / estimate, "--reference", folder / reference, "--align", align, "--rpe-delta", delta,
                                     "--rpe-unit", unit, *(["--all-pairs"] if all_pairs else []), "--json").stdout)
        theirs = self.their_errors(self.theirs(reference), self.theirs(estimate), align, rpe)
        for kind in ("ate", "rpe"):
            for part, statistics in theirs[kind].items():
                for what, value in statistics.items():
                    own = ours[kind][part][what]
                    self.assertLessEqual(abs(own - value), TOLERANCE * max(1, abs(value)), f"{name} {align} {rpe} {kind} {part} {what}")

    def test_kitti_is_equal_to_evo(self):
        for align, rpe in (("se3", (1, "f", False)), ("sim3", (100, "m", False)), ("none", (10, "f", True)), ("origin", (10, "deg", False)),
                           ("scale", (100, "m", True))):
            self.compare("KITTI", align, rpe)

    def test_tum_is_equal_to_evo(self):
        for align, rpe in (("se3", (1, "m", False)), ("sim3", (1, "f", False)), ("origin", (0.5, "rad", False)), ("none", (1, "m", True))):
            self.compare("TUM", align, rpe)

    def test_euroc_is_equal_to_evo(self):
        for align, rpe in (("se3", (1, "m", False)), ("sim3", (10, "f", True)), ("none", (15, "deg", False)), ("scale", (1, "f", False)),
                           ("sim3", (20, "deg", True))):
            self.compare("EuRoC", align, rpe)

    def test_a_strangers_log_is_measured(self):
        log = fetch_data.robot_log(DATA)
        topics = [t["name"] for t in json.loads(self.gloam("info", log, "--json").stdout)["topics"] if t["type"] == "nav_msgs/msg/Odometry"]
        self.assertTrue(topics)
        same = json.loads(self.gloam("evaluate", f"{log}:{topics[0]}", "--reference", f"{log}:{topics[0]}", "--align", "none", "--json").stdout)
        self.assertEqual(same["ate"]["translation_m"]["max"], 0)
        self.gloam("export", log, "--to", "tum", "--topic", topics[0], "--out", self.folder / "odom.tum")
        file = json.loads(self.gloam("evaluate", f"{log}:{topics[0]}", "--reference", self.folder / "odom.tum", "--align", "none", "--json").stdout)
        self.assertLess(file["ate"]["full"]["max"], 1e-9)
        self.assertEqual(file["pairs"], same["pairs"])
        # Odometry is the pose of base_link in odom, which /tf has, too.
        frame = json.loads(self.gloam("evaluate", f"{log}:/tf:base_link", "--reference", f"{log}:{topics[0]}", "--align", "none", "--json",
                                      "--max-difference", "0.02").stdout)
        self.assertLess(frame["ate"]["translation_m"]["median"], 0.05)
        self.assertIn("no topic '/nothing'", self.gloam("evaluate", f"{log}:/nothing", "--reference", f"{log}:{topics[0]}", expect=1).stderr)

    def test_the_plot_is_an_svg(self):
        folder = fetch_data.trajectories(DATA)
        said = self.gloam("evaluate", folder / "V102.txt", "--reference", folder / "V102_groundtruth.csv", "--align", "sim3", "--plot",
                          self.folder / "v.svg").stdout
        self.assertRegex(said, r"ATE translation \[m\] +0\.\d+")
        root = ElementTree.parse(self.folder / "v.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertEqual(len(root.findall(".//{*}path")), 3)
        self.gloam("evaluate", folder / "V102.txt", "--reference", folder / "V102_groundtruth.csv", "--plot", self.folder / "v.svg", expect=2)

    def test_what_is_wrong_is_said(self):
        good = self.write("good.tum", "".join(f"{i} {math.cos(i)} {math.sin(i)} 0 0 0 0 1\n" for i in range(9)))
        later = self.write("later.tum", "".join(f"{i + 100} {i} {i * i} 0 0 0 0 1\n" for i in range(9)))
        line = self.write("line.tum", "".join(f"{i} {i} 0 0 0 0 0 1\n" for i in range(9)))
        bad = self.write("bad.tum", "0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n")
        for estimate, words in ((later, "no poses within"), (bad, "bad.tum:2: "), (self.folder / "none.tum", "none.tum")):
            self.assertIn(words, self.gloam("evaluate", estimate, "--reference", good, expect=1).stderr)
        straight = self.gloam("evaluate", line, "--reference", line, "--json")
        self.assertIn("follow a straight line", straight.stderr)
        self.assertIn("undetermined", straight.stderr)
        self.assertTrue(json.loads(straight.stdout)["align"]["rotation_undetermined"])
        self.assertAlmostEqual(json.loads(straight.stdout)["ate"]["translation_m"]["rmse"], 0)
        self.assertIn("no two of the 9 poses", self.gloam("evaluate", good, "--reference", good, "--rpe-delta", "50", expect=1).stderr)
        self.gloam("evaluate", good, "--reference", good, "--rpe-delta", "0", expect=2)
        self.gloam("evaluate", good, "--reference", good, "--align", "sim4", expect=2)
        self.gloam("evaluate", good, expect=2)
        self.assertIn("ATE", self.gloam("evaluate", later, "--reference", good, "--offset", "-100").stdout)


if __name__ == "__main__":
    unittest.main()
