// gloam::JointPath: splines through points at given times, and motions at rest in every point
// within limits of velocity and acceleration (Biagiotti and Melchiorri, "Trajectory Planning for
// Automatic Machines and Robots", 2008: sections 2.1, 3.2 and 5.1).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "gloam/joints/joint_trajectory.h"

namespace gloam {
namespace {

constexpr size_t kMostPoints = 100'000;
constexpr size_t kMostPositions = 1'000'000;
// Bounds of numbers and of the time between points [s], within which no polynomial overflows.
constexpr double kLargest = 1e9, kShortest = 1e-9;
// Extrema of the derivatives of s(u) = 10 u³ - 15 u⁴ + 6 u⁵ on [0, 1].
constexpr double kQuinticPeakVelocity = 1.875;
const double kQuinticPeakAcceleration = 10 / std::sqrt(3.0);
// Peak deceleration of the velocity v (1 - 3 u² + 2 u³), relative to v per duration.
constexpr double kSmoothBrakePeak = 1.5;

Error bad(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

bool are_bounded(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return std::abs(v) <= kLargest; });
}

Status check_vector(const std::vector<double>& values, std::string_view name, size_t joints) {
  if (!values.empty() && values.size() != joints)
    return bad(fmt::format("a point has {} {} for {} joints", values.size(), name, joints));
  if (!are_bounded(values))
    return bad(fmt::format("the {} of a point are not finite, or above {:g}", name, kLargest));
  return {};
}

Status check_points(const JointTrajectory& trajectory, size_t joints) {
  if (joints == 0) return bad("the trajectory has no joints");
  if (trajectory.points.empty()) return bad("the trajectory has no points");
  if (trajectory.points.size() > kMostPoints || trajectory.points.size() * joints > kMostPositions)
    return bad(fmt::format("the trajectory has more than {} points or {} positions", kMostPoints,
                           kMostPositions));
  const bool has_times = trajectory.profile == TrajectoryProfile::kSpline;
  double before = -1;
  for (const TrajectoryPoint& point : trajectory.points) {
    if (point.positions.empty()) return bad("a point has no positions");
    GLOAM_TRY_STATUS(check_vector(point.positions, "positions", joints));
    GLOAM_TRY_STATUS(check_vector(point.velocities, "velocities", joints));
    GLOAM_TRY_STATUS(check_vector(point.accelerations, "accelerations", joints));
    if (!has_times && !(point.velocities.empty() && point.accelerations.empty()))
      return bad("points have velocities or accelerations, but the profile stops in each point",
                 "use the profile 'spline', or give positions only");
    if (!has_times) continue;
    if (!(point.time >= 0 && point.time <= kLargest))
      return bad("the time of a point is negative or not finite");
    if (point.time < before + kShortest) return bad("the times of the points do not increase");
    before = point.time;
  }
  return {};
}

// One limit for each joint.
Result<std::vector<double>> spread_limit(const std::vector<double>& limit, std::string_view name,
                                         size_t joints) {
  if (limit.size() != 1 && limit.size() != joints)
    return bad(fmt::format("'{}' has {} numbers for {} joints", name, limit.size(), joints),
               "give one limit per joint, or one for all");
  if (!std::ranges::all_of(limit, [](double v) { return v >= 1 / kLargest && v <= kLargest; }))
    return bad(fmt::format("'{}' must be positive and finite", name));
  return limit.size() == joints ? limit : std::vector<double>(joints, limit[0]);
}

using Polynomial = std::array<double, 6>;

JointSample evaluate(const Polynomial& c, double t) {
  const auto& [c0, c1, c2, c3, c4, c5] = c;
  return {c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))),
          c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5))),
          2 * c2 + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))};
}

Polynomial linear(double from, double to, double T) { return {from, (to - from) / T}; }

Polynomial cubic(const JointSample& a, const JointSample& b, double T) {
  const double h = b.position - a.position;
  return {a.position, a.velocity, (3 * h - (2 * a.velocity + b.velocity) * T) / (T * T),
          (-2 * h + (a.velocity + b.velocity) * T) / (T * T * T)};
}

Polynomial quintic(const JointSample& a, const JointSample& b, double T) {
  const double h = b.position - a.position, T2 = T * T;
  const double va = a.velocity * T, vb = b.velocity * T;
  const double aa = a.acceleration * T2, ab = b.acceleration * T2;
  return {a.position,
          a.velocity,
          a.acceleration / 2,
          (20 * h - 8 * vb - 12 * va - 3 * aa + ab) / (2 * T2 * T),
          (-30 * h + 14 * vb + 16 * va + 3 * aa - 2 * ab) / (2 * T2 * T2),
          (12 * h - 6 * (vb + va) + ab - aa) / (2 * T2 * T2 * T)};
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

Result<JointPath> JointPath::make(const JointTrajectory& trajectory, size_t joints) {
  GLOAM_TRY_STATUS(check_points(trajectory, joints));
  JointPath path;
  path.profile_ = trajectory.profile;
  path.joints_ = joints;
  path.points_ = trajectory.points;
  const bool is_spline = path.profile_ == TrajectoryProfile::kSpline;
  if (is_spline) {
    if (!trajectory.max_velocity.empty() || !trajectory.max_acceleration.empty())
      return bad("the profile 'spline' has times, and no limits",
                 "use the profile 'trapezoidal' or 'quintic' to get times from limits");
  } else {
    GLOAM_TRY(path.max_velocity_, spread_limit(trajectory.max_velocity, "max_velocity", joints));
    GLOAM_TRY(path.max_acceleration_,
              spread_limit(trajectory.max_acceleration, "max_acceleration", joints));
    path.rest_.resize(joints);
  }
  path.pieces_per_line_ = path.profile_ == TrajectoryProfile::kTrapezoidal ? 3 : 1;
  const size_t points = path.points_.size();
  const size_t brake = is_spline ? 0 : 1;
  path.pieces_.resize(points * path.pieces_per_line_ + brake);
  path.polynomials_.resize(path.pieces_.size() * joints);
  for (size_t i = brake; i < path.pieces_.size(); ++i)
    path.pieces_[i].point = (i - brake) / path.pieces_per_line_;
  // Everything but the way to the first point is the same wherever it starts.
  std::vector<JointSample> from(joints);
  for (size_t point = 1; point < points; ++point) {
    const TrajectoryPoint& a = path.points_[point - 1];
    if (!is_spline) {
      path.set_line(point, a.positions);
      continue;
    }
    for (size_t j = 0; j < joints; ++j)
      from[j] = {a.positions[j], a.velocities.empty() ? 0 : a.velocities[j],
                 a.accelerations.empty() ? 0 : a.accelerations[j]};
    path.set_spline(point, from, path.points_[point]);
  }
  path.set_ends();
  return path;
}

void JointPath::begin(std::span<const JointSample> start) {
  if (profile_ == TrajectoryProfile::kSpline) {
    set_spline(0, start, points_[0]);
  } else {
    set_brake(start);
    set_line(0, rest_);
  }
  set_ends();
}

// The degree is the highest that both ends determine; a start has all derivatives.
void JointPath::set_spline(size_t piece, std::span<const JointSample> from,
                           const TrajectoryPoint& to) {
  const TrajectoryPoint* before = piece == 0 ? nullptr : &points_[piece - 1];
  const double T = to.time - (before == nullptr ? 0 : before->time);
  pieces_[piece].length = T;
  const bool has_velocities =
      !to.velocities.empty() && (before == nullptr || !before->velocities.empty());
  const bool has_accelerations = has_velocities && !to.accelerations.empty() &&
                                 (before == nullptr || !before->accelerations.empty());
  for (size_t j = 0; j < joints_; ++j) {
    Polynomial& polynomial = polynomials(piece)[j];
    JointSample end{to.positions[j]};
    if (has_velocities) end.velocity = to.velocities[j];
    if (has_accelerations) end.acceleration = to.accelerations[j];
    if (T <= 0)
      polynomial = {end.position};
    else if (has_accelerations)
      polynomial = quintic(from[j], end, T);
    else if (has_velocities)
      polynomial = cubic(from[j], end, T);
    else
      polynomial = linear(from[j].position, end.position, T);
  }
}

// All joints come to rest at the same time, the one that needs longest at its limit.
void JointPath::set_brake(std::span<const JointSample> start) {
  const bool is_smooth = profile_ == TrajectoryProfile::kQuintic;
  double T = 0;
  for (size_t j = 0; j < joints_; ++j)
    T = std::max(T, std::abs(start[j].velocity) / max_acceleration_[j]);
  if (is_smooth) T *= kSmoothBrakePeak;
  pieces_[0].length = T;
  for (size_t j = 0; j < joints_; ++j) {
    const double q = start[j].position, v = start[j].velocity;
    rest_[j] = q + v * T / 2;
    Polynomial& polynomial = polynomials(0)[j];
    if (T <= 0)
      polynomial = {q};
    else if (is_smooth)
      polynomial = {q, v, 0, -v / (T * T), v / (2 * T * T * T)};
    else
      polynomial = {q, v, -v / (2 * T)};
  }
}

// Along the straight line s = 0 … 1 from `from` to a point, from rest to rest.
void JointPath::set_line(size_t point, std::span<const double> from) {
  const std::vector<double>& to = points_[point].positions;
  const size_t first = 1 + point * pieces_per_line_;
  const bool is_smooth = profile_ == TrajectoryProfile::kQuintic;
  double slowness = 0, roughness = 0;  // 1 / (largest velocity and acceleration of s)
  for (size_t j = 0; j < joints_; ++j) {
    slowness = std::max(slowness, std::abs(to[j] - from[j]) / max_velocity_[j]);
    roughness = std::max(roughness, std::abs(to[j] - from[j]) / max_acceleration_[j]);
  }
  if (is_smooth) {
    const double T =
        std::max(kQuinticPeakVelocity * slowness, std::sqrt(kQuinticPeakAcceleration * roughness));
    pieces_[first].length = T;
    for (size_t j = 0; j < joints_; ++j)
      polynomials(first)[j] = T > 0 ? quintic({from[j]}, {to[j]}, T) : Polynomial{to[j]};
    return;
  }
  // Accelerates for `ramp`, cruises, and decelerates for `ramp`.
  const double ramp = slowness * slowness > roughness ? roughness / slowness : std::sqrt(roughness);
  const double cruise = slowness * slowness > roughness ? slowness - ramp : 0;
  const double speed = ramp + cruise > 0 ? 1 / (ramp + cruise) : 0;  // of s [1/s]
  pieces_[first].length = pieces_[first + 2].length = ramp;
  pieces_[first + 1].length = cruise;
  for (size_t j = 0; j < joints_; ++j) {
    const double d = to[j] - from[j], v = d * speed;
    const double a = ramp > 0 ? v / ramp : 0, way = v * ramp / 2;  // on a ramp
    polynomials(first)[j] = {from[j], 0, a / 2};
    polynomials(first + 1)[j] = {from[j] + way, v};
    polynomials(first + 2)[j] = {to[j] - way, v, -a / 2};
  }
}

void JointPath::set_ends() {
  double end = 0;
  for (Piece& piece : pieces_) piece.end = end += piece.length;
  // The sum of the lengths rounds; a spline ends at its last point's time.
  if (profile_ == TrajectoryProfile::kSpline)
    for (Piece& piece : pieces_) piece.end = points_[piece.point].time;
  duration_ = pieces_.back().end;
}

size_t JointPath::piece_at(double time) const {
  const auto piece = std::ranges::upper_bound(pieces_, time, {}, &Piece::end);
  return std::min(static_cast<size_t>(piece - pieces_.begin()), pieces_.size() - 1);
}

JointSample JointPath::at(double time, size_t joint) const {
  if (time >= duration_) return {points_.back().positions[joint]};
  const size_t piece = piece_at(time);
  const double begin = piece == 0 ? 0 : pieces_[piece - 1].end;
  return evaluate(polynomials_[piece * joints_ + joint], std::max(0.0, time - begin));
}

size_t JointPath::point_at(double time) const { return pieces_[piece_at(time)].point; }

}  // namespace gloam
