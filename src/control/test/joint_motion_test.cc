// Trajectories that a simulation follows, and controllers that are switched while it runs.

#include <algorithm>
#include <cmath>

#include "joint_rig.h"
#include "sim/loop/restepper.h"

namespace gloam {
namespace {

const ControllerOptions kHold{.type = "joint_position", .rate = {500, 1}, .kp = 200, .kd = 20};

std::string error_of(Simulator& sim, decltype(Command::what) what) {
  const Status status = sim.post({.what = std::move(what)});
  return status.ok() ? std::string("accepted") : status.error().to_string();
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

FollowTrajectory to_point(double position, double time) {
  return {kArmRobot, {{1, 0}}, {.points = {{time, {position}, {0}, {0}}}}};
}

// The servo's control is its reference plus the share of its damping: a joint without kv shows it.
std::shared_ptr<CompiledWorld> servo_world() {
  auto world = arm_world(kPendulums, kHold);
  world->model->actuator_biasprm[mjNBIAS * 1 + 2] = 0;
  return world;
}

TEST(Trajectory, IsEvaluatedAtEveryCallOfTheController) {
  const auto world = servo_world();
  world->model->opt.gravity[2] = 0;  // it starts at the joint's position, and a servo sags
  auto sim = run_arm(world);
  ASSERT_TRUE(sim->post({100, to_point(0.8, 2)}).ok());
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(sim->step(41).ok());
    const int64_t step = (sim->latest().step() - 1) / 2 * 2;  // of the controller's last call
    const double u = std::clamp((static_cast<double>(step) * 0.001 - 0.1) / 2, 0.0, 1.0);
    EXPECT_NEAR(sim->latest().control(Actuator{1}),
                0.8 * (10 * u * u * u - 15 * std::pow(u, 4) + 6 * std::pow(u, 5)), 1e-9);
  }
  const auto active = sim->latest().trajectory(kArmRobot);
  ASSERT_NE(active, nullptr);
  EXPECT_EQ(active->start_step, 100);
  EXPECT_NEAR(active->end_time(), 2.1, 1e-12);
  EXPECT_EQ(sim->counters().commands_applied, 1);
}

TEST(Trajectory, ALaterOneReplacesItWithoutAJump) {
  auto sim = run_arm(servo_world());
  ASSERT_TRUE(sim->post({.what = to_point(0.8, 1)}).ok());
  ASSERT_TRUE(sim->post({400, to_point(-0.5, 1)}).ok());
  double before = 0, rate_before = 0, steepest = 0, sharpest = 0;
  for (int i = 0; i < 800; ++i) {
    ASSERT_TRUE(sim->step(2).ok());
    const double now = sim->latest().control(Actuator{1}), rate = (now - before) / 0.002;
    steepest = std::max(steepest, std::abs(rate));
    if (i > 0) sharpest = std::max(sharpest, std::abs(rate - rate_before) / 0.002);
    before = now;
    rate_before = rate;
  }
  EXPECT_NEAR(before, -0.5, 1e-12);
  EXPECT_LT(steepest, 4) << "the position does not jump";
  EXPECT_LT(sharpest, 40) << "the velocity does not jump: that would be 1.4 rad/s in 2 ms";
  EXPECT_EQ(sim->counters().commands_applied, 2);
}

TEST(Trajectory, EndsWithAGoalForOneOfItsJointsAndHoldsWhenStopped) {
  auto sim = run_arm(servo_world());
  ASSERT_TRUE(sim->post({.what = to_point(0.8, 1)}).ok());
  ASSERT_TRUE(sim->post({200, SetJointGoal{{0, 0}, 0.1}}).ok());  // another joint
  ASSERT_TRUE(sim->step(300).ok());
  EXPECT_NE(sim->latest().trajectory(kArmRobot), nullptr);
  ASSERT_TRUE(sim->post({.what = StopTrajectory{kArmRobot}}).ok());
  const double position = sim->latest()[Joint{1}].position();
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().trajectory(kArmRobot), nullptr);
  EXPECT_EQ(sim->latest().control(Actuator{1}), position);
  ASSERT_TRUE(sim->post({.what = to_point(0.8, 1)}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_NE(sim->latest().trajectory(kArmRobot), nullptr);
  ASSERT_TRUE(sim->post({.what = SetJointGoal{{1, 0}, 0.3}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().trajectory(kArmRobot), nullptr);
  EXPECT_EQ(sim->latest().control(Actuator{1}), 0.3);
}

// A joint that leaves a trajectory keeps nothing of its velocity, which would shift its goal.
TEST(Trajectory, LeavesNoVelocityBehind) {
  const auto world = arm_world(kPendulums, kHold);  // the servo damps
  for (const bool by_name : {false, true}) {
    auto sim = run_arm(world);
    ASSERT_TRUE(sim->post({.what = to_point(0.8, 1)}).ok());
    ASSERT_TRUE(sim->step(500).ok());
    EXPECT_GT(sim->latest().trajectory(Joint{1})->at(0.5, 0).velocity, 1);
    const decltype(Command::what) command = SetJointCommand{kArmRobot, {{1, 0}}, {0.3}};
    const decltype(Command::what) goal = SetJointGoal{{1, 0}, 0.3};
    ASSERT_TRUE(sim->post({.what = by_name ? command : goal}).ok());
    ASSERT_TRUE(sim->step(10).ok());
    EXPECT_EQ(sim->latest().control(Actuator{1}), 0.3);
  }
}

TEST(Trajectory, MovesOnlyItsJointsAndOthersContinueTheirs) {
  auto sim = run_arm(servo_world());
  const FollowTrajectory both{kArmRobot, {{0, 0}, {1, 0}}, {.points = {{1, {0.4, 0.8}, {0, 0}}}}};
  ASSERT_TRUE(sim->post({.what = both}).ok());
  ASSERT_TRUE(sim->post({300, to_point(-0.5, 1)}).ok());
  ASSERT_TRUE(sim->step(600).ok());
  Snapshot now = sim->latest();
  const auto first = now.trajectory(Joint{0}), second = now.trajectory(Joint{1});
  ASSERT_TRUE(first != nullptr && second != nullptr);
  EXPECT_EQ(first->start_step, 0);
  EXPECT_EQ(second->start_step, 300);
  EXPECT_EQ(now.trajectory(kArmRobot), second) << "the newest";
  EXPECT_EQ(now.trajectory(Joint{2}), nullptr);
  const double change = second->start_time;
  EXPECT_EQ(second->at(change, 0).position, first->at(change, 1).position);
  EXPECT_EQ(second->at(change, 0).velocity, first->at(change, 1).velocity);
  ASSERT_TRUE(sim->post({.what = SetJointGoal{{1, 0}, 0.1}}).ok());
  ASSERT_TRUE(sim->step(500).ok());
  now = sim->latest();
  EXPECT_EQ(now.trajectory(Joint{0}), first);
  EXPECT_EQ(now.trajectory(Joint{1}), nullptr);
  EXPECT_EQ(now.control(Actuator{1}), 0.1);
  ASSERT_TRUE(sim->post({.what = StopTrajectory{kArmRobot, {{1, 0}}}}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().trajectory(Joint{0}), first);
  ASSERT_TRUE(sim->post({.what = StopTrajectory{kArmRobot, {{0, 0}}}}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().trajectory(Joint{0}), nullptr);
}

TEST(Trajectory, ReplacesThoseThatWereToStartLater) {
  const auto start_after = [](auto&&... commands) {
    auto sim = run_arm(servo_world());
    for (const Command& command : {commands...}) EXPECT_TRUE(sim->post(command).ok());
    EXPECT_TRUE(sim->step(700).ok());
    const auto active = sim->latest().trajectory(Joint{1});
    return std::pair(active == nullptr ? -1 : active->start_step,
                     sim->counters().commands_discarded);
  };
  const auto on_other = FollowTrajectory{kArmRobot, {{0, 0}}, {.points = {{1, {0.1}}}}};
  const auto on_all = FollowTrajectory{kArmRobot, {}, {.points = {{1, {0.1, 0.1, 0.1}}}}};
  using Found = std::pair<int64_t, int64_t>;
  const Command later{500, to_point(0.8, 1)};
  EXPECT_EQ(start_after(later, Command{100, to_point(0.1, 1)}), Found(100, 1));
  EXPECT_EQ(start_after(later, Command{100, on_all}), Found(100, 1));
  EXPECT_EQ(start_after(later, Command{100, on_other}), Found(500, 0));
  EXPECT_EQ(start_after(Command{100, to_point(0.1, 1)}, later), Found(500, 0)) << "posted after it";
  EXPECT_EQ(start_after(later, Command{100, StopTrajectory{kArmRobot}}), Found(-1, 1));
  EXPECT_EQ(start_after(later, Command{100, StopTrajectory{kArmRobot, {{1, 0}}}}), Found(-1, 1));
  EXPECT_EQ(start_after(later, Command{100, StopTrajectory{kArmRobot, {{0, 0}}}}), Found(500, 0));
  // Two that wait, of which the last is discarded, and one that is posted behind them.
  EXPECT_EQ(start_after(Command{650, SetControl{Actuator{0}, 0}}, later,
                        Command{100, to_point(0.1, 1)}, Command{600, to_point(0.2, 1)}),
            Found(600, 1));
}

// Ten minutes of points are one Command, and a step of them costs no more than one of a second.
TEST(Trajectory, LongOnesAreOneCommand) {
  auto sim = run_arm(servo_world());
  FollowTrajectory wave{kArmRobot, {}, {}};
  for (int i = 1; i <= 30'000; ++i) {
    const double q = 0.1 * std::sin(0.02 * i);
    wave.trajectory.points.push_back({0.02 * i, {q, q}});
  }
  wave.joints = {{0, 0}, {1, 0}};
  ASSERT_TRUE(sim->post({.what = std::move(wave)}).ok());
  ASSERT_TRUE(sim->step(2000).ok());
  EXPECT_EQ(sim->counters().commands_applied, 1);
  EXPECT_NEAR(sim->latest().control(Actuator{1}), 0.1 * std::sin(2), 1e-3);
}

TEST(Trajectory, BadOnesAreRejectedWhenTheyArePosted) {
  auto sim = run_arm(servo_world());
  EXPECT_PRED2(has, error_of(*sim, FollowTrajectory{kArmRobot, {{1, 0}}, {}}), "no points");
  EXPECT_PRED2(has, error_of(*sim, FollowTrajectory{kArmRobot, {}, {.points = {{1, {1}}}}}),
               "1 positions for 3 joints");
  EXPECT_PRED2(has, error_of(*sim, FollowTrajectory{kArmRobot, {{0, 0}}, {.points = {{1, {7}}}}}),
               "position 7 of joint 'm' in point 0 is outside its range, -6 to 6");
  EXPECT_PRED2(has, error_of(*sim, FollowTrajectory{kArmRobot, {{9, 0}}, {.points = {{1, {0}}}}}),
               "joint number 9");
  EXPECT_PRED2(
      has, error_of(*sim, FollowTrajectory{kArmRobot, {{1, 0}, {1, 0}}, {.points = {{1, {0, 0}}}}}),
      "listed twice");
  EXPECT_PRED2(has, error_of(*sim, FollowTrajectory{{4, 0}, {}, {}}), "robot number 4");
}

TEST(SwitchController, ErrorsComeToWhoPostsIt) {
  auto sim = run_arm(servo_world());
  EXPECT_PRED2(has, error_of(*sim, SetController{kArmRobot, {.type = "joint_velocty"}}),
               "'joint_velocity'");
  EXPECT_PRED2(has,
               error_of(*sim, SetController{kArmRobot, {.type = "joint_position", .target = {1}}}),
               "'target' has 1 values, but 2 joints");
  EXPECT_PRED2(has,
               error_of(*sim, SetController{kArmRobot, {.type = "joint_effort", .rate = {300, 1}}}),
               "does not divide");
  EXPECT_PRED2(has, error_of(*sim, SetController{{2, 0}, {.type = "none"}}), "robot number 2");
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->counters().commands_applied, 0);
}

TEST(SwitchController, TakesOverWithoutAJumpOfTorque) {
  auto sim = run_arm(arm_world(kPendulums, kHold));
  ASSERT_TRUE(sim->step(3000).ok());
  const double held = sim->latest().control(Actuator{0});
  EXPECT_NEAR(held, -9.81 / 2, 0.05) << "it bears its weight";
  const double position = sim->latest()[Joint{0}].position();
  ASSERT_TRUE(
      sim->post(
             {.what =
                  SetController{kArmRobot,
                                {.type = "joint_velocity", .rate = {500, 1}, .kp = 400, .kd = 30}}})
          .ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_NEAR(sim->latest().control(Actuator{0}), held, 1e-6);
  ASSERT_TRUE(sim->step(3000).ok());
  EXPECT_NEAR(sim->latest()[Joint{0}].position(), position, 1e-4);
  ASSERT_TRUE(sim->post({.what = SetController{kArmRobot, {.type = "none"}}}).ok());
  const double last = sim->latest().control(Actuator{0});
  ASSERT_TRUE(sim->post({sim->latest().step() + 10, SetControl{Actuator{0}, 1}}).ok());
  ASSERT_TRUE(sim->step(5).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), last) << "controls stay";
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 1) << "and are the client's";
}

TEST(SwitchController, KeepsTargetsOfTheSameTypeOnly) {
  auto sim = run_arm(servo_world());
  ASSERT_TRUE(sim->post({.what = SetJointGoal{{1, 0}, 0.4}}).ok());
  ASSERT_TRUE(sim->step(1000).ok());
  ASSERT_TRUE(
      sim->post({.what = SetController{kArmRobot, {.type = "joint_position", .kp = 9}}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{1}), 0.4);
  for (const char* type : {"joint_velocity", "joint_position"}) {
    ASSERT_TRUE(sim->post({.what = SetController{kArmRobot, {.type = type}}}).ok());
    ASSERT_TRUE(sim->step(10).ok());
    EXPECT_NEAR(sim->latest().control(Actuator{1}), 0.4, 1e-12) << type << " takes its reference";
  }
}

/// Everything that this file is about, at many steps.
void play(Simulator& sim) {
  const auto post = [&](int64_t step, decltype(Command::what) what) {
    ASSERT_TRUE(sim.post({step, std::move(what)}).ok());
  };
  post(50, SetJointCommand{kArmRobot, {{0, 0}}, {0.3}, {}, {1}});
  post(200, SetController{kArmRobot, {.type = "joint_velocity", .rate = {250, 1}}});
  post(210, SetJointCommand{kArmRobot, {}, {}, {0.1, -0.2, 0.3}});
  post(500, SetController{kArmRobot, {.type = "joint_effort", .kp = 30}});
  post(501, FollowTrajectory{
                kArmRobot, {}, {TrajectoryProfile::kTrapezoidal, {{0, {0.5, 0, -1}}}, {1}, {3}}});
  post(900, SetController{kArmRobot, {.type = "torque", .target = {0.4}}});
  post(950, SetController{kArmRobot, {.type = "none"}});
  post(1000, SetController{kArmRobot, kHold});
  post(1100, to_point(0.5, 0.7));
  post(1150, FollowTrajectory{kArmRobot, {{0, 0}, {1, 0}}, {.points = {{1, {0.1, -0.2}, {0, 0}}}}});
  post(1200, to_point(-0.4, 0.9));
  post(1250, StopTrajectory{kArmRobot, {{0, 0}}});
}

TEST(SwitchController, RunsRepeatToTheBit) {
  const auto world = servo_world();
  auto sim = run_arm(world);
  play(*sim);
  ASSERT_TRUE(sim->step(1500).ok());
  const uint64_t end = sim->latest().hash();
  const std::vector<LoggedCommand> log = sim->take_command_log();
  EXPECT_EQ(log.size(), 12u);

  // A reset returns to the scene's controller: the same again.
  ASSERT_TRUE(sim->reset().ok());
  play(*sim);
  ASSERT_TRUE(sim->step(1500).ok());
  EXPECT_EQ(sim->latest().hash(), end);

  // Its record, stepped again; this is how logs are verified.
  const auto checkpoint = *sim->checkpoint();
  auto again = Restepper::create(checkpoint->record, robot_makers());
  ASSERT_TRUE(again.ok());
  ASSERT_TRUE((*again)->run_until(1500).ok());
  EXPECT_EQ((*again)->loop().stepper().hash(), end);

  // A log, replayed.
  auto replay =
      Simulator::create(world, {.pace = Pace::kLockstep, .replay = log, .makers = robot_makers()});
  auto controllers = *make_controllers(world, robot_makers());
  ASSERT_TRUE((*replay)->add_controller(0, std::move(controllers[0].controller), {500, 1}).ok());
  (*replay)->start();
  ASSERT_TRUE((*replay)->step(1500).ok());
  EXPECT_EQ((*replay)->latest().hash(), end);
}

TEST(SwitchController, CheckpointsHoldTheControllerTheTargetsAndTheTrajectory) {
  for (const int64_t at : {100, 220, 520, 940, 1180, 1300}) {
    auto sim = run_arm(servo_world());
    play(*sim);
    ASSERT_TRUE(sim->step(at).ok());
    const auto checkpoint = *sim->checkpoint();
    ASSERT_NE(checkpoint->copy, nullptr);
    // The rest of the Commands, since those that wait are discarded.
    const auto rest = [&] {
      auto other = run_arm(servo_world());
      play(*other);
      EXPECT_TRUE(other->step(1500).ok());
      for (const LoggedCommand& logged : other->take_command_log()) {
        if (logged.command.step < at) continue;
        EXPECT_TRUE(sim->post(logged.command).ok());
      }
      return other->latest().hash();
    };
    ASSERT_TRUE(sim->step(1500 - at).ok());
    ASSERT_TRUE(sim->restore(*checkpoint).ok());
    EXPECT_EQ(sim->latest().hash(), checkpoint->record.hash);
    const uint64_t end = rest();
    ASSERT_TRUE(sim->step(1500 - at).ok());
    EXPECT_EQ(sim->latest().hash(), end) << at;
  }
}

TEST(SwitchController, SurvivesARecompileUntilTheReset) {
  auto sim = run_arm(servo_world());
  const ControllerOptions effort{.type = "joint_effort", .rate = {500, 1}};
  ASSERT_TRUE(sim->post({.what = SetController{kArmRobot, effort}}).ok());
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {{0, 0}}, {}, {}, {0.5}}}).ok());
  ASSERT_TRUE(
      sim->post({.what = FollowTrajectory{kArmRobot, {{1, 0}}, {.points = {{1, {0.5}, {0}}}}}})
          .ok());
  ASSERT_TRUE(sim->step(10).ok());
  const auto again = servo_world();
  ASSERT_TRUE(sim->recompile(again, *make_controllers(again, robot_makers())).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 0.25);  // gear 2
  ASSERT_NE(sim->latest().trajectory(kArmRobot), nullptr);
  EXPECT_EQ(sim->latest().trajectory(kArmRobot)->start_step, 0);
  EXPECT_EQ(sim->latest().trajectory(Joint{1}), sim->latest().trajectory(kArmRobot));
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(100).ok());
  EXPECT_EQ(sim->latest().control(Actuator{1}), 0) << "the scene's holds the servo at 0";
  EXPECT_EQ(sim->latest().trajectory(kArmRobot), nullptr);
}

}  // namespace
}  // namespace gloam
