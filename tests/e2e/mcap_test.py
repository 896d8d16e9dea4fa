"""Logs against PyPI's mcap: it reads ours wholly, ours reads what it writes with every option, and a robot's log."""
import io
import itertools
import json
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import fetch_data
from e2e.support import PROGRAM

PEER = PROGRAM.parent / "gloam_mcap_peer"
DATA = fetch_data.default_folder()


def peer(*arguments, expect=0):
    result = subprocess.run([str(PEER), *map(str, arguments)], capture_output=True, text=True, timeout=120)
    if result.returncode != expect:
        raise AssertionError(f"mcap_peer {arguments}: {result.returncode}\n{result.stderr}")
    return result


def listed(log, *topic):
    """Messages as ours reads them: topic, sequence, times, size, CRC."""
    return [tuple(line.split(" ")) for line in peer("list", log, *topic).stdout.splitlines()]


class McapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not fetch_data.packages(DATA).is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(fetch_data.packages(DATA)))

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def theirs(self, log, by_summary=True, **how):
        """Messages as theirs reads them, CRCs checked."""
        from mcap.reader import NonSeekingReader, make_reader
        with log.open("rb") as stream:
            reader = (make_reader if by_summary else NonSeekingReader)(stream, validate_crcs=True)
            return [(c.topic, str(m.sequence), str(m.log_time), str(m.publish_time), str(len(m.data)), f"{zlib.crc32(m.data):08x}")
                    for _, c, m in reader.iter_messages(**how)]


class Ours(McapTest):
    """A log of ours, read by theirs."""

    def log(self, level, chunk_size=1 << 16):
        log = self.folder / f"ours_{level}_{chunk_size}.mcap"
        peer("write", log, level, chunk_size)
        return log

    def test_every_record_is_read_and_every_checksum_is_right(self):
        from mcap.records import DataEnd, Footer, Header
        from mcap.stream_reader import StreamReader
        for level, chunk_size in itertools.product((0, 1, 3), (1, 5000, 1 << 20)):
            with self.subTest(level=level, chunk_size=chunk_size), self.log(level, chunk_size).open("rb") as stream:
                records = list(StreamReader(stream, validate_crcs=True).records)
                names = [type(record).__name__ for record in records]
                self.assertEqual(names.count("Message"), 3000)
                self.assertEqual((records[0].profile, records[0].library.split(" ")[0]), ("ros2", "gloam"))
                self.assertIsInstance(records[0], Header)
                self.assertNotEqual(next(r for r in records if isinstance(r, DataEnd)).data_section_crc, 0)
                self.assertIsInstance(records[-1], Footer)
                self.assertNotEqual(records[-1].summary_crc, 0)

    def test_messages_are_the_same_in_the_same_order(self):
        for level in (0, 3):
            log = self.log(level)
            found = self.theirs(log)
            self.assertEqual(len(found), 3000)
            # Within one time theirs keeps the order of its heap.
            self.assertEqual(sorted(found), sorted(listed(log)))
            self.assertEqual([m[2] for m in found], [m[2] for m in listed(log)])
            window = dict(topics=["/chatter_2"], starting_at=1_500_000_000, ending_before=1_600_000_000)
            ours = [m for m in listed(log, "/chatter_2") if 1_500_000_000 <= int(m[2]) < 1_600_000_000]
            self.assertEqual(sorted(self.theirs(log, **window)), sorted(ours))

    def test_ros_decodes_the_messages(self):
        from mcap.reader import make_reader
        from mcap_ros2.decoder import DecoderFactory
        with self.log(1).open("rb") as stream:
            found = {m.sequence: decoded.data for _, _, m, decoded in
                     make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()]).iter_decoded_messages()}
        self.assertEqual(found, {i: f"message {i}" for i in range(3000)})

    def test_the_summary_tells_what_ours_tells(self):
        from mcap.reader import make_reader
        log = self.log(1, 5000)
        info = json.loads(peer("info", log).stdout)
        with log.open("rb") as stream:
            reader = make_reader(stream, validate_crcs=True)
            summary = reader.get_summary()
            attachments = [(a.name, zlib.crc32(a.data), a.log_time, a.create_time, a.media_type) for a in reader.iter_attachments()]
            metadata = {m.name: m.metadata for m in reader.iter_metadata()}
        self.assertEqual(attachments, [("notes.txt", zlib.crc32(b"hello"), 7, 6, "text/plain")])
        self.assertEqual(metadata, {"run": {"scene": "demo", "seed": "7"}})
        self.assertEqual(info["metadata"], metadata)
        statistics = summary.statistics
        self.assertEqual((info["messages"], info["chunks"], info["start"], info["end"]),
                         (statistics.message_count, statistics.chunk_count, statistics.message_start_time, statistics.message_end_time))
        self.assertEqual(len(summary.chunk_indexes), info["chunks"])
        self.assertEqual({t["topic"]: t["messages"] for t in info["topics"]},
                         {summary.channels[c].topic: n for c, n in statistics.channel_message_counts.items()})
        self.assertEqual(summary.channels[1].metadata["topic_type_hash"], "RIHS01_" + "a" * 64)
        self.assertEqual(summary.schemas[1].data, b"string data\n")

    def test_a_recovered_log_is_whole(self):
        log = self.log(1, 5000)
        cut = self.folder / "cut.mcap"
        cut.write_bytes(log.read_bytes()[:20000])
        recovered = self.folder / "recovered.mcap"
        kept, _ = peer("recover", cut, recovered).stdout.split()
        found = self.theirs(recovered)
        self.assertEqual(len(found), int(kept))
        self.assertGreater(len(found), 100)
        self.assertEqual(sorted(found, key=lambda m: int(m[1])), sorted(self.theirs(log), key=lambda m: int(m[1]))[:len(found)])


class Theirs(McapTest):
    """Logs that theirs writes, read by ours."""

    def write(self, **options):
        from mcap.writer import Writer
        out = io.BytesIO()
        writer = Writer(out, **options)
        writer.start(profile="ros2", library="theirs")
        schema = writer.register_schema(name="std_msgs/msg/String", encoding="ros2msg", data=b"string data")
        channels = [writer.register_channel(topic=f"/t{i}", message_encoding="cdr", schema_id=schema, metadata={"k": str(i)}) for i in range(4)]
        for i in range(2000):
            time = 1000 * i - (30_000 if i % 7 == 0 and i > 40 else 0)
            writer.add_message(channel_id=channels[i % 4], log_time=time, publish_time=time, sequence=i, data=bytes([i % 256]) * (i % 90))
        writer.add_attachment(create_time=1, log_time=2, name="a.bin", media_type="application/octet-stream", data=b"12345")
        writer.add_metadata(name="m", data={"a": "b"})
        writer.finish()
        log = self.folder / "theirs.mcap"
        log.write_bytes(out.getvalue())
        return log

    def check(self, log, by_summary=True):
        expected = self.theirs(log, by_summary)
        found = listed(log)
        self.assertEqual(sorted(found), sorted(expected))
        self.assertEqual([m[2] for m in found], [m[2] for m in expected])
        info = json.loads(peer("info", log).stdout)
        self.assertEqual(info["damage"], "")
        self.assertEqual(info["messages"], 2000)
        self.assertEqual({t["topic"]: t["messages"] for t in info["topics"]}, {f"/t{i}": 500 for i in range(4)})
        self.assertEqual(info["attachments"], [{"name": "a.bin", "crc": zlib.crc32(b"12345")}])
        self.assertEqual(info["metadata"], {"m": {"a": "b"}})
        return info

    def test_every_compression_and_option(self):
        from mcap.writer import CompressionType, IndexType
        for compression in CompressionType:
            with self.subTest(compression=compression.name):
                self.assertTrue(self.check(self.write(compression=compression, chunk_size=4000))["by_summary"])
        for index in (IndexType.NONE, IndexType.CHUNK, IndexType.MESSAGE, IndexType.ATTACHMENT, IndexType.METADATA):
            with self.subTest(index=index.name):
                self.check(self.write(index_types=index, chunk_size=4000))
        for name in ("repeat_channels", "repeat_schemas", "use_chunking", "use_statistics", "use_summary_offsets", "enable_crcs"):
            with self.subTest(without=name):
                # By a summary that repeats no channels theirs does not find its own messages.
                self.check(self.write(chunk_size=4000, **{name: False}), by_summary=not name.startswith("repeat"))
        with self.subTest("CRC of the data"):
            self.check(self.write(chunk_size=4000, enable_data_crcs=True))

    def test_cut_logs_are_read_as_far_as_they_go(self):
        log = self.write(chunk_size=4000)
        whole = log.read_bytes()
        for part in range(1, 64, 7):
            cut = self.folder / "cut.mcap"
            cut.write_bytes(whole[:len(whole) * part // 64])
            recovered = self.folder / f"recovered_{part}.mcap"
            kept = int(peer("recover", cut, recovered).stdout.split()[0])
            self.assertEqual(len(self.theirs(recovered)), kept)
            self.assertEqual({int(m[1]) for m in self.theirs(recovered)}, set(range(kept)))

    def test_a_robots_log(self):
        log = fetch_data.robot_log(DATA)
        if not log.is_file():
            self.skipTest("the robot's log is not here: tests/fetch_data.py")
        expected = self.theirs(log)
        self.assertGreater(len(expected), 100)
        self.assertEqual(sorted(listed(log)), sorted(expected))
        info = json.loads(peer("info", log).stdout)
        self.assertEqual((info["messages"], info["profile"], info["by_summary"]), (len(expected), "ros2", True))
        counts = {}
        for message in expected:
            counts[message[0]] = counts.get(message[0], 0) + 1
        self.assertEqual({t["topic"]: t["messages"] for t in info["topics"] if t["messages"]}, counts)


if __name__ == "__main__":
    unittest.main()
