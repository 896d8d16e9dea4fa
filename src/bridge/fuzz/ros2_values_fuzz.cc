#include "bridge/ros2/services/joint_way.h"
#include "bridge/ros2/services/parameter_values.h"
#include "ros/codec.h"
#include "ros/messages/rcl_interfaces.h"
#include "ros/messages/simulation_services.h"

/// Trajectories, parameters and requests of strangers.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const rcl_interfaces::ParameterValue value = bridge::parameter_from_toml(text);
  (void)bridge::parameter_to_toml(value);
  const std::span<const uint8_t> bytes(data, size);
  if (const auto trajectory = decode<trajectory_msgs::JointTrajectory>(bytes); trajectory.ok()) {
    const Result<bridge::JointWay> way = bridge::JointWay::make(*trajectory);
    const std::vector<double> start(trajectory->joint_names.size());
    for (const double time : {0.0, 0.5, 1e9})
      if (way.ok()) (void)way->at(time, start);
  }
  if (const auto set = decode<rcl_interfaces::srv::SetParameters_Request>(bytes); set.ok())
    for (const auto& parameter : set->parameters) (void)bridge::parameter_to_toml(parameter.value);
  (void)decode<simulation_interfaces::srv::SpawnEntities_Request>(bytes).ok();
  return 0;
}
