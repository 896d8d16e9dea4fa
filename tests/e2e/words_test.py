"""What the program says: of outputs that a scene does not have, of pictures that it counts, of what it leaves out."""
import json
import unittest

from e2e.support import PENDULUM, ProgramTest

LIDAR = """[environment]
file = "pendulum.xml"
[[lidar]]
name = "eye"
preset = "VLP-16"
position = [0, -1, 1]
outputs = ["ply"]
[sim]
duration = 0.11
"""


class WordsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.model = self.write("pendulum.xml", PENDULUM)

    def test_of_outputs_that_do_not_exist(self):
        result = self.gloam("run", self.model, "--duration", "0.01", "--output", "depht_png", expect=2)
        self.assertIn("depht_png", result.stderr)
        self.assertIn("depth_png", result.stderr)

    def test_of_outputs_that_name_nothing(self):
        result = self.gloam("run", self.model, "--duration", "0.01", "--output", "lidar,sensors", "--out", "out")
        self.assertIn("--output lidar has no effect", result.stderr)
        self.assertIn("--output sensors has no effect", result.stderr)
        self.assertNotIn("images", result.stdout)

    def test_formats_of_a_lidar_are_kept(self):
        scene = self.write("scene.toml", LIDAR)
        self.gloam("run", scene, "--output", "lidar", "--out", "out")
        self.assertTrue(list((self.folder / "out").rglob("*.ply")))
        self.assertFalse(list((self.folder / "out").rglob("*.pcd")))

    def test_info_of_hidden_things(self):
        model = self.write("hidden.xml", "<mujoco><worldbody>\n<geom size='1' group='3'/><site size='.1'/></worldbody></mujoco>")
        listing = self.gloam("info", model).stdout
        self.assertIn("hidden.xml:2: 1 geom of group 3 is not drawn", listing)
        self.assertIn("hidden.xml:2: 1 site of group 0 is not drawn", listing)
        self.assertNotIn("everything", listing)
        self.assertEqual(len(json.loads(self.gloam("info", model, "--json").stdout)["hidden"]), 2)
        self.assertIn("everything in the file is simulated and rendered", self.gloam("info", self.model).stdout)

    def test_export_says_what_it_leaves_out(self):
        scene = self.write("lamp.toml", "[environment]\nfile = 'pendulum.xml'\n[[light]]\nname = 'l'\ntype = 'point'\nposition = [0, 0, 3]\nflux = 100\n")
        self.assertIn("lamp.toml:3:1: 1 [[light]] is not exported", self.gloam("export", scene, "--out", "out").stderr)


if __name__ == "__main__":
    unittest.main()
