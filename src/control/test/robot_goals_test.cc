// Goals that robots of a scene accept.

#include "gloam/drive/robot_goals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "robot_world.h"

namespace gloam {
namespace {

const char* const kHandOnArm = R"(<mujoco><worldbody>
  <body name="base"><freejoint/><geom size=".1"/>
   <body name="arm"><joint name="turn" axis="0 0 1"/><geom size=".03" mass="1"/>
    <site name="tool" pos="1 0 0" euler="0 0 90"/>
    <body name="f1" pos="0 .05 0"><joint name="left" type="slide" axis="0 1 0" range="-.04 .01"/>
      <geom size=".02" mass=".05"/></body></body></body></worldbody>
  <actuator><motor name="turn" joint="turn"/><motor name="left" joint="left"/></actuator></mujoco>)";

RobotOptions options_of(std::string type) {
  RobotOptions options;
  options.controller.type = std::move(type);
  return options;
}

RobotGoals goals_of(const RobotOptions& options) {
  const World world(make_robot_world(kHandOnArm, options));
  auto goals = robot_goals(world, {0});
  EXPECT_TRUE(goals.ok()) << goals.error().to_string();
  return *goals;
}

TEST(RobotGoals, VelocitiesKeepTheLimitsOfTheController) {
  RobotOptions wheels = options_of("diff_drive");
  wheels.controller.drive = {.max_speed = 0.7, .max_yaw_rate = 1.5};
  const VelocityRanges driven = *goals_of(wheels).velocity;
  EXPECT_EQ(driven.vx.low, -0.7);
  EXPECT_EQ(driven.yaw_rate.high, 1.5);
  EXPECT_TRUE(driven.vy.is_zero() && driven.vz.is_zero());
  RobotOptions drone = options_of("quadrotor");
  drone.controller.flight = {.max_speed = 3, .max_climb = 1};
  const VelocityRanges flown = *goals_of(drone).velocity;
  EXPECT_EQ(flown.vy.high, 3);
  EXPECT_EQ(flown.vz.low, -1);
  EXPECT_TRUE(goals_of(options_of("trot")).velocity.has_value());
  EXPECT_FALSE(goals_of(options_of("joint_position")).velocity.has_value());
  EXPECT_FALSE(goals_of(options_of("none")).velocity.has_value());
}

TEST(RobotGoals, PartsAddTheirs) {
  RobotOptions options = options_of("diff_drive");
  options.parts = {{.name = "arm", .joints = {"turn"}}, {.name = "hand", .joints = {"left"}}};
  options.parts[0].controller.type = "osc";
  options.parts[0].controller.task.frame = "site tool";
  options.parts[1].controller.type = "gripper";
  options.parts[1].controller.grip = {.opening = 0.25, .inverted = true};
  const RobotGoals goals = goals_of(options);
  EXPECT_TRUE(goals.velocity.has_value());
  ASSERT_TRUE(goals.frame.has_value());
  EXPECT_EQ(goals.frame->name, "tool");
  ASSERT_TRUE(goals.gripper.has_value());
  EXPECT_EQ(goals.gripper->closed, 0.01);
  EXPECT_EQ(goals.gripper->open, -0.04);
  EXPECT_EQ(goals.gripper->opening, 0.25);
}

TEST(RobotGoals, ErrorsAreThoseOfTheController) {
  RobotOptions options = options_of("ik");
  options.controller.task.frame = "site tol";
  const World world(make_robot_world(kHandOnArm, options));
  const auto goals = robot_goals(world, {0});
  ASSERT_FALSE(goals.ok());
  EXPECT_NE(goals.error().hint.find("tool"), std::string::npos);
  EXPECT_FALSE(robot_goals(world, {7}).ok());
}

TEST(RobotGoals, AFrameHasItsPoseInTheWorld) {
  auto sim = start_robot(make_robot_world(kHandOnArm, options_of("none")));
  Instant instant;
  ASSERT_TRUE(instant.solve(sim->latest()).ok());
  const auto X_WF = frame_pose(instant, {ik::FrameKind::kSite, "tool"});
  ASSERT_TRUE(X_WF.ok()) << X_WF.error().to_string();
  EXPECT_NEAR(X_WF->p.x, 1, 1e-12);
  EXPECT_NEAR(std::abs(X_WF->q.z), std::sqrt(0.5), 1e-12);
  EXPECT_FALSE(frame_pose(instant, {ik::FrameKind::kBody, "tool"}).ok());
}

}  // namespace
}  // namespace gloam
