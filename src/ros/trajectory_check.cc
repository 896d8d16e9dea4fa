#include "ros/trajectory_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gloam/command.h"

namespace gloam {
namespace {

Error bad(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

}  // namespace

Status check_joint_names(std::span<const std::string> names) {
  if (names.empty()) return bad("the list of joints is empty");
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    if (name.empty()) return bad("a joint has an empty name");
    if (!seen.insert(name).second)
      return bad(fmt::format("joint '{}' is listed twice", name), "list each joint once");
  }
  return {};
}

Result<JointTrajectory> joint_trajectory_of(const trajectory_msgs::JointTrajectory& message) {
  const size_t joints = message.joint_names.size();
  JointTrajectory trajectory;
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points) {
    if (!point.effort.empty() && point.effort.size() != joints)
      return bad(fmt::format("a point has {} efforts for {} joints", point.effort.size(), joints));
    if (!std::ranges::all_of(point.effort, [](double v) { return std::isfinite(v); }))
      return bad("the efforts of a point are not finite");
    trajectory.points.push_back({point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec,
                                 point.positions, point.velocities, point.accelerations});
  }
  GLOAM_TRY_STATUS(JointPath::make(trajectory, joints));
  return trajectory;
}

int64_t start_step(const trajectory_msgs::JointTrajectory& message, double now, double timestep) {
  const double stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec;
  return stamp > now ? std::llround(stamp / timestep) : Command::kNextStep;
}

}  // namespace gloam
