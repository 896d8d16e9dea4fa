"""Brings a robot to something orange: turns until it is in the middle of the picture, walks until it fills enough of it.

Topics: /CAMERA/image_raw (sensor_msgs/Image, rgb8) in, /ROBOT/cmd_vel (geometry_msgs/Twist) out, ten times a second.
Parameters: robot, camera, use_sim_time; goal_height, the share of the picture's height at which it has arrived (0 … 1).
"""
import sys

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image

LEAST_PIXELS = 12


def find_orange(rgb):
    """Where something orange is in a picture (height, width, 3), uint8: (offset from the middle, -1 … 1, positive = to the right;
    share of the picture's height), or None."""
    red, green, blue = (rgb[..., i].astype(int) for i in range(3))
    rows, columns = np.nonzero((red > 90) & (red > 1.3 * green) & (green > 1.5 * blue))
    if len(columns) < LEAST_PIXELS:
        return None
    height, width = red.shape
    return 2 * columns.mean() / (width - 1) - 1, (rows.max() - rows.min() + 1) / height


def command(seen, goal_height):
    """The velocity goal for what is seen: Twist in the robot's heading frame [m/s, rad/s]."""
    goal = Twist()
    if seen is None:
        goal.angular.z = 0.5  # look around
    else:
        offset, height = seen
        goal.angular.z = float(np.clip(-1.2 * offset, -0.6, 0.6))
        if height < goal_height and abs(offset) < 0.5:
            goal.linear.x = 0.4
    return goal


class DriveToGoal(Node):
    def __init__(self, **options):
        super().__init__("drive_to_goal", **options)
        robot = self.declare_parameter("robot", "quadruped").value
        camera = self.declare_parameter("camera", "eye").value
        self.goal_height = self.declare_parameter("goal_height", 0.75).value
        self.seen, self.has_arrived = None, False
        self.publisher = self.create_publisher(Twist, f"/{robot}/cmd_vel", 10)
        self.create_subscription(Image, f"/{camera}/image_raw", self.look, qos_profile_sensor_data)
        self.create_timer(0.1, self.drive)

    def look(self, image):
        self.seen = find_orange(np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)[:, :3 * image.width]
                                .reshape(image.height, image.width, 3))

    def drive(self):
        if self.seen is not None and self.seen[1] >= self.goal_height:
            self.publisher.publish(Twist())
            self.get_logger().info(f"arrived at {self.get_clock().now().nanoseconds * 1e-9:.1f} s")
            self.has_arrived = True
        else:
            self.publisher.publish(command(self.seen, self.goal_height))


def main():
    rclpy.init(args=sys.argv)
    node = DriveToGoal(parameter_overrides=[Parameter("use_sim_time", Parameter.Type.BOOL, True)])
    while rclpy.ok() and not node.has_arrived:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
