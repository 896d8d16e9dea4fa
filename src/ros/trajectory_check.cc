#include "ros/trajectory_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

namespace gloam {
namespace {

constexpr size_t kMostPoints = 100'000;

Error bad(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

Status check_numbers(const std::vector<double>& numbers, std::string_view what, size_t joints,
                     bool is_required) {
  if (numbers.size() != joints && (is_required || !numbers.empty()))
    return bad(fmt::format("a point has {} {} for {} joints", numbers.size(), what, joints));
  if (!std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); }))
    return bad(fmt::format("the {} of a point are not finite", what));
  return {};
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

Status check_points(const trajectory_msgs::JointTrajectory& trajectory) {
  const size_t joints = trajectory.joint_names.size();
  if (trajectory.points.empty()) return bad("the trajectory has no points");
  if (trajectory.points.size() > kMostPoints)
    return bad(fmt::format("the trajectory has more than {} points", kMostPoints));
  double before = -1;
  for (const trajectory_msgs::JointTrajectoryPoint& point : trajectory.points) {
    const double time = point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec;
    if (time < 0) return bad("the time of a point is negative");
    if (time <= before) return bad("the times of the points do not increase");
    before = time;
    GLOAM_TRY_STATUS(check_numbers(point.positions, "positions", joints, true));
    GLOAM_TRY_STATUS(check_numbers(point.velocities, "velocities", joints, false));
    GLOAM_TRY_STATUS(check_numbers(point.accelerations, "accelerations", joints, false));
    GLOAM_TRY_STATUS(check_numbers(point.effort, "efforts", joints, false));
  }
  return {};
}

}  // namespace gloam
