// Robots of running simulations, driven by bytes at a pseudo-terminal.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/joystick.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "gloam/drive/teleop.h"
#include "teleop/jog.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

const char* const kBase = R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
  <geom type="plane" size="9 9 1" friction="1"/>
  <body name="base" pos="0 0 .07"><freejoint/><geom type="box" size=".15 .1 .03" mass="5"/>
    <geom type="sphere" size=".02" pos="-.13 0 -.05" condim="1" priority="1" mass=".05"/>
    <geom type="sphere" size=".02" pos=".13 0 -.05" condim="1" priority="1" mass=".05"/>
    <body name="wl" pos="0 .15 0"><joint name="l" axis="0 1 0"/>
      <geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
    <body name="wr" pos="0 -.15 0"><joint name="r" axis="0 1 0"/>
      <geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
  </body></worldbody>
  <actuator><velocity joint="l" kv="3"/><velocity joint="r" kv="3"/></actuator></mujoco>)";

const char* const kArm = R"(<mujoco><option timestep="0.002" integrator="implicitfast"/>
  <compiler angle="radian"/><worldbody>
  <body name="base"><geom size=".05"/>
   <body name="upper" pos="0 0 .1"><joint name="j1" axis="0 0 1"/><geom size=".04" mass=".5"/>
    <body name="lower"><joint name="j2" axis="0 1 0" ref="0.6"/>
     <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03" mass=".5"/>
     <body name="hand" pos=".3 0 0"><joint name="j3" axis="0 1 0" ref="-1.2"/>
      <geom type="capsule" fromto="0 0 0 .2 0 0" size=".02" mass=".3"/><site name="tool" pos=".2 0 0"/>
      <body name="finger" pos=".2 .02 0"><joint name="f" type="slide" axis="0 1 0" range="0 .04"/>
       <geom size=".01" mass=".05"/></body></body></body></body></body></worldbody>
  <actuator><position joint="j1" kp="200" kv="20"/><position joint="j2" kp="200" kv="20"/>
   <position joint="j3" kp="200" kv="20"/><position name="f" joint="f" kp="300" kv="10"/></actuator></mujoco>)";

const char* const kScene = R"(
[[robot]]
name = "base"
file = "base.xml"
[robot.controller]
type = "diff_drive"
[robot.controller.drive]
max_speed = 0.9

[[robot]]
name = "arm"
file = "arm.xml"
position = [2, 0, 0]
[robot.controller]
type = "ik"
frame = "site tool"
orientation_cost = 0
[[robot.part]]
name = "gripper"
joints = ["f"]
[robot.part.controller]
type = "gripper"
rate = 100

[[robot]]
name = "lazy"
file = "arm.xml"
position = [4, 0, 0]
[robot.controller]
type = "joint_position"
)";

class Teleoperation : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "gloam_teleop_XXXXXX";
    ASSERT_NE(::mkdtemp(folder_.data()), nullptr);
    ::setenv("GLOAM_CACHE", (fs::path(folder_) / "cache").c_str(), 1);
    std::ofstream(fs::path(folder_) / "base.xml") << kBase;
    std::ofstream(fs::path(folder_) / "arm.xml") << kArm;
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_TRUE(master_ >= 0 && ::grantpt(master_) == 0 && ::unlockpt(master_) == 0);
    terminal_ = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
    ASSERT_GE(terminal_, 0);
    auto created = Simulation::create(compile(kScene), {.pace = Pace::kRealTime});
    ASSERT_TRUE(created.ok()) << created.error().to_string();
    simulation_ = std::move(*created);
    simulation_->resume();
  }
  void TearDown() override {
    teleop_.reset();
    simulation_.reset();
    ::close(master_);
    ::close(terminal_);
    fs::remove_all(folder_);
  }

  World compile(const std::string& text) const {
    const Result<Scene> scene = parse_scene(text, folder_);
    EXPECT_TRUE(scene.ok()) << scene.error().to_string();
    auto world = World::compile(*scene);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return *world;
  }
  void start(const std::string& robot = "", const std::string& gamepad = "") {
    auto started = Teleop::start(*simulation_, {robot, gamepad, terminal_});
    ASSERT_TRUE(started.ok()) << started.error().to_string();
    teleop_ = std::move(*started);
    std::this_thread::sleep_for(milliseconds(20));
  }
  void press(const std::string& keys) const {
    ASSERT_EQ(::write(master_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Waits until a condition holds; false after three seconds.
  template <class Condition>
  static bool comes_true(const Condition& condition) {
    const auto end = Clock::now() + std::chrono::seconds(3);
    while (Clock::now() < end) {
      if (condition()) return true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }
  bool has_applied(int64_t count) const {
    return comes_true([&] { return simulation_->stats().commands_applied >= count; });
  }
  template <class T>
  std::vector<T> commands() {
    std::vector<T> found;
    for (const LoggedCommand& logged : simulation_->take_command_log())
      if (const T* what = std::get_if<T>(&logged.command.what)) found.push_back(*what);
    return found;
  }
  std::string notice() {
    std::string all;
    comes_true([&] {
      for (const std::string& text : teleop_->take_notices()) all += text + "\n";
      return !all.empty();
    });
    return all;
  }

  std::string folder_;
  int master_ = -1, terminal_ = -1;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Teleop> teleop_;
};

TEST_F(Teleoperation, AKeyActsSoon) {
  start();
  std::vector<double> delays;
  for (int i = 1; i <= 41; ++i) {
    const auto pressed = Clock::now();
    press(i % 2 == 1 ? "w" : " ");
    ASSERT_TRUE(comes_true([&] { return simulation_->stats().commands_applied >= i; }));
    delays.push_back(std::chrono::duration<double, std::milli>(Clock::now() - pressed).count());
    std::this_thread::sleep_for(milliseconds(7 + i % 5));
  }
  std::ranges::sort(delays);
  const double median = delays[delays.size() / 2], most = delays.back();
  std::printf("from a key to the step that uses its goal: median %.1f ms, longest %.1f ms\n",
              median, most);
  EXPECT_LT(median, 50) << "5 ms on an idle machine, 18 ms beside compilers";
}

TEST_F(Teleoperation, AHeldKeyIsOneCommandAndItsReleaseAnother) {
  start("base");
  for (int i = 0; i < 20; ++i) {
    press("w");
    std::this_thread::sleep_for(milliseconds(30));
  }
  ASSERT_TRUE(has_applied(2));
  const auto goals = commands<SetVelocityGoal>();
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_DOUBLE_EQ(goals[0].vx, 0.5) << "speed 5 of 9";
  EXPECT_EQ(goals[1].vx, 0);
  EXPECT_THAT(teleop_->status(), HasSubstr("vx +0.00"));
}

TEST_F(Teleoperation, TheRobotMovesAndStopsAtTheEnd) {
  start("base");
  press("9w");
  ASSERT_TRUE(has_applied(1));
  std::this_thread::sleep_for(milliseconds(500));
  teleop_.reset();
  ASSERT_TRUE(has_applied(2));
  const auto goals = commands<SetVelocityGoal>();
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_DOUBLE_EQ(goals[0].vx, 0.9);
  EXPECT_EQ(goals[1].vx, 0);
  const Result<Body> body = simulation_->world().find_body("base/base");
  EXPECT_GT(simulation_->body_pose(*body)->p.x, 0.05);
}

TEST_F(Teleoperation, TheTerminalIsRestored) {
  termios before = {}, during = {}, after = {};
  ::tcgetattr(terminal_, &before);
  start();
  ::tcgetattr(terminal_, &during);
  EXPECT_EQ(during.c_lflag & (ICANON | ECHO), 0U);
  EXPECT_NE(during.c_lflag & ISIG, 0U) << "Ctrl-C is a signal";
  auto second = Teleop::start(*simulation_, {"arm", "", terminal_});
  EXPECT_FALSE(second.ok()) << "one at a time";
  teleop_.reset();
  ::tcgetattr(terminal_, &after);
  EXPECT_EQ(after.c_lflag, before.c_lflag);
  EXPECT_EQ(after.c_iflag, before.c_iflag);
  start();
  restore_terminal();
  ::tcgetattr(terminal_, &after);
  EXPECT_EQ(after.c_lflag, before.c_lflag);
}

TEST_F(Teleoperation, AClosedTerminalStopsTheRobot) {
  start("base");
  press("w");
  ASSERT_TRUE(has_applied(1));
  ::close(master_);
  EXPECT_THAT(notice(), HasSubstr("closed"));
  ASSERT_TRUE(has_applied(2));
  EXPECT_EQ(commands<SetVelocityGoal>().back().vx, 0);
}

TEST_F(Teleoperation, KeysMoveTheGoalOfAFrame) {
  start("arm");
  EXPECT_THAT(teleop_->help().front(), HasSubstr("site 'arm/tool'"));
  press("www");
  ASSERT_TRUE(has_applied(3));
  press("r");
  ASSERT_TRUE(has_applied(4));
  const auto goals = commands<SetPoseGoal>();
  ASSERT_EQ(goals.size(), 4U);
  const double step = teleop::key_step(teleop::kUsualSpeed).distance;
  EXPECT_NEAR(goals[2].X_WF.p.x - goals[0].X_WF.p.x, 2 * step, 1e-12);
  EXPECT_NEAR(goals[3].X_WF.p.z - goals[2].X_WF.p.z, step, 1e-12);
  EXPECT_NEAR(goals[0].X_WF.p.y, 0, 1e-3);
}

TEST_F(Teleoperation, GOpensAndClosesTheGripper) {
  start("arm");
  press("g");
  ASSERT_TRUE(has_applied(1));
  std::this_thread::sleep_for(milliseconds(720));
  press("g");
  ASSERT_TRUE(has_applied(2));
  const auto goals = commands<SetJointGoal>();
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_EQ(goals[0].position, 0) << "it was open";
  EXPECT_EQ(goals[1].position, 0.04);
}

TEST_F(Teleoperation, AnotherClientsRobotIsLeftAloneAndTakenWhenItIsFree) {
  start("base");
  auto lease = simulation_->claim(*simulation_->world().find_robot("base"));
  ASSERT_TRUE(lease.ok());
  press("w");
  EXPECT_THAT(notice(), HasSubstr("another client controls robot 'base'"));
  lease->reset();
  ASSERT_TRUE(has_applied(1)) << "the key is still held";
  EXPECT_FALSE(simulation_->claim(*simulation_->world().find_robot("base")).ok());
  press(" ");
  EXPECT_TRUE(comes_true([&] {
    return simulation_->claim(*simulation_->world().find_robot("base")).ok();
  })) << "one second after the last goal";
}

TEST_F(Teleoperation, ContinuesInAnotherWorldAndAfterAReset) {
  start("base");
  ASSERT_TRUE(simulation_->recompile(compile(std::string(kScene) + "[sim]\nseed = 2\n")).ok());
  press("w");
  ASSERT_TRUE(has_applied(1));
  ASSERT_TRUE(simulation_->post({.what = ResetSim{}}).ok());
  const auto is_posted = [&](int count) {
    const auto goals = commands<SetVelocityGoal>();
    return static_cast<int>(goals.size()) >= count;
  };
  for (int i = 0; i < 3; ++i) {
    press("w");
    std::this_thread::sleep_for(milliseconds(100));
  }
  EXPECT_TRUE(is_posted(2)) << "a reset forgets the goal";
}

TEST_F(Teleoperation, HelpAndTheEndAreRequested) {
  start("base");
  press("h");
  EXPECT_TRUE(comes_true([&] { return teleop_->take_help_request(); }));
  EXPECT_FALSE(teleop_->take_help_request());
  EXPECT_THAT(teleop_->help(), testing::Contains(HasSubstr("Space")));
  EXPECT_FALSE(teleop_->end_asked());
  press("\x1b");
  EXPECT_TRUE(comes_true([&] { return teleop_->end_asked(); }));
}

TEST_F(Teleoperation, AGamepadDrivesAndStopsWhenItIsUnplugged) {
  const std::string device = folder_ + "/pad";
  ASSERT_EQ(::mkfifo(device.c_str(), 0600), 0);
  start("base", device);
  const int pad = ::open(device.c_str(), O_WRONLY);
  const js_event ahead{.time = 0, .value = -32767, .type = JS_EVENT_AXIS, .number = 1};
  ASSERT_EQ(::write(pad, &ahead, sizeof ahead), static_cast<ssize_t>(sizeof ahead));
  ASSERT_TRUE(has_applied(1));
  EXPECT_THAT(notice(), HasSubstr(device));
  ::close(pad);
  EXPECT_THAT(notice(), HasSubstr("unplugged"));
  ASSERT_TRUE(has_applied(2));
  const auto goals = commands<SetVelocityGoal>();
  EXPECT_DOUBLE_EQ(goals[0].vx, 0.5);
  EXPECT_EQ(goals[1].vx, 0);
}

TEST_F(Teleoperation, RobotsThatCannotBeDrivenAreErrorsWithARemedy) {
  const auto failure = [&](const std::string& robot) {
    auto started = Teleop::start(*simulation_, {robot, "", terminal_});
    return started.ok() ? "" : started.error().to_string();
  };
  EXPECT_THAT(failure("bas"), HasSubstr("did you mean 'base'"));
  EXPECT_THAT(failure("lazy"), HasSubstr("'joint_position' accepts neither"));
  EXPECT_THAT(failure("lazy"), HasSubstr("diff_drive"));
  const int file = ::open((folder_ + "/base.xml").c_str(), O_RDONLY);
  auto started = Teleop::start(*simulation_, {"base", "", file});
  ::close(file);
  ASSERT_FALSE(started.ok());
  EXPECT_THAT(started.error().to_string(), HasSubstr("not a terminal"));
  auto none = Teleop::start(*simulation_, {"base", "/dev/null", terminal_});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().to_string(), HasSubstr("not a joystick"));
}

}  // namespace
}  // namespace gloam
