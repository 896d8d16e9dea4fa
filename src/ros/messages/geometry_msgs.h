#pragma once
// Messages of ROS 2's package geometry_msgs. SI units; covariances are row-major 6x6 matrices over
// (x, y, z, rotation about x, y, z).

#include "ros/messages/std_msgs.h"

namespace gloam::geometry_msgs {

inline constexpr std::string_view kPackage = "geometry_msgs/msg";

struct Vector3 {
  double x = 0, y = 0, z = 0;
  GLOAM_MESSAGE(Vector3, x, y, z)
};

struct Vector3Stamped {
  std_msgs::Header header;
  Vector3 vector;
  GLOAM_MESSAGE(Vector3Stamped, header, vector)
};

struct Point {
  double x = 0, y = 0, z = 0;  ///< [m]
  GLOAM_MESSAGE(Point, x, y, z)
};

struct Point32 {
  float x = 0, y = 0, z = 0;  ///< [m]
  GLOAM_MESSAGE(Point32, x, y, z)
};

/// The order is x, y, z, w; MuJoCo's is w, x, y, z.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  GLOAM_DEFAULTS(x = 0, y = 0, z = 0, w = 1)
  GLOAM_MESSAGE(Quaternion, x, y, z, w)
};

struct Pose {
  Point position;
  Quaternion orientation;
  GLOAM_MESSAGE(Pose, position, orientation)
};

struct PoseStamped {
  std_msgs::Header header;
  Pose pose;
  GLOAM_MESSAGE(PoseStamped, header, pose)
};

struct PoseArray {
  std_msgs::Header header;
  std::vector<Pose> poses;
  GLOAM_MESSAGE(PoseArray, header, poses)
};

struct PoseWithCovariance {
  Pose pose;
  std::array<double, 36> covariance = {};
  GLOAM_MESSAGE(PoseWithCovariance, pose, covariance)
};

struct PoseWithCovarianceStamped {
  std_msgs::Header header;
  PoseWithCovariance pose;
  GLOAM_MESSAGE(PoseWithCovarianceStamped, header, pose)
};

struct Transform {
  Vector3 translation;  ///< [m]
  Quaternion rotation;
  GLOAM_MESSAGE(Transform, translation, rotation)
};

/// X_AB of A = header.frame_id, B = child_frame_id.
struct TransformStamped {
  std_msgs::Header header;
  std::string child_frame_id;
  Transform transform;
  GLOAM_MESSAGE(TransformStamped, header, child_frame_id, transform)
};

struct Twist {
  Vector3 linear;   ///< [m/s]
  Vector3 angular;  ///< [rad/s]
  GLOAM_MESSAGE(Twist, linear, angular)
};

struct TwistStamped {
  std_msgs::Header header;
  Twist twist;
  GLOAM_MESSAGE(TwistStamped, header, twist)
};

struct TwistWithCovariance {
  Twist twist;
  std::array<double, 36> covariance = {};
  GLOAM_MESSAGE(TwistWithCovariance, twist, covariance)
};

struct Wrench {
  Vector3 force;   ///< [N]
  Vector3 torque;  ///< [N m]
  GLOAM_MESSAGE(Wrench, force, torque)
};

struct WrenchStamped {
  std_msgs::Header header;
  Wrench wrench;
  GLOAM_MESSAGE(WrenchStamped, header, wrench)
};

struct Accel {
  Vector3 linear;   ///< [m/s^2]
  Vector3 angular;  ///< [rad/s^2]
  GLOAM_MESSAGE(Accel, linear, angular)
};

}  // namespace gloam::geometry_msgs
