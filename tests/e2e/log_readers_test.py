"""Every reader of ROS 2's logs opens a log of Gloam as a whole: no reader is told which topics to leave out."""
import io
import json
import math
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import fetch_data
from e2e.support import ProgramTest

ROBOT = """<mujoco model="cart"><option timestep="0.002"/><worldbody><light pos="0 0 4"/>
<geom name="floor" type="plane" size="10 10 0.1"/>
<body name="base" pos="0 0 0.2"><freejoint/><geom type="box" size="0.2 0.1 0.05" mass="4"/><site name="imu" pos="0.05 0 0.02"/>
<camera name="front" pos="0.2 0 0.1" xyaxes="0 -1 0 0 0 1" fovy="50" resolution="32 24"/>
<body name="mast" pos="0 0 0.05"><joint name="pan" axis="0 0 1" range="-115 115" damping="0.1"/>
<geom type="cylinder" size="0.02 0.1" pos="0 0 0.1" mass="0.3"/>
<body name="hand" pos="0 0 0.2"><joint name="lift" type="slide" axis="0 0 1"/><geom size="0.02" mass="0.1"/></body></body></body>
<body name="target" mocap="true" pos="1 1 1"><geom size=".05" contype="0" conaffinity="0"/></body></worldbody>
<actuator><position name="pan" joint="pan" kp="5" ctrlrange="-2 2"/><motor name="lift" joint="lift" gear="3"/></actuator>
<sensor><gyro name="gyro" site="imu"/><accelerometer name="acc" site="imu"/></sensor>
<keyframe><key name="home" qpos="0 0 0.2 1 0 0 0 0.1 0" ctrl="1 0.5"/></keyframe></mujoco>"""

SCENE = """[scene]
name = "every_kind"
[sim]
duration = 0.6
[[robot]]
name = "cart one"
file = "robots/cart.xml"
keyframe = "home"
[[object]]
name = "crate"
file = "meshes/crate.obj"
position = [2, 0, 1]
[[visual]]
name = "sign"
file = "meshes/crate.obj"
position = [3, 1, 1]
[[lidar]]
name = "top"
body = "cart one/base"
position = [0, 0, 0.3]
preset = "VLP-16"
columns = 90
rate = 10
[[stereo]]
name = "eyes"
position = [0, -2, 1]
look_at = [0, 0, 1]
baseline = 0.12
fovy = 60
width = 32
height = 24
rate = 10
[[push]]
body = "crate"
time = 0.1
velocity = [0.2, 0, 0]
[weather]
visibility = 200
[[metric]]
name = "tilt"
value = 'deg(acos(clamp(robot.up.z, -1, 1)))'
robots = "*"
[render]
tier = "direct"
spp = 1
"""

CUBE = "".join(f"v {x} {y} {z}\n" for x in (0, .3) for y in (0, .3) for z in (0, .3)) + \
    "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


class LogTest(ProgramTest):
    """A test that records and reads by others' packages."""

    def setUp(self):
        super().setUp()
        packages = fetch_data.packages(fetch_data.default_folder())
        if not packages.is_dir():
            raise self.skipTest("the packages of the tests are not here: tests/fetch_data.py")
        sys.path.insert(0, str(packages))
        self.packages = packages

    def write_scene(self, more=""):
        self.write("scene/robots/cart.xml", ROBOT)
        self.write("scene/meshes/crate.obj", CUBE)
        return self.write("scene/scene.toml", SCENE + more)

    def record(self, *options, scene=None):
        log = self.folder / "run.mcap"
        self.gloam("record", scene or self.write_scene(), "-o", log, "--overwrite", *options)
        return log

    def decoded(self, log):
        from mcap.reader import make_reader
        from mcap_ros2.decoder import DecoderFactory
        read = defaultdict(list)
        with log.open("rb") as stream:
            for _, channel, message, ros in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
                read[channel.topic].append((message.log_time, ros))
        return read


class Readers(LogTest):
    def test_every_reader_opens_the_whole_log(self):
        for topics in ((), ("--topics", "*")):
            log = self.record(*topics)
            from mcap.reader import make_reader
            summary = make_reader(io.BytesIO(log.read_bytes())).get_summary()
            self.assertIsNotNone(summary.statistics)
            for channel in summary.channels.values():  # the first is what rosbag2 asks for
                self.assertTrue(channel.schema_id in summary.schemas, channel.topic)
                self.assertEqual(channel.message_encoding, "cdr", channel.topic)
                self.assertEqual(summary.schemas[channel.schema_id].encoding, "ros2msg")
                self.assertRegex(channel.topic, r"^(/[A-Za-z_][A-Za-z0-9_]*)+$")
                self.assertNotIn("__", channel.topic)
            count = summary.statistics.message_count
            from mcap_ros2.reader import read_ros2_messages
            self.assertEqual(sum(1 for _ in read_ros2_messages(str(log))), count)
            from rosbags.highlevel import AnyReader
            with AnyReader([log]) as reader:
                names = {reader.deserialize(raw, connection.msgtype).__msgtype__ and connection.topic
                         for connection, _, raw in reader.messages()}
            self.assertTrue({"/gloam/world", "/gloam/states"} <= names)
            for to in ("bag", "one.bag"):
                made = subprocess.run([sys.executable, str(self.packages / "bin/rosbags-convert"), "--src", str(log), "--dst",
                                       str(self.folder / f"{len(topics)}{to}")], capture_output=True, text=True, timeout=120,
                                      env={"PYTHONPATH": str(self.packages), "PATH": "/usr/bin"})
                self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
            info = json.loads(self.gloam("info", log, "--json").stdout)
            self.assertTrue(info["can_be_stepped_again"])
            self.assertEqual(info["messages"], count)
            self.assertRegex(self.gloam("replay", log, "--verify").stdout, "^0 of 300 steps differ")

    def test_the_world_is_a_string(self):
        texts = [ros.data for _, ros in self.decoded(self.record())["/gloam/world"]]
        self.assertEqual(len(texts), 1)
        self.assertIn("every_kind", json.loads(texts[0])["scene"])

    def test_effort_is_the_force_of_the_actuators(self):
        states = self.decoded(self.record())["/cart_one/joint_states"]
        self.assertGreater(len(states), 25)
        for _, state in states:
            self.assertEqual(list(state.name), ["pan", "lift"])
            pan, lift = state.effort
            self.assertAlmostEqual(pan, 5 * (1 - state.position[0]), delta=1e-9)  # kp (ctrl - q)
            self.assertAlmostEqual(lift, 1.5, delta=1e-12)  # gear * ctrl

    def test_the_right_eye_tells_the_baseline(self):
        read = self.decoded(self.record("--topics", "/eyes/*"))
        fx = 12 / math.tan(math.radians(30))
        for eye, shift in (("left", 0), ("right", -fx * 0.12)):
            infos = read[f"/eyes/{eye}/camera_info"] + read[f"/eyes/{eye}/depth/camera_info"]
            self.assertGreater(len(infos), 6)
            for _, info in infos:
                self.assertAlmostEqual(info.p[3], shift, delta=1e-9)
                self.assertAlmostEqual(info.p[0], fx, delta=1e-9)
                self.assertEqual((info.distortion_model, list(info.d)), ("plumb_bob", [0] * 5))
                self.assertEqual(list(info.r), [1, 0, 0, 0, 1, 0, 0, 0, 1])
                self.assertEqual([info.p[i] for i in (0, 1, 2, 4, 5, 6, 8, 9, 10)], list(info.k))

    def test_stamps_of_one_step_are_equal(self):
        # 120 Hz is no divisor of either rate of steps: samples go to the first step at or after their time.
        for timestep, rate in ((0.002, 100), (0.005, 100), (0.002, 120), (0.004, 120)):
            more = f'[[sensor]]\nmatch = "*"\nrate = {rate}\n' + "".join(
                f'[[topic]]\nname = "{name}"\nrate = {rate}\n' for name in ("/tf", "/clock", "/cart_one/joint_states"))
            read = self.decoded(self.record("--topics", "/clock,/tf,/*imu,/cart_one/joint_states", "--timestep", timestep,
                                            "--duration", "0.3", scene=self.write_scene(more)))
            imu = next(messages for name, messages in read.items() if name.endswith("/imu"))
            clock = [m.clock.sec * 10**9 + m.clock.nanosec for _, m in read["/clock"]]
            stamps = [stamp(m) for _, m in imu]
            steps = [math.ceil(k / rate / timestep - 1e-9) for k in range(len(stamps))]
            self.assertEqual(stamps, [round(s * timestep * 1e9) for s in steps])
            self.assertEqual(clock[:len(stamps)], stamps)
            self.assertGreaterEqual(len(stamps), len(clock) - 1)  # the last step's sample comes with the next
            self.assertEqual([stamp(m) for _, m in read["/cart_one/joint_states"]], clock)
            self.assertEqual([stamp(m.transforms[0]) for _, m in read["/tf"]], clock)
            for log_time, message in imu:
                self.assertEqual(log_time, stamp(message))


class Names(LogTest):
    """Any names of a model's elements give topics of their own."""

    MODEL = """<mujoco><worldbody><body name="a"><joint name="j" axis="0 1 0"/><geom size=".1"/><site name="s"/></body>
<body name="clock" mocap="true"><geom size=".1" contype="0" conaffinity="0"/></body>
<body name="two words" mocap="true" pos="1 0 0"/><body name="two_words" mocap="true" pos="2 0 0"/>
<camera name="tf" pos="0 -2 1" resolution="16 16"/><camera name="c m" pos="0 -2 1" resolution="16 16"/><camera name="c_m" pos="0 -2 1" resolution="16 16"/>
</worldbody><sensor>%s</sensor></mujoco>"""

    def topics(self, file):
        listed = json.loads(self.gloam("info", file, "--topics", "--json").stdout)
        names = [topic["name"] for topic in listed]
        self.assertEqual(len(names), len(set(names)))
        for name in names:
            self.assertRegex(name, r"^(/[A-Za-z_][A-Za-z0-9_]*)+$")
            self.assertNotIn("__", name)
            self.assertLess(len(name), 248)
        return {topic["name"]: topic for topic in listed}

    def test_sensors_may_have_the_names_of_the_simulations_topics(self):
        names = ("clock", "tf", "tf_static", "contacts", "reset", "metrics", "scene", "weather", "diagnostics", "rosout", "gloam/world")
        sensors = "".join(f'<clock name="{name}"/>' for name in names)
        model = self.write("user.xml", self.MODEL % sensors)
        said = self.gloam("record", model, "-o", self.folder / "r.mcap", "--duration", "0.1", "--topics", "*").stderr
        self.assertIn("'/clock_2'", said)
        topics = self.topics(model)
        self.assertEqual(topics["/clock"]["type"], "rosgraph_msgs/msg/Clock")
        self.assertEqual(topics["/reset"]["type"], "std_msgs/msg/Empty")
        for name in names:
            renamed = topics[f"/{name}_2"]
            self.assertEqual((renamed["type"], renamed["source"]), ("std_msgs/msg/Float64MultiArray", f"sensor {name}"))
        read = self.decoded(self.folder / "r.mcap")
        self.assertAlmostEqual(read["/clock_2"][3][1].data[0], 0.03, delta=1e-12)
        self.assertEqual(self.topics(model), topics)  # the same each time

    def test_elements_that_are_alike_but_for_what_ros_lacks(self):
        long = "x" * 300
        sensors = "".join(f'<clock name="{name}"/>' for name in ("a b", "a_b", "a_b_2", "a//b", "größe", "gr_e", "手", "腕", "1", long, long + "y"))
        topics = self.topics(self.write("m.xml", self.MODEL % sensors))
        self.assertEqual({topics[n]["source"] for n in ("/a_b", "/a_b_2", "/a_b_3", "/a/b", "/gr_e", "/gr_e_2")},
                         {"sensor " + n for n in ("a b", "a_b", "a_b_2", "a//b", "größe", "gr_e")})
        self.assertEqual(topics["/a_b_2"]["source"], "sensor a_b_2", "a name that is made up does not take another's")
        # All topics of a camera are renamed alike.
        for name, source in (("/c_m", "camera c m"), ("/c_m_2", "camera c_m")):
            self.assertEqual(topics[name + "/camera_info"]["source"], source)
            self.assertEqual(topics[name + "/image_raw"]["source"], source)

    def test_a_rename_that_takes_a_name_is_an_error_with_its_line(self):
        self.write("scene/robots/cart.xml", ROBOT)
        scene = self.write("scene/bad.toml", '[[robot]]\nname = "c"\nfile = "robots/cart.xml"\n[[topic]]\nname = "/c/odom"\nrename = "/clock"\n')
        said = self.gloam("info", scene, "--topics", expect=1).stderr
        self.assertIn("bad.toml:4", said)
        self.assertIn("'/clock'", said)
