// Paths of joints against closed forms: splines, trapezoidal and quintic profiles.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gloam/joints/joint_trajectory.h"

namespace gloam {
namespace {

using testing::HasSubstr;

JointPath path_of(const JointTrajectory& trajectory, const std::vector<JointSample>& start) {
  Result<JointPath> made = JointPath::make(trajectory, start.size());
  EXPECT_TRUE(made.ok()) << made.error().to_string();
  JointPath path = *made;
  path.begin(start);
  return path;
}

std::vector<double> steps_of(const JointPath& path, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(path.duration() * i / count);
  return times;
}

// The derivatives that a path gives are those of its positions, and positions do not jump.
void expect_consistent(const JointPath& path) {
  const double dt = path.duration() / 50'000;
  for (size_t j = 0; j < path.joints(); ++j) {
    for (double t = 0; t + 2 * dt < path.duration(); t += 37 * dt) {
      const JointSample a = path.at(t, j), m = path.at(t + dt / 2, j), b = path.at(t + dt, j);
      const double a_peak = std::max(std::abs(a.acceleration), std::abs(b.acceleration)) + 1;
      EXPECT_NEAR((b.position - a.position) / dt, m.velocity, 2 * a_peak * dt) << t;
    }
  }
}

TEST(JointPath, TrapezoidTakesTheTimeOfItsClosedForm) {
  // Long way: v / a to accelerate, and D / v in all at the mean speed of the ramps.
  const JointPath far = path_of({TrajectoryProfile::kTrapezoidal, {{0, {3}}}, {0.5}, {2}}, {{1}});
  EXPECT_NEAR(far.duration(), 2.0 / 0.5 + 0.5 / 2, 1e-12);
  // Short way: never reaches 0.5.
  const JointPath near =
      path_of({TrajectoryProfile::kTrapezoidal, {{0, {1.1}}}, {0.5}, {2}}, {{1}});
  EXPECT_NEAR(near.duration(), 2 * std::sqrt(0.1 / 2), 1e-12);
  EXPECT_NEAR(near.at(near.duration() / 2, 0).velocity, std::sqrt(0.1 * 2), 1e-12);
  for (const JointPath* path : {&far, &near}) {
    expect_consistent(*path);
    EXPECT_EQ(path->at(0, 0).position, 1);
    EXPECT_NEAR(path->at(path->duration() * (1 - 1e-12), 0).velocity, 0, 1e-9);
  }
  EXPECT_EQ(far.at(far.duration(), 0).position, 3);
  EXPECT_EQ(far.at(1e9, 0).velocity, 0);
}

TEST(JointPath, LimitsHoldAndJointsArriveTogether) {
  const std::vector<double> v = {0.5, 1, 2}, a = {4, 1, 3};
  for (const auto profile : {TrajectoryProfile::kTrapezoidal, TrajectoryProfile::kQuintic}) {
    const std::vector<std::vector<double>> points = {{1, -2, 0.3}, {1, 0.5, 3}, {0, 0, 0}};
    const JointPath path =
        path_of({profile, {{0, points[0]}, {0, points[1]}, {0, points[2]}}, v, a}, {{0}, {0}, {1}});
    std::vector<double> fastest(3), strongest(3);
    bool reaches_one = false;
    for (const double t : steps_of(path, 20'000))
      for (size_t j = 0; j < 3; ++j) {
        const JointSample s = path.at(t, j);
        fastest[j] = std::max(fastest[j], std::abs(s.velocity) / v[j]);
        strongest[j] = std::max(strongest[j], std::abs(s.acceleration) / a[j]);
        reaches_one |= fastest[j] > 0.999 || strongest[j] > 0.999;
      }
    for (size_t j = 0; j < 3; ++j) {
      EXPECT_LE(fastest[j], 1 + 1e-9) << j;
      EXPECT_LE(strongest[j], 1 + 1e-9) << j;
    }
    EXPECT_TRUE(reaches_one) << "no limit is used";
    expect_consistent(path);
    // On a straight line: all joints have done the same share of their way.
    for (const double t : steps_of(path, 100)) {
      if (path.point_at(t) != 0) continue;
      const double share = path.at(t, 0).position;
      EXPECT_NEAR(path.at(t, 1).position, -2 * share, 1e-12);
      EXPECT_NEAR(path.at(t, 2).position, 1 - 0.7 * share, 1e-12);
    }
  }
}

TEST(JointPath, QuinticPeaksAtFifteenEighthsAndStartsWithoutAcceleration) {
  const JointPath slow = path_of({TrajectoryProfile::kQuintic, {{0, {2}}}, {0.5}, {100}}, {{0}});
  const double T = slow.duration();
  EXPECT_NEAR(T, 1.875 * 2 / 0.5, 1e-12);
  EXPECT_NEAR(slow.at(T / 2, 0).velocity, 1.875 * 2 / T, 1e-12);
  EXPECT_NEAR(slow.at(0, 0).acceleration, 0, 1e-12);
  EXPECT_NEAR(slow.at(T * (1 - 1e-12), 0).acceleration, 0, 1e-9);
  const JointPath weak = path_of({TrajectoryProfile::kQuintic, {{0, {2}}}, {100}, {0.5}}, {{0}});
  EXPECT_NEAR(weak.duration(), std::sqrt(10 / std::sqrt(3) * 2 / 0.5), 1e-12);
}

TEST(JointPath, BrakesFromAMotionWithinTheLimits) {
  for (const auto profile : {TrajectoryProfile::kTrapezoidal, TrajectoryProfile::kQuintic}) {
    const JointPath path = path_of({profile, {{0, {-1, 0}}}, {1}, {2}}, {{0, 0.8}, {0, -0.2}});
    EXPECT_EQ(path.at(0, 0).velocity, 0.8);
    EXPECT_EQ(path.at(0, 1).velocity, -0.2);
    double strongest = 0;
    for (const double t : steps_of(path, 20'000))
      strongest = std::max(strongest, std::abs(path.at(t, 0).acceleration));
    EXPECT_NEAR(strongest, 2, 1e-3);
    expect_consistent(path);
  }
  // Trapezoid: 0.4 s to stop after 0.16 rad.
  const JointPath path =
      path_of({TrajectoryProfile::kTrapezoidal, {{0, {-1}}}, {1}, {2}}, {{0, 0.8}});
  EXPECT_NEAR(path.at(0.4, 0).position, 0.16, 1e-12);
  EXPECT_NEAR(path.duration(), 0.4 + 1.16 / 1 + 1.0 / 2, 1e-12);
}

TEST(JointPath, SplinesPassThroughPointsWithContinuousDerivatives) {
  const std::vector<TrajectoryPoint> points = {{0.5, {1, -1}, {0.5, 0}, {1, 0}},
                                               {1.25, {0.5, -3}, {-1, 0.2}, {0, 2}},
                                               {2, {0, 0}, {0, 0}, {0, 0}}};
  const JointPath quintic = path_of({.points = points}, {{0, 0.1, 0.3}, {0.2, 0, 0}});
  EXPECT_EQ(quintic.duration(), 2);
  EXPECT_EQ(quintic.at(0, 0).velocity, 0.1);
  EXPECT_NEAR(quintic.at(0, 0).acceleration, 0.3, 1e-12);
  for (const TrajectoryPoint& point : points)
    for (size_t j = 0; j < 2; ++j)
      for (const double side : {-1e-9, 1e-9}) {
        if (point.time == 2 && side > 0) continue;
        const JointSample s = quintic.at(point.time + side, j);
        EXPECT_NEAR(s.position, point.positions[j], 1e-7);
        EXPECT_NEAR(s.velocity, point.velocities[j], 1e-7);
        EXPECT_NEAR(s.acceleration, point.accelerations[j], 1e-6);
      }
  expect_consistent(quintic);
  EXPECT_EQ(quintic.point_at(0.1), 0u);
  EXPECT_EQ(quintic.point_at(0.6), 1u);
  EXPECT_EQ(quintic.point_at(5), 2u);
}

// Hermite's basis for values, first and second derivatives at both ends of [0, 1].
double hermite(double u, double T, const JointSample& a, const JointSample& b) {
  const double u2 = u * u, u3 = u2 * u, u4 = u3 * u, u5 = u4 * u;
  return a.position * (1 - 10 * u3 + 15 * u4 - 6 * u5) +
         a.velocity * T * (u - 6 * u3 + 8 * u4 - 3 * u5) +
         a.acceleration * T * T * (u2 - 3 * u3 + 3 * u4 - u5) / 2 +
         b.acceleration * T * T * (u3 - 2 * u4 + u5) / 2 +
         b.velocity * T * (-4 * u3 + 7 * u4 - 3 * u5) + b.position * (10 * u3 - 15 * u4 + 6 * u5);
}

TEST(JointPath, TwoPointsWithAccelerationsAreHermitesQuintic) {
  const JointSample a{0.3, -0.7, 2}, b{-1.1, 0.4, -3};
  const double begin = 0.4, T = 1.7;
  const JointPath path =
      path_of({.points = {{begin, {a.position}, {a.velocity}, {a.acceleration}},
                          {begin + T, {b.position}, {b.velocity}, {b.acceleration}}}},
              {{0.1, 0.2, -0.3}});
  for (int i = 0; i < 100; ++i) {
    const double u = i / 100.0;
    EXPECT_NEAR(path.at(begin + u * T, 0).position, hermite(u, T, a, b), 1e-12);
    EXPECT_NEAR(path.at(u * begin, 0).position, hermite(u, begin, {0.1, 0.2, -0.3}, a), 1e-12);
  }
}

TEST(JointPath, TwoPointsWithVelocitiesAreHermitesCubic) {
  const JointSample a{0.3, -0.7}, b{-1.1, 0.4};
  const double begin = 0.4, T = 1.7;
  const JointPath path = path_of(
      {.points = {{begin, {a.position}, {a.velocity}}, {begin + T, {b.position}, {b.velocity}}}},
      {{0}});
  for (int i = 0; i < 100; ++i) {
    const double u = i / 100.0, v = 1 - u;
    EXPECT_NEAR(path.at(begin + u * T, 0).position,
                a.position * (1 + 2 * u) * v * v + a.velocity * T * u * v * v +
                    b.position * u * u * (3 - 2 * u) - b.velocity * T * u * u * v,
                1e-12);
  }
  EXPECT_NEAR(path.at(begin, 0).velocity, a.velocity, 1e-12);
  EXPECT_NEAR(path.at(begin + T * (1 - 1e-13), 0).velocity, b.velocity, 1e-9);
}

// The rest of the path is shared, and a copy that starts elsewhere leaves the other as it is.
TEST(JointPath, CopiesStartIndependently) {
  for (const auto profile : {TrajectoryProfile::kSpline, TrajectoryProfile::kTrapezoidal}) {
    JointTrajectory trajectory{profile, {{1, {1}}, {2, {0}}}};
    if (profile != TrajectoryProfile::kSpline)
      trajectory.max_velocity = trajectory.max_acceleration = {2};
    const JointPath path = path_of(trajectory, {{0}});
    std::vector<double> before, after;
    for (const double t : steps_of(path, 50)) before.push_back(path.at(t, 0).position);
    JointPath copy = path;
    copy.begin(std::vector<JointSample>{{5, 1}});
    EXPECT_EQ(copy.at(0, 0).position, 5);
    EXPECT_NEAR(copy.at(copy.duration() - 1e-13, 0).position, 0, 1e-9);
    for (const double t : steps_of(path, 50)) after.push_back(path.at(t, 0).position);
    EXPECT_EQ(after, before);
  }
}

// The same numbers as the polynomials of third degree have by hand.
TEST(JointPath, DegreeFollowsWhatThePointsHave) {
  const JointPath cubic = path_of({.points = {{2, {1}, {0}}}}, {{0}});
  EXPECT_NEAR(cubic.at(1, 0).position, 0.5, 1e-15);
  EXPECT_NEAR(cubic.at(1, 0).velocity, 1.5 / 2, 1e-15);
  const JointPath line = path_of({.points = {{2, {1}}, {3, {0}}}}, {{0, 5}});
  EXPECT_NEAR(line.at(0.5, 0).position, 0.25, 1e-15);
  EXPECT_NEAR(line.at(0.5, 0).velocity, 0.5, 1e-15);
  EXPECT_NEAR(line.at(2.5, 0).velocity, -1, 1e-15);
  // Velocities at one end only: linear.
  const JointPath mixed = path_of({.points = {{1, {1}}, {2, {3}, {0}}}}, {{0}});
  EXPECT_NEAR(mixed.at(1.25, 0).position, 1.5, 1e-15);
  // A point at time 0 is reached at once.
  const JointPath now = path_of({.points = {{0, {1}}, {1, {2}}}}, {{0}});
  EXPECT_EQ(now.at(0, 0).position, 1);
  EXPECT_NEAR(now.at(0.5, 0).position, 1.5, 1e-15);
}

TEST(JointPath, AWayOfNoLengthTakesNoTime) {
  for (const auto profile : {TrajectoryProfile::kTrapezoidal, TrajectoryProfile::kQuintic}) {
    const JointPath path = path_of({profile, {{0, {1}}, {0, {1}}}, {1}, {1}}, {{1}});
    EXPECT_EQ(path.duration(), 0);
    EXPECT_EQ(path.at(0, 0).position, 1);
  }
}

TEST(JointPath, BadTrajectoriesAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto error = [](const JointTrajectory& trajectory) {
    const Result<JointPath> made = JointPath::make(trajectory, 2);
    return made.ok() ? std::string("accepted") : made.error().to_string();
  };
  const auto spline = [&](std::vector<TrajectoryPoint> points) {
    return error({.points = std::move(points)});
  };
  EXPECT_THAT(spline({}), HasSubstr("no points"));
  EXPECT_THAT(spline({{1, {}}}), HasSubstr("no positions"));
  EXPECT_THAT(spline({{1, {1, 1}}, {2, {1}}}), HasSubstr("point 1 has 1 positions for 2 joints"));
  EXPECT_THAT(spline({{1, {1, nan}}}), HasSubstr("not finite"));
  EXPECT_THAT(spline({{1, {1, 1e300}}}), HasSubstr("not finite"));
  EXPECT_THAT(spline({{1, {1, 2}, {1}}}), HasSubstr("1 velocities"));
  EXPECT_THAT(spline({{1, {1, 2}, {}, {0, inf}}}),
              HasSubstr("accelerations of point 0 are not finite"));
  EXPECT_THAT(spline({{-1, {1, 2}}}), HasSubstr("negative"));
  EXPECT_THAT(spline({{nan, {1, 2}}}), HasSubstr("negative"));
  EXPECT_THAT(spline({{1, {1, 2}}, {1, {1, 2}}}), HasSubstr("do not increase"));
  EXPECT_THAT(spline({{1, {1, 2}}, {3, {1, 2}}, {2.5, {1, 2}}}),
              HasSubstr("point 1 at 3 s, point 2 at 2.5 s"));
  EXPECT_THAT(spline({{1, {1, 2}}, {1 + 1e-15, {1, 2}}}), HasSubstr("do not increase"));
  EXPECT_THAT(spline(std::vector<TrajectoryPoint>(100'001, {0, {1, 2}})), HasSubstr("more than"));
  EXPECT_THAT(error({.points = {{1, {1, 2}}}, .max_velocity = {1}}), HasSubstr("has times"));
  const auto profile = [&](std::vector<double> v, std::vector<double> a, TrajectoryPoint point) {
    return error({TrajectoryProfile::kQuintic, {std::move(point)}, std::move(v), std::move(a)});
  };
  EXPECT_THAT(profile({}, {1}, {0, {1, 2}}), HasSubstr("'max_velocity' has 0 numbers"));
  EXPECT_THAT(profile({1}, {1, 2, 3}, {0, {1, 2}}), HasSubstr("'max_acceleration' has 3"));
  EXPECT_THAT(profile({0}, {1}, {0, {1, 2}}), HasSubstr("positive"));
  EXPECT_THAT(profile({1}, {nan}, {0, {1, 2}}), HasSubstr("positive"));
  EXPECT_THAT(profile({1}, {1}, {0, {1, 2}, {0, 0}}), HasSubstr("stops in each point"));
  EXPECT_FALSE(JointPath::make({.points = {{1, {}}}}, 0).ok());
}

}  // namespace
}  // namespace gloam
