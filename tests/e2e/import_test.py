"""Scenes of mesh files, things of the catalogue, generated places and height fields, as a user meets them on the command line."""
import json
import unittest

from e2e.support import ProgramTest

BALL = "<mujoco><worldbody><body name='ball'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"
FACES = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]


def box(low, high, faces=FACES, group="box"):
    """A closed box as OBJ."""
    corners = [[(high if i >> k & 1 else low)[k] for k in range(3)] for i in range(8)]
    return "\n".join([f"g {group}", *(f"v {x} {y} {z}" for x, y, z in corners), *(f"f {a} {b} {c} {d}" for a, b, c, d in faces)]) + "\n"


class Notes(ProgramTest):
    """What is odd is told once, on stderr, by every command."""
    SMALL = ["--spp", "1", "--resolution", "32x24"]

    def commands(self, scene):
        yield self.gloam("info", scene)
        yield self.gloam("run", scene, "--duration", "0.01", "--output", "metrics", "--out", "run", "--overwrite")
        yield self.gloam("render", scene, *self.SMALL, "--out", "stills")
        yield self.gloam("export", scene, "--out", "exported")

    def assert_told(self, scene, text):
        for result in self.commands(scene):
            self.assertEqual(result.stderr.count(text), 1, f"{result.args[1]} says\n{result.stderr}")
            self.assertIn("note: ", next(line for line in result.stderr.splitlines() if text in line))
            self.assertNotIn("not supported", result.stderr)

    def test_of_objects(self):
        self.write("open.obj", box((0, 0, 0), (0.2, 0.2, 0.2), FACES[:5]))
        scene = self.write("s.toml", "[[object]]\nname = 'lid'\nfile = 'open.obj'\ncolliders = 'hull'\nposition = [0, 0, 1]\n")
        self.assert_told(scene, "object 'lid' is open")
        listing = self.gloam("info", scene).stdout
        self.assertIn("notes (1)", listing)
        self.assertIn("everything in the file is simulated and rendered", listing)
        self.assertIn("10 triangles rendered", listing)

    def test_of_places(self):
        self.write("mm.obj", box((0, 0, 0), (20000, 20000, 100)))
        scene = self.write("s.toml", "[environment]\nfile = 'mm.obj'\n[[robot]]\nname = 'box'\nfile = 'ball.xml'\nposition = [1, 1, 200]\n")
        self.write("ball.xml", BALL)
        self.assert_told(scene, "the environment has a size of 2e+04 m")
        self.assert_told(scene, "node 'box' is renamed to 'box_2'")
        notes = json.loads(self.gloam("info", scene, "--json").stdout)["notes"]
        self.assertTrue(any("unit = 0.001" in note["hint"] for note in notes), notes)
        self.assertTrue(all(note["line"] == 1 for note in notes), notes)

    def test_of_props(self):
        scene = self.write("s.toml", "[[prop]]\nname = 'c'\nkind = 'chair'\nsize = [50, 50, 50]\n")
        self.assert_told(scene, "prop 'c': it is")

    def test_of_height_fields(self):
        self.write("g.obj", box((0, 0, 0), (1, 1, 0.2)))
        scene = self.write("s.toml", "[[hfield]]\nname = 'g'\nfile = 'g.obj'\nlow = [-5, -5]\nhigh = [5, 5]\n")
        self.assert_told(scene, "samples missed the mesh: most of this ground is filled in")
        self.assertIn("12 triangles rendered", self.gloam("info", scene).stdout)

    def test_of_robots_in_generated_places(self):
        self.write("ball.xml", BALL)
        text = "[environment.bedroom]\nseed = 1\n[[robot]]\nname = 'go'\nfile = 'ball.xml'\nposition = [0, 0, {}]\n"
        self.assertEqual(self.gloam("info", self.write("good.toml", text.format(0.2))).stderr, "")
        self.assert_told(self.write("s.toml", text.format(0.02)), "robot 'go' starts 0.08 m deep in ")

    def test_what_is_not_supported_is_told_too(self):
        self.write("a.xml", BALL.replace("<worldbody>", "<option integrator='Euler'/><worldbody>"))
        self.write("b.xml", BALL.replace("<worldbody>", "<option integrator='RK4'/><worldbody>"))
        scene = self.write("s.toml", "[environment]\nfile = 'a.xml'\n[[robot]]\nname = 'r'\nfile = 'b.xml'\nposition = [0, 0, 1]\n")
        for result in self.commands(scene):
            self.assertEqual(result.stderr.count("not supported: "), 1, result.stderr)
            self.assertIn("integrator", result.stderr)
        self.assertIn("hint", json.loads(self.gloam("info", scene, "--json").stdout)["unsupported"][0])


class Rooms(ProgramTest):
    def test_a_robot_stands_in_a_scanned_room(self):
        self.write("room.obj", box((0, 0, 0), (5, 4, 2.5), [face[::-1] for face in FACES], "room"))
        self.write("ball.xml", BALL)
        scene = self.write("s.toml", "[environment]\nfile = 'room.obj'\n[[robot]]\nname = 'go'\nfile = 'ball.xml'\nposition = [2, 2, 0.1]\n")
        result = self.gloam("run", scene, "--duration", "1", "--output", "metrics", "--out", "run")
        self.assertIn("'room' faces inwards: it is treated as a room", result.stderr)
        self.assertNotIn("starts", result.stderr)


class Convert(ProgramTest):
    def report(self, *arguments):
        return json.loads(self.gloam("convert", self.folder / "box.obj", "--json", *arguments).stdout)

    def test_takes_what_an_object_takes(self):
        self.write("box.obj", box((0, 0, 0), (1, 2, 3)))
        self.assertEqual(self.report()["size"], [1, 2, 3])
        self.assertEqual(self.report("--scale", "2")["size"], [2, 4, 6])
        self.assertEqual(self.report("--scale", "1,1,2")["size"], [1, 2, 6])
        self.assertEqual(self.report("--up", "y")["size"], [1, 3, 2])
        self.assertAlmostEqual(self.report("--unit", "0.5", "--density", "100")["mass"], 75, places=3)
        self.assertAlmostEqual(self.report("--mass", "4")["mass"], 4)
        self.assertEqual(self.report("--concavity", "0.5", "--max-hulls", "3", "--colliders", "hull")["colliders"], ["hull"])

    def test_refuses_what_an_object_refuses(self):
        self.write("box.obj", box((0, 0, 0), (1, 2, 3)))
        for bad in (["--scale", "0"], ["--scale", "1,2"], ["--up", "x"], ["--density", "-1"]):
            self.gloam("convert", self.folder / "box.obj", *bad, expect=2)
        for bad in (["--concavity", "7"], ["--max-hulls", "0"]):
            self.assertIn(bad[0][2:].replace("-", "_"), self.gloam("convert", self.folder / "box.obj", *bad, expect=1).stderr)


if __name__ == "__main__":
    unittest.main()
