"""Logs of runs: what the command line writes, others' programs read, and `replay --verify` steps again."""
import contextlib
import io
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fetch_data
from e2e.support import PROGRAM, ROOT

SCENE = ROOT / "examples" / "two_robots.toml"
QUICK = ["--tier", "direct", "--spp", "1", "--resolution", "64x48"]


def gloam(*arguments, expect=0):
    result = subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=600)
    if result.returncode != expect:
        raise AssertionError(f"gloam {arguments}: {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


class Log(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        packages = fetch_data.packages(fetch_data.default_folder())
        if not packages.is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(packages))
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        cls.log = cls.folder / "run.mcap"
        cls.topics = [t for t in json.loads(gloam("info", SCENE, "--topics", "--json").stdout) if not t["input"]]
        gloam("record", SCENE, "-o", cls.log, "--duration", "1", "--topics", "*", *QUICK)

    def messages(self):
        from mcap.reader import make_reader
        with self.log.open("rb") as stream:
            yield from make_reader(stream, validate_crcs=True).iter_messages()

    def test_every_message_of_every_topic_is_read_by_rosbags(self):
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
        store = get_typestore(Stores.ROS2_KILTED)
        read = {}
        for schema, channel, message in self.messages():
            if channel.message_encoding != "cdr":
                continue
            if schema.name not in store.fielddefs:
                store.register(get_types_from_msg(schema.data.decode(), schema.name))
            self.assertEqual(store.hash_rihs01(schema.name), channel.metadata["topic_type_hash"], schema.name)
            self.assertIn("reliability", channel.metadata["offered_qos_profiles"])
            value = store.deserialize_cdr(message.data, schema.name)
            read.setdefault(channel.topic, []).append((message.log_time, value))
        for topic in self.topics:
            self.assertIn(topic["name"], read, "a topic without a message")
        clock = [v.clock.sec + 1e-9 * v.clock.nanosec for _, v in read["/clock"]]
        self.assertEqual(clock, sorted(clock))
        self.assertAlmostEqual(clock[-1], 1, delta=0.011)
        for name, messages in read.items():
            for log_time, value in messages:
                if hasattr(value, "header") and not name.startswith("/gloam"):
                    stamp = value.header.stamp.sec * 10**9 + value.header.stamp.nanosec
                    self.assertEqual(stamp, log_time, name)
        image = next(v for n, ms in read.items() if n.endswith("/image_raw") for _, v in ms)
        self.assertEqual((image.encoding, image.width, image.height, image.data.size), ("rgb8", 64, 48, 64 * 48 * 3))

    def test_the_lines_of_the_readme_read_it(self):
        code = re.search(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text(), re.M | re.S).group(1)
        code = code.replace("fire.mcap", str(self.log)).replace("/go/odom", "/ada/odom")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(compile(code, "README.md", "exec"), {})
        rows = said.getvalue().splitlines()
        self.assertGreater(len(rows), 40)
        self.assertNotEqual(rows[0].split()[-1], rows[-1].split()[-1])

    def test_the_run_is_stepped_again_to_the_bit(self):
        said = gloam("replay", self.log, "--verify").stdout
        self.assertRegex(said, r"^0 of 500 steps differ")
        info = json.loads(gloam("info", self.log, "--json").stdout)
        self.assertTrue(info["can_be_stepped_again"])
        self.assertEqual(info["damage"], "")

    def test_a_run_that_goes_on_has_a_log_that_verifies(self):
        said = subprocess.run([str(PROGRAM), "run", str(self.log), "--at", "0.5", "--duration", "0.2", "--mcap", "--camera", "chase",
                               "--resolution", "64x48"], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(said.returncode, 0, said.stderr)
        log = self.folder / "results/two_robots/run.mcap"  # where a run goes that names no folder
        self.assertRegex(gloam("replay", log, "--verify").stdout, r"^0 of 350 steps differ")

    def test_a_run_that_goes_on_refuses_by_name_what_it_cannot_change(self):
        for options in (["--spp", "9"], ["--device", "cpu"], ["--tier", "direct"], ["--error", "0.1"], ["--max-depth", "2"], ["--ev", "3"],
                        ["--look", "studio"], ["--groups", "0"], ["--sites"], ["--no-denoise"], ["--output", "png"], ["--keyframe", "home"],
                        ["--seed", "4"], ["--set", "sim.duration=1"], ["--timestep", "0.001"], ["--root", "."], ["--strict"],
                        ["--package", "a=b"]):
            said = subprocess.run([str(PROGRAM), "run", str(self.log), "--at", "0.5", "--duration", "0.01", "--out", "refused", *options],
                                  cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(said.returncode, 2, (options, said.stderr))
            self.assertIn(f"{options[0]} cannot be combined with --at", said.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_a_replay_says_where_its_motion_comes_from(self):
        for option, word in (("--poses", "poses only"), ("--restep", "a new run")):
            out = self.folder / option
            said = gloam("replay", self.log, option, "--out", out, "--output", "state", "--json")
            self.assertIn(word, said.stderr)
            self.assertIn(word, json.loads(said.stdout)["notes"][0])

    def test_trajectories_and_tables_are_those_of_the_messages(self):
        from rosbags.typesys import Stores, get_typestore
        store = get_typestore(Stores.ROS2_KILTED)
        odom = [store.deserialize_cdr(m.data, "nav_msgs/msg/Odometry") for _, c, m in self.messages() if c.topic == "/ada/odom"]
        self.assertGreater(len(odom), 40)
        tum, kitti, euroc, table = (self.folder / f"ada.{end}" for end in ("tum", "kitti", "euroc", "csv"))
        for path, to in ((tum, "tum"), (kitti, "kitti"), (euroc, "euroc")):
            gloam("export", self.log, "--to", to, "--topic", "/ada/odom", "--out", path)
        rows = [[float(x) for x in line.split()] for line in tum.read_text().splitlines()]
        self.assertEqual(len(rows), len(odom))
        for row, message in zip(rows, odom):
            p, q = message.pose.pose.position, message.pose.pose.orientation
            self.assertEqual(row[1:], [p.x, p.y, p.z, q.x, q.y, q.z, q.w])
            self.assertAlmostEqual(row[0], message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec, delta=1e-9)
        matrices = [[float(x) for x in line.split()] for line in kitti.read_text().splitlines()]
        self.assertEqual([[m[3], m[7], m[11]] for m in matrices], [r[1:4] for r in rows])
        for m in matrices:
            self.assertAlmostEqual(sum(x * x for x in (m[0], m[4], m[8])), 1, delta=1e-12)
        lines = euroc.read_text().splitlines()
        self.assertTrue(lines[0].startswith("#timestamp"))
        self.assertEqual([float(x) for x in lines[1].split(",")][1:4], rows[0][1:4])
        gloam("export", self.log, "--to", "csv", "--topic", "/ada/odom", "--out", table)
        import csv
        with table.open() as stream:
            read = list(csv.DictReader(stream))
        self.assertEqual([float(r["pose.pose.position.x"]) for r in read], [r[1] for r in rows])
        self.assertEqual(read[0]["child_frame_id"], odom[0].child_frame_id)
        frame = self.folder / "frame.tum"
        gloam("export", self.log, "--to", "tum", "--topic", f"/tf:{odom[0].child_frame_id}", "--out", frame)
        self.assertEqual([line.split()[1:4] for line in frame.read_text().splitlines()][0], tum.read_text().split()[1:4])
        for topic, word in (("/ada/odmo", "/ada/odom"), ("/clock", "no pose"), ("/tf:nothing", "no pose")):
            self.assertIn(word, gloam("export", self.log, "--to", "tum", "--topic", topic, "--out", self.folder / "x", expect=1).stderr)
        gloam("export", self.log, "--to", "tum", "--topic", "/ada/odom", "--out", tum, expect=2)  # is there already

    def test_a_cut_log_is_made_whole(self):
        cut, whole = self.folder / "cut.mcap", self.folder / "whole.mcap"
        cut.write_bytes(self.log.read_bytes()[:self.log.stat().st_size // 2])
        self.assertIn("recover", gloam("info", cut, expect=3).stdout)
        gloam("recover", cut, "-o", whole, expect=3)
        self.assertIn("0 of ", gloam("replay", whole, "--verify").stdout)
        self.assertIn("exists", gloam("recover", cut, "-o", whole, expect=1).stderr)

    def test_what_cannot_be_is_refused(self):
        self.assertIn("already", gloam("record", SCENE, "-o", self.log, "--duration", "0.1", expect=2).stderr)
        missing = gloam("record", SCENE, "-o", self.folder / "x.mcap", "--topics", "/tff", expect=1).stderr
        self.assertIn("/tf", missing)
        gloam("record", SCENE, "-o", "/dev/full/run.mcap", "--duration", "0.1", expect=1)
        text = self.folder / "text.mcap"
        text.write_text("no log")
        for command in (["info", text], ["replay", text, "--verify"], ["recover", text]):
            self.assertIn("text.mcap", gloam(*command, expect=1).stderr)
        robot = fetch_data.robot_log(fetch_data.default_folder())
        if robot.exists():
            self.assertIn("/tf", gloam("info", robot).stdout)
            self.assertIn("no Gloam run", gloam("replay", robot, "--verify", expect=1).stderr)

    def test_a_changed_model_is_named(self):
        scene = self.folder / "copy"
        shutil.copytree(ROOT / "assets" / "robots" / "quadruped", scene)
        (scene / "scene.toml").write_text('[[robot]]\nname = "go"\nfile = "quadruped.xml"\n')
        log = self.folder / "changed.mcap"
        gloam("record", scene / "scene.toml", "-o", log, "--duration", "0.1", "--topics", "/tf")
        model = scene / "quadruped.xml"
        model.write_text(model.read_text().replace('friction="', 'friction="1', 1))
        self.assertIn("quadruped.xml", gloam("replay", log, "--verify", expect=1).stderr)


if __name__ == "__main__":
    unittest.main()
