// [robot.actuators] and [[robot.actuator]] in scene files.

#include <gtest/gtest.h>

#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

const char* const kRobot = "[[robot]]\nname = \"go\"\nfile = \"go.xml\"\n";

std::string actuator_error(const std::string& text, Scene* scene) {
  Status status = read_scene_toml(kRobot + text, "a.toml", scene);
  if (status.ok()) status = validate_scene(*scene);
  return status.ok() ? std::string() : status.error().to_string();
}

TEST(ActuatorToml, ReadsEveryTable) {
  Scene scene;
  ASSERT_EQ(actuator_error(R"(
[robot.actuators]
idle_power = 25
[robot.actuators.battery]
curve = [[0, 21], [1, 25.2]]
internal_resistance = 0.05
capacity = 6
[[robot.actuator]]
joints = ".*_hip_joint"
stall_torque = 23.7
no_load_speed = 30.1
delay = 0.004
friction = { coulomb = 0.2, breakaway = 0.3 }
thermal = { thermal_resistance = 1.2, heat_capacity = 80 }
torque_constant = 0.6
winding_resistance = 0.2
[[robot.actuator]]
joints = ".*_calf_joint"
curve = [[0, 35.55], [10, 35.55], [20.06, 0]]
network = { file = "net.onnx", position_scale = -1, kp = 20, kd = 0.5 }
)",
                           &scene),
            "");
  const RobotOptions& robot = scene.robots[0];
  EXPECT_EQ(robot.actuators->idle_power, 25);
  EXPECT_EQ(robot.actuators->battery->curve[1][1], 25.2);
  ASSERT_EQ(robot.actuator.size(), 2U);
  EXPECT_EQ(robot.actuator[0].friction->breakaway, 0.3);
  EXPECT_EQ(robot.actuator[0].thermal->cutoff, 100);
  EXPECT_EQ(robot.actuator[0].loc.line, 11);
  EXPECT_EQ(robot.actuator[1].curve[2][0], 20.06);
  EXPECT_EQ(robot.actuator[1].network->kp, 20);
}

TEST(ActuatorToml, ReadsPropellers) {
  Scene scene;
  ASSERT_EQ(actuator_error(R"(
[[robot.actuator]]
actuators = "thrust_.*"
torque_constant = 0.0125
winding_resistance = 0.07
propeller = { diameter = 0.26, thrust_coefficient = 0.12, inertia = 8e-5, voltage = 15, zero_thrust_advance = 0.6 }
)",
                           &scene),
            "");
  const ActuatorOptions& o = scene.robots[0].actuator.at(0);
  EXPECT_EQ(o.actuators, "thrust_.*");
  EXPECT_EQ(o.propeller->thrust_coefficient, 0.12);
  EXPECT_EQ(o.propeller->zero_thrust_advance, 0.6);
  EXPECT_FALSE(o.propeller->power_coefficient);
}

TEST(ActuatorToml, ErrorsNameTheKeyAndTheRemedy) {
  const struct {
    const char *text, *error;
  } cases[] = {
      {"[[robot.actuator]]\n", "'joints' is missing"},
      {"[[robot.actuator]]\njoints = \".*\"\nstal_torque = 3\n", "'stall_torque'"},
      {"[[robot.actuator]]\njoints = \".*\"\nstall_torque = 3\n", "no_load_speed"},
      {"[[robot.actuator]]\njoints = \"(\"\n", "not a regular expression"},
      {"[[robot.actuator]]\njoints = \".*\"\ngear_ratio = 0\n", "gear_ratio"},
      {"[[robot.actuator]]\njoints = \".*\"\ncurve = [[0, 3]]\n", "at least two rows"},
      {"[[robot.actuator]]\njoints = \".*\"\ncurve = [[0, 3], [0, 2]]\n", "has 0 after 0"},
      {"[[robot.actuator]]\njoints = \".*\"\ncurve = [[1, 3], [2, 2]]\n", "not at 0"},
      {"[[robot.actuator]]\njoints = \".*\"\nfriction = { coulomb = 2, breakaway = 1 }\n",
       "'breakaway'"},
      {"[[robot.actuator]]\njoints = \".*\"\ntorque_limit = 1\n"
       "thermal = { thermal_resistance = 1, heat_capacity = 1 }\n",
       "torque_constant"},
      {"[[robot.actuator]]\njoints = \".*\"\ntorque_constant = 1\nwinding_resistance = 1\n"
       "thermal = { thermal_resistance = 1, heat_capacity = 1 }\n",
       "no torque limit"},
      {"[robot.actuators]\nidle_power = 3\n", "add [[robot.actuator]]"},
      {"[robot.actuators.battery]\ncapacity = 3\n[[robot.actuator]]\njoints = \".*\"\n",
       "has no voltage"},
      {"[robot.actuators.battery]\ncurve = [[0, 20], [0.9, 24]]\n"
       "[[robot.actuator]]\njoints = \".*\"\n",
       "not at 1"},
      {"[[robot.actuator]]\nactuators = \"t\"\n", "'actuators' alone"},
      {"[[robot.actuator]]\njoints = \"t\"\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1 }\n",
       "'propeller' alone"},
      {"[[robot.actuator]]\nactuators = \"t\"\npropeller = { diameter = 0.2 }\n",
       "'thrust_coefficient' is missing"},
      {"[[robot.actuator]]\nactuators = \"(\"\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1 }\n",
       "not a regular expression"},
      {"[[robot.actuator]]\nactuators = \"t\"\nbacklash = 0.1\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1 }\n",
       "'backlash', which is for joints"},
      {"[[robot.actuator]]\nactuators = \"t\"\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1, zero_torque_advance = 0.7 }\n",
       "not above 'zero_thrust_advance'"},
      {"[[robot.actuator]]\nactuators = \"t\"\ntorque_constant = 0.01\nwinding_resistance = 0.1\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1, inertia = 1e-5 }\n",
       "no 'propeller.voltage'"},
      {"[[robot.actuator]]\nactuators = \"t\"\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1, current_limit = 3 }\n",
       "9.549 / Kv"},
      {"[robot.actuators.battery]\nvoltage = 12\n"
       "[[robot.actuator]]\nactuators = \"t\"\n"
       "propeller = { diameter = 0.2, thrust_coefficient = 0.1, voltage = 12 }\n",
       "beside a battery"},
  };
  for (const auto& one : cases) {
    Scene scene;
    const std::string error = actuator_error(one.text, &scene);
    EXPECT_NE(error.find(one.error), std::string::npos) << one.text << error;
    EXPECT_NE(error.find("a.toml:"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace gloam
