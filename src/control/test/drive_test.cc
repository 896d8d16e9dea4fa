// Bases on wheels, grippers, and robots of several parts.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "control/controllers.h"
#include "robot_world.h"

namespace gloam {
namespace {

// Wheels of 0.07 m, 0.3 m apart, and a castor without friction. ACTUATOR is a word to be replaced.
const char* const kBase = R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
  <geom type="plane" size="9 9 1" friction="1"/>
  <body name="base" pos="0 0 .07"><freejoint/><geom type="box" size=".15 .1 .03" mass="5"/>
    <geom type="sphere" size=".02" pos="-.13 0 -.05" condim="1" priority="1" mass=".05"/>
    <geom type="sphere" size=".02" pos=".13 0 -.05" condim="1" priority="1" mass=".05"/>
    <body name="wl" pos="0 .15 0"><joint name="l" axis="0 1 0"/><geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
    <body name="wr" pos="0 -.15 0"><joint name="r" axis="0 -1 0"/><geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
  </body></worldbody><actuator>ACTUATOR</actuator></mujoco>)";
const char* const kServoWheels = R"(<velocity joint="l" kv="3"/><velocity joint="r" kv="3"/>)";
const char* const kMotorWheels = R"(<motor joint="l" gear="2"/><motor joint="r"/>)";

std::string base(const char* actuators) {
  std::string text = kBase;
  return text.replace(text.find("ACTUATOR"), 8, actuators);
}

RobotOptions driven(DriveOptions drive = {}) {
  RobotOptions options;
  options.controller.type = "diff_drive";
  options.controller.drive = std::move(drive);
  return options;
}

class DiffDrive : public testing::TestWithParam<const char*> {};

TEST_P(DiffDrive, DrivesAnArcOfTheGoalsRadius) {
  auto sim = start_robot(make_robot_world(base(GetParam()).c_str(), driven()));
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}, 0.4, 0, 0.5}}).ok());
  ASSERT_TRUE(sim->step(1000).ok());
  const BodyState s = base_of(*sim);
  EXPECT_NEAR(std::hypot(s.velocity.x, s.velocity.y), 0.4, 0.01);
  EXPECT_NEAR(s.angular_velocity.z, 0.5, 0.015);
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}}}).ok());
  ASSERT_TRUE(sim->step(1000).ok());
  EXPECT_NEAR(base_of(*sim).velocity.x, 0, 1e-3);
}

TEST_P(DiffDrive, KeepsItsLimits) {
  auto sim = start_robot(make_robot_world(base(GetParam()).c_str(),
                                          driven({.max_speed = 0.3, .max_acceleration = 0.5})));
  ASSERT_TRUE(sim->post({.what = SetVelocityGoal{Robot{0, 0}, 5, 0, 0}}).ok());
  ASSERT_TRUE(sim->step(200).ok());
  // The wheel's speed, because MuJoCo's soft tyres creep while they pull.
  EXPECT_NEAR(0.07 * sim->latest()[Joint{1}].velocity(), 0.2, 0.03) << "0.5 m/s2 for 0.4 s";
  ASSERT_TRUE(sim->step(800).ok());
  EXPECT_NEAR(base_of(*sim).velocity.x, 0.3, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Actuators, DiffDrive, testing::Values(kServoWheels, kMotorWheels));

TEST(Wheels, AreFoundByTheirNamesWithTheNearestInTheError) {
  const auto world =
      make_robot_world(base(kServoWheels).c_str(), driven({.left = {"ll"}, .right = {"r"}}));
  const auto result = make_controller(world, world->robots[0]);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("'ll'"), std::string::npos);
  EXPECT_NE(result.error().hint.find("'l'"), std::string::npos) << result.error().hint;
}

// Two fingers that close on a block between them, and an arm joint that carries them.
const char* const kHand =
    R"(<mujoco><option timestep="0.002" gravity="0 0 0" integrator="implicitfast"/><worldbody>
  <body name="arm"><joint name="turn" axis="0 0 1" damping="1" armature=".1"/><geom size=".03" mass="1"/>
    <body name="f1" pos="0 .05 0"><joint name="left" type="slide" axis="0 1 0" range="-.045 0"/><geom type="box" size=".02 .005 .02" mass=".05"/></body>
    <body name="f2" pos="0 -.05 0"><joint name="right" type="slide" axis="0 -1 0" range="-.045 0"/><geom type="box" size=".02 .005 .02" mass=".05"/></body>
  </body></worldbody>
  <actuator><motor name="turn" joint="turn"/><motor name="left" joint="left"/><position name="right" joint="right" kp="2000" kv="20"/></actuator></mujoco>)";

RobotOptions hand(GripOptions grip) {
  RobotOptions options;
  options.controller = {.type = "joint_position", .kp = 50, .kd = 5, .target = {0.4}};
  options.parts = {{.name = "gripper", .joints = {"left", "right"}}};
  options.parts[0].controller.type = "gripper";
  options.parts[0].controller.grip = grip;
  return options;
}

TEST(Gripper, MovesItsFingersTogetherAtItsSpeedAndLeavesTheArmAlone) {
  auto sim = start_robot(make_robot_world(kHand, hand({.force = 10, .speed = 0.045})));
  ASSERT_TRUE(sim->step(200).ok());
  ASSERT_TRUE(sim->post({.what = SetJointGoal{Joint{1}, -0.04}}).ok());
  ASSERT_TRUE(sim->step(222).ok());  // half a second of 0.9 s
  EXPECT_NEAR(sim->latest()[Joint{1}].position(), -0.02, 0.003);
  EXPECT_NEAR(sim->latest()[Joint{2}].position(), -0.02, 0.003) << "the other follows";
  ASSERT_TRUE(sim->step(800).ok());
  EXPECT_NEAR(sim->latest()[Joint{1}].position(), -0.04, 1e-3);
  EXPECT_NEAR(sim->latest()[Joint{2}].position(), -0.04, 1e-3);
  EXPECT_NEAR(sim->latest()[Joint{0}].position(), 0.4, 1e-2) << "the arm has its own controller";
}

TEST(Gripper, SqueezesWithItsForceOnly) {
  std::string text = kHand;
  const std::string block =
      R"(<body name="block"><geom type="box" size=".02 .02 .02" mass=".1"/></body></worldbody>)";
  text.replace(text.find("</worldbody>"), 12, block);
  auto sim = start_robot(make_robot_world(text.c_str(), hand({.force = 10, .opening = 0})));
  ASSERT_TRUE(sim->step(2000).ok());
  EXPECT_GT(sim->latest()[Joint{1}].position(), -0.03) << "the block is in the way";
  for (int i : {1, 2}) EXPECT_NEAR(std::abs(force_of(*sim, i)), 10, 0.2);
}

TEST(Parts, AreRejectedIfTheyShareAJointOrHaveNone) {
  RobotOptions options = hand({});
  options.parts.push_back({.name = "other", .joints = {"l.*"}});
  const auto shared =
      make_robot_controller(make_robot_world(kHand, options), 0, options.controller);
  ASSERT_FALSE(shared.ok());
  EXPECT_NE(shared.error().message.find("'gripper' and 'other'"), std::string::npos);
  options.parts[1].joints = {"lefft"};
  const auto missing =
      make_robot_controller(make_robot_world(kHand, options), 0, options.controller);
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().hint.find("'left'"), std::string::npos) << missing.error().hint;
}

}  // namespace
}  // namespace gloam
