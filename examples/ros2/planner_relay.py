#!/usr/bin/env python3
"""Connects a planner that is a ROS 2 node to `[planner] type = "external"`, in lockstep: Gloam waits for each answer.

    python3 examples/ros2/planner_relay.py --address tcp://127.0.0.1:7801 --namespace go --needs scan

Needs rclpy and pyzmq (python3-zmq), but not Gloam. For each observation it publishes, with one stamp in simulation time,

    NAMESPACE/odom                     nav_msgs/Odometry; the same pose on /tf
    NAMESPACE/image_raw                sensor_msgs/Image, rgb8
    NAMESPACE/depth/image_rect_raw     sensor_msgs/Image, 32FC1 [m]
    NAMESPACE/points                   sensor_msgs/PointCloud2 of the LiDAR in the base frame
    /clock                             rosgraph_msgs/Clock, last

and waits for an answer with this stamp:

    NAMESPACE/cmd_vel_stamped          geometry_msgs/TwistStamped
    NAMESPACE/path                     nav_msgs/Path in the base frame or in the frame of the odometry
    NAMESPACE/arrived                  std_msgs/Header: the robot is at its goal

Nodes with use_sim_time stamp with this time, because the clock stands still until the answer. Answers with other stamps are
ignored. After 10 s without one, Gloam counts the answer as invalid and goes on. NAMESPACE/goal_pose
(geometry_msgs/PoseStamped, latched) is the goal of an episode.
"""
import argparse
import array
import json
import math
import queue
import signal
import sys
import threading
import time

import rclpy
import zmq
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from nav_msgs.msg import Odometry, Path
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

NEEDS = ("image", "depth", "scan")
LOOKAHEAD = 0.5  # of the pose on a path that the robot drives to [m]
MOST_POSES = 1024  # of a path
SETTLED = 1.0  # time without a new subscription after which all nodes are considered connected [s]
CONNECTING = 8.0  # most time for this; Gloam waits 10 s for a reply [s]


class Relay:
    def __init__(self, node, options):
        self.node, self.options = node, options
        self.frame, self.base = options.odom_frame, options.base_frame
        self.answers = queue.Queue()
        self.pose = (0.0, 0.0, 0.0)
        space = f"/{options.namespace.strip('/')}/".replace("//", "/")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.odometry = node.create_publisher(Odometry, space + "odom", 10)
        self.image = node.create_publisher(Image, space + "image_raw", 5)
        self.depth = node.create_publisher(Image, space + "depth/image_rect_raw", 5)
        self.points = node.create_publisher(PointCloud2, space + "points", 5)
        self.goal = node.create_publisher(PoseStamped, space + "goal_pose", latched)
        self.clock = node.create_publisher(Clock, "/clock", 10)
        self.tf = node.create_publisher(TFMessage, "/tf", 100)
        self.inputs = [
            node.create_subscription(TwistStamped, space + "cmd_vel_stamped", self.on_velocity, 10),
            node.create_subscription(Path, space + "path", self.on_path, 10),
            node.create_subscription(Header, space + "arrived", lambda header: self.answers.put((header.stamp, {"arrived": True})), 10),
        ]

    def reply(self, message, is_given_up):
        """The reply to a request, or None if is_given_up(), which is called while the node has not answered."""
        header = json.loads(message[0])
        call = header["call"]
        if call == "describe":
            o = self.options
            return {"needs": o.needs, "rate": o.rate, "latency": o.latency, "image_size": o.image_size}
        return self.reset(header) if call == "reset" else self.plan(header, message[1:], is_given_up)

    def reset(self, header):
        if not self.wait_for_nodes():
            names = ", ".join(entry.topic_name for entry in self.inputs)
            return {"error": f"no node publishes any of {names} within {CONNECTING:g} s"}
        if header["goal"] is not None:
            goal = PoseStamped()
            goal.header.frame_id = self.frame
            goal.pose.position.x, goal.pose.position.y = map(float, header["goal"])
            goal.pose.orientation.w = 1.0
            self.goal.publish(goal)
        return {}

    def wait_for_nodes(self):
        """Waits for a publisher of answers, and until the numbers of connections have settled."""
        end, last, since = time.monotonic() + CONNECTING, None, 0.0
        outputs = (self.odometry, self.image, self.depth, self.points, self.clock, self.tf)
        while time.monotonic() < end:
            publishers = sum(self.node.count_publishers(entry.topic_name) for entry in self.inputs)
            now = (publishers, *(entry.get_subscription_count() for entry in outputs))
            if now != last:
                last, since = now, time.monotonic()
            if publishers > 0 and time.monotonic() - since >= SETTLED:
                return True
            time.sleep(0.05)
        return False

    def plan(self, header, arrays, is_given_up):
        clock = Clock()
        nanoseconds = round(header["time"] * 1e9)
        stamp = clock.clock
        stamp.sec, stamp.nanosec = divmod(nanoseconds, 1_000_000_000)
        self.pose = tuple(map(float, header["pose"]))
        while not self.answers.empty():
            self.answers.get_nowait()
        self.publish_motion(stamp, map(float, header["velocity"]))
        for part, data in zip(header["parts"], arrays, strict=True):
            self.publish_part(stamp, part, data)
        self.clock.publish(clock)
        while not is_given_up():
            try:
                answered, answer = self.answers.get(timeout=0.1)
            except queue.Empty:
                continue
            if (answered.sec, answered.nanosec) == (stamp.sec, stamp.nanosec):
                return answer
        return None

    def publish_motion(self, stamp, velocity):
        x, y, yaw = self.pose
        odometry = Odometry()
        odometry.header.stamp, odometry.header.frame_id, odometry.child_frame_id = stamp, self.frame, self.base
        pose, twist = odometry.pose.pose, odometry.twist.twist
        pose.position.x, pose.position.y = x, y
        pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        twist.linear.x, twist.linear.y, twist.angular.z = velocity
        transform = TransformStamped(header=odometry.header, child_frame_id=self.base)
        transform.transform.translation.x, transform.transform.translation.y = x, y
        transform.transform.rotation = pose.orientation
        self.tf.publish(TFMessage(transforms=[transform]))
        self.odometry.publish(odometry)

    def publish_part(self, stamp, part, data):
        shape, bytes_ = part["shape"], array.array("B", data)
        if part["name"] == "scan":
            fields = [PointField(name=n, offset=4 * i, datatype=PointField.FLOAT32, count=1) for i, n in enumerate("xyz")]
            cloud = PointCloud2(height=1, width=shape[0], fields=fields, point_step=12, row_step=12 * shape[0], is_dense=True, data=bytes_)
            cloud.header.stamp, cloud.header.frame_id = stamp, self.base
            self.points.publish(cloud)
            return
        encoding, size = ("rgb8", 3) if part["name"] == "image" else ("32FC1", 4)
        image = Image(height=shape[0], width=shape[1], encoding=encoding, step=size * shape[1], data=bytes_)
        image.header.stamp, image.header.frame_id = stamp, self.options.camera_frame
        (self.image if part["name"] == "image" else self.depth).publish(image)

    def on_velocity(self, message):
        twist = message.twist
        self.answers.put((message.header.stamp, {"velocity": [twist.linear.x, twist.linear.y, twist.angular.z]}))

    def on_path(self, message):
        points = [(p.pose.position.x, p.pose.position.y) for p in message.poses[:MOST_POSES]]
        if message.header.frame_id == self.frame:
            x, y, yaw = self.pose
            c, s = math.cos(yaw), math.sin(yaw)
            points = [(c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)) for px, py in points]
        elif message.header.frame_id != self.base:
            answer = {"error": f"a path must be in frame '{self.base}' or '{self.frame}', got '{message.header.frame_id}'"}
            self.answers.put((message.header.stamp, answer))
            return
        chosen = next((i for i, p in enumerate(points) if math.hypot(*p) >= LOOKAHEAD), len(points) - 1)
        self.answers.put((message.header.stamp, {"waypoints": points, "chosen": chosen}))


def parsed(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    option = parser.add_argument
    option("--address", default="tcp://127.0.0.1:7801", help="of [planner]; default: %(default)s")
    option("--namespace", default="", help="of the topics; default: none")
    option("--needs", default="image", help="of image, depth and scan, separated by commas; default: %(default)s")
    option("--image-size", default="85x64", help="[px]; default: %(default)s")
    option("--rate", type=float, default=4.0, help="of observations in simulation time [Hz]; default: %(default)s")
    option("--latency", type=float, default=0.1, help="of answers in simulation time [s]; default: %(default)s")
    option("--odom-frame", default="odom", help="default: %(default)s")
    option("--base-frame", default="base_link", help="default: %(default)s")
    option("--camera-frame", default="camera", help="default: %(default)s")
    options = parser.parse_args(arguments)
    options.needs = [need for need in options.needs.split(",") if need]
    width, _, height = options.image_size.partition("x")
    if not set(options.needs) <= set(NEEDS) or not (width.isdigit() and height.isdigit()):
        parser.error("--needs takes image, depth and scan; --image-size takes, for example, 85x64")
    options.image_size = [int(width), int(height)]
    return options


def main():
    options = parsed(rclpy.utilities.remove_ros_args(sys.argv)[1:])
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("gloam_planner_relay")
    relay, executor = Relay(node, options), SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    try:
        serve(relay, options.address, stop)
    finally:
        executor.shutdown()
        thread.join(2)
        rclpy.shutdown()


def serve(relay, address, stop):
    socket = zmq.Context.instance().socket(zmq.ROUTER)  # unlike REP, it may leave requests without a reply
    socket.setsockopt(zmq.LINGER, 0)
    socket.bind(address)
    while not stop.is_set():
        if not socket.poll(200):
            continue
        client, empty, *message = socket.recv_multipart()
        try:
            # Gloam gives an answer up after 10 s, and asks for the next one.
            reply = relay.reply(message, lambda: stop.is_set() or socket.poll(0))
        except (ValueError, KeyError, TypeError, AssertionError) as error:
            reply = {"error": f"{type(error).__name__}: {error}"}
        if reply is not None:
            socket.send_multipart([client, empty, json.dumps(reply).encode()])
    socket.close()


if __name__ == "__main__":
    main()
