#include "control/trot_force.h"

#include <algorithm>

namespace gloam {
namespace {
using Matrix6x16 = Eigen::Matrix<double, 6, 16>;
using Matrix3x4 = Eigen::Matrix<double, 3, 4>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
}  // namespace

void ForceDistribution::reset() {
  mix_.setZero();
  for (auto& force : force_) force.setZero();
}

const std::array<Eigen::Vector3d, 4>& ForceDistribution::solve(const ForceProblem& problem) {
  const double mu = options_.friction;
  Matrix3x4 edges_H;
  edges_H << mu, -mu, mu, -mu, mu, mu, -mu, -mu, 1, 1, 1, 1;
  const Matrix3x4 edges = problem.R_WH * edges_H;

  // Rows in the heading frame, scaled by the weights.
  Vector6d weight;
  weight << options_.weight_xy, options_.weight_xy, options_.weight_z, options_.weight_tilt,
      options_.weight_tilt, options_.weight_yaw;
  weight = weight.cwiseSqrt();
  const auto weigh = [&](const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
    Vector6d row;
    row.head<3>() = problem.R_WH.transpose() * force;
    row.tail<3>() = problem.R_WH.transpose() * moment;
    return Vector6d(weight.cwiseProduct(row));
  };
  Matrix6x16 A = Matrix6x16::Zero();
  for (int leg = 0; leg < 4; ++leg)
    if (problem.stands[leg])
      for (int e = 0; e < 4; ++e)
        A.col(4 * leg + e) = weigh(edges.col(e), problem.foot[leg].cross(edges.col(e)));
  const Vector6d wanted = weigh(problem.wrench.head<3>(), problem.wrench.tail<3>());

  Eigen::Matrix<double, 16, 16> H = A.transpose() * A;
  Eigen::Matrix<double, 16, 1> g = A.transpose() * wanted;
  const Eigen::Matrix4d gram = edges.transpose() * edges;
  for (int leg = 0; leg < 4; ++leg) {
    if (!problem.stands[leg]) {
      mix_.segment<4>(4 * leg).setZero();
      force_[leg].setZero();
      continue;
    }
    H.block<4, 4>(4 * leg, 4 * leg) += (options_.weight_force + options_.weight_change) * gram;
    g.segment<4>(4 * leg) += options_.weight_change * (edges.transpose() * force_[leg]);
  }
  for (int sweep = 0; sweep < options_.sweeps; ++sweep)
    for (int leg = 0; leg < 4; ++leg) {
      if (!problem.stands[leg]) continue;
      for (int i = 4 * leg; i < 4 * leg + 4; ++i)
        mix_[i] = std::max(0.0, mix_[i] + (g[i] - H.col(i).dot(mix_)) / H(i, i));
    }
  for (int leg = 0; leg < 4; ++leg)
    if (problem.stands[leg]) force_[leg] = edges * mix_.segment<4>(4 * leg);
  return force_;
}

}  // namespace gloam
