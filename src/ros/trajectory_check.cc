#include "ros/trajectory_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gloam/command.h"

namespace gloam {
namespace {

constexpr double kLongestDelay = 86'400;  // [s]

double seconds_of(const auto& time) { return time.sec + 1e-9 * time.nanosec; }

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
  for (size_t i = 0; i < message.points.size(); ++i) {
    const trajectory_msgs::JointTrajectoryPoint& point = message.points[i];
    if (!point.effort.empty() && point.effort.size() != joints)
      return bad(
          fmt::format("point {} has {} efforts for {} joints", i, point.effort.size(), joints));
    if (!std::ranges::all_of(point.effort, [](double v) { return std::isfinite(v); }))
      return bad(fmt::format("the efforts of point {} are not finite", i));
    trajectory.points.push_back({seconds_of(point.time_from_start), point.positions,
                                 point.velocities, point.accelerations});
  }
  GLOAM_TRY_STATUS(JointPath::check(trajectory, joints));
  return trajectory;
}

Result<int64_t> start_step(const trajectory_msgs::JointTrajectory& message, double now,
                           double timestep) {
  const double stamp = seconds_of(message.header.stamp);
  const double length =
      message.points.empty() ? 0 : seconds_of(message.points.back().time_from_start);
  if (stamp != 0 && stamp + length < now)
    return bad(fmt::format("the trajectory ended at {:g} s, but was received at {:g} s",
                           stamp + length, now),
               "use the stamp 0 to start at once");
  if (stamp > now + kLongestDelay)
    return bad(fmt::format("the trajectory starts at {:.0f} s, but the simulation is at {:g} s",
                           stamp, now),
               "stamps are simulation time: set use_sim_time, or use the stamp 0 to start at once");
  return stamp > now ? std::llround(stamp / timestep) : Command::kNextStep;
}

}  // namespace gloam
