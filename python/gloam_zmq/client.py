"""Operations of a running simulation."""
import itertools
import os
import threading
import time

import msgpack
import zmq
from zmq.utils.monitor import recv_monitor_message

from gloam_zmq.discovery import machine_id, servers
from gloam_zmq.errors import GloamError
from gloam_zmq.stream import IMAGE, Stream


class Client:
    """A connection to one server. Threads may share it; their operations take turns.

    Methods raise GloamError (refused), TimeoutError (no answer) and ConnectionError (the server has gone).
    """

    def __init__(self, address=None, token=None, server_key=None, timeout=120.0):
        """address: "tcp://127.0.0.1:5556"; None = the newest server of this user on this machine. token: None = that server's, else
        $GLOAM_TOKEN. server_key: CURVE public key of a server that has one, 40 characters. timeout: longest wait for an answer [s]."""
        known = [server for server in servers() if address in (None, server["address"])]
        if address is None and not known:
            raise ConnectionError("no server of this user is running on this machine: start gloam run SCENE --zmq, or give an address")
        server = known[0] if known else {}
        self.address = address or server["address"]
        self.timeout = timeout
        self._token = token or server.get("token") or os.environ.get("GLOAM_TOKEN", "")
        self._server_key = (server_key or server.get("public_key") or "").encode()
        self._context, self._lock, self._ids = zmq.Context(), threading.Lock(), itertools.count(1)
        self._socket = self._connect(zmq.DEALER, self.address)
        self._monitor = self._socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
        try:
            self._server = self._ask("hello", {"machine": machine_id()}, token="")
            self.call("ping")  # whether the token is right
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the connection; robots that it has claimed are given back."""
        if not self._socket.closed:
            self._socket.disable_monitor()
        self._context.destroy(linger=0)

    def _connect(self, kind, address):
        socket = self._context.socket(kind)
        socket.setsockopt(zmq.LINGER, 0)
        socket.setsockopt(zmq.IPV6, "[" in address)
        # Not ZMQ_HEARTBEAT_IVL, whose timer ends the process when a connection is lost while a slow reader's queue is full (libzmq 4364, 3937).
        for option, value in ((zmq.TCP_KEEPALIVE, 1), (zmq.TCP_KEEPALIVE_IDLE, 5), (zmq.TCP_KEEPALIVE_INTVL, 1), (zmq.TCP_KEEPALIVE_CNT, 5)):
            socket.setsockopt(option, value)
        if self._server_key:
            socket.curve_serverkey = self._server_key
            socket.curve_publickey, socket.curve_secretkey = zmq.curve_keypair()
        socket.connect(address)
        return socket

    def call(self, operation, /, timeout=None, **arguments):
        """Any operation by its name, as hello() lists them; returns its result. timeout: [s], None = the client's."""
        return self._ask(operation, arguments, self._token, timeout)

    def _ask(self, operation, arguments, token, timeout=None):
        with self._lock:
            number = next(self._ids)
            request = {"op": operation, "id": number, "args": arguments, **({"token": token} if token else {})}
            while self._monitor.poll(0):
                recv_monitor_message(self._monitor)
            self._socket.send(msgpack.packb(request, default=_plain))
            reply = self._wait(number, self.timeout if timeout is None else timeout)
        if "error" in reply:
            raise GloamError(reply["error"])
        return reply["result"]

    def _wait(self, number, timeout):
        poller = zmq.Poller()
        poller.register(self._socket, zmq.POLLIN)
        poller.register(self._monitor, zmq.POLLIN)
        end = time.monotonic() + timeout
        while True:
            ready = dict(poller.poll(max(0, int(1000 * (end - time.monotonic())))))
            if self._socket in ready:
                reply = msgpack.unpackb(self._socket.recv(), strict_map_key=False)
                if reply.get("id") == number:  # else an event, or an answer that came too late
                    return reply
                if "id" in reply and reply["id"] is None:
                    return reply  # the request could not be read
            elif self._monitor in ready:
                recv_monitor_message(self._monitor)
                raise ConnectionError(f"the server at {self.address} is no longer running")
            elif time.monotonic() >= end:
                raise TimeoutError(f"no answer from {self.address} within {timeout} s")

    # The server.
    def hello(self):
        """What the server is and can do: gloam, protocol, scene, step_rate [Hz], operations with arguments and units, topics, types
        {type: {ros2msg, hash}}, robots [{name, joints, actuators}], bodies, joints, actuators, sensors, cameras, live_fields."""
        return self.call("hello", machine=machine_id())

    def topics(self):
        """Topics of the World that runs: [{name, type, frame_id, rate [Hz], latched, input, source}]."""
        return self.call("topics")

    def ping(self):
        """Seconds that an answer takes; other operations do not delay it."""
        begin = time.monotonic()
        self.call("ping")
        return time.monotonic() - begin

    def end(self):
        """Ends the program."""
        self.call("end")

    # The run.
    def state(self):
        """The latest instant: step, time [s], hash, qpos (nq), qvel (nv), ctrl (nu), run_state, paused, speed, realtime_factor …"""
        return self.call("state")

    def pause(self):
        """Stops after the present step; returns the state there."""
        return self.call("pause")

    def resume(self):
        """Runs until paused."""
        self.call("resume")

    def pace(self, speed=None):
        """Simulated seconds per second, 0.001 … 1000; None = as fast as possible."""
        self.call("pace", **_given(speed=speed))

    def step(self, n=1, paced=False):
        """Takes n steps of a paused run and returns the state after the last: step, time [s], hash, qpos, qvel, ctrl."""
        return self.call("step", n=n, paced=paced)

    def reset(self, state=True, spawned=True):
        """Back to the initial state, and to the entities of the scene."""
        self.call("reset", state=state, spawned=spawned)

    def checkpoint(self):
        """Keeps the present instant; returns its number."""
        return self.call("checkpoint")["id"]

    def restore(self, checkpoint):
        """Restores a checkpoint and returns its state."""
        return self.call("restore", id=checkpoint)

    def seek(self, time):
        """Goes to an instant [s] of a replay (gloam replay LOG --zmq); returns the state there."""
        return self.call("seek", time=time)

    # Commands; at_step: step before which it applies, None = the next.
    def controls(self, values=None, robot=None, actuators=None, at_step=None):
        """values: all controls of a robot, (its actuators), each actuator's own unit; actuators: {full name: value}."""
        self.call("controls", **_given(values=values, robot=robot, actuators=actuators, at_step=at_step))

    def joint_goals(self, joints, at_step=None):
        """{full name: position [rad, m]} for robots' controllers."""
        self.call("joint_goals", **_given(joints=joints, at_step=at_step))

    def velocity_goal(self, vx=0.0, vy=0.0, yaw_rate=0.0, robot=None, at_step=None, vz=0.0):
        """[m/s, m/s, rad/s] in the robot's heading frame."""
        self.call("velocity_goal", **_given(vx=vx, vy=vy, yaw_rate=yaw_rate, vz=vz or None, robot=robot, at_step=at_step))

    def pose_goal(self, position, orientation=None, robot=None, at_step=None):
        """Goal of the frame that the robot's controller controls, in the world: position (3) [m], orientation (4) w x y z."""
        self.call("pose_goal", **_given(position=position, orientation=orientation, robot=robot, at_step=at_step))

    def joint_states(self, positions=None, velocities=None, at_step=None):
        """Puts joints elsewhere: {full name: [position(s)]} [rad, m; ball 4, free 7], velocities likewise [1, 3, 6]."""
        self.call("joint_states", **_given(positions=positions, velocities=velocities, at_step=at_step))

    def mocap_pose(self, body, position, orientation=None, at_step=None):
        """Pose in the world of a mocap body: position (3) [m], orientation (4) w x y z."""
        self.call("mocap_pose", **_given(body=body, position=position, orientation=orientation, at_step=at_step))

    def wrench(self, body, force=None, torque=None, at_step=None):
        """Force (3) [N] and torque (3) [N m] on a body at its centre of mass, world axes; stays until changed."""
        self.call("wrench", **_given(body=body, force=force, torque=torque, at_step=at_step))

    def add_velocity(self, body, velocity, at_step=None):
        """Adds (3) [m/s] to the velocity of a body that floats."""
        self.call("add_velocity", **_given(body=body, velocity=velocity, at_step=at_step))

    def live_field(self, field, values, first=0):
        """Changes elements of a field of the model while it runs: "gravity", "body_mass" … of hello()["live_fields"]."""
        self.call("live_field", field=field, values=values, first=first)

    def claim(self, robot=None):
        """Makes a robot's controls and goals this client's alone until it releases it, closes or is gone for 5 s."""
        self.call("claim", **_given(robot=robot))

    def release(self, robot=None):
        """Releases a claimed robot."""
        self.call("release", **_given(robot=robot))

    def publish(self, topic, data):
        """A message in CDR (bytes) to an input topic, "/ROBOT/cmd_vel"."""
        self.call("publish", topic=topic, data=bytes(data))

    # The World.
    def option(self, path):
        """One option as TOML: "sim.duration", "camera.NAME.width"."""
        return self.call("get_option", path=path)["value"]

    def options(self):
        """[{path, value, unit, low, high, choices}]"""
        return self.call("options")

    def set_options(self, options):
        """{path: value as TOML}: the scene is compiled again, the run goes on."""
        self.call("set_options", options={path: str(value) for path, value in options.items()})

    def entities(self):
        """[{name, kind, floats, spawned, description, tags}]"""
        return self.call("entities")

    def entity_state(self, name):
        """position [m], orientation w x y z, velocity [m/s], angular_velocity [rad/s], accelerations, box_low, box_high [m]; world axes."""
        return self.call("entity_state", name=name)

    def set_entity_state(self, name, **change):
        """position (3), orientation (4), velocity (3), angular_velocity (3), world axes; omitted values are kept."""
        self.call("set_entity_state", name=name, **change)

    def spawn(self, uri=None, text=None, name=None, position=None, orientation=None, **more):
        """Adds a model by its file or its text (MJCF, URDF), or a prop, "gloam://prop/KIND"; returns its name."""
        given = _given(uri=uri, text=text, name=name, position=position, orientation=orientation)
        return self.call("spawn", **given, **more)["name"]

    def remove(self, name):
        """Takes an entity away."""
        self.call("remove", name=name)

    def recompile(self, toml):
        """Continues in another scene, given as text; elements with the same name keep their state."""
        self.call("recompile", toml=toml)

    def load_world(self, uri=None, text=None):
        """Another scene, stopped at its first instant."""
        return self.call("load_world", **_given(uri=uri, text=text))

    # Looking.
    def picture(self, camera="free", width=None, height=None, outputs=None, **more):
        """One picture of the present instant: step, time [s], width, height [px] and an array for each channel: rgb (height, width, 3)
        sRGB, depth (height, width) [m] … more: position (3), orientation (4) of the free camera, jpeg=True for rgb as JPEG bytes."""
        picture = self.call("picture", camera=camera, **_given(width=width, height=height, outputs=outputs), **more)
        return {name: _array(value) if isinstance(value, dict) else value for name, value in picture.items()}

    def value(self, field, element=None):
        """Any array of MuJoCo's by its name, row by row: value("xpos"), value("geom_friction", "floor")."""
        return self.call("value", **_given(field=field, element=element))["values"]

    def labels(self):
        """Ids in pictures of segmentation: [{part, geom, body, instance, instance_name, semantic, semantic_name}]"""
        return self.call("labels")

    def record_start(self, name=None, topics=None):
        """Begins an MCAP log of the run; returns its file on the server's machine."""
        return self.call("record_start", **_given(name=name, topics=topics))["file"]

    def record_stop(self):
        """Ends the log; returns its file."""
        return self.call("record_stop")["file"]

    def stream(self, topics, timeout=None, shared=True, decode=True):
        """A Stream of messages. topics: names; "state" is 100 states a second of simulation time, "state/500" 500, "state/0" one a
        step. Pictures come through shared memory where the server allows it (shared=False: over the socket) and stay CDR for
        Message.image(); all others are dicts (decode=False: CDR bytes). timeout: longest wait for one message [s]."""
        topics = [topics] if isinstance(topics, str) else list(topics)
        types = {topic["name"]: topic["type"] for topic in self.topics()}
        may_share = shared and self._server["shared_memory"]
        subscriptions = {}
        for topic in topics:
            prefix = ""
            if topic.startswith("/") and types.get(topic) == IMAGE:
                prefix = "shm" if may_share else ""
            elif topic.startswith("/") and decode:
                prefix = "decoded"
            subscriptions[prefix + topic] = topic
        host, port = self.address.rsplit(":", 1)[0], self._server["streams"].rsplit(":", 1)[1]
        return Stream(self._connect(zmq.SUB, f"{host}:{port}"), subscriptions, timeout)


def _given(**arguments):
    return {name: value for name, value in arguments.items() if value is not None}


def _plain(value):
    """What msgpack does not know: arrays become lists."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be sent")


def _array(value):
    import numpy
    return numpy.frombuffer(value["data"], dtype=value["dtype"]).reshape(value["shape"])
