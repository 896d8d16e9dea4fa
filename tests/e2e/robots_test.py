"""The catalogue of robots on the command line: lists, previews, robots of one's own, proposals, logs."""
import json
import shutil
import struct
import tomllib
import unittest

from e2e.support import ROOT, ProgramTest

POST = """<mujoco><compiler angle="degree" eulerseq="zyx"/><worldbody><body name="post"><geom size="0.1"/>
<frame pos="0 0 1" euler="90 0 0"><site name="top" pos="0.2 0 0.1" euler="0 10 0"/></frame></body></worldbody></mujoco>"""
ENTRY = """description = "a post"
file = "post.xml"
[[sensor]]
name = "lidar"
kind = "lidar"
mount = "top"
position = [0.3, 0, 0]
[[sensor]]
name = "eye"
kind = "camera"
mount = "top"
position = [0.3, 0, 0]
[[sensor]]
name = "eyes"
kind = "stereo"
mount = "post"
baseline = 0.1
"""


class Robots(ProgramTest):
    def own(self, entry=ENTRY):
        self.write("post/post.xml", POST)
        return self.write("post/robot.toml", entry)

    def test_the_list(self):
        names = sorted(file.parent.name for file in (ROOT / "assets" / "robots").glob("*/robot.toml"))
        table = self.gloam("robots").stdout
        self.assertEqual([line.split()[0] for line in table.splitlines()[1:]], names)
        robots = {robot["name"]: robot for robot in json.loads(self.gloam("--json", "robots").stdout)}
        self.assertEqual(list(robots), names)
        dog = robots["quadruped"]
        self.assertEqual((dog["joints"], dog["floating"], dog["controller"]), (12, True, "trot"))
        one = self.gloam("robots", "quadruped").stdout
        toml = one[one.index("[[robot]]"):]
        self.assertEqual(tomllib.loads(toml)["robot"][0]["model"], "quadruped")
        self.assertIn("did you mean 'quadruped'", self.gloam("robots", "quadrupde", expect=1).stderr)

    def test_what_it_prints_is_a_scene(self):
        text = self.gloam("robots", "cart").stdout
        scene = self.write("s.toml", text[text.index("[[robot]]"):])
        self.gloam("run", scene, "--duration", "0.02", "--out", "out")

    def test_previews(self):
        said = self.gloam("robots", "cart", "--preview", "pictures", timeout=300).stdout
        self.assertEqual(said.split(), ["pictures/cart.png"])
        png = (self.folder / "pictures" / "cart.png").read_bytes()
        self.assertEqual(struct.unpack(">II", png[16:24]), (640, 480))
        self.assertGreater(len(png), 20_000, "a picture of one colour")

    def test_a_robot_of_ones_own(self):
        self.own()
        robot = json.loads(self.gloam("--json", "robots", "./post").stdout)
        self.assertEqual([sensor["name"] for sensor in robot["sensors"]], ["lidar", "eye", "eyes"])
        self.own(ENTRY.replace("mount = \"post\"", "mount = \"pots\""))
        self.assertIn("there is no body or site 'robot/pots'", self.gloam("robots", "./post", expect=1).stderr)

    def test_sensors_at_sites(self):
        self.own()
        scene = self.write("s.toml", '[[robot]]\nname = "p"\nmodel = "./post"\nsensors = ["lidar", "eye", "eyes"]\n')
        streams = {s["name"]: s for s in json.loads(self.gloam("--json", "info", scene, "--streams").stdout)["says"]}
        self.assertIn("p/eyes/right", streams)
        # The frame turns x to y, and the site is pitched by 10° about the y of the frame.
        expected = (0, 0.2 + 0.3 * 0.984807753, 1.1 - 0.3 * 0.173648178)
        for name in ("p/lidar", "p/eye"):
            self.assertEqual(streams[name]["parent"], "p/post")
            for is_, wanted in zip(streams[name]["pose_in_parent"]["position"], expected, strict=True):
                self.assertAlmostEqual(is_, wanted, places=8, msg=name)
        poses = [streams[name]["pose_in_parent"]["orientation_wxyz"] for name in ("p/lidar", "p/eye")]
        for a, b in zip(*poses, strict=True):
            self.assertAlmostEqual(a, b, places=12)

    def test_logs_replay_without_the_catalogue(self):
        home = self.folder / "home"  # a catalogue that can be taken away
        shutil.copytree(ROOT / "assets" / "robots" / "cart", home / "assets" / "robots" / "cart")
        env = {"GLOAM_HOME": str(home)}
        scene = self.write("scene/s.toml", '[[robot]]\nmodel = "cart"\n')
        self.gloam("record", scene, "--duration", "0.1", "--log", "run.mcap", "--embed", env=env)
        self.gloam("record", scene, "--duration", "0.1", "--log", "plain.mcap", env=env)
        (home / "assets" / "robots" / "cart" / "robot.toml").unlink()  # its settings are in the log
        self.gloam("replay", "plain.mcap", "--verify", env=env)
        shutil.rmtree(home)
        shutil.rmtree(self.folder / "scene")
        self.gloam("replay", "run.mcap", "--verify", env={"GLOAM_HOME": str(ROOT)})

    def test_proposals(self):
        text = self.gloam("robots", "--guess", ROOT / "assets" / "robots" / "quadruped" / "quadruped.xml").stdout
        table = tomllib.loads(text)["robot"][0]
        self.assertEqual(table["controller"], {"type": "trot"})
        self.assertEqual(table["joints"]["FL"], ["FL_hip_joint", "FL_thigh_joint", "FL_calf_joint"])
        self.assertIn("# quadruped.xml, from the shape of its tree", text)
        self.gloam("run", self.write("s.toml", text), "--root", "/", "--duration", "0.02", "--out", "out")
        self.gloam("robots", "--guess", "nothing.xml", expect=1)
        self.gloam("robots", "cart", "--guess", "nothing.xml", expect=2)


if __name__ == "__main__":
    unittest.main()
