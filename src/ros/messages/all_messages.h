#pragma once
// The list of all messages that Gloam knows by struct.

#include "ros/messages/action_msgs.h"
#include "ros/messages/builtin_interfaces.h"
#include "ros/messages/control_msgs.h"
#include "ros/messages/diagnostic_msgs.h"
#include "ros/messages/event_camera_msgs.h"
#include "ros/messages/foxglove_msgs.h"
#include "ros/messages/geometry_msgs.h"
#include "ros/messages/gloam_msgs.h"
#include "ros/messages/nav_msgs.h"
#include "ros/messages/rcl_interfaces.h"
#include "ros/messages/rmw_dds_common.h"
#include "ros/messages/rosgraph_msgs.h"
#include "ros/messages/sensor_images.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/simulation_services.h"
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
    sensor_msgs::BatteryState, tf2_msgs::TFMessage, rosgraph_msgs::Clock,
    trajectory_msgs::JointTrajectory, trajectory_msgs::JointTrajectoryPoint,
    diagnostic_msgs::DiagnosticArray, diagnostic_msgs::DiagnosticStatus, diagnostic_msgs::KeyValue,
    visualization_msgs::MarkerArray, visualization_msgs::Marker, visualization_msgs::MeshFile,
    visualization_msgs::UVCoordinate, vision_msgs::VisionClass, vision_msgs::LabelInfo,
    rmw_dds_common::ParticipantEntitiesInfo, rmw_dds_common::NodeEntitiesInfo, rmw_dds_common::Gid,
    foxglove_msgs::CompressedVideo, foxglove_msgs::Color, foxglove_msgs::KeyValuePair,
    foxglove_msgs::ArrowPrimitive, foxglove_msgs::CubePrimitive, foxglove_msgs::SpherePrimitive,
    foxglove_msgs::CylinderPrimitive, foxglove_msgs::LinePrimitive,
    foxglove_msgs::TriangleListPrimitive, foxglove_msgs::TextPrimitive,
    foxglove_msgs::ModelPrimitive, foxglove_msgs::SceneEntityDeletion, foxglove_msgs::SceneEntity,
    foxglove_msgs::SceneUpdate, event_camera_msgs::EventPacket, std_srvs::Empty_Request,
    std_srvs::Empty_Response, std_srvs::Trigger_Request, std_srvs::Trigger_Response,
    std_srvs::SetBool_Request, std_srvs::SetBool_Response, gloam_msgs::Contact,
    gloam_msgs::Contacts, gloam_msgs::State, gloam_msgs::Weather, gloam_msgs::Gas,
    gloam_msgs::ActuatorStates, gloam_msgs::Probe, gloam_msgs::Metrics, gloam_msgs::StepInput,
    unique_identifier_msgs::UUID, action_msgs::GoalInfo, action_msgs::GoalStatus,
    action_msgs::GoalStatusArray, action_msgs::srv::CancelGoal_Request,
    action_msgs::srv::CancelGoal_Response, trajectory_msgs::MultiDOFJointTrajectory,
    trajectory_msgs::MultiDOFJointTrajectoryPoint, control_msgs::JointTolerance,
    control_msgs::JointComponentTolerance, control_msgs::action::FollowJointTrajectory_Goal,
    control_msgs::action::FollowJointTrajectory_Result,
    control_msgs::action::FollowJointTrajectory_Feedback,
    control_msgs::action::FollowJointTrajectory_SendGoal_Request,
    control_msgs::action::FollowJointTrajectory_SendGoal_Response,
    control_msgs::action::FollowJointTrajectory_GetResult_Request,
    control_msgs::action::FollowJointTrajectory_GetResult_Response,
    control_msgs::action::FollowJointTrajectory_FeedbackMessage, rcl_interfaces::ParameterType,
    rcl_interfaces::ParameterValue, rcl_interfaces::Parameter, rcl_interfaces::ParameterEvent,
    rcl_interfaces::FloatingPointRange, rcl_interfaces::IntegerRange,
    rcl_interfaces::ParameterDescriptor, rcl_interfaces::SetParametersResult,
    rcl_interfaces::ListParametersResult, rcl_interfaces::srv::GetParameters_Request,
    rcl_interfaces::srv::GetParameters_Response, rcl_interfaces::srv::GetParameterTypes_Request,
    rcl_interfaces::srv::GetParameterTypes_Response, rcl_interfaces::srv::SetParameters_Request,
    rcl_interfaces::srv::SetParameters_Response,
    rcl_interfaces::srv::SetParametersAtomically_Request,
    rcl_interfaces::srv::SetParametersAtomically_Response,
    rcl_interfaces::srv::ListParameters_Request, rcl_interfaces::srv::ListParameters_Response,
    rcl_interfaces::srv::DescribeParameters_Request,
    rcl_interfaces::srv::DescribeParameters_Response, simulation_interfaces::Result,
    simulation_interfaces::Resource, simulation_interfaces::SimulationState,
    simulation_interfaces::EntityState, simulation_interfaces::EntityCategory,
    simulation_interfaces::EntityInfo, simulation_interfaces::TagsFilter,
    simulation_interfaces::Bounds, simulation_interfaces::EntityFilters,
    simulation_interfaces::NamedPose, simulation_interfaces::Spawnable,
    simulation_interfaces::SpawnEntity, simulation_interfaces::SpawnResult,
    simulation_interfaces::WorldResource, simulation_interfaces::SimulatorFeatures,
    simulation_interfaces::srv::GetSimulatorFeatures_Request,
    simulation_interfaces::srv::GetSimulatorFeatures_Response,
    simulation_interfaces::srv::GetSimulationState_Request,
    simulation_interfaces::srv::GetSimulationState_Response,
    simulation_interfaces::srv::SetSimulationState_Request,
    simulation_interfaces::srv::SetSimulationState_Response,
    simulation_interfaces::srv::StepSimulation_Request,
    simulation_interfaces::srv::StepSimulation_Response,
    simulation_interfaces::srv::ResetSimulation_Request,
    simulation_interfaces::srv::ResetSimulation_Response,
    simulation_interfaces::srv::SpawnEntity_Request,
    simulation_interfaces::srv::SpawnEntity_Response,
    simulation_interfaces::srv::SpawnEntities_Request,
    simulation_interfaces::srv::SpawnEntities_Response,
    simulation_interfaces::srv::DeleteEntity_Request,
    simulation_interfaces::srv::DeleteEntity_Response,
    simulation_interfaces::srv::GetEntities_Request,
    simulation_interfaces::srv::GetEntities_Response,
    simulation_interfaces::srv::GetEntitiesStates_Request,
    simulation_interfaces::srv::GetEntitiesStates_Response,
    simulation_interfaces::srv::GetEntityState_Request,
    simulation_interfaces::srv::GetEntityState_Response,
    simulation_interfaces::srv::SetEntityState_Request,
    simulation_interfaces::srv::SetEntityState_Response,
    simulation_interfaces::srv::GetEntityInfo_Request,
    simulation_interfaces::srv::GetEntityInfo_Response,
    simulation_interfaces::srv::SetEntityInfo_Request,
    simulation_interfaces::srv::SetEntityInfo_Response,
    simulation_interfaces::srv::GetEntityBounds_Request,
    simulation_interfaces::srv::GetEntityBounds_Response,
    simulation_interfaces::srv::GetNamedPoses_Request,
    simulation_interfaces::srv::GetNamedPoses_Response,
    simulation_interfaces::srv::GetNamedPoseBounds_Request,
    simulation_interfaces::srv::GetNamedPoseBounds_Response,
    simulation_interfaces::srv::GetSpawnables_Request,
    simulation_interfaces::srv::GetSpawnables_Response,
    simulation_interfaces::srv::LoadWorld_Request, simulation_interfaces::srv::LoadWorld_Response,
    simulation_interfaces::srv::UnloadWorld_Request,
    simulation_interfaces::srv::UnloadWorld_Response,
    simulation_interfaces::srv::GetCurrentWorld_Request,
    simulation_interfaces::srv::GetCurrentWorld_Response,
    simulation_interfaces::srv::GetAvailableWorlds_Request,
    simulation_interfaces::srv::GetAvailableWorlds_Response,
    simulation_interfaces::action::SimulateSteps_Goal,
    simulation_interfaces::action::SimulateSteps_Result,
    simulation_interfaces::action::SimulateSteps_Feedback,
    simulation_interfaces::action::SimulateSteps_SendGoal_Request,
    simulation_interfaces::action::SimulateSteps_SendGoal_Response,
    simulation_interfaces::action::SimulateSteps_GetResult_Request,
    simulation_interfaces::action::SimulateSteps_GetResult_Response,
    simulation_interfaces::action::SimulateSteps_FeedbackMessage>;

}  // namespace gloam
