// Actuators of scenes: which joints they are for, and errors with their remedies.

#include <gtest/gtest.h>

#include "actuator_rig.h"
#include "control/actuators/drive.h"
#include "trot_robots.h"

namespace gloam {
namespace {

std::string error_of(const Wheel& wheel, ActuatorOptions options) {
  options.loc = {"scene.toml", 12, 3};
  const auto world = wheel_world(wheel, RobotOptions{.actuator = {options}});
  auto layer = make_actuators(*world, world->robots[0]);
  if (!layer) return layer.error().to_string();
  const Status begun = (*layer)->begin(*world->model, {1, 1000});
  return begun.ok() ? "" : begun.error().to_string();
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
}

TEST(ActuatorOptions, OfAJointThatDoesNotExistNameTheNearest) {
  expect_words(error_of({}, {.joints = "wheal"}), {"scene.toml:12", "'wheal'", "'wheel'"});
}

TEST(ActuatorOptions, DelaysAreMultiplesOfTheTimestep) {
  expect_words(error_of({}, {.delay = 0.0025}),
               {"scene.toml:12", "0.0025 s", "0.001 s", "use 0.002 or 0.003"});
  EXPECT_EQ(error_of({}, {.delay = 0.003}), "");
}

TEST(ActuatorOptions, BacklashNeedsARotor) {
  expect_words(error_of({}, {.backlash = 0.01}), {"scene.toml:12", "armature", "override.rig"});
  EXPECT_EQ(error_of({.armature = 0.01}, {.backlash = 0.01}), "");
}

TEST(ActuatorOptions, OfActuatorsThatAreNoMotorsAreRejected) {
  Wheel muscle;
  muscle.actuator = R"(<muscle name="wheel" joint="wheel" ctrlrange="0 1" lengthrange="0 1"/>)";
  expect_words(error_of(muscle, {}), {"'wheel'", "<motor>"});
  Wheel filtered;
  filtered.actuator = R"(<general joint="wheel" dyntype="filter" dynprm="0.1"/>)";
  expect_words(error_of(filtered, {}), {"activation", "<motor>"});
  Wheel two;
  two.actuator = R"(<motor joint="wheel"/><motor joint="wheel"/>)";
  expect_words(error_of(two, {}), {"2 actuators", "match fewer joints"});
  Wheel none;
  none.actuator = "";
  expect_words(error_of(none, {}), {"0 actuators", "add a <motor>"});
}

TEST(ActuatorOptions, OfNetworksDependOnTheActuator) {
  expect_words(error_of({}, {.network = ActuatorNetworkOptions{.file = "net.onnx"}}),
               {"is a motor", "'kp'"});
  Wheel servo;
  servo.actuator = R"(<position joint="wheel" kp="30"/>)";
  expect_words(error_of(servo, {.network = ActuatorNetworkOptions{.file = "net.onnx", .kp = 20}}),
               {"is a servo", "remove 'kp'"});
}

TEST(ActuatorOptions, LaterTablesTakePrecedence) {
  const ModelPtr quadruped = load_quadruped();
  RobotInstance robot = robot_instance(*quadruped);
  robot.options.actuator = {{.joints = ".*", .torque_limit = 10},
                            {.joints = ".*_(calf|knee).*", .torque_limit = 20}};
  const auto drives = find_drives(*quadruped, robot);
  ASSERT_TRUE(drives.ok()) << drives.error().to_string();
  EXPECT_EQ(drives->size(), 12U);
  int knees = 0;
  for (const DriveSetup& drive : *drives) knees += drive.options.torque_limit == 20 ? 1 : 0;
  EXPECT_EQ(knees, 4);
}

}  // namespace
}  // namespace gloam
