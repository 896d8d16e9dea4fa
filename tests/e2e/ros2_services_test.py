"""The services and actions of `gloam run --ros2`, called by real rclpy: every service of simulation_interfaces and its result codes."""
import contextlib
import json
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

from e2e.ros2_env import ros2_env
from e2e.support import PROGRAM

HERE = Path(__file__).resolve().parent
CALLER = HERE / "ros2_caller.py"
DOMAINS = iter(range(1 + (os.getpid() + 40) % 80, 1 + (os.getpid() + 40) % 80 + 20))
UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = range(5)
STOPPED, PLAYING, PAUSED, QUITTING, NO_WORLD = range(5)

ROOM = """<mujoco><option timestep="0.002"/><worldbody><geom name="floor" type="plane" size="5 5 0.1"/>
<body name="crate" pos="1 2 0.5"><freejoint/><geom type="box" size="0.1 0.2 0.5" mass="3"/></body>
<body name="table" pos="0 -1 0.4"><geom type="box" size="0.5 0.3 0.4"/></body></worldbody></mujoco>"""
ARM = """<mujoco model="arm"><worldbody><body name="base"><geom size="0.05" mass="1"/><body name="link">
<joint name="elbow" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02"/></body></body></worldbody>
<actuator><motor name="elbow" joint="elbow"/></actuator></mujoco>"""
BALL = '<mujoco model="ball"><worldbody><body name="ball"><freejoint/><geom size="0.1" mass="1"/></body></worldbody></mujoco>'
FBX = '<mujoco><asset><mesh name="a" file="a.fbx"/></asset><worldbody><geom type="mesh" mesh="a"/></worldbody></mujoco>'
URDF = """<robot name="box"><link name="base"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0"
iyz="0"/></inertial><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>"""
SCENE = """[scene]
name = "lab"
[environment]
file = "room.xml"
[[robot]]
name = "arm"
file = "arm.xml"
position = [0, 3, 1]
[robot.controller]
type = "joint_position"
kp = 50
kd = 5
[[goal]]
robot = "arm"
position = [1, 1, 0]
radius = 0.3
"""


def service(name, request=None, package="simulation_interfaces"):
    snake = "".join(("_" if c.isupper() and i else "") + c.lower() for i, c in enumerate(name))
    return {"service": f"/sim/{snake}", "type": f"{package}/srv/{name}", "request": request or {}}


def parameters(name, request):
    snake = "".join(("_" if c.isupper() and i else "") + c.lower() for i, c in enumerate(name))
    return {"service": f"/sim/gloam/{snake}", "type": f"rcl_interfaces/srv/{name}", "request": request}


def spawn(name, uri="", text="", **more):
    return service("SpawnEntity", {"name": name, "entity_resource": {"uri": uri, "resource_string": text}, **more})


def set_state(state):
    return service("SetSimulationState", {"state": {"state": state}})


def load(uri="", text=""):
    return service("LoadWorld", {"world_resource": {"uri": uri, "resource_string": text}})


class Ros2Services(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ros = ros2_env()

    def setUp(self):
        self.domain = next(DOMAINS)
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name) / "a" / "b" / "c" / "d"
        self.folder.mkdir(parents=True)
        for name, text in {"room.xml": ROOM, "arm.xml": ARM, "ball.xml": BALL, "lab.toml": SCENE, "a.fbx": "no mesh", "fbx.xml": FBX,
                           "other.toml": '[environment]\nfile = "room.xml"\n'}.items():
            (self.folder / name).write_text(text)

    @contextlib.contextmanager
    def gloam(self, *arguments):
        """A live run, paused at its beginning, in namespace /sim."""
        env = {**os.environ, "ROS_DOMAIN_ID": str(self.domain)}
        with open(self.folder / "stderr", "w+") as errors:
            self.process = subprocess.Popen([str(PROGRAM), "run", str(self.folder / "lab.toml"), "--ros2", "--paused", "--set",
                                             "bridge.ros2.ns=/sim", *arguments], env=env, stdout=subprocess.PIPE, stderr=errors)
            try:
                yield
            finally:
                if self.process.poll() is None:
                    self.process.send_signal(signal.SIGINT)
                self.process.communicate(timeout=60)
            errors.seek(0)
            self.assertIn(self.process.returncode, (0, 130), errors.read())

    def call(self, *calls):
        result = subprocess.run([str(self.ros.python), str(CALLER)], env=self.ros.variables(self.domain), input=json.dumps(calls),
                                capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def codes(self, *calls):
        return [answer["result"]["result"] for answer in self.call(*calls)]

    def test_types_have_the_hashes_of_rosidl(self):
        """Our structs against the descriptions that ROS's generator made of the packages' definitions."""
        theirs = {}
        for root in (self.ros.overlay, self.ros.venv):
            for file in root.glob("share/*/*/*.json"):
                theirs |= {t["type_name"]: t["hash_string"] for t in json.loads(file.read_text()).get("type_hashes", [])}
        program = PROGRAM.parent / "gloam_ros_test"
        subprocess.run([str(program), "--gtest_filter=MessageFiles.*"], check=True, capture_output=True,
                       env={**os.environ, "GLOAM_ROS_FILES": str(self.folder)})
        ours = dict(line.split() for line in (self.folder / "hashes.txt").read_text().splitlines())
        # The wheels' control_msgs are those before 6.3, without indices in the feedback.
        newer = {f"control_msgs/action/FollowJointTrajectory_{part}" for part in ("Feedback", "FeedbackMessage")}
        common = (ours.keys() & theirs.keys()) - newer
        for package, least in {"simulation_interfaces": 60, "rcl_interfaces": 20, "action_msgs": 5, "control_msgs": 8}.items():
            self.assertGreaterEqual(sum(name.startswith(package + "/") for name in common), least, package)
        self.assertEqual({name: ours[name] for name in common}, {name: theirs[name] for name in common})

    def test_the_run_goes_through_its_states(self):
        with self.gloam():
            features = self.call(service("GetSimulatorFeatures"))[0]["features"]
            self.assertIn(33, features["features"])
            self.assertIn("urdf", features["spawn_formats"])
            state = service("GetSimulationState")
            answers = self.call(state, set_state(STOPPED), set_state(PAUSED), state, service("StepSimulation", {"steps": 5}),
                                service("StepSimulation", {"steps": 0}), set_state(PLAYING), state, service("StepSimulation"),
                                set_state(5), service("ResetSimulation", {"scope": 1}), service("ResetSimulation", {"scope": 3}),
                                set_state(STOPPED), state)
            self.assertEqual([a["result"]["result"] for a in answers],
                             [OK, 101, OK, OK, OK, FAILED, OK, OK, FAILED, 103, UNSUPPORTED, OK, OK, OK])
            self.assertEqual([a["state"]["state"] for a in answers if "state" in a], [STOPPED, PAUSED, PLAYING, STOPPED])
            self.assertEqual(self.codes(set_state(QUITTING)), [OK])
            self.assertEqual(self.process.wait(timeout=30), 0)

    def test_entities_that_come_and_go_keep_no_world_in_memory(self):
        """Each World holds a height field of 8 MB; 200 recompiles in full, else 40."""
        (self.folder / "room.xml").write_text('<mujoco><option timestep="0.002"/><asset><hfield name="hill" nrow="1000" ncol="2000" '
                                              'size="5 5 .1 .1"/></asset><worldbody><geom type="hfield" hfield="hill"/></worldbody></mujoco>')
        come_and_go = [spawn("ball", text=BALL), service("DeleteEntity", {"entity": "ball"})]

        def resident():
            return int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20

        with self.gloam():
            self.assertEqual(self.codes(*come_and_go * 3), [OK] * 6)
            before = resident()
            times = 100 if os.environ.get("GLOAM_TEST_FULL") else 20
            after = []
            for _ in range(4):
                self.assertEqual(self.codes(*come_and_go * (times // 4)), [OK] * 2 * (times // 4))
                after.append(resident())
            self.assertLess(min(after[1:]) - before, 200, "a leak is 320 MB")

    def test_entities_are_listed_moved_and_told_of(self):
        with self.gloam():
            entities, filtered, states = self.call(
                service("GetEntities"), service("GetEntities", {"filters": {"filter": "^cr", "categories": [{"category": 0}]}}),
                service("GetEntitiesStates", {"filters": {"bounds": {"type": 3, "points": [{"x": 1.0, "y": 2.0}, {"x": 0.1}]}}}))
            self.assertEqual(entities["entities"], ["crate", "table", "arm"])
            self.assertEqual(filtered["entities"], ["crate"])
            self.assertEqual(states["entities"], ["crate"])
            pose = {"position": {"x": 0.0, "y": 0.0, "z": 3.0}}
            moved = {"entity": "crate", "state": {"pose": pose, "twist": {"linear": {"x": 1.0}}}, "set_pose": True, "set_twist": True}
            answers = self.call(
                service("SetEntityState", moved), service("StepSimulation", {"steps": 50}), service("GetEntityState", {"entity": "crate"}),
                service("SetEntityState", {**moved, "entity": "table"}), service("SetEntityState", {**moved, "entity": "nobody"}),
                service("SetEntityState", {**moved, "state": {"pose": {"orientation": {"w": 5.0}}}}),
                service("GetEntityState", {"entity": "nobody"}))
            self.assertEqual([a["result"]["result"] for a in answers], [OK, OK, OK, FAILED, NOT_FOUND, 101, NOT_FOUND])
            state = answers[2]["state"]
            self.assertAlmostEqual(state["pose"]["position"]["x"], 0.1, delta=1e-6)
            self.assertAlmostEqual(state["twist"]["linear"]["z"], -0.981, delta=1e-6)
            self.assertAlmostEqual(state["acceleration"]["linear"]["z"], -9.81, delta=1e-4)
            info = {"category": {"category": 4}, "description": "beer", "tags": ["heavy"]}
            answers = self.call(
                service("SetEntityInfo", {"entity": "crate", "info": info}), service("GetEntityInfo", {"entity": "crate"}),
                service("SetEntityInfo", {"entity": "nobody", "info": info}), service("GetEntityInfo", {"entity": "nobody"}),
                service("SetEntityInfo", {"entity": "crate", "info": {"category": {"category": 9}}}),
                service("GetEntityBounds", {"entity": "crate"}), service("GetEntityBounds", {"entity": "nobody"}),
                service("GetNamedPoses"), service("GetNamedPoseBounds", {"name": "arm_goal"}), service("GetNamedPoseBounds", {"name": "x"}),
                service("GetEntities", {"filters": {"filter": "("}}),
                service("GetEntities", {"filters": {"bounds": {"type": 2, "points": [{}, {}, {}]}}}),
                service("GetEntities", {"filters": {"tags": {"tags": ["heavy"]}}}))
            self.assertEqual([a["result"]["result"] for a in answers],
                             [OK, OK, NOT_FOUND, NOT_FOUND, FAILED, OK, NOT_FOUND, OK, OK, NOT_FOUND, FAILED, UNSUPPORTED, OK])
            self.assertEqual(answers[1]["info"], info)
            self.assertEqual(answers[5]["bounds"]["type"], 1)
            self.assertEqual(answers[8]["bounds"]["type"], 3)
            self.assertEqual(answers[12]["entities"], ["crate"])

    def test_entities_are_spawned_and_deleted(self):
        with self.gloam():
            answers = self.call(
                spawn("ball", text=BALL, initial_pose={"pose": {"position": {"z": 2.0}}}), spawn("ball", text=BALL),
                spawn("ball", text=BALL, allow_renaming=True), spawn("a b", text=BALL), spawn("", text="<mujoco/>"),
                spawn("x", text="<sdf/>"), spawn("x"), spawn("x", text=BALL, entity_namespace="a//b"),
                spawn("x", text="<mujoco><worldbody><body><geom/></body>"), spawn("x", text='<mujoco><asset><mesh file="no.stl"/></asset></mujoco>'),
                spawn("x", uri="fbx.xml"), spawn("x", text=BALL, initial_pose={"pose": {"orientation": {"w": 3.0}}}),
                spawn("box", text=URDF, initial_pose={"pose": {"position": {"y": 4.0, "z": 1.0}}}),
                spawn("chair", uri="gloam://prop/chair", initial_pose={"pose": {"position": {"x": -3.0}}}),
                spawn("second", uri="arm.xml", entity_namespace="fleet/b", initial_pose={"pose": {"position": {"y": -4.0}}}),
                spawn("x", uri="/etc/passwd"))
            self.assertEqual([a["result"]["result"] for a in answers],
                             [OK, 101, OK, 102, 102, 103, 104, 105, 106, 107, 108, 109, OK, OK, OK, 104])
            self.assertEqual([a["entity_name"] for a in answers if a["result"]["result"] == OK], ["ball", "ball_2", "box", "chair", "second"])
            one = {"name": "c", "entity_resource": {"uri": "ball.xml"}, "initial_pose": {"pose": {"position": {"z": 4.0}}}}
            answers = self.call(service("SpawnEntities", {"spawn_requests": [one, one]}), service("SpawnEntities", {"spawn_requests": []}),
                                service("DeleteEntity", {"entity": "ball"}), service("DeleteEntity", {"entity": "ball"}),
                                service("DeleteEntity", {"entity": "table"}), service("GetSpawnables", {"sources": [".", "/etc"]}),
                                service("ResetSimulation", {"scope": 4}), service("GetEntities"))
            self.assertEqual([a["result"]["result"] for a in answers], [150, OK, OK, NOT_FOUND, UNSUPPORTED, OK, OK, OK])
            self.assertEqual([a["result"]["result"] for a in answers[0]["results"]], [OK, 101])
            uris = [s["entity_resource"]["uri"] for s in answers[5]["spawnables"]]
            self.assertIn("gloam://prop/chair", uris)
            self.assertTrue(any(uri.endswith("/ball.xml") for uri in uris))
            self.assertEqual(answers[7]["entities"], ["crate", "table", "arm"])

    def test_worlds_are_loaded_and_unloaded(self):
        with self.gloam():
            available, bad, current = self.call(service("GetAvailableWorlds"), service("GetAvailableWorlds", {"additional_sources": ["/etc"]}),
                                                service("GetCurrentWorld"))
            names = [w["name"] for w in available["worlds"]]
            self.assertIn("demo", names)
            self.assertIn("other", names)
            self.assertEqual(bad["result"]["result"], NOT_FOUND)
            self.assertEqual(current["world"]["name"], "lab")
            self.assertEqual(self.codes(
                load(), load("nothing"), load("a.sdf"), load(text="[["), load(text='[environment]\nfile = "no.xml"'),
                load(text='[environment]\nfile = "fbx.xml"'), load("other"),
                service("GetCurrentWorld"), service("UnloadWorld"), service("UnloadWorld"), service("GetCurrentWorld"),
                service("GetSimulationState"), set_state(PLAYING), service("StepSimulation"),
                service("ResetSimulation"), service("DeleteEntity", {"entity": "crate"}), load("lab"), service("StepSimulation")),
                [102, 102, 101, 103, 104, 105, OK, OK, OK, 101, 101, OK, 103, FAILED, INCORRECT_STATE,
                 INCORRECT_STATE, OK, OK])

    def test_actions_step_and_follow(self):
        steps = {"action": "/sim/simulate_steps", "type": "simulation_interfaces/action/SimulateSteps"}
        follow = {"action": "/arm/follow_joint_trajectory", "type": "control_msgs/action/FollowJointTrajectory"}
        bend = {"trajectory": {"joint_names": ["elbow"], "points": [{"positions": [0.5], "time_from_start": {"sec": 1}}]},
                "goal_tolerance": [{"name": "elbow", "position": 0.1}]}
        with self.gloam("--set", "bridge.ros2.interfaces=1"):  # the shapes of Kilted's control_msgs
            done, cancelled, refused = self.call({**steps, "goal": {"steps": 500}},
                                                 {**steps, "goal": {"steps": 10**12}, "cancel_after": 0.5}, {**steps, "goal": {"steps": 0}})
            self.assertEqual((done["status"], done["result"]["result"]["result"]), (4, OK))
            self.assertEqual(done["feedback"][-1], {"completed_steps": 500, "remaining_steps": 0})
            self.assertEqual((cancelled["cancelling"], cancelled["status"]), (1, 5))
            self.assertFalse(refused["accepted"])
            answers = self.call(set_state(PLAYING), {**follow, "goal": bend}, {**follow, "goal": {"trajectory": {"joint_names": ["knee"]}}})
            self.assertEqual((answers[1]["status"], answers[1]["result"]["error_code"]), (4, 0),
                             answers[1]["result"])
            self.assertGreater(len(answers[1]["feedback"]), 10)
            self.assertFalse(answers[2]["accepted"])

    def test_parameters_are_read_and_set(self):
        with self.gloam():
            names, got, described, results, after = self.call(
                parameters("ListParameters", {}), parameters("GetParameters", {"names": ["paused", "robot.arm.controller.kp"]}),
                parameters("DescribeParameters", {"names": ["sim.seed"]}),
                parameters("SetParameters", {"parameters": [
                    {"name": "robot.arm.controller.kp", "value": {"type": 3, "double_value": 60.0}},
                    {"name": "sim.seed", "value": {"type": 2, "integer_value": 4}},
                    {"name": "speed", "value": {"type": 3, "double_value": 2.0}}]}),
                parameters("GetParameters", {"names": ["robot.arm.controller.kp", "speed"]}))
            self.assertIn("robot.arm.controller.kp", names["result"]["names"])
            self.assertTrue(got["values"][0]["bool_value"])
            self.assertTrue(described["descriptors"][0]["read_only"])
            self.assertEqual([r["successful"] for r in results["results"]], [True, False, True])
            self.assertEqual([v["double_value"] for v in after["values"]], [60.0, 2.0])


if __name__ == "__main__":
    unittest.main()
