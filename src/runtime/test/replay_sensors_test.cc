// Sensors of a replay, and the settings of a scene that do not affect a replay.

#include <gmock/gmock.h>
#include <cstdio>

#include <fstream>
#include <iterator>

#include "gloam/log_replay.h"
#include "gloam/run.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

// Contacts, a motor and an impulse: readings that no pose tells.
constexpr const char* kMeasuredModel = R"(<mujoco model="m"><option timestep="0.002"/>
<worldbody><light pos="0 0 4"/><geom type="plane" size="5 5 .1"/>
<body name="arm" pos="1 0 1"><joint name="swing" axis="0 1 0"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .5 0 0"/><site name="wrist" pos=".5 0 0"/></body>
<body name="box" pos="0 0 .3" euler="20 30 0"><freejoint/>
  <geom type="box" size=".2 .1 .1" mass="2"/><site name="imu"/></body>
</worldbody>
<actuator><motor name="swing" joint="swing"/></actuator>
<sensor><accelerometer name="acc" site="imu"/><gyro name="gyro" site="imu"/>
<touch name="touch" site="imu"/><force name="force" site="wrist"/>
<jointpos name="angle" joint="swing"/><actuatorfrc name="effort" actuator="swing"/></sensor>
</mujoco>)";

constexpr const char* kMeasuredScene = R"(
[sim]
seed = 5
[record]
outputs = ["sensors", "state"]
[[robot]]
name = "toy"
file = "m.xml"
[robot.controller]
type = "joint_position"
target = [0.7]
[[push]]
body = "toy/box"
time = 0.1
velocity = [0.5, 0, 1]
[[sensor]]
match = "toy/acc"
noise = 0.02
[[camera]]
name = "eye"
position = [-3, -1, 1.5]
look_at = [0, 0, 0.3]
)";

std::string bytes_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ReplayedSensors : public testing::Test {
 protected:
  ReplayedSensors() {
    folder_.write("m.xml", kMeasuredModel);
    folder_.write("s.toml", kMeasuredScene);
    RunRequest request{.out = folder_.path() / "first"};
    request.log.file = replay_.log = folder_.path() / "run.mcap";
    request.log.topics = {"/tf"};
    request.duration = 0.3;
    request.simulation.seed = 5;
    const auto report =
        run_and_record(*World::compile(*load_scene(folder_.path() / "s.toml")), request, {});
    EXPECT_TRUE(report.ok()) << report.error().to_string();
    replay_.request.out = folder_.path() / "again";
    replay_.request.overwrite = true;
  }
  std::string refusal(const std::string& option, const std::string& value) {
    replay_.settings = {{option, value}};
    const auto report = replay_log(replay_, {});
    return report.ok() ? "taken" : report.error().message + " | " + report.error().hint;
  }

  TempFolder folder_;
  LogReplay replay_;
};

TEST_F(ReplayedSensors, AreTheRecordedOnesToTheBit) {
  replay_.settings = {{"camera.eye.fovy", "50"}};
  const auto report = replay_log(replay_, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "first/sensors")) {
    const fs::path again = folder_.path() / "again/sensors" / entry.path().filename();
    EXPECT_EQ(bytes_of_file(entry.path()), bytes_of_file(again)) << again;
    ++files;
  }
  EXPECT_EQ(files, 6);
  EXPECT_EQ(bytes_of_file(folder_.path() / "first/state.csv"),
            bytes_of_file(folder_.path() / "again/state.csv"));
}

// The forces are not in the poses, but what follows from positions alone is.
TEST_F(ReplayedSensors, OfPosesHaveTheStampsOfTheRecordedOnes) {
  replay_.motion = ReplayMotion::kPoses;
  ASSERT_TRUE(replay_log(replay_, {}).ok());
  std::ifstream first(folder_.path() / "first/sensors/toy_angle.csv");
  std::ifstream again(folder_.path() / "again/sensors/toy_angle.csv");
  std::string a, b;
  while (std::getline(first, a)) {
    ASSERT_TRUE(std::getline(again, b));
    double n[4] = {}, m[4] = {};  // sample, step, times [s]; the clock's own roundings aside
    std::sscanf(a.c_str(), "%lf,%lf,%lf,%lf", &n[0], &n[1], &n[2], &n[3]);
    std::sscanf(b.c_str(), "%lf,%lf,%lf,%lf", &m[0], &m[1], &m[2], &m[3]);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(n[i], m[i], 1e-12) << a << " and " << b;
  }
}

TEST_F(ReplayedSensors, RefuseOptionsThatChangeNothing) {
  const std::pair<const char*, const char*> changes[] = {
      {"robot.toy.controller.target", "[0.2]"},
      {"robot.toy.controller.kp", "3"},
      {"robot.toy.controller.type", "none"},
      {"sim.seed", "9"},
      {"sim.duration", "0.1"},
      {"sim.timestep", "0.001"},
      {"push.0.time", "0.2"},
      {"navigation.cell", "0.2"},
  };
  for (const auto& [option, value] : changes) {
    const std::string says = refusal(option, value);
    EXPECT_THAT(says, HasSubstr(option));
    EXPECT_THAT(says, HasSubstr("no effect")) << option;
  }
  EXPECT_THAT(refusal("sim.seed", "5"), "taken") << "it is as it was";
  EXPECT_THAT(refusal("sensor.0.noise", "0.1"), "taken");
  EXPECT_THAT(refusal("record.metrics_rate", "50"), "taken");
}

TEST_F(ReplayedSensors, RefuseOverlaysThatChangeNothing) {
  folder_.write("o.toml",
                "[[robot]]\nname = \"toy\"\nfile = \"m.xml\"\n[robot.controller]\ntype = "
                "\"joint_position\"\nkp = 7\n");
  replay_.overlays = {folder_.path() / "o.toml"};
  const auto report = replay_log(replay_, {});
  ASSERT_FALSE(report.ok());
  EXPECT_THAT(report.error().message, HasSubstr("robot.toy.controller.kp"));
}

TEST_F(ReplayedSensors, OfANewRunTakeAllOptions) {
  replay_.motion = ReplayMotion::kNewRun;
  replay_.settings = {{"sim.duration", "0.1"}, {"robot.toy.controller.target", "[0.2]"}};
  const auto report = replay_log(replay_, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  EXPECT_EQ(report->steps, 50);
}

}  // namespace
}  // namespace gloam
