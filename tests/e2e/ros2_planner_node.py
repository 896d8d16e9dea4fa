"""A planner as a ROS 2 node, for tests of examples/ros2/planner_relay.py; run by the interpreter of ros2_env.

    ros2_planner_node.py NAMESPACE MODE

velocity: turns and drives to NAMESPACE/goal_pose, then says that it has arrived; path: a path to the goal in the frame of
the odometry; clock: as velocity, but stamps with its clock under use_sim_time; stale: stamps one second too early.
"""
import math
import sys

import rclpy
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry, Path
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header

NEAR = 0.3  # of the goal [m]


class Node:
    def __init__(self, node, namespace, mode):
        self.node, self.mode, self.goal, self.odometry = node, mode, None, None
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.velocity = node.create_publisher(TwistStamped, f"/{namespace}/cmd_vel_stamped", 10)
        self.path = node.create_publisher(Path, f"/{namespace}/path", 10)
        self.arrived = node.create_publisher(Header, f"/{namespace}/arrived", 10)
        self.inputs = [node.create_subscription(PoseStamped, f"/{namespace}/goal_pose", self.on_goal, latched),
                       node.create_subscription(Odometry, f"/{namespace}/odom", self.on_odometry, 10),
                       node.create_subscription(Clock, "/clock", self.on_clock, 10)]

    def on_goal(self, message):
        self.goal = message.pose.position

    def on_odometry(self, message):
        self.odometry = message
        if self.mode != "clock":
            self.answer(message.header.stamp)

    def on_clock(self, message):
        # The node's own subscription to /clock may be served after this one.
        if self.mode == "clock" and self.odometry is not None:
            while self.node.get_clock().now().nanoseconds < message.clock.sec * 1_000_000_000 + message.clock.nanosec:
                rclpy.spin_once(self.node, timeout_sec=0.01)
            self.answer(self.node.get_clock().now().to_msg())

    def answer(self, stamp):
        place, turn = self.odometry.pose.pose.position, self.odometry.pose.pose.orientation
        dx, dy = self.goal.x - place.x, self.goal.y - place.y
        header = Header(stamp=stamp, frame_id="base_link")
        if self.mode == "stale":
            header.stamp.sec -= 1
        if math.hypot(dx, dy) < NEAR:
            return self.arrived.publish(header)
        if self.mode == "path":
            path = Path()
            path.header = Header(stamp=stamp, frame_id="odom")
            for k in range(1, 11):
                pose = PoseStamped()
                pose.pose.position.x, pose.pose.position.y = place.x + dx * k / 10, place.y + dy * k / 10
                path.poses.append(pose)
            return self.path.publish(path)
        angle = math.atan2(dy, dx) - 2 * math.atan2(turn.z, turn.w)
        angle = math.atan2(math.sin(angle), math.cos(angle))
        twist = TwistStamped(header=header)
        twist.twist.linear.x = 0.35 * max(0.0, math.cos(angle))
        twist.twist.angular.z = max(-0.8, min(0.8, 1.5 * angle))
        return self.velocity.publish(twist)


def main():
    namespace, mode = sys.argv[1:3]
    rclpy.init()
    node = rclpy.create_node("planner", parameter_overrides=[Parameter("use_sim_time", value=mode == "clock")])
    made = Node(node, namespace, mode)
    try:
        rclpy.spin(made.node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
