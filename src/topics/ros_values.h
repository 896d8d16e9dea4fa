#pragma once
// Gloam's values as ROS's, and names as ROS takes them.

#include <string>
#include <string_view>

#include "gloam/types.h"
#include "ros/messages/geometry_msgs.h"

namespace gloam {

/// Simulation time [s] >= 0, to the nearest nanosecond.
builtin_interfaces::Time ros_time(double time);
double from_ros(const builtin_interfaces::Time& time);

std_msgs::Header ros_header(double time, std::string_view frame_id);

inline geometry_msgs::Vector3 ros_vector(const Vec3& v) { return {v.x, v.y, v.z}; }
inline geometry_msgs::Point ros_point(const Vec3& p) { return {p.x, p.y, p.z}; }
inline geometry_msgs::Quaternion ros_quaternion(const Quat& q) { return {q.x, q.y, q.z, q.w}; }
inline geometry_msgs::Pose ros_pose(const Pose& X) { return {ros_point(X.p), ros_quaternion(X.q)}; }
inline Vec3 from_ros(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }
inline Vec3 from_ros(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }
inline Pose from_ros(const geometry_msgs::Pose& pose) {
  const geometry_msgs::Quaternion& q = pose.orientation;
  return {from_ros(pose.position), {q.w, q.x, q.y, q.z}};
}

/// A name of an element as a part of a topic's name: letters, digits, '_' and '/', none of its
/// tokens empty or beginning with a digit, no two '_' in a row, at most 180 characters.
std::string topic_token(std::string_view name);

}  // namespace gloam
