"""Outputs have the same names in render, run and replay."""
import unittest

from e2e.support import PENDULUM, ProgramTest

SMALL = ("--camera", "side", "--resolution", "16x12", "--spp", "1", "--no-denoise")


class Outputs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.model = self.write("pendulum.xml", PENDULUM)

    def names(self, folder):
        return sorted({path.suffix or path.name for path in (self.folder / folder).rglob("*") if path.is_file()})

    def test_channels_and_files_everywhere(self):
        self.gloam("render", self.model, *SMALL, "--output", "rgb,depth", "--out", "channels")
        self.gloam("render", self.model, *SMALL, "--output", "png,depth_exr", "--out", "files")
        stills = {path.name for path in (self.folder / "channels").iterdir()}
        self.assertEqual({name.split("side")[-1] for name in stills if "side" in name}, {".png", "_depth.png", "_depth.exr"})
        stills = {path.name for path in (self.folder / "files").iterdir()}
        self.assertEqual({name.split("side")[-1] for name in stills if "side" in name}, {".png", "_depth.exr"})
        self.gloam("run", self.model, *SMALL, "--duration", "0.01", "--output", "rgb,depth", "--out", "run", "--mcap")
        self.assertEqual({path.name for path in (self.folder / "run").rglob("*") if path.is_dir()} & {"rgb", "depth", "depth_exr", "normal"},
                         {"rgb", "depth", "depth_exr"})
        self.gloam("replay", "run/run.mcap", "--output", "normal,depth_png", "--out", "again", "--resolution", "16x12")
        self.assertEqual({path.name for path in (self.folder / "again").rglob("*") if path.is_dir()} & {"rgb", "depth", "depth_exr", "normal"},
                         {"depth", "normal"})

    def test_scenes_take_channels(self):
        scene = self.write("scene.toml", '[environment]\nfile = "pendulum.xml"\n[sim]\nduration = 0.01\n[record]\noutputs = ["depth"]\n'
                                         '[render]\nspp = 1\n')
        self.gloam("run", scene, "--resolution", "16x12", "--out", "scene")
        self.assertTrue(list((self.folder / "scene").rglob("depth_exr")))

    def test_errors_name_the_nearest(self):
        for command in ("render", "run"):
            result = self.gloam(command, self.model, "--output", "depht_png", expect=2)
            self.assertIn("depth_png", result.stderr)
            self.assertIn("rgb", self.gloam(command, self.model, "--output", "rbg", expect=2).stderr)
        self.assertIn("gloam run", self.gloam("render", self.model, "--output", "video", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
