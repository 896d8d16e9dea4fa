// Checks of trajectories and the names of their profiles.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "base/text.h"
#include "gloam/joints/joint_trajectory.h"

namespace gloam {
namespace {

constexpr size_t kMostPoints = 100'000;
constexpr size_t kMostPositions = 1'000'000;
// Bounds of numbers and of the time between points [s], within which no polynomial overflows.
constexpr double kLargest = 1e9, kShortest = 1e-9;

Error bad(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

Status check_vector(const std::vector<double>& values, std::string_view name, size_t point,
                    size_t joints) {
  if (!values.empty() && values.size() != joints)
    return bad(fmt::format("point {} has {} {} for {} joints", point, values.size(), name, joints));
  if (!std::ranges::all_of(values, [](double v) { return std::abs(v) <= kLargest; }))
    return bad(
        fmt::format("the {} of point {} are not finite, or above {:g}", name, point, kLargest));
  return {};
}

Status check_time(const JointTrajectory& trajectory, size_t point) {
  const double time = trajectory.points[point].time;
  if (!(time >= 0 && time <= kLargest))
    return bad(fmt::format("the time of point {} is negative or not finite", point));
  if (point > 0 && time < trajectory.points[point - 1].time + kShortest)
    return bad(
        fmt::format("the times of the points do not increase: point {} at {:g} s, point {} "
                    "at {:g} s",
                    point - 1, trajectory.points[point - 1].time, point, time));
  return {};
}

Status check_points(const JointTrajectory& trajectory, size_t joints) {
  if (joints == 0) return bad("the trajectory has no joints");
  if (trajectory.points.empty()) return bad("the trajectory has no points");
  if (trajectory.points.size() > kMostPoints || trajectory.points.size() * joints > kMostPositions)
    return bad(fmt::format("the trajectory has more than {} points or {} positions", kMostPoints,
                           kMostPositions));
  const bool has_times = trajectory.profile == TrajectoryProfile::kSpline;
  for (size_t i = 0; i < trajectory.points.size(); ++i) {
    const TrajectoryPoint& point = trajectory.points[i];
    if (point.positions.empty()) return bad(fmt::format("point {} has no positions", i));
    GLOAM_TRY_STATUS(check_vector(point.positions, "positions", i, joints));
    GLOAM_TRY_STATUS(check_vector(point.velocities, "velocities", i, joints));
    GLOAM_TRY_STATUS(check_vector(point.accelerations, "accelerations", i, joints));
    if (has_times) {
      GLOAM_TRY_STATUS(check_time(trajectory, i));
    } else if (!point.velocities.empty() || !point.accelerations.empty()) {
      return bad("points have velocities or accelerations, but the profile stops in each point",
                 "use the profile 'spline', or give positions only");
    }
  }
  return {};
}

Status check_limit(const std::vector<double>& limit, std::string_view name, size_t joints) {
  if (limit.size() != 1 && limit.size() != joints)
    return bad(fmt::format("'{}' has {} numbers for {} joints", name, limit.size(), joints),
               "give one limit per joint, or one for all");
  if (!std::ranges::all_of(limit, [](double v) { return v >= 1 / kLargest && v <= kLargest; }))
    return bad(fmt::format("'{}' must be positive and finite", name));
  return {};
}

constexpr const char* kProfileNames[] = {"spline", "trapezoidal", "quintic"};

}  // namespace

const char* profile_name(TrajectoryProfile profile) {
  return kProfileNames[static_cast<size_t>(profile)];
}

Result<TrajectoryProfile> profile_named(std::string_view name) {
  const auto* const found = std::ranges::find(kProfileNames, name);
  if (found != std::end(kProfileNames))
    return static_cast<TrajectoryProfile>(found - std::begin(kProfileNames));
  const std::vector<std::string> names(std::begin(kProfileNames), std::end(kProfileNames));
  return Error{ErrorKind::kInput,
               fmt::format("there is no profile '{:.40}'", name),
               {},
               suggest_name(std::string(name), names)};
}

Status JointPath::check(const JointTrajectory& trajectory, size_t joints) {
  GLOAM_TRY_STATUS(check_points(trajectory, joints));
  if (trajectory.profile != TrajectoryProfile::kSpline) {
    GLOAM_TRY_STATUS(check_limit(trajectory.max_velocity, "max_velocity", joints));
    return check_limit(trajectory.max_acceleration, "max_acceleration", joints);
  }
  if (!trajectory.max_velocity.empty() || !trajectory.max_acceleration.empty())
    return bad("the profile 'spline' has times, and no limits",
               "use the profile 'trapezoidal' or 'quintic' to get times from limits");
  return {};
}

}  // namespace gloam
