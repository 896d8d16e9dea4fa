"""A ROS 2 node for tests of the bridge, run by the interpreter of ros2_env: does one thing and prints JSON.

    ros2_probe.py listen SECONDS [TOPIC …]  all topics that there are, or these: counts, stamps, what pictures are
    ros2_probe.py drive ROBOT SECONDS VX    drives by cmd_vel, prints where odometry says it went
    ros2_probe.py clock SECONDS             a node with use_sim_time: its clock beside /clock
    ros2_probe.py graph SECONDS             nodes, topics with types and hashes
    ros2_probe.py stuck SECONDS             subscribes to raw pictures and never reads them
    ros2_probe.py outlast SECONDS COMMAND   stamps of /clock from its first message until SECONDS after COMMAND, which runs a second later
"""
import importlib
import json
import subprocess
import sys
import time

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

HIDDEN = {"/parameter_events", "/rosout"}


def message_class(type_name):
    package, _, name = type_name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        return None


def stamp_of(message):
    stamp = getattr(message, "clock", None) or getattr(getattr(message, "header", None), "stamp", None)
    if stamp is None and getattr(message, "transforms", None):
        stamp = message.transforms[0].header.stamp
    return None if stamp is None else stamp.sec + 1e-9 * stamp.nanosec


def spin(node, seconds, until=lambda: False):
    end = time.monotonic() + seconds
    while time.monotonic() < end and not until():
        rclpy.spin_once(node, timeout_sec=0.02)


def find_topics(node, seconds):
    """Topics of the simulator, once it is there."""
    spin(node, 10, lambda: "/clock" in dict(node.get_topic_names_and_types()))
    spin(node, seconds)
    return {name: types[0] for name, types in node.get_topic_names_and_types() if name not in HIDDEN and node.count_publishers(name)}


def listen(node, seconds, only=()):
    got, unknown = {}, []
    for name, type_name in find_topics(node, 1).items():
        if only and name not in only:
            continue
        kind = message_class(type_name)
        if kind is None:
            unknown.append(type_name)
            continue
        got[name] = {"type": type_name, "count": 0, "stamps": []}

        def take(message, entry=got[name]):
            entry["count"] += 1
            entry["stamps"].append(stamp_of(message))
            for part in ("encoding", "width", "height", "format"):
                if hasattr(message, part):
                    entry[part] = getattr(message, part)

        latched = any(i.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for i in node.get_publishers_info_by_topic(name))
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        node.create_subscription(kind, name, take, QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE, durability=durability))
    spin(node, seconds)
    return {"topics": got, "unknown": sorted(set(unknown))}


def drive(node, robot, seconds, vx):
    poses = []
    node.create_subscription(Odometry, f"/{robot}/odom", lambda m: poses.append([m.pose.pose.position.x, m.pose.pose.position.y]), 50)
    publisher = node.create_publisher(Twist, f"/{robot}/cmd_vel", 10)
    spin(node, 10, lambda: publisher.get_subscription_count() > 0 and poses)
    goal = Twist()
    goal.linear.x = float(vx)
    end = time.monotonic() + float(seconds)
    while time.monotonic() < end:
        publisher.publish(goal)
        spin(node, 0.05)
    return {"from": poses[0] if poses else None, "to": poses[-1] if poses else None, "count": len(poses)}


def clock(node, seconds):
    said = []
    node.create_subscription(Clock, "/clock", lambda m: said.append(m.clock.sec + 1e-9 * m.clock.nanosec), 10)
    spin(node, 10, lambda: said)
    node.set_parameters([Parameter("use_sim_time", Parameter.Type.BOOL, True)])
    spin(node, float(seconds))
    return {"node": node.get_clock().now().nanoseconds * 1e-9, "said": said[-1] if said else None, "first": said[0] if said else None}


def graph(node, seconds):
    topics = find_topics(node, float(seconds))
    hashes = {name: [[i.node_name, str(i.topic_type_hash)] for i in node.get_publishers_info_by_topic(name)] for name in topics}
    return {"nodes": node.get_node_names_and_namespaces(), "topics": topics, "publishers": hashes,
            "services": dict(node.get_service_names_and_types())}


def stuck(node, seconds):
    from sensor_msgs.msg import Image
    find_topics(node, 0.5)
    for name, type_name in node.get_topic_names_and_types():
        if type_name == ["sensor_msgs/msg/Image"]:
            node.create_subscription(Image, name, lambda m: None, QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE))
    print("subscribed", flush=True)
    time.sleep(float(seconds))
    return {}


def outlast(node, seconds, *command):
    stamps = []
    node.create_subscription(Clock, "/clock", lambda m: stamps.append(stamp_of(m)), QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE))
    spin(node, 60, lambda: stamps)
    spin(node, 1)
    subprocess.run(command, check=True)
    before = len(stamps)
    spin(node, float(seconds))
    return {"before": stamps[:before], "after": stamps[before:]}


def main():
    rclpy.init()
    node = rclpy.create_node("probe")
    work, *arguments = sys.argv[1:]
    result = {"listen": lambda s, *only: listen(node, float(s), only), "drive": lambda r, s, v: drive(node, r, s, v), "clock": lambda s: clock(node, s),
              "graph": lambda s: graph(node, s), "stuck": lambda s: stuck(node, s),
              "outlast": lambda s, *command: outlast(node, s, *command)}[work](*arguments)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
