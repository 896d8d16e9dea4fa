// Deflections -> velocities and steps of a frame's goal.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "teleop/jog.h"
#include "teleop/velocity_mapping.h"

namespace gloam::teleop {
namespace {

const VelocityRanges kWheels{{-1.8, 1.8}, {0, 0}, {-3.6, 3.6}};

TEST(VelocityMapping, ScalesWithTheSpeedUpToTheLimits) {
  const Deflection ahead{.forward = 1, .turn = -1};
  for (int speed = kSlowest; speed <= kFastest; ++speed) {
    const SetVelocityGoal goal = velocity_goal({}, kWheels, ahead, speed);
    EXPECT_DOUBLE_EQ(goal.vx, 0.2 * speed);
    EXPECT_DOUBLE_EQ(goal.yaw_rate, -0.4 * speed);
  }
}

TEST(VelocityMapping, TurnsWhereTheRobotCannotMoveSideways) {
  EXPECT_DOUBLE_EQ(velocity_goal({}, kWheels, {.left = 1}, 9).yaw_rate, 3.6);
  EXPECT_DOUBLE_EQ(velocity_goal({}, kWheels, {.left = 1, .turn = 1}, 9).yaw_rate, 3.6);
  const SetVelocityGoal legs = velocity_goal({}, {{}, {-0.3, 0.3}, {}}, {.left = 1}, 9);
  EXPECT_DOUBLE_EQ(legs.vy, 0.3);
  EXPECT_EQ(legs.yaw_rate, 0);
}

TEST(VelocityMapping, KeepsRangesThatAreNotSymmetric) {
  const VelocityRanges walker{{-0.5, 2}, {-0.2, 0.4}, {0, 1}};
  const Deflection all{.forward = -1, .left = -1, .turn = -1};
  const SetVelocityGoal back = velocity_goal({}, walker, all, 9);
  EXPECT_EQ(back.vx, -0.5);
  EXPECT_EQ(back.vy, -0.2);
  EXPECT_EQ(back.yaw_rate, 0) << "it cannot turn right";
  const VelocityRanges runner{{0.5, 2}, {0, 0}, {-1, 1}};
  EXPECT_EQ(velocity_goal({}, runner, {.forward = -1}, 9).vx, 0) << "it cannot go back";
  EXPECT_EQ(velocity_goal({}, runner, {.forward = 1}, 1).vx, 0.5) << "nor slowly";
}

TEST(VelocityMapping, UnlimitedAxesGetUsualSpeeds) {
  const SetVelocityGoal goal =
      velocity_goal({}, {}, {.forward = 1, .left = 1, .up = 1, .turn = 1}, 9);
  EXPECT_EQ(goal.vx, 1);
  EXPECT_EQ(goal.vy, 0.5);
  EXPECT_EQ(goal.yaw_rate, 1);
  EXPECT_EQ(goal.vz, 0) << "only flying robots";
}

TEST(VelocityMapping, NoiseOfAStickDoesNotChangeTheGoal) {
  const auto goal = [](double forward) {
    return velocity_goal({}, kWheels, {.forward = forward}, 5);
  };
  EXPECT_TRUE(is_same(goal(0.5), goal(0.509)));
  EXPECT_FALSE(is_same(goal(0.5), goal(0.515)));
  EXPECT_TRUE(is_standing(goal(0.009)));
  EXPECT_FALSE(std::signbit(goal(-0.001).vx));
}

double angle_between(const Quat& a, const Quat& b) {
  return 2 * std::acos(std::min(1.0, std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z)));
}

TEST(Jog, MovesAlongTheHeadingOfTheBase) {
  const Pose X{{1, 2, 3}, {}};
  const Pose moved = jogged(X, X, M_PI / 2, {.forward = 1, .up = 1}, {0.01, 0.1});
  EXPECT_NEAR(moved.p.x, 1, 1e-12);
  EXPECT_NEAR(moved.p.y, 2.01, 1e-12);
  EXPECT_NEAR(moved.p.z, 3.01, 1e-12);
  EXPECT_EQ(angle_between(moved.q, X.q), 0);
}

TEST(Jog, TurnsAboutTheFramesOrigin) {
  const Pose X{{1, 2, 3}, {}};
  const Pose moved = jogged(X, X, 1.2, {.turn = -1}, {0.01, 0.1});
  EXPECT_EQ(moved.p, X.p);
  EXPECT_NEAR(moved.q.w, std::cos(0.05), 1e-12);
  EXPECT_NEAR(moved.q.z, -std::sin(0.05), 1e-12);
  const Pose tilted = jogged(X, X, M_PI / 2, {.pitch = 1}, {0.01, 0.1});
  EXPECT_NEAR(tilted.q.x, -std::sin(0.05), 1e-12) << "the left axis is -x of the world";
}

TEST(Jog, StepsAddUpFromTheGoalNotFromTheFrame) {
  const Pose X_WF{{0, 0, 0.98}, {}};  // sags below its goal
  Pose X_WG{{0, 0, 1}, {}};
  for (int i = 0; i < 5; ++i) X_WG = jogged(X_WG, X_WF, 0, {.forward = 1}, key_step(1));
  EXPECT_NEAR(X_WG.p.x, 0.01, 1e-12);
  EXPECT_NEAR(X_WG.p.z, 1, 1e-12);
}

TEST(Jog, TheGoalDoesNotRunAway) {
  const Pose X_WF{};
  Pose X_WG{};
  for (int i = 0; i < 1000; ++i) {
    X_WG = jogged(X_WG, X_WF, 0, {.forward = 1, .turn = 1}, key_step(9));
    EXPECT_LE(X_WG.p.x, kJogReach + 1e-12);
    EXPECT_LE(angle_between(X_WG.q, X_WF.q), kJogTurn + 1e-9);
  }
  EXPECT_NEAR(X_WG.p.x, kJogReach, 1e-12);
}

TEST(Jog, StartsAtTheFrameIfAnotherClientHasMovedIt) {
  const Pose X_WF{{2, 0, 0}, {}};
  const Pose moved = jogged({}, X_WF, 0, {.forward = 1}, {0.01, 0.1});
  EXPECT_NEAR(moved.p.x, 2.01, 1e-12);
}

TEST(Jog, HeadingIsTheAngleAboutTheVertical) {
  EXPECT_NEAR(heading({{}, {std::cos(0.4), 0, 0, std::sin(0.4)}}), 0.8, 1e-12);
  EXPECT_NEAR(heading({{}, {std::cos(0.4), std::sin(0.4), 0, 0}}), 0, 1e-12);
}

}  // namespace
}  // namespace gloam::teleop
