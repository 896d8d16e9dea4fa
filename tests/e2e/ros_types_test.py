"""Our ROS 2 messages against rosbags, a stranger's reader and writer: definitions, type hashes, bytes in both directions."""
import os
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from e2e.support import ROOT

sys.path.insert(0, str(ROOT / "tests"))
import fetch_data  # noqa: E402

PROGRAM = ROOT / "build" / "release" / "bin" / "gloam_ros_test"
MESSAGES = 8  # of each type, as in message_files_test.cc
OURS_ALONE = {"foxglove_msgs", "event_camera_msgs", "std_srvs", "vision_msgs", "gloam_msgs", "simulation_interfaces", "control_msgs"}  # packages that rosbags does not know


def types_of_text(text, name):
    """rosbags' description of a type. It takes names of services for packages, so what it calls the type is put right."""
    from rosbags.typesys import get_types_from_msg
    types = get_types_from_msg(text, name)
    (own,) = [known for known in types if known.replace("/msg/", "/") == name.replace("/msg/", "/")]
    types[name] = types.pop(own)
    return types


class RosTypes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        packages = fetch_data.packages(fetch_data.default_folder())
        if not packages.is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(packages))
        from rosbags.typesys import Stores, get_typestore
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        cls.run_ours()
        cls.hashes = dict(line.split() for line in (cls.folder / "hashes.txt").read_text().splitlines())
        cls.known = get_typestore(Stores.ROS2_KILTED)
        cls.store = get_typestore(Stores.ROS2_KILTED)
        for name in cls.hashes:
            # register() refuses a definition that differs from the one it knows.
            cls.store.register(types_of_text(cls.text(name), name))

    @classmethod
    def run_ours(cls):
        result = subprocess.run([str(PROGRAM), "--gtest_filter=MessageFiles.*"], capture_output=True, text=True,
                                env=os.environ | {"GLOAM_ROS_FILES": str(cls.folder)})
        if result.returncode != 0:
            raise RuntimeError(result.stdout[-2000:] + result.stderr)

    @classmethod
    def text(cls, name):
        return (cls.folder / f"{name.replace('/', '.')}.msg").read_text()

    def file(self, name, number, kind):
        return self.folder / f"{name.replace('/', '.')}.{number}.{kind}"

    def test_rosbags_knows_all_types_but_those_of_other_packages(self):
        self.assertGreater(len(self.hashes), 60)
        for name in self.hashes:
            self.assertEqual(name in self.known.types, "/msg/" in name and name.split("/")[0] not in OURS_ALONE, name)

    def test_hashes_are_those_of_types_that_rosbags_knows(self):
        for name, found in self.hashes.items():
            # rosbags hashes char as itself, ROS as uint8: message_types_test.cc has ROS's own hash of them.
            if name in self.known.types and "char[" not in self.text(name):
                self.assertEqual(found, self.known.hash_rihs01(name), name)

    def test_hashes_are_those_of_our_texts(self):
        from rosbags.typesys import Stores, get_typestore
        for name, found in self.hashes.items():
            store = get_typestore(Stores.EMPTY)
            store.register(types_of_text(self.text(name).replace("char[", "uint8["), name))
            self.assertEqual(found, store.hash_rihs01(name), name)

    def test_rosbags_reads_and_writes_the_bytes_that_we_write(self):
        for name in self.hashes:
            for number in range(MESSAGES):
                ours = self.file(name, number, "ours").read_bytes()
                again = bytes(self.store.serialize_cdr(self.store.deserialize_cdr(ours, name), name, little_endian=True))
                self.assertEqual(again.hex(), ours.hex(), f"{name} {number}")

    def test_we_read_what_rosbags_writes_in_both_byte_orders(self):
        draw, expected = random.Random(7), {}
        for name in self.hashes:
            for number in range(MESSAGES):
                message = self.random_message(draw, name)
                little = number % 2 == 0
                self.file(name, number, "theirs").write_bytes(self.store.serialize_cdr(message, name, little_endian=little))
                expected[name, number] = bytes(self.store.serialize_cdr(message, name, little_endian=True)).hex()
        self.run_ours()
        for (name, number), bytes_ in expected.items():
            self.assertEqual(self.file(name, number, "echo").read_bytes().hex(), bytes_, f"{name} {number}")

    def random_message(self, draw, name):
        fields = {field: self.random_value(draw, *description) for field, description in self.store.fielddefs[name][1]
                  if field != "structure_needs_at_least_one_member"}
        return self.store.types[name](**fields)

    def random_value(self, draw, kind, what):
        import numpy
        from rosbags.interfaces import Nodetype
        if kind == Nodetype.NAME:
            return self.random_message(draw, what)
        if kind == Nodetype.BASE:
            return self.random_primitive(draw, what[0])
        element, size = what
        count = size if kind == Nodetype.ARRAY else draw.randrange((size or 3) + 1)  # of a sequence `size` is its bound
        values = [self.random_value(draw, *element) for _ in range(count)]
        if element[0] == Nodetype.NAME or element[1][0] == "string":
            return values
        if element[1][0] == "byte":
            values = [value % 256 for value in values]
        return numpy.array(values, {"bool": "bool", "char": "uint8", "byte": "uint8"}.get(element[1][0], element[1][0]))

    def random_primitive(self, draw, name):
        if name == "string":
            return "".join(draw.choice("abcé/_ 7") for _ in range(draw.randrange(9)))
        if name == "bool":
            return draw.random() < 0.5
        if name == "byte":
            return draw.randrange(-128, 128)  # rosbags' byte has a sign
        if name.startswith("float"):
            return draw.choice([0.5, -2.0, 1.25e30, float("inf"), draw.randrange(1 << 20) / 1024])
        bits = 8 if name == "char" else int(name.lstrip("uint"))
        return draw.randrange(1 << bits) if name[0] in "uc" else draw.randrange(-(1 << bits - 1), 1 << bits - 1)


if __name__ == "__main__":
    unittest.main()
