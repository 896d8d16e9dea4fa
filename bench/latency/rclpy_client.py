"""A client in Python of bench/latency: rclpy_client.py TOPIC TYPE DESCRIPTOR tells of each message as struct Arrival."""
import importlib
import os
import struct
import sys
import time

import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy

topic, type_name, out = sys.argv[1], sys.argv[2], int(sys.argv[3])
package, _, name = type_name.split("/")
kind = getattr(importlib.import_module(f"{package}.msg"), name)
rclpy.init()
node = rclpy.create_node("latency_py")


def take(message):
    at = time.clock_gettime(time.CLOCK_MONOTONIC) * 1e3
    stamp = message.header.stamp
    data = getattr(message, "data", None)
    os.write(out, struct.pack("=QdQ", stamp.sec * 10**9 + stamp.nanosec, at, len(data) if data is not None else 0))


node.create_subscription(kind, topic, take, QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT))
try:
    rclpy.spin(node)
except (rclpy.executors.ExternalShutdownException, BrokenPipeError):
    pass
