#pragma once
// The list of all messages that Gloam knows by struct.

#include "ros/messages/builtin_interfaces.h"
#include "ros/messages/diagnostic_msgs.h"
#include "ros/messages/event_camera_msgs.h"
#include "ros/messages/foxglove_msgs.h"
#include "ros/messages/geometry_msgs.h"
#include "ros/messages/gloam_msgs.h"
#include "ros/messages/nav_msgs.h"
#include "ros/messages/rmw_dds_common.h"
#include "ros/messages/rosgraph_msgs.h"
#include "ros/messages/sensor_images.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/std_msgs.h"
#include "ros/messages/std_srvs.h"
#include "ros/messages/tf2_msgs.h"
#include "ros/messages/trajectory_msgs.h"
#include "ros/messages/vision_msgs.h"
#include "ros/messages/visualization_msgs.h"

namespace gloam {

template <class... T>
struct MessageList {
  /// Calls f(std::type_identity<T>()) for each.
  template <class F>
  static void for_each(F&& f) {
    (f(std::type_identity<T>()), ...);
  }
};

using AllMessages = MessageList<
    builtin_interfaces::Time, builtin_interfaces::Duration, std_msgs::Header, std_msgs::String,
    std_msgs::Bool, std_msgs::Empty, std_msgs::Float64, std_msgs::Float64MultiArray,
    std_msgs::MultiArrayLayout, std_msgs::MultiArrayDimension, std_msgs::ColorRGBA,
    geometry_msgs::Vector3, geometry_msgs::Vector3Stamped, geometry_msgs::Point,
    geometry_msgs::Point32, geometry_msgs::Quaternion, geometry_msgs::Pose,
    geometry_msgs::PoseStamped, geometry_msgs::PoseArray, geometry_msgs::PoseWithCovariance,
    geometry_msgs::PoseWithCovarianceStamped, geometry_msgs::Transform,
    geometry_msgs::TransformStamped, geometry_msgs::Twist, geometry_msgs::TwistStamped,
    geometry_msgs::TwistWithCovariance, geometry_msgs::Wrench, geometry_msgs::WrenchStamped,
    geometry_msgs::Accel, nav_msgs::Odometry, nav_msgs::Path, sensor_msgs::JointState,
    sensor_msgs::Imu, sensor_msgs::Range, sensor_msgs::MagneticField, sensor_msgs::Image,
    sensor_msgs::CompressedImage, sensor_msgs::CameraInfo, sensor_msgs::RegionOfInterest,
    sensor_msgs::PointCloud2, sensor_msgs::PointField, sensor_msgs::LaserScan,
    sensor_msgs::Temperature, sensor_msgs::Illuminance, sensor_msgs::FluidPressure,
    tf2_msgs::TFMessage, rosgraph_msgs::Clock, trajectory_msgs::JointTrajectory,
    trajectory_msgs::JointTrajectoryPoint, diagnostic_msgs::DiagnosticArray,
    diagnostic_msgs::DiagnosticStatus, diagnostic_msgs::KeyValue, visualization_msgs::MarkerArray,
    visualization_msgs::Marker, visualization_msgs::MeshFile, visualization_msgs::UVCoordinate,
    vision_msgs::VisionClass, vision_msgs::LabelInfo, rmw_dds_common::ParticipantEntitiesInfo,
    rmw_dds_common::NodeEntitiesInfo, rmw_dds_common::Gid, foxglove_msgs::CompressedVideo,
    foxglove_msgs::Color, foxglove_msgs::KeyValuePair, foxglove_msgs::ArrowPrimitive,
    foxglove_msgs::CubePrimitive, foxglove_msgs::SpherePrimitive, foxglove_msgs::CylinderPrimitive,
    foxglove_msgs::LinePrimitive, foxglove_msgs::TriangleListPrimitive,
    foxglove_msgs::TextPrimitive, foxglove_msgs::ModelPrimitive, foxglove_msgs::SceneEntityDeletion,
    foxglove_msgs::SceneEntity, foxglove_msgs::SceneUpdate, event_camera_msgs::EventPacket,
    std_srvs::Empty_Request, std_srvs::Empty_Response, std_srvs::Trigger_Request,
    std_srvs::Trigger_Response, std_srvs::SetBool_Request, std_srvs::SetBool_Response,
    gloam_msgs::Contact, gloam_msgs::Contacts, gloam_msgs::State, gloam_msgs::Weather,
    gloam_msgs::Gas, gloam_msgs::Metrics, gloam_msgs::StepInput>;

}  // namespace gloam
