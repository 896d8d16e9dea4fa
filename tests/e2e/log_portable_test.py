"""A log is replayed where its folders were moved, and an embedded one where there is nothing else; it tells nothing of its machine."""
import io
import json
import os
import shutil
import struct
import sys
import zlib

import fetch_data
from e2e.log_readers_test import CUBE, ROBOT
from e2e.support import ProgramTest

SCENE = """[sim]
duration = 0.1
[[robot]]
name = "cart"
file = "../robots/cart/cart.xml"
[[robot]]
name = "arm"
file = "../robots/arm_description/urdf/arm.urdf"
position = [0, 4, 0.5]
[[object]]
name = "crate"
file = "{meshes}/crate.obj"
position = [2, 0, 1]
[[visual]]
name = "sign"
file = "sign/sign.gltf"
position = [3, 1, 1]
[[material]]
name = "crate"
bump = "pictures/bump.png"
[[randomize]]
option = "sky.file"
choice = ["pictures/one.hdr", "pictures/two.hdr"]
[sky]
file = "pictures/one.hdr"
[render]
tier = "direct"
spp = 1
"""

URDF = """<robot name="arm"><link name="root"/><link name="upper"><inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0"
iyz="0"/></inertial><visual><geometry><mesh filename="package://arm_description/meshes/upper.obj"/></geometry></visual>
<collision><geometry><mesh filename="package://arm_description/meshes/upper.stl"/></geometry></collision></link>
<joint name="shoulder" type="revolute"><parent link="root"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
</joint></robot>"""


def png():
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(range(r, r + 12)) for r in range(4))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def hdr(red):
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([red, 100, 100, 128]) * 8


def stl():
    corners = [(0, 0, 0), (.2, 0, 0), (0, .2, 0), (0, 0, .4)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return b"\0" * 80 + struct.pack("<I", 4) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *corners[a], *corners[b], *corners[c], 0) for a, b, c in faces)


def gltf():
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    return points, json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "skin.png"}],
        "buffers": [{"uri": "sign.bin", "byteLength": len(points)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}]})


class Portable(ProgramTest):
    def setUp(self):
        super().setUp()
        packages = fetch_data.packages(fetch_data.default_folder())
        if not packages.is_dir():
            raise self.skipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(packages))
        self.home = self.folder / "home" / "jane_doe"

    def write_bytes(self, name, data):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)

    def write_project(self, place, meshes="meshes"):
        """A scene with files beside it, above it and below, in MJCF, URDF with packages, glTF, OBJ with MTL, pictures."""
        points, sign = gltf()
        cart = ROBOT.replace("<worldbody>", '<asset><mesh name="hull" file="meshes/hull.stl"/></asset><worldbody>').replace(
            '<geom type="box" size="0.2 0.1 0.05" mass="4"/>', '<geom type="mesh" mesh="hull" mass="4"/>')
        for name, data in {"robots/cart/cart.xml": cart, "robots/cart/meshes/hull.stl": stl(),
                           "robots/arm_description/package.xml": "<package><name>arm_description</name></package>",
                           "robots/arm_description/urdf/arm.urdf": URDF, "robots/arm_description/meshes/upper.stl": stl(),
                           "robots/arm_description/meshes/upper.obj": "mtllib upper.mtl\nusemtl red\n" + CUBE,
                           "robots/arm_description/meshes/upper.mtl": "newmtl red\nKd 1 0 0\nmap_Kd paint.png\n",
                           "robots/arm_description/meshes/paint.png": png(),
                           "scenes/meshes/crate.obj": CUBE, "scenes/sign/sign.gltf": sign, "scenes/sign/sign.bin": points,
                           "scenes/sign/skin.png": png(), "scenes/pictures/bump.png": png(), "scenes/pictures/one.hdr": hdr(100),
                           "scenes/pictures/two.hdr": hdr(200), "scenes/night.toml": SCENE.format(meshes=meshes)}.items():
            self.write_bytes(f"{place}/{name}", data if isinstance(data, bytes) else data.encode())
        return self.folder / place / "scenes/night.toml"

    def gloam(self, *arguments, **more):
        return super().gloam(*arguments, env={"HOME": str(self.home), **more.pop("env", {})}, **more)

    def record(self, scene, *options, log="logs/run.mcap"):
        path = self.folder / log
        path.parent.mkdir(parents=True, exist_ok=True)
        self.gloam("record", scene, "-o", path, "--overwrite", *options)
        return path

    def forget(self):
        """As on another machine: nothing is in the cache."""
        shutil.rmtree(self.folder / "cache", ignore_errors=True)

    def verifies(self, log, *options, cwd=None):
        said = self.gloam("replay", log, "--verify", *options, cwd=cwd)
        self.assertRegex(said.stdout, "^0 of 50 steps differ", said.stdout + said.stderr)

    def all_bytes(self, log):
        """The log's bytes, and those of its chunks as they were before they were compressed."""
        import zstandard
        from mcap.records import Chunk
        from mcap.stream_reader import StreamReader
        data = log.read_bytes()
        parts = [data]
        for record in StreamReader(io.BytesIO(data), emit_chunks=True).records:
            if isinstance(record, Chunk):
                self.assertEqual(record.compression, "zstd")
                parts.append(zstandard.ZstdDecompressor().decompress(record.data, max_output_size=record.uncompressed_size))
        self.assertGreater(len(parts), 1)
        return b"\n".join(parts)

    def assert_tells_nothing(self, log):
        data = self.all_bytes(log)
        for word in (str(self.folder), self.folder.name, str(self.home), "jane_doe", os.path.expanduser("~") + "/", "/tmp/"):
            self.assertFalse(word.encode() in data, word)

    def test_a_log_beside_its_project_is_replayed_where_both_were_moved(self):
        log = self.record(self.write_project("project"), log="project/logs/run.mcap")
        self.assert_tells_nothing(log)
        self.verifies(log)
        (self.folder / "project").rename(self.folder / "elsewhere")
        self.forget()
        self.verifies(self.folder / "elsewhere/logs/run.mcap")
        self.verifies(self.folder / "elsewhere/logs/run.mcap", cwd="/")

    def test_a_log_far_away_is_replayed_on_this_machine_and_by_folder(self):
        scene = self.write_project("home/jane_doe/project")
        log = self.record(scene, log="logs/run.mcap")
        self.assert_tells_nothing(log)
        self.verifies(log, cwd="/")  # this machine remembers
        self.forget()
        self.assertIn("--folder", self.gloam("replay", log, "--verify", expect=1, cwd="/").stderr)
        self.verifies(log, "--folder", scene.parent, cwd="/")
        self.home.joinpath("project").rename(self.folder / "there")
        self.verifies(log, "--folder", self.folder / "there/scenes", cwd="/")
        self.verifies(log, "--folder", "there")  # the folder above: files are found by name and content
        self.verifies(log, cwd=self.folder / "there/scenes")
        log.rename(self.folder / "there/scenes/run.mcap")
        self.verifies(self.folder / "there/scenes/run.mcap", cwd="/")

    def test_an_embedded_log_needs_nothing_else(self):
        log = self.record(self.write_project("home/jane_doe/project"), "--embed")
        self.assert_tells_nothing(log)
        shutil.rmtree(self.home)
        self.forget()
        self.verifies(log, cwd="/")
        out = self.folder / "seen"
        self.gloam("replay", log, "--set", "sky.scale=0.5", "--out", out, "--output", "png", "--camera", "cart/front",
                   "--resolution", "16x12", cwd="/")
        self.assertTrue(list(out.rglob("*.png")))

    def test_paths_that_the_scene_gives_as_absolute_are_moved_too(self):
        meshes = self.folder / "project/scenes/meshes"
        log = self.record(self.write_project("project", meshes=meshes), log="project/run.mcap")
        self.assert_tells_nothing(log)
        (self.folder / "project").rename(self.folder / "moved")
        self.forget()
        self.verifies(self.folder / "moved/run.mcap", cwd="/")

    def test_files_outside_the_scenes_root_are_found_and_embedded(self):
        scene = self.write_project("home/jane_doe/project")
        far = self.home / "far"
        (self.home / "project/scenes/meshes").rename(far)
        scene.write_text(scene.read_text().replace("meshes/crate.obj", str(far / "crate.obj")))
        log = self.record(scene, "--embed", "--root", self.folder)
        self.assert_tells_nothing(log)
        self.verifies(log, cwd="/")
        shutil.rmtree(self.home)
        self.forget()
        self.verifies(log, cwd="/")

    def test_a_bare_model_is_moved(self):
        self.write_project("models")
        log = self.record(self.folder / "models/robots/cart/cart.xml", "--duration", "0.1", "--embed")
        self.assert_tells_nothing(log)
        shutil.rmtree(self.folder / "models")
        self.forget()
        self.verifies(log, cwd="/")

    def test_what_has_changed_is_named(self):
        scene = self.write_project("project")
        log = self.record(scene)
        cart = self.folder / "project/robots/cart/cart.xml"
        cart.write_text(cart.read_text().replace('mass="4"', 'mass="5"'))
        self.assertIn("cart.xml", self.gloam("replay", log, "--verify", expect=1).stderr)
        whole = self.record(self.write_project("project"), "--embed")
        cart.write_text(cart.read_text().replace('mass="4"', 'mass="5"'))
        self.verifies(whole)  # the log has the file that it was written with


if __name__ == "__main__":
    import unittest
    unittest.main()
