"""ros2 launch gloam_drive drive.launch.py robot:=quadruped camera:=eye"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("robot", default_value="quadruped"),
        DeclareLaunchArgument("camera", default_value="eye"),
        Node(package="gloam_drive", executable="drive_to_goal", output="screen",
             parameters=[{"use_sim_time": True, "robot": LaunchConfiguration("robot"), "camera": LaunchConfiguration("camera")}]),
    ])
