"""Files of other formats are named, with the way to make of them what Gloam reads."""
import bz2
import gzip
import io
import lzma
import sqlite3
import tarfile
import zipfile

from e2e.support import ProgramTest

METADATA = """rosbag2_bagfile_information:
  version: 9
  storage_identifier: {storage}
  relative_file_paths: [bag_0.{ending}]
"""
MCAP = b"\x89MCAP0\r\n"
ENTIRE = MCAP + b"\x01" + (8).to_bytes(8, "little") + bytes(8) + b"\x0f" + (4).to_bytes(8, "little") + bytes(4)


class Foreign(ProgramTest):
    def files(self):
        sqlite3.connect(self.folder / "real.db3").execute("create table messages (id integer)").connection.close()
        tar, archive = io.BytesIO(), io.BytesIO()
        with tarfile.open(fileobj=tar, mode="w") as made:
            made.addfile(tarfile.TarInfo("x"))
        with zipfile.ZipFile(archive, "w") as made:
            made.writestr("x.mcap", b"x")
        return {  # name: (content, format, remedy)
            "real.db3": (None, "SQLite", "rosbags-convert"),
            "cut.db3": (b"SQLite format 3\0" + bytes(84), "SQLite", "--dst-storage mcap"),
            "ros1.bag": (b"#ROSBAG V2.0\n" + bytes(64), "ROS 1 bag", "rosbags-convert --src"),
            "old.bag": (b"#ROSRECORD V1.1\n", "ROS 1 bag", "rosbag fix"),
            "bag_0.db3.zstd": (b"\x28\xb5\x2f\xfd" + bytes(20), "zstd", "rosbags-convert"),
            "run.mcap.zst": (b"\x28\xb5\x2f\xfd" + bytes(20), "zstd", "zstd -d"),
            "run.mcap.gz": (gzip.compress(b"x"), "gzip", "gunzip"),
            "run.bag.bz2": (bz2.compress(b"x"), "bzip2", "bunzip2"),
            "run.xz": (lzma.compress(b"x"), "xz", "unxz"),
            "run.lz4": (b"\x04\x22\x4d\x18" + bytes(20), "LZ4", "lz4 -d"),
            "logs.tar": (tar.getvalue(), "tar archive", "tar -xf"),
            "demo.hdf5": (b"\x89HDF\r\n\x1a\n" + bytes(40), "HDF5", "h5py"),
            "flight.ulg": (b"ULog\x01\x12\x35\x01" + bytes(40), "PX4", "pyulog"),
            "table.parquet": (b"PAR1" + bytes(10), "Parquet", "MCAP"),
            "array.npy": (b"\x93NUMPY\x01\0", "NumPy", "MCAP"),
            "zipped.bag": (archive.getvalue(), "ZIP", "unzip"),
            "nothing.mcap": (b"", "is empty", "0 bytes"),
            "nothing.bag": (b"", "is empty", "0 bytes"),
            "short.mcap": (MCAP[:5], "truncated after 5 bytes", "recovered"),
            "renamed.mcap": (b"#ROSBAG V2.0\n" + bytes(64), "ROS 1 bag", "rosbags-convert"),
        }

    def test_every_command_that_takes_a_log_names_the_format_and_the_converter(self):
        for name, (content, what, remedy) in self.files().items():
            path = self.folder / name
            if content is not None:
                path.write_bytes(content)
            for command in (["info", path], ["replay", path, "--verify"], ["export", path, "--to", "tum", "--topic", "/odom", "--out", "x.tum"],
                            ["evaluate", path, "--reference", path], ["evaluate", f"{path}:/odom", "--reference", path],
                            ["recover", path, "-o", "whole.mcap"], ["run", path, "--out", "r"]):
                said = self.gloam(*command, expect=1).stderr
                self.assertIn(what, said, command)
                self.assertIn(remedy, said, command)
                self.assertIn(name, said, command)
            self.assertFalse((self.folder / "whole.mcap").exists())

    def test_the_folder_of_a_bag(self):
        for storage, ending, hint in (("mcap", "mcap", "give its log: "), ("sqlite3", "db3", "rosbags-convert --src")):
            folder = self.write(f"{storage}/metadata.yaml", METADATA.format(storage=storage, ending=ending)).parent
            (folder / f"bag_0.{ending}").write_bytes(b"x")
            for command in (["info", folder], ["replay", folder, "--verify"], ["evaluate", folder, "--reference", folder]):
                said = self.gloam(*command, expect=1).stderr
                self.assertIn("is the folder of a ROS 2 bag", said)
                self.assertIn(hint, said)
            self.assertIn("describes a ROS 2 bag", self.gloam("info", folder / "metadata.yaml", expect=1).stderr)

    def test_a_log_without_messages_says_so(self):
        path = self.folder / "empty.mcap"
        path.write_bytes(ENTIRE + b"\x02" + (20).to_bytes(8, "little") + bytes(20) + MCAP)
        self.assertIn("is empty", self.gloam("info", path).stdout)
        for command in (["replay", path, "--verify"], ["export", path, "--to", "tum", "--topic", "/odom", "--out", "x.tum"],
                        ["evaluate", path, "--reference", path], ["evaluate", f"{path}:/odom", "--reference", path]):
            self.assertIn("is empty", self.gloam(*command, expect=1).stderr)
        unnamed = path.rename(self.folder / "empty.log")  # known by its content
        self.assertIn("is empty", self.gloam("info", unnamed).stdout)
