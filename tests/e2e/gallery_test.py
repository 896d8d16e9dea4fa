"""Every scene of ./gloam gallery still renders, and docs/gallery agrees with the chapters in tools/gallery."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fetch_data
from e2e.support import PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "tools" / "gallery"))
import gallery  # noqa: E402
import models  # noqa: E402
import page  # noqa: E402
import pixels  # noqa: E402
import plot  # noqa: E402
from chapters import read_chapters  # noqa: E402

MEGABYTE = 1 << 20


def gallery_run(*arguments):
    return subprocess.run([sys.executable, ROOT / "tools" / "gallery" / "gallery.py", *arguments], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True)


class Gallery(unittest.TestCase):
    def scratch(self):
        (ROOT / "build").mkdir(exist_ok=True)
        folder = tempfile.TemporaryDirectory(prefix="gallery_test_", dir=ROOT / "build")
        self.addCleanup(folder.cleanup)
        return Path(folder.name)

    def test_every_scene_renders_to_something_to_see(self):
        folder = self.scratch()
        done = gallery_run("--quick", "--out", folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        for chapter in read_chapters(gallery.HERE):
            for picture in gallery.one_of_each_place(chapter.pictures):
                self.assertTrue((folder / f"{picture.file_name}.jpg").exists(), picture.name)

    def test_a_picture_is_the_same_each_time(self):
        folders = [self.scratch(), self.scratch()]
        for folder in folders:
            self.assertEqual(gallery_run("--quick", "--only", "materials/g", "--out", folder).returncode, 0)
        first, second = ({path.name: path.read_bytes() for path in folder.glob("*.jpg")} for folder in folders)
        self.assertGreaterEqual(len(first), 3)
        self.assertEqual(first, second)

    def test_pages_and_scenes_agree_with_the_chapters(self):
        chapters, book = read_chapters(gallery.HERE), gallery.BOOK
        pictures = [picture for chapter in chapters for picture in chapter.pictures]
        names = {picture.file_name for picture in pictures}
        self.assertEqual({path.stem for path in book.glob("*.jpg")}, names, "missing or superfluous pictures: ./gloam gallery --only NAME")
        self.assertEqual({path.stem for path in (book / "scenes").iterdir()}, names)
        texts = page.pages(chapters, book)
        self.assertEqual({path.name for path in book.iterdir() if path.suffix != ".jpg"}, {"scenes", *texts}, "no other files belong here")
        self.assertEqual(set(texts), {"README.md", *(f"{chapter.key}.md" for chapter in chapters)})
        for picture in pictures:
            self.assertEqual((book / "scenes" / f"{picture.file_name}.toml").read_text(), picture.scene(),
                             f"{picture.name} has changed since its picture was made: ./gloam gallery --only {picture.name}")
        for name, text in texts.items():
            self.assertEqual((book / name).read_text(), text, f"{name} is out of date: ./gloam gallery --text-only")
        size = sum(path.stat().st_size for path in book.rglob("*") if path.is_file())
        self.assertLess(size, 4 * MEGABYTE)

    def test_text_only_writes_a_page_per_chapter_and_an_index_that_leads_to_each(self):
        folder = self.scratch()
        chapters = read_chapters(gallery.HERE)
        for chapter in chapters[:2]:
            for picture in chapter.pictures[:3]:
                (folder / f"{picture.file_name}.jpg").touch()
        (folder / "removed_chapter.md").touch()
        done = gallery_run("--text-only", "--out", folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({path.name for path in folder.glob("*.md")}, {"README.md", *(f"{chapter.key}.md" for chapter in chapters[:2])})
        for chapter in chapters[:2]:
            self.assertIn(f"]({chapter.key}.md)", (folder / "README.md").read_text())
            text = (folder / f"{chapter.key}.md").read_text()
            self.assertEqual([picture.key for picture in chapter.pictures if f"]({picture.file_name}.jpg)" in text],
                             [picture.key for picture in chapter.pictures[:3]])

    def test_only_without_a_match_is_an_error(self):
        done = gallery_run("--only", "no such picture")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no picture name contains 'no such picture'", done.stderr)


class Plots(unittest.TestCase):
    def test_axes_have_round_numbers_that_lie_in_the_range(self):
        self.assertEqual([words for _, words in plot.ticks(-0.9, 6.9)], ["0", "1", "2", "3", "4", "5", "6"])
        self.assertEqual([words for _, words in plot.ticks(0, 1.2)], ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0", "1.2"])
        for low, high in [(0, 1), (-3e-4, 2e-4), (995, 1007), (-1e6, 1e6)]:
            values = [value for value, _ in plot.ticks(low, high)]
            self.assertTrue(4 <= len(values) <= 11 and low - 1e-9 <= values[0] and values[-1] <= high + 1e-9, values)

    def test_a_value_is_drawn_where_the_axes_say(self):
        picture = plot.Plot((360, 240), [0, 1], [-1, 1], "rate [rad/s]")
        picture.series("gyro", [0, 1], [0.5, 0.5], (255, 90, 60))
        u, v = picture.at(0.5, 0.5)
        self.assertEqual(picture.rgb[3 * (v * 360 + u):][:3], bytes((255, 90, 60)))
        self.assertEqual(u, (picture.at(0, 0)[0] + picture.at(1, 0)[0]) / 2)
        self.assertLess(v, picture.at(0, 0)[1])

    def test_every_plot_says_what_it_is_of_and_the_unit(self):
        plots = [picture for chapter in read_chapters(gallery.HERE) for picture in chapter.pictures if picture.show == "signals"]
        self.assertGreaterEqual(len(plots), 2)
        for picture in plots:
            self.assertRegex(picture.axis, r"^[a-z ]+ \[[a-z/]+\]$", picture.name)
            self.assertLessEqual(set(picture.axis), set(plot.GLYPHS))


class FirstLook(unittest.TestCase):
    """Default pictures of robots. gallery_models.py checks all models of the packages."""
    ROBOTS = ["mjlab/mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml", *(f"robosuite/robosuite/models/assets/{name}" for name in (
        "robots/panda/robot.xml", "robots/jaco/robot.xml", "robots/baxter/robot.xml", "grippers/robotiq_gripper_140.xml", "objects/door.xml",
        "bullet_data/panda_description/urdf/hand.urdf", "grippers/fourier_left_hand.xml"))]

    def test_black_robots_hands_and_doors_are_seen_well(self):
        data = fetch_data.default_folder()
        if not data.exists():
            self.skipTest("the robots of the tests are not here: tests/fetch_data.py")
        with tempfile.TemporaryDirectory() as folder:
            for robot in self.ROBOTS:
                result = models.measure(PROGRAM, data / robot, data, Path(folder))
                self.assertIn("picture", result, f"{robot}: {result}")
                self.assertEqual(list(models.faults(result)), [], robot)


class Faults(unittest.TestCase):
    """Detection of faulty pictures."""

    def test_of_the_display(self):
        scene = bytes(range(40, 200)) * 10
        for name, grey, words in [("black", bytes(1600), "black"), ("white", bytes([255]) * 1600, "white"),
                                  ("half white", bytes([255]) * 900 + scene[:700], "white"),
                                  ("flat", bytes([128]) * 1600, "no contrast")]:
            self.assertIn(words, pixels.fault_of_display(grey) or "", name)
        self.assertIsNone(pixels.fault_of_display(scene))

    def test_of_light(self):
        self.assertIsNone(pixels.fault_of_light([0.0, 3.5, 1e6]))
        for value in (float("nan"), float("inf"), -1.0):
            self.assertIn("1 values of 2", pixels.fault_of_light([1.0, value]) or "")


if __name__ == "__main__":
    unittest.main()
