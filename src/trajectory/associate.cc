// Association of two trajectories by time, and alignment of one to the other.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/log.h"
#include "trajectory/rigid_pose.h"

namespace gloam {
namespace {

Trajectory picked(const Trajectory& from, const std::vector<size_t>& indices) {
  Trajectory out;
  out.name = from.name;
  for (const size_t i : indices) {
    if (!from.stamps.empty()) out.stamps.push_back(from.stamps[i]);
    out.positions.push_back(from.positions[i]);
    out.rotations.push_back(from.rotations[i]);
  }
  return out;
}

// Seconds as evo has them, rounded to a double: ties of times in the middle fall as there.
double seconds_of(int64_t stamp) {
  return static_cast<double>(static_cast<long double>(stamp) / 1e9L);
}

// Index of the stamp nearest to t; of two as near the earlier.
size_t nearest_stamp(const std::vector<int64_t>& stamps, int64_t t) {
  const auto above = std::upper_bound(stamps.begin(), stamps.end(), t);
  if (above == stamps.begin()) return 0;
  const size_t below = static_cast<size_t>(above - stamps.begin()) - 1;
  if (above == stamps.end()) return below;
  const double time = seconds_of(t);
  return seconds_of(*above) - time < time - seconds_of(stamps[below]) ? below + 1 : below;
}

std::string span_of(const Trajectory& t) {
  return fmt::format("'{}' spans {:.3f} to {:.3f} s", t.name,
                     1e-9 * static_cast<double>(t.stamps.front()),
                     1e-9 * static_cast<double>(t.stamps.back()));
}

Eigen::Vector3d vector_of(const Vec3& v) { return {v.x, v.y, v.z}; }

enum class WithScale : bool { kNo, kYes };

// Second singular value of the covariance, over the first, below which positions count as on one
// line: they deviate from it by less than a thousandth of its length.
constexpr double kLine = 1e-6;
// The same below which the deviations are those of rounding.
constexpr double kRounding = 1e-13;

// The smallest rotation from one unit vector to another.
Eigen::Matrix3d least_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

void warn_of_open_turn(const Trajectory& reference, const Trajectory& estimate) {
  log_warning(
      "'{}' and '{}' follow a straight line to within a thousandth of its length: the rotation of "
      "the alignment about that line is undetermined, and so are the rotation and full parts of "
      "the absolute error (ATE). Its translation part and relative errors (RPE) are determined. "
      "Align by 'origin' or 'none' for rotations",
      reference.name, estimate.name);
}

// Least squares of Umeyama 1991, equations 34 to 43.
Result<Similarity> umeyama(const Trajectory& from, const Trajectory& to, WithScale with_scale) {
  const double n = static_cast<double>(from.size());
  Eigen::Vector3d mean_x = Eigen::Vector3d::Zero(), mean_y = mean_x;
  for (size_t i = 0; i < from.size(); ++i) {
    mean_x += vector_of(from.positions[i]);
    mean_y += vector_of(to.positions[i]);
  }
  mean_x /= n;
  mean_y /= n;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance = 0;
  for (size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d x = vector_of(from.positions[i]) - mean_x;
    covariance += (vector_of(to.positions[i]) - mean_y) * x.transpose();
    variance += x.squaredNorm();
  }
  covariance /= n;
  variance /= n;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d d = svd.singularValues();
  if (!(d[0] > std::numeric_limits<double>::epsilon()))
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' or '{}' stays at one point: the rotation is undetermined",
                             from.name, to.name),
                 {},
                 "align by the first poses ('origin'), or not at all ('none')"};
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  Eigen::Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  Similarity out;
  out.is_turn_open = d[1] <= kLine * d[0];
  if (d[1] <= kRounding * d[0]) R = least_rotation(svd.matrixV().col(0), svd.matrixU().col(0));
  if (with_scale == WithScale::kYes) out.scale = d.dot(sign) / variance;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.R_AB[static_cast<size_t>(3 * i + j)] = R(i, j);
  const Eigen::Vector3d p = mean_y - out.scale * (R * mean_x);
  out.p_AB = {p[0], p[1], p[2]};
  return out;
}

}  // namespace

Result<TrajectoryPair> associate(const Trajectory& reference, const Trajectory& estimate,
                                 const AssociationOptions& options) {
  if (reference.stamps.empty() || estimate.stamps.empty()) {
    if (reference.size() == estimate.size()) return TrajectoryPair{reference, estimate};
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' has {} poses and '{}' has {}, without times to match them",
                             reference.name, reference.size(), estimate.name, estimate.size()),
                 {},
                 "KITTI files have no times; use the TUM format"};
  }
  if (!(options.max_difference >= 0 && options.max_difference <= 1e9 &&
        std::fabs(options.offset) <= 1e9))
    return Error{ErrorKind::kUsage, "time differences and offsets must be at most 1e9 s"};
  const bool estimate_longer = estimate.size() > reference.size();
  const Trajectory& few = estimate_longer ? reference : estimate;
  const Trajectory& many = estimate_longer ? estimate : reference;
  const auto nanoseconds = [](double seconds) { return std::llround(seconds * 1e9); };
  const int64_t most = nanoseconds(options.max_difference);
  // Offset of the times of `few`, so that they compare with those of `many`.
  const int64_t shift = nanoseconds(estimate_longer ? -options.offset : options.offset);
  std::vector<size_t> of_few, of_many;
  for (size_t i = 0; i < few.size(); ++i) {
    const int64_t t = few.stamps[i] + shift;
    const size_t j = nearest_stamp(many.stamps, t);
    if (std::abs(many.stamps[j] - t) > most) continue;
    of_few.push_back(i);
    of_many.push_back(j);
  }
  if (of_few.empty())
    return Error{ErrorKind::kInput,
                 fmt::format("no poses within {} s of each other: {}, {}", options.max_difference,
                             span_of(reference), span_of(estimate)),
                 {},
                 "use an offset to shift the estimate's times"};
  const Trajectory short_one = picked(few, of_few), long_one = picked(many, of_many);
  return estimate_longer ? TrajectoryPair{short_one, long_one}
                         : TrajectoryPair{long_one, short_one};
}

Result<Similarity> align(Alignment alignment, TrajectoryPair* pair) {
  Similarity by;
  Trajectory& moved = pair->estimate;
  if (alignment == Alignment::kNone) return by;
  if (alignment == Alignment::kOrigin) {
    const RigidPose X = product(pose_of(pair->reference, 0), inverse(pose_of(moved, 0)));
    by.R_AB = X.R;
    by.p_AB = X.p;
  } else {
    GLOAM_TRY(by, umeyama(moved, pair->reference,
                          alignment == Alignment::kSe3 ? WithScale::kNo : WithScale::kYes));
    if (alignment == Alignment::kScale) by = {.scale = by.scale};
    if (by.is_turn_open) warn_of_open_turn(pair->reference, moved);
  }
  for (size_t i = 0; i < moved.size(); ++i) {
    moved.positions[i] = rotate(by.R_AB, by.scale * moved.positions[i]) + by.p_AB;
    moved.rotations[i] = product(by.R_AB, moved.rotations[i]);
  }
  return by;
}

}  // namespace gloam
