"""Scenes made of hostile, damaged and absurd files, through the program: one clear line or a picture, in bounded time and memory, never a crash."""
import json
import math
import os
import resource
import struct
import subprocess
import unittest
import zlib

from e2e.support import PROGRAM, ROOT, ProgramTest

LIMIT = 4 << 30  # of address space [bytes]: far more than any of these scenes should need, less than they ask for
SECONDS = 100  # a machine that does other things too; most take less than two
LAMP = '[[light]]\nname = "lamp"\ntype = "point"\nposition = [0, -1, 2]\nintensity = 100\n'
CAMERA = '[[camera]]\nname = "eye"\nposition = [0.3, -3, 1]\nlook_at = [0, 0, 0]\nfovy = 45\nwidth = 48\nheight = 32\n'
MODEL = '<mujoco><worldbody><geom name="floor" type="plane" size="3 3 .1"/></worldbody></mujoco>'
ROBOT = '[[robot]]\nname = "floor"\nfile = "floor.xml"\n'
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
FLAT = "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 1 1 2\nf 3 3 3\n"


def ply(rows, faces="3 0 1 2\n"):
    return (f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {faces.count(chr(10))}\nproperty list uchar int vertex_indices\nend_header\n"
            + "".join(f"{row}\n" for row in rows) + faces)


def stl(triangles):
    rows = b"".join(struct.pack("<12fH", 0, 0, 1, *(float(v) for v in corners), 0) for corners in triangles)
    return b"h" * 80 + struct.pack("<I", len(triangles)) + rows


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(range(width)) * 3 for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b""))


def exr(width, height, values):
    """R, G, B as 32-bit floats in plain scan lines; every channel of pixel i holds values[i]."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = (struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels) + attribute(b"compression", b"compression", b"\0")
            + attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
            + attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
            + b"\0")
    row = 8 + 12 * width
    offsets = b"".join(struct.pack("<Q", len(head) + 8 * height + y * row) for y in range(height))
    lines = b"".join(struct.pack("<ii", y, 12 * width) + 3 * struct.pack(f"<{width}f", *values[y * width:(y + 1) * width]) for y in range(height))
    return head + offsets + lines


class HostileTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("floor.xml", MODEL)

    def put(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def render(self, scene, expect, *options, limit=LIMIT):
        path = self.write("scene.toml", ROBOT + CAMERA + scene)
        bounded = lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))  # noqa: E731
        return self.gloam("render", path, "--spp", "4", "--no-denoise", "--out", "out", *options, expect=expect, timeout=SECONDS,
                          preexec_fn=bounded)

    def refuses(self, scene, *words, options=(), limit=LIMIT, code=1):
        result = self.render(scene, code, *options, limit=limit)
        errors = [line for line in result.stderr.splitlines() if "error" in line.lower()]
        self.assertEqual(len(errors), 1, result.stderr)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertEqual(result.stdout, "")
        return errors[0]

    def draws(self, scene, *words, options=(), limit=LIMIT):
        """Its notes on stderr hold `words`."""
        result = self.render(scene, 0, *options, limit=limit)
        self.assertTrue((self.folder / "out" / "eye.png").stat().st_size > 50)
        for word in words:
            self.assertIn(word, result.stderr)
        return result


def visual(file):
    return LAMP + f'[[visual]]\nname = "thing"\nfile = "{file}"\n'


class Meshes(HostileTest):
    def test_cut_short(self):
        glb = (ROOT / "assets/models/lantern/lantern.glb").read_bytes()
        whole = {"a.glb": glb, "a.ply": ply(["0 0 0", "1 0 0", "0 1 0"]).encode(), "a.stl": stl([[0, 0, 0, 1, 0, 0, 0, 1, 0]] * 4)}
        for name, content in whole.items():
            for share in (0.02, 0.4, 0.97):
                with self.subTest(name, share=share):
                    self.put(name, content[:int(len(content) * share)])
                    self.refuses(visual(name), "scene.toml", name)

    def test_obj_cut_short(self):  # in the middle of a vertex, of a face
        self.put("a.obj", OBJ[:13])
        self.refuses(visual("a.obj"), "a.obj:2")
        self.put("a.obj", OBJ[:-5])
        self.draws(visual("a.obj"), "1 triangles without area are ignored")

    def test_vertices_that_are_no_numbers(self):
        self.put("a.ply", ply(["0 0 0", "nan 0 0", "0 1 0"]))
        self.refuses(visual("a.ply"), "scene.toml", "a.ply")
        self.put("a.obj", OBJ.replace("v 1 0 0", "v nan 0 0"))
        self.refuses(visual("a.obj"), "a.obj")
        self.put("a.stl", stl([[0, 0, 0, math.nan, 0, 0, 0, 1, 0]]))
        self.refuses(visual("a.stl"), "a.stl")
        self.put("a.stl", stl([[0, 0, 0, math.inf, 0, 0, 0, 1, 0]]))
        self.refuses(visual("a.stl"), "a.stl")

    def test_nothing_to_draw(self):
        self.put("flat.obj", FLAT)
        self.draws(visual("flat.obj"), "3 triangles without area are ignored")
        for name, content in {"empty.stl": stl([]), "empty.ply": ply([], ""), "empty.obj": "v 0 0 0\n"}.items():
            with self.subTest(name):
                self.put(name, content)
                self.draws(visual(name), "nothing to draw")

    def test_a_lamp_without_a_face(self):
        self.put("flat.obj", FLAT)
        lamp = '[[light]]\nname = "mesh"\ntype = "mesh"\nfile = "flat.obj"\nflux = 100\n'
        self.refuses(lamp, "scene.toml", "flat.obj", "no triangle")
        self.put("flat.obj", "v 0 0 0\n")
        self.refuses(lamp, "scene.toml", "flat.obj", "no triangle")

    def test_a_flat_height_field_and_a_flat_mesh_of_the_model(self):
        self.write("floor.xml", '<mujoco><asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 .1" elevation="0 0 0 0"/></asset>'
                   '<worldbody><geom type="hfield" hfield="h"/></worldbody></mujoco>')
        self.draws(LAMP)
        self.put("flat.obj", FLAT)
        self.write("floor.xml", '<mujoco><asset><mesh name="m" file="flat.obj"/></asset><worldbody><geom type="mesh" mesh="m"/></worldbody></mujoco>')
        self.refuses(LAMP, "floor.xml")

    def test_more_than_there_is_memory_for(self):
        with open(self.folder / "huge.stl", "wb") as out:
            out.write(b"h" * 80 + struct.pack("<I", 30_000_000))
            out.truncate(84 + 50 * 30_000_000)
        self.refuses(visual("huge.stl"), "huge.stl", "needs about", "GiB", "ulimit -v")


class Pictures(HostileTest):
    def test_cut_short(self):
        self.put("a.obj", "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 0 1\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl m\nf 1/1 2/2 3/3\n")
        self.put("a.mtl", "newmtl m\nmap_Kd a.png\n")
        self.put("a.png", png(60, 60))
        self.assertNotIn("is ignored", self.draws(visual("a.obj")).stderr)
        self.put("a.png", png(60, 60)[:120])
        self.draws(visual("a.obj"), "an image is ignored", "a.png")

    def test_skies(self):
        sky = '[sky]\nfile = "a.{}"\n'
        hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes([128, 128, 128, 129]) * 32
        self.put("a.hdr", hdr)
        self.draws(sky.format("hdr"))
        self.put("a.hdr", hdr[:-50])
        self.refuses(sky.format("hdr"), "scene.toml", "a.hdr")
        good = exr(8, 4, [1.0] * 32)
        self.put("a.exr", good)
        self.draws(sky.format("exr"))
        self.put("a.exr", good[:-50])
        self.refuses(sky.format("exr"), "a.exr")
        for bad in (math.nan, math.inf):
            self.put("a.exr", exr(8, 4, [1.0] * 31 + [bad]))
            self.refuses(sky.format("exr"), "a.exr", "not finite", "column 7", "row 3")
        self.put("a.exr", exr(8, 4, [1.0] * 31 + [-2.0]))  # what filters leave: counts as black
        self.draws(sky.format("exr"))

    def test_more_than_there_is_memory_for(self):
        self.put("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 5000 +X 10000\n" + bytes(200_000_000))
        self.refuses('[sky]\nfile = "a.hdr"\n', "a.hdr", "limit", limit=2 << 30)
        model = LAMP
        every = ["--output", "rgb,radiance,samples,depth,normal,albedo,segmentation,motion"]
        error = self.refuses(model, "16384 x 16384 pixels", "needs about", "GiB", "ulimit -v", "lower the resolution",
                             options=[*every, "--resolution", "16384x16384"])
        self.assertNotIn("interrupted", error)
        self.refuses(model, "memory", options=["--resolution", "16384x16384", "--tier", "interactive"])
        self.refuses(model, "16384", options=["--resolution", "16385x16"], code=2)
        scene = self.folder / "scene.toml"
        scene.write_text(scene.read_text().replace("width = 48\nheight = 32", "width = 16384\nheight = 16384"))
        bounded = lambda: resource.setrlimit(resource.RLIMIT_AS, (LIMIT, LIMIT))  # noqa: E731
        for arguments in (["render", scene, "--out", "out"], ["run", scene, "--out", "record", "--duration", "0.1"],
                          ["run", scene, "--view", "--port", "0", "--camera", "eye", "--duration", "0.1"]):
            with self.subTest(arguments[0], view="--view" in arguments):
                self.assertIn("memory", self.gloam(*arguments, expect=1, timeout=SECONDS, preexec_fn=bounded).stderr)
        self.assertFalse((self.folder / "record").exists(), "an older recording would be lost")


class Volumes(HostileTest):
    VOLUME = ('[[volume]]\nname = "fog"\nposition = [0, 0, 1]\nsize = [1, 1, 1]\nmedium = "fog"\ndensity = 1e-4\ngrid = "a.npy"\n')

    def npy(self, shape, kind="<f4", size=None):
        head = str({"descr": kind, "fortran_order": False, "shape": shape}).encode()
        head = head.ljust(117) + b"\n"
        with open(self.folder / "a.npy", "wb") as out:
            out.write(b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head)
            out.truncate(10 + len(head) + (size if size is not None else math.prod(shape) * int(kind[2])))

    def test_of_two_gibibytes(self):
        self.npy((512, 1024, 1024))
        self.refuses(LAMP + self.VOLUME, "scene.toml", "a.npy", "1024 x 1024 x 512 voxels", "limit")
        self.npy((256, 1024, 1024), "<f8")
        self.refuses(LAMP + self.VOLUME, "a.npy", "needs about 3.0 GiB", "fewer voxels", limit=3 << 30)

    def test_that_claim_more_than_they_hold(self):
        self.npy((64, 64, 64), size=100)
        self.refuses(LAMP + self.VOLUME, "a.npy", "its shape requires")
        self.npy((1 << 40, 1 << 40, 1 << 40), size=100)
        self.refuses(LAMP + self.VOLUME, "a.npy", "limit")


class Places(HostileTest):
    def test_files_that_are_no_files(self):
        os.mkfifo(self.folder / "pipe.obj")
        (self.folder / "folder.obj").mkdir()
        (self.folder / "device.obj").symlink_to("/dev/zero")
        (self.folder / "loop.obj").symlink_to("loop.obj")
        for name in ("pipe", "folder", "device", "loop", "missing"):
            for scene in (visual(f"{name}.obj"), f'[[light]]\nname = "mesh"\ntype = "mesh"\nfile = "{name}.obj"\nflux = 100\n',
                          f'[sky]\nfile = "{name}.obj"\n', Volumes.VOLUME.replace("a.npy", f"{name}.obj"),
                          f'[[light]]\nname = "ies"\ntype = "point"\nies = "{name}.obj"\n'):
                with self.subTest(name, scene=scene):
                    self.refuses(scene, "scene.toml", f"{name}.obj")

    def test_links_out_of_the_root(self):
        outside = self.folder.parent / f"{self.folder.name}_outside.obj"
        outside.write_text(OBJ)
        self.addCleanup(outside.unlink)
        (self.folder / "link.obj").symlink_to(outside)
        self.refuses(visual("link.obj"), "scene.toml", "link.obj", options=["--strict"])

    def test_a_camera_inside_of_things(self):
        self.write("floor.xml", '<mujoco><worldbody><geom type="plane" size="3 3 .1"/><geom type="box" size=".5 .5 .5" pos="0.3 -3 1"/>'
                   '<geom type="sphere" size="5"/></worldbody></mujoco>')
        self.draws(LAMP)
        self.put("a.obj", OBJ.replace("v 0 0 0", "v -90 -90 -90").replace("v 1 0", "v 90 0").replace("v 0 1", "v 0 90").replace("0 0 1", "0 0 90"))
        self.draws(visual("a.obj"))
        self.draws(Volumes.VOLUME.replace('grid = "a.npy"\n', "").replace("size = [1, 1, 1]", "size = [9, 9, 9]"))


class Crowds(HostileTest):
    def lamps(self, count):
        return "".join(f'[[light]]\nname = "l{i}"\ntype = "point"\nposition = [{i % 300}, {i // 300}, 3]\nintensity = 5\n' for i in range(count))

    def test_fifty_thousand_lamps(self):
        self.draws(self.lamps(50_000))

    def test_lights_of_a_file(self):
        for count in (100_000, 1_000_000):
            nodes = ",".join(f'{{"translation":[{i % 300},3,{i // 300}],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}' for i in range(count))
            self.put("crowd.gltf", '{"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":'
                     '[{"type":"point","intensity":5}]}},"scene":0,"scenes":[{"nodes":' + json.dumps(list(range(count))) + f'}}],"nodes":[{nodes}]}}')
            with self.subTest(count):
                if count == 100_000:
                    self.draws('[[visual]]\nname = "crowd"\nfile = "crowd.gltf"\n')
                else:
                    self.refuses('[[visual]]\nname = "crowd"\nfile = "crowd.gltf"\n', "crowd.gltf", "limit")

    def test_a_million_lamps(self):
        self.refuses(self.lamps(1_000_000), "scene.toml", "limit")



class Texts(ProgramTest):
    """Texts that are deep, wide or meant for the terminal."""

    def refuses(self, *arguments, words, code=1, **how):
        result = self.gloam(*arguments, expect=code, timeout=SECONDS, **how)
        errors = [line for line in result.stderr.splitlines() if "error" in line]
        self.assertEqual(len(errors), 1, result.stderr)
        for word in words:
            self.assertIn(word, errors[0])

    def test_that_nest_without_end(self):
        deep = "a" + ".a" * 40_000
        for name, text, line in [("key.toml", f"\n{deep} = 1\n", 2), ("table.toml", f"[{deep}]\n", 1), ("model.toml", f"[mujoco]\n[mujoco.{deep}]\n", 2),
                                 ("array.toml", "a = " + "[" * 40_000, 1), ("m.xml", "<mujoco>" + "<body>" * 40_000, 1),
                                 ("m.urdf", "<robot>" + "<link>" * 40_000, 1)]:
            with self.subTest(name):
                self.write(name, text)
                self.refuses("info", name, words=[f"{name}:{line}", "nested more than"])
        self.write("s.toml", '[[visual]]\nname = "v"\nfile = "a.dae"\n')
        self.write("a.dae", "<COLLADA>" + "<node>" * 40_000)
        self.refuses("render", "s.toml", words=["a.dae:1", "nested more than"])

    def test_that_would_take_a_minute(self):
        self.write("wide.xml", "<mujoco><worldbody><geom " + " ".join(f'a{i}="1"' for i in range(100_000)) + "/></worldbody></mujoco>")
        parts = [f'<link name="{i}"/>' for i in range(2001)]
        parts += [f'<joint name="j{i}" type="fixed"><parent link="{i}"/><child link="{i + 1}"/></joint>' for i in range(2000)]
        self.write("chain.urdf", f'<robot name="r">{"".join(parts)}</robot>')
        self.refuses("info", "wide.xml", words=["wide.xml:1", "more than 1000 attributes"])
        self.refuses("info", "chain.urdf", words=["chain.urdf:1", "more than 512 deep"])

    def test_that_speak_to_the_terminal(self):
        evil = r"\u001b]0;owned\u0007\u009b31m\u202e\u007f"
        raw = [chr(c) for c in [*range(10), *range(11, 32), *range(127, 160), 0x202E]]
        model = self.write("m.xml", MODEL.replace("floor", evil.encode().decode("unicode_escape").replace("\a", "").replace("\x1b", "")))
        self.write("s.toml", f'[[robot]]\nname = "r"\nfile = "m.xml"\n[[camera]]\nname = "{evil}"\nposition = [0, 0, 1]\n'
                   f'[[light]]\nname = "{evil}"\ntype = "point"\nintensity = 1\n')
        self.write("key.toml", f'[["{evil}"]]\na = 1\n')
        self.write("value.toml", f'[[robot]]\nname = "r"\nfile = "{evil}.xml"\n')
        for arguments in (["info", "s.toml"], ["info", "s.toml", "--json"], ["info", "s.toml", "--streams"], ["info", model], ["info", "key.toml"],
                          ["info", "value.toml"], ["render", "s.toml", "--camera", "\x1b[31m"], ["info", "\x1b[2J.toml"], ["\x1b[2J"], ["info", "--\x1b[2J"]):
            with self.subTest(arguments):
                result = subprocess.run([str(PROGRAM), *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=SECONDS,
                                        env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache")})
                shown = (result.stdout + result.stderr).decode()
                self.assertEqual([hex(ord(c)) for c in raw if c in shown], [], shown)
        self.assertIn(r"\x1b]0;owned\x07\u009b31m", self.gloam("info", "key.toml", expect=1).stderr)


class Roots(ProgramTest):
    GLTF = {"asset": {"version": "2.0"}, "buffers": [{"uri": "../outside.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}

    def setUp(self):
        super().setUp()
        self.write("model/a.gltf", json.dumps(self.GLTF))
        (self.folder / "outside.bin").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))

    def test_hold_for_convert(self):
        file = self.folder / "model/a.gltf"
        self.gloam("convert", file, "--colliders", "hull")
        self.gloam("convert", file, "--colliders", "hull", "--root", self.folder)
        for options in (["--strict"], ["--root", self.folder / "model"]):
            self.assertIn("leads outside of the folder", self.gloam("convert", file, "--colliders", "hull", *options, expect=1).stderr)
        self.assertIn("given with --root", self.gloam("convert", file, "--root", self.folder / "elsewhere", expect=1).stderr)

    def test_are_told_of_by_info(self):
        scene = self.write("model/s.toml", '[[visual]]\nname = "v"\nfile = "a.gltf"\n')
        for uri in ("../outside.bin", "http://host/a.bin", "/etc/passwd", "missing.bin"):
            self.write("model/a.gltf", json.dumps({**self.GLTF, "buffers": [{"uri": uri, "byteLength": 36}]}))
            said = self.gloam("info", scene, "--strict").stdout
            self.assertIn("/buffers/0", said)
            self.assertNotIn("everything in the file is simulated and rendered", said)


if __name__ == "__main__":
    unittest.main()
