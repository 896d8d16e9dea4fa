"""The bridge to Foxglove, from other processes: a client by hand, Foxglove's own package, rosbags as the judge of schemas."""
import contextlib
import json
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import fetch_data
from e2e.foxglove_client import FoxgloveClient, Refused
from e2e.support import PROGRAM, ROOT

SCENE = ROOT / "examples" / "two_robots.toml"
QUICK = ["--tier", "direct", "--spp", "1", "--resolution", "64x48"]
NODE_CLIENT = ROOT / "tests" / "e2e" / "foxglove_client.mjs"


class Served:
    """A program that serves Foxglove, by its two addresses."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([str(PROGRAM), *map(str, arguments), "--foxglove", "--port", "0"], stderr=subprocess.PIPE, text=True)
        self.url = self.watch_url = None
        said = []
        for line in self.process.stderr:
            said.append(line)
            if found := re.search(r"foxglove: (ws://\S+) \((ws://\S+) to watch\)", line):
                self.url, self.watch_url = found.groups()
            if "Ctrl-C" in line:
                return
        raise AssertionError("".join(said))

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(30)
        self.process.stderr.close()
        return code


class Messages:
    """Decodes messages by the schemas that the server sends, with rosbags."""

    def __init__(self):
        from rosbags.typesys import Stores, get_typestore
        self._store, self._compared = get_typestore(Stores.ROS2_KILTED), set()

    def decode(self, channel, payload):
        from rosbags.typesys import get_types_from_msg
        name = channel["schemaName"]
        if name not in self._compared:
            types = get_types_from_msg(channel["schema"], name)
            if name in self._store.fielddefs:
                assert types[name][1] == self._store.fielddefs[name][1], f"{name} is another type than ROS's"
            self._store.register({n: t for n, t in types.items() if n not in self._store.fielddefs})
            self._compared.add(name)
        return self._store.deserialize_cdr(payload, name)


class FoxgloveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        packages = fetch_data.packages(fetch_data.default_folder())
        if not packages.is_dir():
            raise unittest.SkipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(packages))
        cls.messages = Messages()

    def serve(self, *arguments):
        served = Served(*arguments)
        self.addCleanup(served.end)
        return served

    def connect(self, url, *arguments, **options):
        client = FoxgloveClient(url, *arguments, **options)
        self.addCleanup(client.close)
        return client

    def decoded(self, client, topic, subscription):
        stamp, payload = client.data(subscription)
        return stamp, self.messages.decode(client.channels[topic], payload)


class Live(FoxgloveTest):
    def setUp(self):
        self.served = self.serve("run", SCENE, *QUICK)

    def test_every_topic_is_decoded_by_its_schema(self):
        client = self.connect(self.served.watch_url, ("foxglove.sdk.v1.1", "foxglove.sdk.v1"))
        listed = json.loads(subprocess.run([str(PROGRAM), "info", str(SCENE), "--topics", "--json"], capture_output=True, text=True, check=True).stdout)
        self.assertEqual(set(client.channels), {t["name"] for t in listed if not t["input"]})
        ids = {client.subscribe(topic): topic for topic in client.channels}
        end = time.monotonic() + 120
        while ids and time.monotonic() < end:
            message = client.next(60)
            number = int.from_bytes(message[1:5], "little") if isinstance(message, bytes) and message[0] == 1 else 0
            if number not in ids:
                continue
            topic = ids.pop(number)
            client.unsubscribe(number)
            value = self.messages.decode(client.channels[topic], message[13:])
            if hasattr(value, "header"):
                stamp = value.header.stamp.sec * 10**9 + value.header.stamp.nanosec
                self.assertEqual(stamp, int.from_bytes(message[5:13], "little"), topic)
        self.assertEqual(set(ids.values()), set())

    def test_the_layout_shows_what_there_is(self):
        client = self.connect(self.served.watch_url)
        layout = json.loads((ROOT / "examples" / "foxglove" / "two_robots.json").read_text())
        panels = layout["configById"]
        shown = set(re.findall(r'"([\w!]+![\w]+)"', json.dumps(layout["layout"])))
        self.assertEqual(shown, set(panels))
        topics = set(panels["3D!scene"]["topics"]) | {panels["Image!chase"]["imageMode"][key] for key in ("imageTopic", "calibrationTopic")}
        topics |= {path["value"].split(".")[0] for path in panels["Plot!joints"]["paths"]}
        self.assertLessEqual(topics, set(client.channels))
        self.assertLessEqual({panel["serviceName"] for panel in panels.values() if "serviceName" in panel}, set(client.services))

    def test_a_robot_goes_where_it_is_told(self):
        client = self.connect(self.served.url)
        odometry = client.subscribe("/bo/odom")
        _, start = self.decoded(client, "/bo/odom", odometry)
        channel = client.advertise("/bo/cmd_vel", "geometry_msgs/msg/Twist")
        from rosbags.typesys import Stores, get_typestore
        store = get_typestore(Stores.ROS2_KILTED)
        vector = store.types["geometry_msgs/msg/Vector3"]
        twist = store.types["geometry_msgs/msg/Twist"](linear=vector(-0.4, 0, 0), angular=vector(0, 0, 0))
        as_cdr = client.advertise("/bo/cmd_vel", "geometry_msgs/Twist", "cdr")
        end = time.monotonic() + 30
        x = start.pose.pose.position.x
        while x > start.pose.pose.position.x - 0.4 and time.monotonic() < end:
            client.publish(channel, {"linear": {"x": -0.4}})
            client.publish(as_cdr, bytes(store.serialize_cdr(twist, "geometry_msgs/msg/Twist")))
            for _ in range(10):
                x = self.decoded(client, "/bo/odom", odometry)[1].pose.pose.position.x
        self.assertLess(x, start.pose.pose.position.x - 0.4, "its schedule would have taken it forwards")

    def test_the_scene_stands_in_frames_that_move(self):
        client = self.connect(self.served.watch_url)
        _, scene = self.decoded(client, "/scene", client.subscribe("/scene"))
        entities = {entity.id: entity for entity in scene.entities}
        self.assertLessEqual({"ada/trunk", "floor"}, set(entities))
        self.assertTrue(entities["ada/trunk"].frame_locked)
        frames = {"world"}
        for topic in ("/tf", "/tf_static"):
            _, tf = self.decoded(client, topic, client.subscribe(topic))
            frames |= {transform.child_frame_id for transform in tf.transforms}
        self.assertLessEqual({entity.frame_id for entity in scene.entities}, frames)

    def time_of_a_step(self, client):
        """Time of a paused run. A time is sent only when it changes, and may come before the response of the step."""
        for _ in range(10):
            client.call("/step_simulation", {"steps": 1})
            with contextlib.suppress(TimeoutError):
                return client.time(1)
        self.fail("no time came after ten steps")

    def test_services_and_parameters_control_the_run(self):
        client = self.connect(self.served.url)
        self.assertEqual(client.call("/pause"), {"success": True, "message": ""})
        self.assertTrue(client.parameters("paused")["paused"])
        before = self.time_of_a_step(client)
        self.assertEqual(client.call("/step_simulation", {"steps": 50})["result"]["result"], 1)
        self.assertAlmostEqual(client.until(before + 0.099), before + 0.1, delta=0.03)
        self.assertLessEqual({"ada", "bo"}, set(client.call("/get_entities")["entities"]))
        client.set_parameter("speed", 0.5)
        self.assertEqual(client.parameters("speed"), {"speed": 0.5})
        client.set_parameter("paused", False)
        first = client.time()
        start = time.monotonic()
        while time.monotonic() < start + 3:
            last = client.time()
        self.assertLess(last - first, 0.75 * 3, "at half speed")
        self.assertGreater(last - first, 0.1)

    def test_watchers_are_told_that_they_watch(self):
        watcher = self.connect(self.served.watch_url)
        with self.assertRaisesRegex(RuntimeError, "can only watch"):
            watcher.call("/pause")
        for headers in (["Origin: https://app.foxglove.dev"], ["Origin: null"]):
            with self.assertRaisesRegex(Refused, "403"):
                FoxgloveClient(self.served.watch_url, headers=headers)
            self.connect(self.served.url, headers=headers)
        with self.assertRaisesRegex(Refused, "400"):
            FoxgloveClient(self.served.url, ("graphql",))

    def test_a_client_that_is_killed_leaves_the_others(self):
        code = ("import sys, time; sys.path.insert(0, sys.argv[1])\nfrom e2e.foxglove_client import FoxgloveClient\n"
                "c = FoxgloveClient(sys.argv[2]); [c.subscribe(t) for t in ('/tf', '/chase/image_raw')]; print('there', flush=True); time.sleep(99)")
        other = subprocess.Popen([sys.executable, "-c", code, str(ROOT / "tests"), self.served.url], stdout=subprocess.PIPE, text=True)
        self.assertEqual(other.stdout.readline(), "there\n")
        client = self.connect(self.served.watch_url)
        clock = client.subscribe("/clock")
        before, _ = client.data(clock)
        other.kill()
        other.wait()
        other.stdout.close()
        time.sleep(0.5)
        self.assertGreater(max(client.data(clock)[0] for _ in range(20)), before)

    def test_a_second_start_says_that_the_port_is_taken(self):
        port = re.search(r":(\d+)/", self.served.url).group(1)
        second = subprocess.run([str(PROGRAM), "run", str(SCENE), "--foxglove", "--port", port], capture_output=True, text=True, timeout=120)
        self.assertEqual(second.returncode, 1)
        self.assertRegex(second.stderr, f"port {port} is in use")

    def test_foxglove_s_own_client_understands_it(self):
        node, modules = shutil.which("node"), fetch_data.npm_packages(fetch_data.default_folder())
        if node is None:
            self.skipTest("there is no node on this machine")
        if not modules.is_dir():
            self.skipTest("the npm packages of the tests are not here: tests/fetch_data.py")
        result = subprocess.run([node, "--experimental-websocket", "--no-warnings", str(NODE_CLIENT), str(modules), self.served.url],
                                capture_output=True, text=True, timeout=180)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        seen = json.loads(result.stdout)
        self.assertIn("services", seen["capabilities"])
        self.assertEqual(seen["errors"], [])
        self.assertGreater(seen["messages"]["/tf"], 5)
        self.assertGreater(seen["messages"]["/chase/image_raw/compressed"], 0)
        self.assertEqual(seen["pause"], {"success": True, "message": ""})
        self.assertEqual(seen["speed"], 0.25)
        self.assertIn("/reset", seen["heard"])
        self.assertEqual(seen["asset_status"], 1)
        self.assertLess(seen["time_after_reset"], 0.2)


class Replay(FoxgloveTest):
    def test_a_log_is_played_slowed_and_gone_about_in(self):
        with tempfile.TemporaryDirectory(prefix="gloam_e2e_") as folder:
            log = Path(folder) / "run.mcap"
            subprocess.run([str(PROGRAM), "record", str(SCENE), "-o", str(log), "--duration", "2", "--camera", "chase", *QUICK],
                           check=True, capture_output=True, timeout=300)
            served = self.serve("replay", log, "--paused")
            client = self.connect(served.url)
            self.assertIn("playbackControl", client.info["capabilities"])
            self.assertEqual(client.info["dataStartTime"], {"sec": 0, "nsec": 0})
            self.assertEqual(client.info["dataEndTime"], {"sec": 2, "nsec": 0})
            self.assertEqual(client.playback_state()[0], "paused")

            joints = client.subscribe("/ada/joint_states")
            status, now, speed, did_seek = client.control_playback(True, 1.0, seek=1.0)
            self.assertEqual((status, speed, did_seek), ("playing", 1.0, True))
            self.assertAlmostEqual(now, 1.0, delta=0.1)
            stamps = [client.data(joints)[0] * 1e-9 for _ in range(10)]
            self.assertEqual(stamps, sorted(stamps))
            self.assertGreaterEqual(stamps[0], 0.99)
            self.assertEqual(client.playback_state()[0], "ended")

            self.assertEqual(client.control_playback(False, 0.25, seek=0.5), ("paused", 0.5, 0.25, True))
            client.control_playback(True, 0.25)
            start, first = time.monotonic(), client.time()
            while time.monotonic() < start + 2:
                last = client.time()
            self.assertLess(last - first, 0.25 * 2 * 1.5)
            status, now, _, _ = client.control_playback(False, 0.25)
            self.assertEqual(status, "paused")
            watcher = self.connect(served.watch_url)
            watcher.send_binary(b"\x03\x00\x00\x00\x80\x3f\x00" + bytes(12))
            self.assertEqual(watcher.wait_for("status")["level"], 2)
            client.send_binary(b"\x03\x00\x00\x00\x80\x3f\x01" + (99 * 10**9).to_bytes(8, "little") + bytes(4))
            self.assertIn("99", client.wait_for("status")["message"])
            self.assertEqual(served.end(), 0)


if __name__ == "__main__":
    unittest.main()
