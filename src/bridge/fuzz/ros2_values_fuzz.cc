#include <cmath>

#include "bridge/ros2/services/parameter_values.h"
#include "ros/codec.h"
#include "ros/messages/rcl_interfaces.h"
#include "ros/messages/simulation_interfaces.h"
#include "ros/trajectory_check.h"

/// Trajectories, parameters and requests of strangers.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const rcl_interfaces::ParameterValue value = bridge::parameter_from_toml(text);
  (void)bridge::parameter_to_toml(value);
  const std::span<const uint8_t> bytes(data, size);
  if (const auto trajectory = decode<trajectory_msgs::JointTrajectory>(bytes); trajectory.ok()) {
    const std::vector<JointSample> start(trajectory->joint_names.size());
    const Result<JointTrajectory> read = joint_trajectory_of(*trajectory);
    if (read.ok()) {
      JointPath path = JointPath::make(*read, start.size()).value();
      path.begin(start);
      for (const double time : {0.0, 0.5, 1e9})
        if (!std::isfinite(path.at(time, 0).position)) __builtin_trap();
    }
  }
  if (const auto set = decode<rcl_interfaces::srv::SetParameters_Request>(bytes); set.ok())
    for (const auto& parameter : set->parameters) (void)bridge::parameter_to_toml(parameter.value);
  (void)decode<simulation_interfaces::srv::SpawnEntities_Request>(bytes).ok();
  return 0;
}
