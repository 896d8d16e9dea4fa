// Logs: what is written is read back, stepped again to the bit, and found out where it is not.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <fstream>

#include "base/test/source_dir.h"
#include "gloam/controller.h"
#include "gloam/log.h"
#include "gloam/log_replay.h"
#include "gloam/run.h"
#include "runtime/log/command_text.h"
#include "runtime/log/log_recorder.h"
#include "runtime/log/run_text.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kSwing = R"(<mujoco model="swing"><option timestep="0.002"/>
<worldbody><light pos="0 0 3"/><geom type="plane" size="3 3 .1"/>
<body name="box" pos="0 0 .5"><freejoint/><geom type="box" size=".1 .1 .1" mass="1"/></body>
<body name="upper" pos="1 0 1"><joint name="shoulder" axis="0 1 0" damping=".1"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/></body>
<body name="hand" mocap="true" pos="-1 0 1"><geom size=".05" contype="0" conaffinity="0"/></body>
</worldbody><actuator><motor name="s" joint="shoulder"/></actuator></mujoco>)";

constexpr const char* kLogScene = "[[robot]]\nname = \"swing\"\nfile = \"swing.xml\"\n";

class Logs : public testing::Test {
 protected:
  Logs() {
    folder_.write("swing.xml", kSwing);
    folder_.write("s.toml", kLogScene);
    file_ = folder_.path() / "run.mcap";
  }
  World world() { return *World::compile(*load_scene(folder_.path() / "s.toml")); }
  static std::unique_ptr<LiveSimulation> simulation(const World& world) {
    return *LiveSimulation::create(world, {.seed = 7, .pace = Pace::kLockstep});
  }
  void disturb(LiveSimulation& simulation) {
    const World world = simulation.world();
    const RobotInfo robot = world.robots()[0];
    const Body box = *world.find_body("swing/box");
    ASSERT_TRUE(simulation.post({.what = SetControls{robot.robot, {0.7}}}).ok());
    ASSERT_TRUE(simulation.post({.what = SetWrench{box, {0.1, 1.0 / 3, 2}, {0, 0, 0.05}}}).ok());
    ASSERT_TRUE(simulation.post({.what = AddVelocity{box, {0.2, 0, 0.1}}}).ok());
    ASSERT_TRUE(simulation.post({.what = DragBody{box, {0, 0, .1}, {.3, 0, 1}}}).ok());
    ASSERT_TRUE(simulation.post({.what = SetLiveField{LiveFieldId::kGravity, 2, {-3.7}}}).ok());
    ASSERT_TRUE(simulation
                    .post({.what = SetMocapPose{*world.find_body("swing/hand"),
                                                {{0, 0, .1}, {1, 0, 0, 0}}}})
                    .ok());
  }
  LogVerification verify() { return *verify_log(file_, "", {}); }

  TempFolder folder_;
  fs::path file_;
};

TEST_F(Logs, MayOutliveTheirSimulationOnceTheyAreFinished) {
  auto live = simulation(world());
  auto log = *start_log(*live, {.file = file_});
  ASSERT_TRUE(live->step(20).ok());
  ASSERT_TRUE(log->finish().ok());
  live.reset();
  EXPECT_TRUE(log->status().ok());
  EXPECT_EQ(log->dropped(), 0);
  EXPECT_TRUE(log->finish().ok()) << "the second call does nothing";
  log.reset();
  EXPECT_TRUE(verify().is_equal());
}

TEST_F(Logs, AreSteppedAgainToTheBit) {
  auto live = simulation(world());
  auto log = *LogRecorder::start(*live, {.file = file_});
  ASSERT_TRUE(live->step(100).ok());
  disturb(*live);
  ASSERT_TRUE(live->step(100).ok());
  ASSERT_TRUE(live->recompile(world()).ok());  // in the middle of it
  disturb(*live);
  ASSERT_TRUE(live->step(57).ok());
  ASSERT_TRUE(live->post({.what = ResetSim{}}).ok());
  disturb(*live);
  ASSERT_TRUE(live->step(33).ok());
  live->simulator().stop();
  ASSERT_TRUE(log->finish(live->latest()).ok());
  const LogVerification found = verify();
  EXPECT_TRUE(found.is_equal()) << found.where << " run " << found.run << ", equal at "
                                << found.equal_step << ", not at " << found.step;
  EXPECT_TRUE(found.notes.empty());
  EXPECT_EQ(found.runs, 2);
  EXPECT_EQ(found.steps, 255 + 33);  // up to the last state before the reset
  EXPECT_GT(found.states, 45);
  const LogInfo info = *describe_log(file_);
  EXPECT_TRUE(info.has_run);
  EXPECT_EQ(info.scene, "s");
  EXPECT_EQ(info.profile, "ros2");
}

FollowTrajectory swing_to(double position, double seconds) {
  return {{0, 0},
          {},
          {.points = {{seconds / 3, {position / 2}, {0.3}, {1.0 / 7}},
                      {seconds, {position}, {0}, {0}}}}};
}

constexpr const char* kPendulum = R"(<mujoco model="swing"><option timestep="0.002"/>
<worldbody><light pos="0 0 3"/>
<body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping=".1"/>
  <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/></body>
</worldbody><actuator><motor name="s" joint="shoulder"/></actuator></mujoco>)";

// Replaced in motion, followed across a recompile, waiting for its step, stopped, restored.
TEST_F(Logs, TrajectoriesAreSteppedAgainToTheBit) {
  folder_.write("swing.xml", kPendulum);
  folder_.write("s.toml", std::string(kLogScene) +
                              "[robot.controller]\ntype = \"joint_position\"\nrate = 250\n");
  auto live = simulation(world());
  const auto post = [&](int64_t step, decltype(Command::what) what) {
    ASSERT_TRUE(live->post({step, std::move(what)}).ok());
  };
  auto log = *LogRecorder::start(*live, {.file = file_});
  post(10, swing_to(0.7, 0.4));
  post(100, swing_to(-0.2, 0.5));
  ASSERT_TRUE(live->step(150).ok());
  const auto checkpoint = live->checkpoint();
  ASSERT_TRUE(checkpoint.ok()) << checkpoint.error().to_string();
  post(Command::kNextStep, swing_to(0.1, 0.2));
  ASSERT_TRUE(live->step(50).ok());
  EXPECT_EQ(live->latest().trajectory(Robot{0, 0})->start_step, 150);
  ASSERT_TRUE(live->restore(*checkpoint).ok());
  EXPECT_EQ(live->latest().trajectory(Robot{0, 0})->start_step, 100);
  post(300, swing_to(0.4, 1));  // waits during the recompile
  ASSERT_TRUE(live->step(50).ok());
  ASSERT_TRUE(live->recompile(world()).ok());
  ASSERT_TRUE(live->step(50).ok());
  EXPECT_EQ(live->latest().trajectory(Robot{0, 0})->start_step, 100);
  ASSERT_TRUE(live->step(100).ok());
  EXPECT_EQ(live->latest().trajectory(Robot{0, 0})->start_step, 300);
  post(Command::kNextStep, StopTrajectory{{0, 0}, {}});
  ASSERT_TRUE(live->step(20).ok());
  post(Command::kNextStep, ResetSim{});
  post(5, {FollowTrajectory{
              {0, 0}, {}, {TrajectoryProfile::kQuintic, {{0, {0.3}}, {0, {0}}}, {2}, {9}}}});
  ASSERT_TRUE(live->step(100).ok());
  live->simulator().stop();
  ASSERT_TRUE(log->finish(live->latest()).ok());
  const Result<LogVerification> found = verify_log(file_, "", {});
  ASSERT_TRUE(found.ok()) << found.error().to_string();
  EXPECT_TRUE(found->is_equal()) << found->where << " run " << found->run << " after step "
                                 << found->equal_step;
  EXPECT_EQ(found->runs, 3);
}

// Velocities, forces and a control that a controller would write, too.
TEST_F(Logs, InputsOfStepHooksAreSteppedAgain) {
  auto live = simulation(world());
  ASSERT_TRUE(live->set_step_hook([](const mjModel_*, mjData_* d) {
                    d->ctrl[0] = std::sin(20 * d->time);
                    d->qfrc_applied[2] = d->time > 0.1 ? 11.5 : 0;
                    if (d->time > 0.1999 && d->time < 0.2001) d->qvel[6] += 1e-9;
                  })
                  .ok());
  auto log = *LogRecorder::start(*live, {.file = file_});
  disturb(*live);
  ASSERT_TRUE(live->step(120).ok());
  ASSERT_TRUE(live->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(live->step(200).ok());
  live->simulator().stop();
  ASSERT_TRUE(log->finish(live->latest()).ok());
  const LogVerification found = verify();
  EXPECT_TRUE(found.is_equal()) << found.where << " after step " << found.equal_step;
  EXPECT_EQ(found.runs, 2);
}

// A log of a run that went on from a log, and of one that went on from that.
TEST_F(Logs, InputsOfStepHooksBeforeABranchAreInItsLog) {
  const auto hook = [](const mjModel_*, mjData_* d) { d->qfrc_applied[2] = 9 + d->time; };
  {
    auto live = simulation(world());
    ASSERT_TRUE(live->set_step_hook(hook).ok());
    auto log = *LogRecorder::start(*live, {.file = file_});
    ASSERT_TRUE(live->step(100).ok());
    live->simulator().stop();
    ASSERT_TRUE(log->finish(live->latest()).ok());
  }
  for (const auto& [time, steps] : {std::pair(0.1, 100), std::pair(0.2, 150)}) {
    const auto from = log_checkpoint(file_, "", 0, time);
    ASSERT_TRUE(from.ok()) << from.error().to_string();
    file_ = folder_.path() / fmt::format("branch_{}.mcap", steps);
    auto live = simulation(from->world());
    ASSERT_TRUE(live->restore(*from).ok());
    if (steps == 150) {
      ASSERT_TRUE(live->set_step_hook(hook).ok());
    }
    auto log = *LogRecorder::start(*live, {.file = file_});
    ASSERT_TRUE(live->step(50).ok());
    live->simulator().stop();
    ASSERT_TRUE(log->finish(live->latest()).ok());
    const LogVerification found = verify();
    EXPECT_TRUE(found.is_equal()) << found.where << " after step " << found.equal_step;
    EXPECT_TRUE(found.notes.empty());
    EXPECT_EQ(found.steps, steps);
  }
}

/// Depends on the wall: no log can know.
class Restless final : public Controller {
 public:
  void reset(const mjModel_*, const mjData_*) override {}
  void control(const ControlInputs& inputs) override {
    static std::atomic<int> calls{0};
    if (inputs.step == 100) inputs.data->qvel[6] += 1e-9 * ++calls;
  }
};

TEST_F(Logs, WhatIsInNoLogIsFound) {
  ASSERT_TRUE(register_controller("restless", [](const ControllerRequest&) {
                return Result<std::unique_ptr<Controller>>(std::make_unique<Restless>());
              }).ok());
  folder_.write("s.toml", std::string(kLogScene) + "[robot.controller]\ntype = \"restless\"\n");
  auto live = simulation(world());
  auto log = *LogRecorder::start(*live, {.file = file_});
  ASSERT_TRUE(live->step(200).ok());
  live->simulator().stop();
  ASSERT_TRUE(log->finish(live->latest()).ok());
  const LogVerification found = verify();
  EXPECT_FALSE(found.is_equal());
  EXPECT_EQ(found.equal_step, 100);
  EXPECT_EQ(found.step, 105);
  EXPECT_EQ(found.differing, 100);
  EXPECT_THAT(found.where, HasSubstr("swing/shoulder"));
}

TEST_F(Logs, RunsFromACheckpointAreSteppedFromTheirBeginning) {
  auto live = simulation(world());
  auto log = *LogRecorder::start(*live, {.file = file_});
  ASSERT_TRUE(live->step(50).ok());
  disturb(*live);
  ASSERT_TRUE(live->step(7).ok());
  const Checkpoint checkpoint = *live->checkpoint();
  ASSERT_TRUE(live->step(50).ok());
  ASSERT_TRUE(live->restore(checkpoint).ok());
  ASSERT_TRUE(live->step(50).ok());
  live->simulator().stop();
  ASSERT_TRUE(log->finish(live->latest()).ok());
  const LogVerification found = verify();
  EXPECT_TRUE(found.is_equal()) << found.where;
  EXPECT_TRUE(found.notes.empty());
  EXPECT_EQ(found.runs, 2);
  EXPECT_EQ(found.steps, 105 + 107);
}

TEST_F(Logs, ChangedModelIsNamed) {
  RunRequest request;
  request.log.file = file_;
  request.duration = 0.2;
  ASSERT_TRUE(run_and_record(world(), request, {}).ok());
  EXPECT_TRUE(verify().is_equal());
  std::string other = kSwing;
  other.replace(other.find("mass=\"1\""), 8, "mass=\"2\"");
  folder_.write("swing.xml", other);
  const auto found = verify_log(file_, "", {});
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().to_string(), HasSubstr("swing.xml"));
  fs::remove(folder_.path() / "swing.xml");
  EXPECT_FALSE(verify_log(file_, "", {}).ok());
  // Elsewhere it is as it was.
  fs::create_directory(folder_.path() / "moved");
  std::ofstream(folder_.path() / "moved" / "swing.xml") << kSwing;
  EXPECT_TRUE(verify_log(file_, folder_.path() / "moved", {}).ok());
}

TEST_F(Logs, ExistingFileAndUnknownTopicAreRefused) {
  auto live = simulation(world());
  EXPECT_FALSE(LogRecorder::start(*live, {.file = file_, .topics = {"/nothing"}}).ok());
  EXPECT_FALSE(fs::exists(file_)) << "nothing is left of it";
  std::ofstream(file_) << "mine";
  EXPECT_FALSE(
      LogRecorder::start(*live, {.file = file_, .overwrite = true, .topics = {"/nothing"}}).ok());
  EXPECT_EQ(fs::file_size(file_), 4u) << "the old one is replaced only by a log that begins";
  EXPECT_FALSE(LogRecorder::start(*live, {.file = file_}).ok());
  EXPECT_FALSE(describe_log(file_).ok());
  EXPECT_FALSE(verify_log(file_, "", {}).ok());
  EXPECT_FALSE(LogRecorder::start(*live, {.file = folder_.path() / "no" / "such.mcap"}).ok());
}

TEST_F(Logs, CutLogIsRecoveredAndVerified) {
  RunRequest request;
  request.log.file = file_;
  request.duration = 0.5;
  ASSERT_TRUE(run_and_record(world(), request, {}).ok());
  const auto size = fs::file_size(file_);
  const fs::path whole = folder_.path() / "whole.mcap";
  int64_t bytes_lost = 0;
  for (const int tenths : {9, 8, 7, 6}) {  // chunks end where paths and texts have them end
    fs::resize_file(file_, size * static_cast<uintmax_t>(tenths) / 10);
    fs::remove(whole);
    const auto recovery = recover_log(file_, whole);
    ASSERT_TRUE(recovery.ok()) << recovery.error().to_string();
    const auto found = verify_log(whole, "", {});
    ASSERT_TRUE(found.ok()) << found.error().to_string();
    EXPECT_TRUE(found->is_equal());
    EXPECT_TRUE(recovery->bytes_lost == 0 || !recovery->is_whole);
    bytes_lost += recovery->bytes_lost;
  }
  EXPECT_GT(bytes_lost, 0);
}

TEST_F(Logs, CommandsAreReadBackToTheBit) {
  const World world = this->world();
  const CompiledWorld& compiled = *world.compiled();
  const uint64_t serial = compiled.serial;
  const std::vector<decltype(Command::what)> all = {
      SetControl{{0, serial}, 0.1 + 0.2},
      SetVelocityGoal{{0, serial}, 1e-300, -0.0, 1.0 / 3},
      SetMocapPose{{3, serial}, {{1, 2, 3}, {0.5, 0.5, -0.5, 0.5}}},
      SetWrench{{1, serial}, {1, 2, 3}, {4, 5, 6}},
      AddVelocity{{1, serial}, {1, 2, 3}},
      DragBody{{1, serial}, {1, 2, 3}, {4, 5, 6}, false},
      ResetSim{},
      SetLiveField{LiveFieldId::kBodyMass, 1, {0.1, 3.3}},
      SetJointState{{1, serial}, {0.7}, {}},
      SetControls{{0, serial}, {0.25}},
      SetJointGoal{{1, serial}, 0.3},
      SetJointCommand{{0, serial}, {{1, serial}}, {0.1}, {}, {JointTarget::kNone}, {3}, {1.0 / 3}},
      SetController{{0, serial},
                    {.type = "joint_position", .rate = {250, 1}, .kp = 1.0 / 3, .target = {0.1}}},
      FollowTrajectory{{0, serial},
                       {{1, serial}},
                       {TrajectoryProfile::kQuintic, {{0, {0.1}}, {0, {0.2}}}, {1.0 / 3}, {2}},
                       -7'000'000'000'000'000'001},
      StopTrajectory{{0, serial}, {{1, serial}}},
      SetPoseGoal{{0, serial}, {{0.1, 0.2, 0.3}, {0, 0.6, 0.8, 0}}},
      TurnBody{{1, serial}, {0.5, 0.5, -0.5, 0.5}, false},
      SetEquality{{0, serial}, false}};
  ASSERT_EQ(all.size(), std::variant_size_v<decltype(Command::what)>);
  for (const auto& what : all) {
    const std::string text = command_text({2, {17, what}}, compiled);
    const auto again = parse_command(text);
    ASSERT_TRUE(again.ok()) << text;
    EXPECT_EQ(again->run, 2);
    EXPECT_EQ(again->command.step, 17);
    EXPECT_EQ(command_text(*again, compiled), text);
  }
  for (
      const char* bad :
      {"", "{}", "[]", R"({"run":0,"step":0,"command":"fly"})",
       R"({"run":0,"step":0,"command":"set_control","actuator":"x","value":1})",
       R"({"run":0,"step":0,"command":"set_control","actuator":0})",
       R"({"run":0,"step":0,"command":"set_controller","robot":0,"controller":"type = 'x'"})",
       R"({"run":0,"step":0,"command":"follow_trajectory","robot":0,"joints":[1],"profile":"round","points":[],"max_velocity":[],"max_acceleration":[]})",
       R"({"run":0,"step":0,"command":"follow_trajectory","robot":0,"joints":[1],"profile":"spline","points":[[1]],"max_velocity":[],"max_acceleration":[]})"})
    EXPECT_FALSE(parse_command(bad).ok()) << bad;
  for (const char* bad : {"", "{}", "[1]", R"({"run":0})"}) EXPECT_FALSE(parse_run_text(bad).ok());
}

/// Steps that differ when `seconds` of an example are logged and stepped again; -1 = an error.
int64_t differing_steps(const std::string& example, double seconds) {
  const TempFolder folder;
  const Scene scene = *load_scene(source_dir() / "examples" / (example + ".toml"));
  RunRequest request;
  request.log.file = folder.path() / "run.mcap";
  request.log.topics = {"/clock", "/tf"};
  request.duration = seconds;
  const auto report = run_and_record(*World::compile(scene), request, {});
  if (!report.ok() || !report->status.ok()) return -1;
  const auto found = verify_log(request.log.file, "", {});
  if (!found.ok()) return -1;
  EXPECT_TRUE(found->is_equal()) << found->where;
  EXPECT_EQ(found->steps, report->steps);
  return found->differing;
}

class ExampleLog : public testing::TestWithParam<const char*> {};

TEST_P(ExampleLog, ZeroStepsDiffer) { EXPECT_EQ(differing_steps(GetParam(), 0.4), 0); }

INSTANTIATE_TEST_SUITE_P(Worlds, ExampleLog,
                         testing::Values("demo", "house_fire", "sand", "pool", "crowd", "rover",
                                         "randomized_house"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LongLog, AMinuteIsSteppedAgainToTheBit) { EXPECT_EQ(differing_steps("two_robots", 60), 0); }
TEST(LongLog, DISABLED_SweepAnHourIsSteppedAgainToTheBit) {
  EXPECT_EQ(differing_steps("two_robots", 3600), 0);
}

}  // namespace
}  // namespace gloam
