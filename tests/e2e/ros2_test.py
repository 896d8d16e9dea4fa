"""`gloam run --ros2` and real rclpy nodes in other processes."""
import contextlib
import json
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from e2e.ros2_env import ros2_env
from e2e.support import PROGRAM, ROOT

DEMO = ROOT / "examples" / "demo.toml"
# The direct tier: the first image of each camera in the interactive tier takes seconds on two cores.
SMALL = ["--set", "camera.chase.width=64", "--set", "camera.chase.height=48", "--tier", "direct"]
PROBE = Path(__file__).resolve().parent / "ros2_probe.py"
# The domains of a run of tests do not meet those of another, most likely; ports of domains above 101 are ephemeral ones on Linux.
DOMAINS = iter(range(1 + os.getpid() % 80, 1 + os.getpid() % 80 + 20))


class Ros2(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ros = ros2_env()

    def setUp(self):
        self.domain = next(DOMAINS)
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    @contextlib.contextmanager
    def gloam(self, *arguments, scene=DEMO, domain=None):
        """A live run; ended as a user does, by Ctrl-C, and expected to end well."""
        env = {**os.environ, "ROS_DOMAIN_ID": str(domain or self.domain)}
        errors = open(self.folder / "stderr", "w+")
        process = subprocess.Popen([str(PROGRAM), "run", str(scene), "--ros2", *map(str, arguments)], env=env, stdout=subprocess.PIPE,
                                   stderr=errors, text=True)
        try:
            yield process
        finally:
            process.send_signal(signal.SIGINT)
            try:
                out, _ = process.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
            errors.seek(0)
            self.errors = errors.read()
            errors.close()
        self.assertIn(process.returncode, (0, 130), self.errors)
        self.assertEqual(out, "", "stdout is data")

    def start(self, *arguments, domain=None):
        return subprocess.Popen([str(self.ros.python), str(PROBE), *map(str, arguments)], env=self.ros.variables(domain or self.domain),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def probe(self, *arguments, domain=None):
        process = self.start(*arguments, domain=domain)
        out, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, errors)
        return json.loads(out)

    def test_every_topic_is_heard_with_stamps_that_agree(self):
        with self.gloam(*SMALL):
            heard = self.probe("listen", 12)
            graph = self.probe("graph", 1)
        topics = heard["topics"]
        self.assertGreater(len(topics), 50)
        for name, topic in topics.items():
            if "h264" in name or "label_info" in name or "/_action/" in name:  # no goal, no word of one
                continue
            with self.subTest(topic=name):
                self.assertGreater(topic["count"], 0)
                stamps = [s for s in topic["stamps"] if s is not None]
                self.assertEqual(stamps, sorted(stamps), "time goes back")
        # Pictures and their camera_info are of one instant.
        pictures = set(topics["/chase/image_raw"]["stamps"])
        self.assertGreater(len(pictures & set(topics["/chase/camera_info"]["stamps"])), 0.8 * len(pictures))
        self.assertEqual(topics["/chase/image_raw"]["encoding"], "rgb8")
        self.assertIn(["gloam", "/"], graph["nodes"])
        for node, type_hash in graph["publishers"]["/quadruped/odom"]:
            self.assertEqual(node, "gloam")
            self.assertNotIn("INVALID", type_hash)

    def test_transforms_and_joints_come_without_a_gap(self):
        with self.gloam():
            topics = self.probe("listen", 5, "/tf", "/quadruped/joint_states", "/quadruped/odom")["topics"]
        for name, topic in topics.items():
            stamps = topic["stamps"][5:]
            gaps = [round(b - a, 6) for a, b in zip(stamps, stamps[1:])]
            self.assertGreater(len(gaps), 50)
            self.assertEqual({g for g in gaps if abs(g - 0.02) > 1e-6}, set(), name)

    def test_a_robot_is_driven_from_outside_and_the_log_verifies(self):
        out = self.folder / "run"
        with self.gloam("--mcap", "--out", out):
            way = self.probe("drive", "quadruped", 6, 0.4)
        self.assertGreater(way["to"][0] - way["from"][0], 0.5, way)
        result = subprocess.run([str(PROGRAM), "replay", str(out / "run.mcap"), "--verify"], capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r"\b0 of \d+ steps differ")
        listing = subprocess.run([str(PROGRAM), "info", str(out / "run.mcap")], capture_output=True, text=True, timeout=60).stdout
        self.assertRegex(listing, r"/quadruped/odom")

    def test_of_two_masters_one_is_obeyed_and_the_other_told_of(self):
        with self.gloam():
            first = self.start("drive", "quadruped", 8, 0.4)
            time.sleep(4)
            self.probe("drive", "quadruped", 2, -0.4)
            out, errors = first.communicate(timeout=60)
            self.assertEqual(first.returncode, 0, errors)
            way = json.loads(out)
        self.assertGreater(way["to"][0] - way["from"][0], 0.3, way)
        self.assertIn("is controlled by another publisher", self.errors)

    def test_sim_time_and_two_simulators_in_two_domains(self):
        other = next(DOMAINS)
        with self.gloam(), self.gloam(scene=ROOT / "examples" / "two_robots.toml", domain=other):
            clock = self.probe("clock", 2)
            self.assertAlmostEqual(clock["node"], clock["said"], delta=0.2)
            self.assertGreater(clock["said"] - clock["first"], 0.5)
            here, there = self.probe("graph", 1), self.probe("graph", 1, domain=other)
        self.assertIn("/quadruped/odom", here["topics"])
        self.assertNotIn("/quadruped/odom", there["topics"])

    def test_either_side_may_start_again(self):
        listener = self.start("drive", "quadruped", 3, 0.2)
        with self.gloam():
            out, errors = listener.communicate(timeout=60)
            self.assertEqual(listener.returncode, 0, errors)
            self.assertGreater(json.loads(out)["count"], 20, "a node that was there first")
        with self.gloam():
            self.assertGreater(self.probe("drive", "quadruped", 2, 0.2)["count"], 20)
            killed = self.start("drive", "quadruped", 30, 0.2)
            time.sleep(3)
            killed.kill()
            killed.communicate()
            self.assertGreater(self.probe("drive", "quadruped", 2, 0.2)["count"], 20)

    def test_a_stuck_subscriber_of_raw_pictures_stops_nobody(self):
        with self.gloam():
            stuck = self.start("stuck", 40)
            stuck.stdout.readline()
            clock = self.probe("clock", 5)
            stuck.kill()
            stuck.communicate()
        self.assertGreater(clock["said"] - clock["first"], 2.5, "half of real time at least on a machine that renders beside it")

    def test_it_listens_on_loopback_alone(self):
        with self.gloam() as process:
            self.probe("graph", 0.5)
            sockets = subprocess.run(["ss", "-ulnpH"], capture_output=True, text=True)
            if sockets.returncode != 0:
                self.skipTest("no ss here")
            own = [line.split()[3] for line in sockets.stdout.splitlines() if f"pid={process.pid}," in line]
        self.assertTrue(own)
        for address in own:
            self.assertRegex(address, r"^(127\.0\.0\.1|239\.255\.0\.1):\d+$")

    def test_the_example_brings_the_robot_to_the_pillar(self):
        package = ROOT / "examples" / "ros2" / "gloam_drive"
        out = self.folder / "run"
        variables = self.ros.variables(self.domain)
        variables["PYTHONPATH"] += f":{package}"
        with self.gloam("--mcap", "--out", out, scene=ROOT / "examples" / "ros2" / "field.toml"):
            node = subprocess.run([str(self.ros.python), "-m", "gloam_drive.drive_to_goal"], env=variables, capture_output=True, text=True,
                                  timeout=150)
        self.assertEqual(node.returncode, 0, node.stderr)
        self.assertIn("arrived at", node.stdout + node.stderr)
        way = self.folder / "way.tum"
        export = subprocess.run([str(PROGRAM), "export", str(out / "run.mcap"), "--to", "tum", "--topic", "/quadruped/odom", "--out", str(way)],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(export.returncode, 0, export.stderr)
        x, y = (float(v) for v in way.read_text().split("\n")[-2].split()[1:3])
        self.assertLess(((x - 2.5) ** 2 + (y - 1.2) ** 2) ** 0.5, 1.5, "it stands before the pillar")

    def test_a_network_card_that_disappears_cuts_nobody_off(self):
        script = f"""set -e
ip link set lo up multicast on
ip link add card0 type veth peer name card1
ip link set card1 up
ip addr add 10.9.9.1/24 dev card0
ip link set card0 up multicast on
ip route add 224.0.0.0/4 dev card0
{PROGRAM} run {ROOT / "examples" / "two_robots.toml"} --duration 0.01 --output state --out $(mktemp -d) >/dev/null 2>&1  # fills the cache
{PROGRAM} run {ROOT / "examples" / "two_robots.toml"} --ros2 --set bridge.ros2.network=true --duration 60 2>/dev/null &
run=$!
{self.ros.python} {PROBE} outlast 5 ip link del card0
kill -INT $run
wait $run || true
"""
        if subprocess.run(["unshare", "-rn", "ip", "link", "add", "x0", "type", "veth"], capture_output=True).returncode != 0:
            self.skipTest("no network of one's own here: unshare -rn, veth")
        result = subprocess.run(["unshare", "-rn", "bash", "-c", script], env=self.ros.variables(self.domain), capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        stamps = json.loads(result.stdout)
        self.assertTrue(stamps["before"], "no message came before the card disappeared")
        self.assertGreater(len(stamps["after"]), 100, "messages come on after it")
        whole = stamps["before"] + stamps["after"]
        self.assertLess(max(b - a for a, b in zip(whole, whole[1:])), 0.5)

    def test_bad_settings_are_told_of(self):
        for setting, words in (("bridge.ros2.domain=300", "232"), ("bridge.ros2.ns='a b'", "namespace"), ("bridge.ros2.interfaces=3", "2")):
            result = subprocess.run([str(PROGRAM), "run", str(DEMO), "--ros2", "--duration", "1", "--set", setting], capture_output=True,
                                    text=True, timeout=60)
            self.assertNotEqual(result.returncode, 0)
            self.assertTrue(re.search(words, result.stderr), result.stderr)


if __name__ == "__main__":
    unittest.main()
