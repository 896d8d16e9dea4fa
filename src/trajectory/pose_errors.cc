// Absolute and relative errors of associated trajectories.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "trajectory/rigid_pose.h"

namespace gloam {
namespace {

using PosePairs = std::vector<std::pair<size_t, size_t>>;

constexpr size_t kMostPosesByAngle = 30'000;  // 450 million pairs, seconds

double part_of(const RigidPose& E, ErrorPart part) {
  if (part == ErrorPart::kTranslation) return norm(E.p);
  if (part == ErrorPart::kAngle) return angle_of(nearest_quaternion(E.R));
  double squares = E.p.x * E.p.x + E.p.y * E.p.y + E.p.z * E.p.z;
  for (size_t i = 0; i < 9; ++i) {
    const double e = E.R[i] - (i % 4 == 0 ? 1.0 : 0.0);
    squares += e * e;
  }
  return std::sqrt(squares);
}

Result<PoseErrors> finished(PoseErrors errors) {
  for (const double value : errors.values)
    if (!std::isfinite(value)) return Error{ErrorKind::kInput, "the error of a pose is not finite"};
  errors.statistics = statistics_of(errors.values);
  return errors;
}

/// From each pose to the next, in the unit of delta; the first is 0.
std::vector<double> steps_of(const Trajectory& along, DeltaUnit unit) {
  std::vector<double> steps(along.size(), 0);
  std::vector<Quat> turned;
  if (unit == DeltaUnit::kRadians)
    for (const RotationRows& R : along.rotations) turned.push_back(nearest_quaternion(R));
  for (size_t i = 1; i < along.size(); ++i) {
    if (unit == DeltaUnit::kSeconds)
      steps[i] = 1e-9 * static_cast<double>(along.stamps[i] - along.stamps[i - 1]);
    else if (unit == DeltaUnit::kMeters)
      steps[i] = norm(along.positions[i] - along.positions[i - 1]);
    else
      steps[i] = angle_of(relative(turned[i - 1], turned[i]));
  }
  return steps;
}

PosePairs consecutive_pairs(const std::vector<double>& steps, double delta) {
  PosePairs pairs;
  size_t start = 0;
  double way = 0;
  for (size_t i = 1; i < steps.size(); ++i) {
    way += steps[i];
    if (way < delta) continue;
    pairs.emplace_back(start, i);
    start = i;
    way = 0;
  }
  return pairs;
}

// The pose nearest to `delta` behind each pose; of two as near the first. `at`: along the way.
PosePairs all_pairs_of(const std::vector<double>& at, double delta, double tolerance) {
  PosePairs pairs;
  for (size_t i = 0; i + 1 < at.size(); ++i) {
    const auto begin = at.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    auto best = std::lower_bound(begin, at.end(), at[i] + delta);
    if (best == at.end() ||
        (best != begin && delta - (*(best - 1) - at[i]) <= std::fabs((*best - at[i]) - delta)))
      --best;
    best = std::lower_bound(begin, at.end(), *best);
    if (std::fabs((*best - at[i]) - delta) > tolerance) continue;
    pairs.emplace_back(i, static_cast<size_t>(best - at.begin()));
  }
  return pairs;
}

PosePairs all_pairs_by_angle(const Trajectory& along, double delta, double tolerance) {
  std::vector<Quat> turned;
  for (const RotationRows& R : along.rotations) turned.push_back(nearest_quaternion(R));
  PosePairs pairs;
  for (size_t i = 0; i < turned.size(); ++i)
    for (size_t j = i + 1; j < turned.size(); ++j) {
      const double angle = angle_of(relative(turned[i], turned[j]));
      if (delta - tolerance <= angle && angle <= delta + tolerance) pairs.emplace_back(i, j);
    }
  return pairs;
}

PosePairs pairs_by_frames(size_t poses, size_t delta, bool all) {
  PosePairs pairs;
  for (size_t i = 0; i < poses && delta < poses - i; i += all ? 1 : delta)
    pairs.emplace_back(i, i + delta);
  return pairs;
}

Status check_options(const Trajectory& along, const RelativeOptions& options) {
  const auto wrong = [](std::string message) {
    return Error{ErrorKind::kUsage, std::move(message)};
  };
  if (!(options.delta > 0) || !std::isfinite(options.delta))
    return wrong("the delta of relative errors must be above 0");
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
    return wrong("the tolerance of the delta must be 0 or above");
  if (options.unit == DeltaUnit::kFrames &&
      (options.delta != std::floor(options.delta) || options.delta > 1e15))
    return wrong(fmt::format("a delta of {} frames is not a whole number", options.delta));
  if (options.unit == DeltaUnit::kRadians && options.delta > std::numbers::pi)
    return wrong("a delta of angles must be at most half a turn");
  if (options.unit == DeltaUnit::kSeconds && along.stamps.empty())
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' has no times for a delta in seconds", along.name)};
  if (options.unit == DeltaUnit::kRadians && options.all_pairs && along.size() > kMostPosesByAngle)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("all pairs by angle are limited to {} poses", kMostPosesByAngle),
                 {},
                 "consecutive pairs are not limited"};
  return {};
}

PosePairs chosen_pairs(const Trajectory& along, const RelativeOptions& options) {
  if (options.unit == DeltaUnit::kFrames)
    return pairs_by_frames(along.size(), static_cast<size_t>(options.delta), options.all_pairs);
  const double tolerance = options.tolerance * options.delta;
  if (options.unit == DeltaUnit::kRadians && options.all_pairs)
    return all_pairs_by_angle(along, options.delta, tolerance);
  std::vector<double> steps = steps_of(along, options.unit);
  if (!options.all_pairs) return consecutive_pairs(steps, options.delta);
  std::partial_sum(steps.begin(), steps.end(), steps.begin());
  return all_pairs_of(steps, options.delta, tolerance);
}

}  // namespace

ErrorStatistics statistics_of(std::vector<double> values) {
  GLOAM_CHECK(!values.empty(), "statistics need at least one value");
  const double n = static_cast<double>(values.size());
  ErrorStatistics out;
  for (const double v : values) {
    out.sse += v * v;
    out.mean += v;
  }
  out.rmse = std::sqrt(out.sse / n);
  out.mean /= n;
  double squares = 0;
  for (const double v : values) squares += (v - out.mean) * (v - out.mean);
  out.std = std::sqrt(squares / n);
  std::sort(values.begin(), values.end());
  out.min = values.front();
  out.max = values.back();
  const size_t middle = values.size() / 2;
  out.median =
      values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return out;
}

Result<PoseErrors> absolute_errors(const TrajectoryPair& pair, ErrorPart part) {
  GLOAM_CHECK(pair.reference.size() == pair.estimate.size() && pair.reference.size() > 0,
              "trajectories must be associated first");
  PoseErrors errors;
  for (size_t i = 0; i < pair.reference.size(); ++i) {
    const RigidPose estimate = pose_of(pair.estimate, i), reference = pose_of(pair.reference, i);
    errors.values.push_back(part == ErrorPart::kTranslation
                                ? norm(estimate.p - reference.p)
                                : part_of(relative(estimate, reference), part));
    errors.poses.push_back(i);
  }
  return finished(std::move(errors));
}

Result<PoseErrors> relative_errors(const TrajectoryPair& pair, ErrorPart part,
                                   const RelativeOptions& options) {
  GLOAM_CHECK(pair.reference.size() == pair.estimate.size() && pair.reference.size() > 0,
              "trajectories must be associated first");
  const Trajectory& along = options.from_reference ? pair.reference : pair.estimate;
  GLOAM_TRY_STATUS(check_options(along, options));
  const PosePairs pairs = chosen_pairs(along, options);
  if (pairs.empty())
    return Error{ErrorKind::kInput,
                 fmt::format("no two of the {} poses are {} apart", along.size(), options.delta),
                 {},
                 "use a lower delta"};
  PoseErrors errors;
  for (const auto& [i, j] : pairs) {
    const RigidPose of_reference = relative(pose_of(pair.reference, i), pose_of(pair.reference, j));
    const RigidPose of_estimate = relative(pose_of(pair.estimate, i), pose_of(pair.estimate, j));
    errors.values.push_back(part_of(relative(of_reference, of_estimate), part));
    errors.poses.push_back(j);
  }
  return finished(std::move(errors));
}

}  // namespace gloam
