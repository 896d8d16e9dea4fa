"""`gloam report`: one page without a network, whole in a browser; tables as Parquet, read by pyarrow."""
import base64
import csv
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

import fetch_data
from e2e import browser
from e2e.support import PENDULUM, PROGRAM, ProgramTest, video_frames

DATA = fetch_data.default_folder()
VOID = {"meta", "img", "br", "line", "rect", "path", "circle"}
SCENE = """[scene]
name = "swing"
[sim]
duration = 1
[[robot]]
name = "arm"
file = "pendulum.xml"
[[camera]]
name = "side"
position = [0, -2, 1]
look_at = [0, 0, 1]
rate = 10
[record]
outputs = ["video", "metrics"]
"""


class Page(HTMLParser):
    """Checks that tags are closed in order, and collects what a browser would load."""

    def __init__(self, text):
        super().__init__()
        self.open, self.problems, self.loads, self.images, self.tags, self.text = [], [], [], [], [], ""
        self.feed(text)
        self.close()
        self.problems += [f"<{tag}> is not closed" for tag in self.open]

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            if name in ("src", "href", "xlink:href", "data", "action", "srcset", "poster"):
                (self.images if (value or "").startswith("data:image/") else self.loads).append(value)
            if name.startswith("on"):
                self.problems.append(f"{name} of <{tag}>")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        if not self.open or self.open.pop() != tag:
            self.problems.append(f"</{tag}> at line {self.getpos()[0]}")

    def handle_data(self, data):
        self.text += data


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        (cls.folder / "pendulum.xml").write_text(PENDULUM)
        (cls.folder / "swing.toml").write_text(SCENE)
        quick = ["--tier", "direct", "--spp", "1", "--resolution", "96x64", "--camera", "side"]
        for seed in (1, 2, 3):
            cls.gloam("run", "swing.toml", "--out", f"swing-00{seed}", "--seed", seed, *(["--mcap"] if seed == 1 else []), *quick)
        cls.gloam("replay", "swing-001/run.mcap", "--set", "camera.side.fovy=20", "--set", "render.tier=direct", "--set", "render.spp=1",
                  "--resolution", "96x64", "--camera", "side", "--out", "near")
        cls.said = cls.gloam("report", "swing-001", "swing-002", "swing-003", "near", "-o", "all.html", "--json").stdout
        cls.html = (cls.folder / "all.html").read_text()
        cls.page = Page(cls.html)

    @classmethod
    def gloam(cls, *arguments, expect=0):
        result = subprocess.run([str(PROGRAM), *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True, timeout=300)
        if result.returncode != expect:
            raise AssertionError(f"gloam {arguments}: {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
        return result

    def test_the_page_is_whole_and_loads_nothing(self):
        self.assertEqual(self.page.problems, [])
        self.assertEqual(self.page.loads, [])
        self.assertNotRegex(self.html, r"(?i)(https?:)?//[a-z0-9-]+\.[a-z]")
        self.assertNotRegex(self.html, r"(?i)@import|url\(|fetch\(|XMLHttpRequest|WebSocket|import\(")
        self.assertEqual(self.page.tags.count("script"), 1)
        self.assertIn("default-src 'none'", self.html)

    def test_pictures_are_those_of_the_videos(self):
        said = json.loads(self.said)
        self.assertEqual((said["runs"], said["pictures"], said["left_out"]), (4, 24, []))
        self.assertEqual(len(self.page.images), 24)
        for image in self.page.images:
            self.assertTrue(base64.b64decode(image.partition(",")[2], validate=True).startswith(b"\xff\xd8\xff"))
        self.assertEqual(len(set(self.page.images[:6])), 6, "the arm swings")
        self.assertNotEqual(self.page.images[0], self.page.images[18], "the replay is nearer")

    def test_numbers_are_those_of_the_runs(self):
        summary = json.loads((self.folder / "near/summary.json").read_text())
        self.assertIn(summary["final_state_hash"], self.page.text)
        self.assertIn("One motion:", self.page.text)
        for name in ("swing-001", "near"):
            self.assertIn(name, self.page.text)
        self.assertEqual(len(re.findall(r'class="charts"', self.html)), self.html.count("<h2>From above") + self.html.count("<h2>Over time"))

    def test_what_cannot_be_read_is_told_with_exit_code_3(self):
        broken = self.folder / "broken"
        shutil.copytree(self.folder / "swing-002", broken)
        (broken / "side.mp4").write_bytes((broken / "side.mp4").read_bytes()[:300])
        said = self.gloam("report", "swing-001", "broken", "missing", "-o", "partial.html", expect=3).stderr
        self.assertRegex(said, r"missing: is not a results folder")
        self.assertRegex(said, r"broken/side.mp4: ")
        page = Page((self.folder / "partial.html").read_text())
        self.assertEqual(page.problems, [])
        self.assertIn("Omitted", page.text)
        self.assertIn("is not a results folder", self.gloam("report", "missing", "-o", "none.html", expect=1).stderr)
        self.assertFalse((self.folder / "none.html").exists())
        self.assertIn("already", self.gloam("report", "swing-001", "-o", "all.html", expect=2).stderr)
        self.gloam("report", expect=2)

    def test_a_page_is_a_function_of_its_runs(self):
        self.gloam("report", "swing-001", "swing-002", "swing-003", "near", "-o", "again.html")
        self.assertEqual((self.folder / "again.html").read_text(), self.html)

    def test_the_program_alone_makes_pages_tables_and_plots(self):
        # As in a bundle or an installation (ARCHITECTURE.md): no interpreter in PATH, no variables, and no network where that can be had.
        unshare = shutil.which("unshare")
        isolated = unshare and subprocess.run([unshare, "-rn", "true"], capture_output=True).returncode == 0
        (self.folder / "line.tum").write_text("".join(f"{t} {t} 0 0 0 0 0 1\n" for t in range(5)))
        for command in ("report swing-001 swing-002 swing-003 near -o alone.html", "export near/metrics.csv --to parquet --out alone.parquet",
                        "evaluate line.tum --reference line.tum --plot alone.svg"):
            made = subprocess.run([*([unshare, "-rn"] if isolated else []), str(PROGRAM), *command.split()], cwd=self.folder, timeout=300,
                                  env={"PATH": "/nonexistent"}, capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
        self.assertEqual((self.folder / "alone.html").read_text(), self.html)
        self.assertEqual((self.folder / "alone.parquet").read_bytes()[-4:], b"PAR1")
        self.assertTrue((self.folder / "alone.svg").read_text().startswith("<svg "))

    @unittest.skipUnless(browser.find(), "no Chromium is installed")
    def test_a_browser_has_no_complaints(self):
        page = browser.Browser(1300, 1000)
        self.addCleanup(page.close)
        page.call("Page.navigate", url=(self.folder / "all.html").as_uri())
        ready = "document.readyState=='complete' && [...document.images].filter(i=>i.getAttribute('src')).every(i=>i.complete&&i.naturalWidth>0)"
        for _ in range(50):
            if page.call("Runtime.evaluate", expression=ready, returnByValue=True)["result"].get("value"):
                break
        else:
            self.fail("pictures do not load")
        self.assertEqual(page.problems, [])
        wide = page.call("Runtime.evaluate", expression="document.documentElement.scrollWidth", returnByValue=True)["result"]["value"]
        self.assertLessEqual(wide, 1300)


class Parquet(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if not fetch_data.packages(DATA).is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(fetch_data.packages(DATA)))

    def read(self, path):
        import pyarrow.parquet
        return pyarrow.parquet.read_table(path)

    def test_a_strangers_topics_are_read_by_pyarrow(self):
        log = fetch_data.robot_log(DATA)
        for i, topic in enumerate(t["name"] for t in json.loads(self.gloam("info", log, "--json").stdout)["topics"] if t["messages"] > 0):
            table, columns = self.folder / f"{i}.csv", self.folder / f"{i}.parquet"
            if subprocess.run([str(PROGRAM), "export", str(log), "--to", "csv", "--topic", topic, "--out", str(table)], capture_output=True).returncode:
                continue  # more columns than a table has
            self.gloam("export", log, "--to", "parquet", "--topic", topic, "--out", columns)
            read = self.read(columns)
            with table.open(newline="") as stream:
                rows = list(csv.reader(stream))
            self.assertEqual(read.column_names, rows[0], topic)
            self.assertEqual(read.num_rows, len(rows) - 1, topic)
            for k, name in enumerate(rows[0]):
                for text, value in zip((row[k] for row in rows[1:]), read.column(k).to_pylist()):
                    if isinstance(value, str):
                        self.assertEqual(text, value, name)
                    elif value is None or math.isnan(value):
                        self.assertIn(text, ("", "nan", "-nan"), name)
                    else:
                        self.assertEqual(float(text), float(value), name)
        self.assertGreaterEqual(i, 3)

    def test_types_nulls_and_row_groups(self):
        rows = 70_000
        table = self.write("m.csv", "time_s,\"a,b\",empty\n" + "".join(f"{i / 8},{'' if i % 3 == 0 else i * 1e-3},\n" for i in range(rows)))
        self.gloam("export", table, "--to", "parquet", "--out", self.folder / "m.parquet")
        read = self.read(self.folder / "m.parquet")
        self.assertEqual([str(t) for t in read.schema.types], ["double"] * 3)
        self.assertEqual(read.column("time_s").to_pylist(), [i / 8 for i in range(rows)])
        self.assertEqual(read.column("a,b").to_pylist(), [None if i % 3 == 0 else float(f"{i * 1e-3}") for i in range(rows)])
        self.assertEqual(read.column("empty").null_count, rows)
        import pyarrow.parquet
        file = pyarrow.parquet.ParquetFile(self.folder / "m.parquet")
        self.assertEqual(file.metadata.num_row_groups, 2)
        self.assertTrue(file.metadata.created_by.startswith("gloam"))
        self.gloam("export", table, "--to", "parquet", "--out", self.folder / "m.parquet", expect=1)  # is there already
        bad = self.write("bad.csv", "a,b\n1\n2,3\n")
        self.assertIn("bad.csv:2", self.gloam("export", bad, "--to", "parquet", "--out", self.folder / "x.parquet", expect=1).stderr)

    def test_a_table_without_rows(self):
        self.gloam("export", self.write("none.csv", "a,b\n"), "--to", "parquet", "--out", self.folder / "none.parquet")
        read = self.read(self.folder / "none.parquet")
        self.assertEqual((read.num_rows, read.column_names), (0, ["a", "b"]))


class Pictures(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if not fetch_data.packages(DATA).is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(fetch_data.packages(DATA)))

    def decoded(self, path, pixels):
        return subprocess.run(["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", pixels, "-"], capture_output=True,
                              check=True).stdout

    def test_pictures_of_a_log_are_those_of_its_messages(self):
        from mcap.reader import make_reader
        from rosbags.typesys import Stores, get_typestore
        store = get_typestore(Stores.ROS2_KILTED)
        self.write("pendulum.xml", PENDULUM)
        scene = self.write("swing.toml", SCENE)
        self.gloam("record", scene, "-o", "run.mcap", "--topics", "*", "--tier", "direct", "--spp", "1", "--resolution", "64x48")
        topics = {t["name"]: t["type"] for t in json.loads(self.gloam("info", "run.mcap", "--json").stdout)["topics"] if t["messages"] > 0}
        raw = next(n for n, t in topics.items() if t == "sensor_msgs/msg/Image" and n.endswith("image_raw"))
        messages = []
        with (self.folder / "run.mcap").open("rb") as stream:
            for _, channel, message in make_reader(stream).iter_messages(topics=[raw]):
                messages.append(store.deserialize_cdr(message.data, "sensor_msgs/msg/Image"))
        self.gloam("export", "run.mcap", "--to", "png", "--topic", raw, "--out", "pictures")
        files = sorted((self.folder / "pictures").glob("*.png"))
        self.assertEqual(len(files), len(messages))
        for file, message in zip(files, messages):
            self.assertEqual(self.decoded(file, "rgb24"), message.data.tobytes(), file.name)
        with (self.folder / "pictures/stamps.csv").open() as stream:
            stamps = [int(row["stamp_ns"]) for row in csv.DictReader(stream)]
        self.assertEqual(stamps, [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages])
        self.gloam("export", "run.mcap", "--to", "mp4", "--topic", raw, "--out", "video.mp4")
        self.assertEqual(video_frames(self.folder / "video.mp4"), len(messages))
        for name, kind in topics.items():
            if kind == "sensor_msgs/msg/CompressedImage" or (kind == "sensor_msgs/msg/Image" and name != raw):
                folder = name.replace("/", "_")
                self.gloam("export", "run.mcap", "--to", "mp4", "--topic", name, "--out", folder + ".mp4")
                self.assertGreater(video_frames(self.folder / (folder + ".mp4")), 0)
        for to in ("png", "mp4"):
            self.assertIn("contains no images", self.gloam("export", "run.mcap", "--to", to, "--topic", "/clock", "--out", "x", expect=1).stderr)
        self.gloam("export", "run.mcap", "--to", "png", "--topic", raw, "--out", "pictures", expect=2)  # is there already


if __name__ == "__main__":
    unittest.main()
