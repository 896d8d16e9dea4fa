// gloam::JointPath: splines through points at given times, and motions at rest in every point
// within limits of velocity and acceleration (Biagiotti and Melchiorri, "Trajectory Planning for
// Automatic Machines and Robots", 2008: sections 2.1, 3.2 and 5.1).

#include <algorithm>
#include <cmath>
#include <utility>

#include "gloam/joints/joint_trajectory.h"

namespace gloam {
namespace {

// Extrema of the derivatives of s(u) = 10 u³ - 15 u⁴ + 6 u⁵ on [0, 1].
constexpr double kQuinticPeakVelocity = 1.875;
const double kQuinticPeakAcceleration = 10 / std::sqrt(3.0);
// Peak deceleration of the velocity v (1 - 3 u² + 2 u³), relative to v per duration.
constexpr double kSmoothBrakePeak = 1.5;

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

// One limit for each joint.
std::vector<double> spread_limit(const std::vector<double>& limit, size_t joints) {
  return limit.size() == joints ? limit : std::vector<double>(joints, limit[0]);
}

// From `from` in the time T. The degree is the highest that both ends determine. `before`: the
// point at `from`; null = a start, which has all derivatives.
void set_spline(std::span<const JointSample> from, const TrajectoryPoint* before,
                const TrajectoryPoint& to, double T, Polynomial* motion) {
  const bool has_velocities =
      !to.velocities.empty() && (before == nullptr || !before->velocities.empty());
  const bool has_accelerations = has_velocities && !to.accelerations.empty() &&
                                 (before == nullptr || !before->accelerations.empty());
  for (size_t j = 0; j < from.size(); ++j) {
    JointSample end{to.positions[j]};
    if (has_velocities) end.velocity = to.velocities[j];
    if (has_accelerations) end.acceleration = to.accelerations[j];
    if (T <= 0)
      motion[j] = {end.position};
    else if (has_accelerations)
      motion[j] = quintic(from[j], end, T);
    else if (has_velocities)
      motion[j] = cubic(from[j], end, T);
    else
      motion[j] = linear(from[j].position, end.position, T);
  }
}

}  // namespace

struct JointPath::Plan {
  TrajectoryProfile profile = TrajectoryProfile::kSpline;
  size_t joints = 0, last_point = 0;
  TrajectoryPoint first;
  std::vector<double> last;                            ///< positions of the last point
  std::vector<double> max_velocity, max_acceleration;  ///< (joints)
  std::vector<Piece> pieces;       ///< ends after the start for kSpline, else after the first point
  std::vector<Polynomial> motion;  ///< (pieces x joints)

  bool is_spline() const { return profile == TrajectoryProfile::kSpline; }
  size_t pieces_per_line() const { return profile == TrajectoryProfile::kTrapezoidal ? 3 : 1; }
  double begin() const { return is_spline() ? first.time : 0; }
  double end() const { return pieces.empty() ? begin() : pieces.back().end; }
  void set_line(std::span<const double> from, std::span<const double> to, Piece* line,
                Polynomial* line_motion) const;
  void add_spline(const TrajectoryPoint& before, const TrajectoryPoint& to);
  void add_line(std::span<const double> from, std::span<const double> to);
};

// Along the straight line s = 0 … 1, from rest to rest.
void JointPath::Plan::set_line(std::span<const double> from, std::span<const double> to,
                               Piece* line, Polynomial* line_motion) const {
  double slowness = 0, roughness = 0;  // 1 / (largest velocity and acceleration of s)
  for (size_t j = 0; j < joints; ++j) {
    slowness = std::max(slowness, std::abs(to[j] - from[j]) / max_velocity[j]);
    roughness = std::max(roughness, std::abs(to[j] - from[j]) / max_acceleration[j]);
  }
  if (profile == TrajectoryProfile::kQuintic) {
    const double T =
        std::max(kQuinticPeakVelocity * slowness, std::sqrt(kQuinticPeakAcceleration * roughness));
    line[0].length = T;
    for (size_t j = 0; j < joints; ++j)
      line_motion[j] = T > 0 ? quintic({from[j]}, {to[j]}, T) : Polynomial{to[j]};
    return;
  }
  // Accelerates for `ramp`, cruises, and decelerates for `ramp`.
  const double ramp = slowness * slowness > roughness ? roughness / slowness : std::sqrt(roughness);
  const double cruise = slowness * slowness > roughness ? slowness - ramp : 0;
  const double speed = ramp + cruise > 0 ? 1 / (ramp + cruise) : 0;  // of s [1/s]
  line[0].length = line[2].length = ramp;
  line[1].length = cruise;
  for (size_t j = 0; j < joints; ++j) {
    const double d = to[j] - from[j], v = d * speed;
    const double a = ramp > 0 ? v / ramp : 0, way = v * ramp / 2;  // on a ramp
    line_motion[j] = {from[j], 0, a / 2};
    line_motion[joints + j] = {from[j] + way, v};
    line_motion[2 * joints + j] = {to[j] - way, v, -a / 2};
  }
}

void JointPath::Plan::add_spline(const TrajectoryPoint& before, const TrajectoryPoint& to) {
  std::vector<JointSample> from(joints);
  for (size_t j = 0; j < joints; ++j)
    from[j] = {before.positions[j], before.velocities.empty() ? 0 : before.velocities[j],
               before.accelerations.empty() ? 0 : before.accelerations[j]};
  const double T = to.time - before.time;
  pieces.push_back({T, to.time, last_point});
  motion.resize(motion.size() + joints);
  set_spline(from, &before, to, T, motion.data() + motion.size() - joints);
}

void JointPath::Plan::add_line(std::span<const double> from, std::span<const double> to) {
  const size_t first_piece = pieces.size(), count = pieces_per_line();
  double time = end();
  pieces.resize(first_piece + count);
  motion.resize(pieces.size() * joints);
  set_line(from, to, pieces.data() + first_piece, motion.data() + first_piece * joints);
  for (size_t i = first_piece; i < pieces.size(); ++i) {
    pieces[i].point = last_point;
    pieces[i].end = time += pieces[i].length;
  }
}

Result<JointPath> JointPath::make(const JointTrajectory& trajectory, size_t joints) {
  GLOAM_TRY_STATUS(check(trajectory, joints));
  const std::vector<TrajectoryPoint>& points = trajectory.points;
  auto plan = std::make_shared<Plan>();
  plan->profile = trajectory.profile;
  plan->joints = joints;
  plan->first = points.front();
  plan->last = points.back().positions;
  if (!plan->is_spline()) {
    plan->max_velocity = spread_limit(trajectory.max_velocity, joints);
    plan->max_acceleration = spread_limit(trajectory.max_acceleration, joints);
  }
  plan->pieces.reserve((points.size() - 1) * plan->pieces_per_line());
  plan->motion.reserve(plan->pieces.capacity() * joints);
  for (size_t i = 1; i < points.size(); ++i) {
    plan->last_point = i;
    if (plan->is_spline())
      plan->add_spline(points[i - 1], points[i]);
    else
      plan->add_line(points[i - 1].positions, points[i].positions);
  }
  JointPath path;
  path.start_.resize(plan->is_spline() ? 1 : 1 + plan->pieces_per_line());
  path.start_motion_.resize(path.start_.size() * joints);
  path.rest_.resize(joints);
  path.duration_ = plan->end();
  path.plan_ = std::move(plan);
  return path;
}

void JointPath::begin(std::span<const JointSample> start) {
  if (plan_->is_spline()) {
    start_[0].length = plan_->first.time;
    set_spline(start, nullptr, plan_->first, plan_->first.time, start_motion_.data());
  } else {
    set_brake(start);
    plan_->set_line(rest_, plan_->first.positions, start_.data() + 1,
                    start_motion_.data() + plan_->joints);
  }
  reached_ = 0;
  for (Piece& piece : start_) piece.end = reached_ += piece.length;
  shift_ = reached_ - plan_->begin();
  duration_ = shift_ + plan_->end();
}

// All joints come to rest at the same time, the one that needs longest at its limit.
void JointPath::set_brake(std::span<const JointSample> start) {
  const bool is_smooth = plan_->profile == TrajectoryProfile::kQuintic;
  double T = 0;
  for (size_t j = 0; j < start.size(); ++j)
    T = std::max(T, std::abs(start[j].velocity) / plan_->max_acceleration[j]);
  if (is_smooth) T *= kSmoothBrakePeak;
  start_[0].length = T;
  for (size_t j = 0; j < start.size(); ++j) {
    const double q = start[j].position, v = start[j].velocity;
    rest_[j] = q + v * T / 2;
    Polynomial& polynomial = start_motion_[j];
    if (T <= 0)
      polynomial = {q};
    else if (is_smooth)
      polynomial = {q, v, 0, -v / (T * T), v / (2 * T * T * T)};
    else
      polynomial = {q, v, -v / (2 * T)};
  }
}

size_t JointPath::joints() const { return plan_->joints; }

JointPath::Place JointPath::place_at(double time) const {
  const bool is_start = time < reached_ || plan_->pieces.empty();
  const std::span<const Piece> pieces = is_start ? std::span(start_) : std::span(plan_->pieces);
  const double shift = is_start ? 0 : shift_;
  const auto found = std::ranges::upper_bound(pieces, time - shift, {}, &Piece::end);
  const auto i = std::min(static_cast<size_t>(found - pieces.begin()), pieces.size() - 1);
  const double begin = i > 0 ? pieces[i - 1].end : is_start ? 0 : plan_->begin();
  const Polynomial* motion = is_start ? start_motion_.data() : plan_->motion.data();
  return {&pieces[i], motion + i * plan_->joints, std::max(0.0, time - shift - begin)};
}

JointSample JointPath::at(double time, size_t joint) const {
  if (time >= duration_) return {plan_->last[joint]};
  const Place place = place_at(time);
  return evaluate(place.polynomials[joint], place.time);
}

size_t JointPath::point_at(double time) const {
  return time >= duration_ ? plan_->last_point : place_at(time).piece->point;
}

}  // namespace gloam
