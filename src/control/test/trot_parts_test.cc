// The parts of the trot controller on their own: forces, swing path, gait clock.

#include <gtest/gtest.h>

#include "base/rng.h"
#include "control/trot_force.h"
#include "control/trot_gait.h"
#include "control/trot_swing.h"

namespace gloam {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Eigen::Vector3d;

ForceProblem standing_on(std::array<bool, 4> stands) {
  ForceProblem problem;
  problem.stands = stands;
  for (int k = 0; k < 4; ++k)
    problem.foot[k] = {k < 2 ? 0.19 : -0.19, k % 2 == 0 ? 0.13 : -0.13, -0.3};
  problem.R_WH.setIdentity();
  problem.wrench.setZero();
  problem.wrench[2] = 125;
  return problem;
}

Vector6d wrench_of(const ForceProblem& problem, const std::array<Vector3d, 4>& force) {
  Vector6d out = Vector6d::Zero();
  for (int k = 0; k < 4; ++k) {
    out.head<3>() += force[k];
    out.tail<3>() += problem.foot[k].cross(force[k]);
  }
  return out;
}

double cost_of(const TrotOptions& o, const ForceProblem& problem,
               const std::array<Vector3d, 4>& force, const std::array<Vector3d, 4>& last) {
  const Vector6d e = wrench_of(problem, force) - problem.wrench;
  double cost = o.weight_xy * (e[0] * e[0] + e[1] * e[1]) + o.weight_z * e[2] * e[2] +
                o.weight_tilt * (e[3] * e[3] + e[4] * e[4]) + o.weight_yaw * e[5] * e[5];
  for (int k = 0; k < 4; ++k)
    cost += o.weight_force * force[k].squaredNorm() +
            o.weight_change * (force[k] - last[k]).squaredNorm();
  return cost;
}

TEST(TrotForce, FourFeetGiveAWrenchWithinReach) {
  TrotOptions options;
  ForceDistribution forces(options);
  ForceProblem problem = standing_on({true, true, true, true});
  problem.wrench << 10, -6, 130, 2, -3, 1.5;
  std::array<Vector3d, 4> force;
  for (int call = 0; call < 50; ++call) force = forces.solve(problem);
  const Vector6d error = wrench_of(problem, force) - problem.wrench;
  EXPECT_LT(error.head<3>().norm(), 0.3);
  EXPECT_LT(error.tail<3>().norm(), 0.05);
}

TEST(TrotForce, StaysInsideTheFrictionPyramid) {
  TrotOptions options;
  ForceDistribution forces(options);
  ForceProblem problem = standing_on({true, false, false, true});
  problem.R_WH = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  problem.wrench << 300, -200, 100, 40, 30, 20;  // far out of reach
  const auto& force = forces.solve(problem);
  for (int k = 0; k < 4; ++k) {
    const Vector3d f = problem.R_WH.transpose() * force[k];
    EXPECT_LE(std::abs(f.x()), options.friction * f.z() + 1e-9);
    EXPECT_LE(std::abs(f.y()), options.friction * f.z() + 1e-9);
    if (!problem.stands[k]) {
      EXPECT_EQ(force[k].norm(), 0);
    }
  }
  EXPECT_GT(force[0].norm(), 1);
}

TEST(TrotForce, NoNearbyForcesInsideThePyramidAreBetter) {
  TrotOptions options;
  const RandomStream random{7, stream_id("trot.force_test")};
  for (uint32_t trial = 0; trial < 20; ++trial) {
    ForceDistribution forces(options);
    ForceProblem problem = standing_on({true, trial % 2 == 0, trial % 2 == 0, true});
    for (int i = 0; i < 6; ++i)
      problem.wrench[i] += (i < 3 ? 60 : 8) * (2 * random.uniform(trial, i) - 1);
    for (int call = 0; call < 200; ++call) forces.solve(problem);
    const std::array<Vector3d, 4> force = forces.solve(problem);
    const auto& last = force;  // converged: the change term is about this very point
    const double best = cost_of(options, problem, force, last);
    for (uint32_t n = 0; n < 500; ++n) {
      auto other = force;
      bool feasible = true;
      for (int k = 0; k < 4; ++k) {
        if (!problem.stands[k]) continue;
        for (int i = 0; i < 3; ++i)
          other[k][i] += 2 * (2 * random.uniform(1000 + n, 12 * trial + 3 * k + i) - 1);
        feasible &= std::abs(other[k].x()) <= options.friction * other[k].z() &&
                    std::abs(other[k].y()) <= options.friction * other[k].z();
      }
      if (feasible) {
        EXPECT_GT(cost_of(options, problem, other, last), best - 0.02);
      }
    }
  }
}

TEST(TrotSwing, GoesFromLiftOffToFootholdOverTheTop) {
  const Vector3d from(0.1, 0.2, 0.02), to(0.25, 0.17, 0.04);
  const FootGoal start = swing_point(from, to, 0.06, 0, 0.2);
  const FootGoal middle = swing_point(from, to, 0.06, 0.5, 0.2);
  const FootGoal end = swing_point(from, to, 0.06, 1, 0.2);
  EXPECT_LT((start.p - from).norm(), 1e-12);
  EXPECT_LT((end.p - to).norm(), 1e-12);
  EXPECT_LT(start.v.norm() + end.v.norm(), 1e-12);
  EXPECT_NEAR(middle.p.z(), 0.10, 1e-12);
  EXPECT_LT((middle.p - 0.5 * (from + to)).head<2>().norm(), 1e-12);
  EXPECT_LT((swing_point(from, to, 0.06, 7, 0.2).p - to).norm(), 1e-12);  // stays there
}

TEST(TrotSwing, VelocityAndAccelerationAreDerivatives) {
  const Vector3d from(0, 0, 0), to(0.2, -0.05, 0.02);
  const double T = 0.2, h = 1e-6;
  for (double phase = 0.05; phase < 1; phase += 0.0901) {
    const FootGoal a = swing_point(from, to, 0.06, phase - h, T);
    const FootGoal b = swing_point(from, to, 0.06, phase + h, T);
    const FootGoal at = swing_point(from, to, 0.06, phase, T);
    EXPECT_LT(((b.p - a.p) / (2 * h * T) - at.v).norm(), 1e-6);
    EXPECT_LT(((b.v - a.v) / (2 * h * T) - at.a).norm(), 1e-4);
  }
}

TEST(TrotGait, DiagonalPairsAlternateWithTheDuty) {
  TrotGait gait(0.4, 0.6);
  for (int leg = 0; leg < 4; ++leg) EXPECT_TRUE(gait.should_stand(leg));
  gait.start();
  std::array<int, 4> stands{};
  int both_in_air = 0;
  for (int i = 0; i < 4000; ++i) {
    gait.advance(0.001);
    EXPECT_EQ(gait.should_stand(0), gait.should_stand(3));
    EXPECT_EQ(gait.should_stand(1), gait.should_stand(2));
    both_in_air += !gait.should_stand(0) && !gait.should_stand(1);
    for (int leg = 0; leg < 4; ++leg) {
      stands[leg] += gait.should_stand(leg);
      if (!gait.should_stand(leg)) {
        EXPECT_GE(gait.swing_phase(leg), 0);
        EXPECT_LT(gait.swing_phase(leg), 1);
      }
    }
  }
  EXPECT_EQ(both_in_air, 0);
  for (int leg = 0; leg < 4; ++leg) EXPECT_NEAR(stands[leg], 2400, 10);
}

}  // namespace
}  // namespace gloam
