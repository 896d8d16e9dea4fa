// Controllers on small robots, run through the Simulator.

#include "control/controllers.h"

#include <gtest/gtest.h>

#include "robot_world.h"
#include "sim/loop/simulator.h"
#include "trot_robots.h"

namespace gloam {
namespace {

const char* const kArm = R"(<mujoco><option timestep="0.002" gravity="0 0 0"/><worldbody>
  <body name="post"><geom size=".1"/>
    <body name="a"><joint name="m" axis="0 1 0" armature=".1"/><geom size=".05" pos=".3 0 0" mass="1"/></body>
    <body name="b" pos="0 2 0"><joint name="s" axis="0 1 0" damping="5"/><geom size=".05" pos=".3 0 0" mass="1"/></body>
    <body name="c" pos="0 4 0"><joint name="w" axis="0 1 0"/><geom size=".05" pos=".3 0 0" mass="1"/></body>
  </body></worldbody>
  <actuator><motor name="m" joint="m" gear="2" ctrlrange="-3 3"/><position name="s" joint="s" kp="50"/>
    <general name="w" joint="w" gainprm="4" forcerange="-1 1"/></actuator></mujoco>)";

std::shared_ptr<CompiledWorld> make_world(ControllerOptions options) {
  return make_robot_world(kArm, {.name = "arm", .controller = std::move(options)});
}

std::unique_ptr<Simulator> start(const std::shared_ptr<CompiledWorld>& world) {
  auto controller = make_controller(world, world->robots[0]);
  EXPECT_TRUE(controller.ok());
  auto sim = Simulator::create(world, {.pace = Pace::kLockstep});
  EXPECT_TRUE(sim.ok());
  EXPECT_TRUE((*sim)->add_controller(0, std::move(*controller), {500, 1}).ok());
  (*sim)->start();
  return std::move(*sim);
}

TEST(JointPosition, MotorsAndServosReachTheirTargets) {
  auto sim =
      start(make_world({.type = "joint_position", .kp = 20, .kd = 4, .target = {0.5, -0.4, 0.2}}));
  ASSERT_TRUE(sim->step(3000).ok());
  const Snapshot s = sim->latest();
  EXPECT_NEAR(s[Joint{0}].position(), 0.5, 1e-3);
  EXPECT_NEAR(s[Joint{1}].position(), -0.4, 1e-3);
  EXPECT_NEAR(s[Joint{2}].position(), 0.2, 1e-2);
}

TEST(JointPosition, TorqueIsThatOfThePdLawWithinTheLimits) {
  auto sim =
      start(make_world({.type = "joint_position", .kp = 5, .kd = 1, .target = {0.4, 0, 0.1}}));
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_DOUBLE_EQ(sim->latest().control(Actuator{0}), 5 * 0.4 / 2);  // gear 2
  EXPECT_DOUBLE_EQ(sim->latest().control(Actuator{2}), 5 * 0.1 / 4);  // 4 N m per unit
  auto strong =
      start(make_world({.type = "joint_position", .kp = 500, .kd = 1, .target = {1, 0, 1}}));
  ASSERT_TRUE(strong->step(1).ok());
  EXPECT_EQ(strong->latest().control(Actuator{0}), 3);     // ctrlrange
  EXPECT_EQ(strong->latest().control(Actuator{2}), 0.25);  // forcerange / gain
}

TEST(JointPosition, WithoutTargetsItHoldsWhereItStarts) {
  auto sim = start(make_world({.type = "joint_position"}));
  ASSERT_TRUE(sim->step(500).ok());
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(sim->latest()[Joint{j}].position(), 0, 1e-9);
}

TEST(Torque, IsConstantUntilACommandChangesIt) {
  auto sim = start(make_world({.type = "torque", .target = {1, 0.5}}));
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 0.5);
  EXPECT_EQ(sim->latest().control(Actuator{1}), 0);  // a servo is not its business
  EXPECT_EQ(sim->latest().control(Actuator{2}), 0.125);
  ASSERT_TRUE(sim->post({.what = SetControl{Actuator{0}, -1}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), -1);
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 0.5);
}

std::vector<RobotController> controllers_of(const std::shared_ptr<const CompiledWorld>& world) {
  std::vector<RobotController> controllers;
  controllers.push_back({0, *make_controller(world, world->robots[0]), {500, 1}});
  return controllers;
}

TEST(JointPosition, HoldsOnThroughARecompile) {
  const auto world = make_world({.type = "joint_position"});
  auto sim = start(world);
  ASSERT_TRUE(sim->post({.what = SetWrench{{2}, {0, 0, 8}, {}}}).ok());  // on body a
  ASSERT_TRUE(sim->step(200).ok());
  EXPECT_LT(sim->latest()[Joint{0}].position(), -0.01) << "it gives way";
  const auto again = make_world({.type = "joint_position"});
  ASSERT_TRUE(sim->recompile(again, controllers_of(again)).ok());
  ASSERT_TRUE(sim->post({.what = SetWrench{{2}, {}, {}}}).ok());
  ASSERT_TRUE(sim->step(4000).ok());
  EXPECT_NEAR(sim->latest()[Joint{0}].position(), 0, 1e-3) << "and comes back to where it began";
}

TEST(Torque, OfACommandSurvivesARecompile) {
  const ControllerOptions options{.type = "torque", .target = {1, 0.5}};
  auto sim = start(make_world(options));
  ASSERT_TRUE(sim->step(10).ok());
  ASSERT_TRUE(sim->post({.what = SetControl{Actuator{0}, -1}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  const auto again = make_world(options);
  ASSERT_TRUE(sim->recompile(again, controllers_of(again)).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), -1);
  const auto stronger = make_world({.type = "torque", .target = {2, 0.5}});
  ASSERT_TRUE(sim->recompile(stronger, controllers_of(stronger)).ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 1) << "the scene asks for another one now";
}

// In the middle of a stride, to the same scene: not a bit of the walk changes.
TEST(Trot, WalksOnThroughARecompile) {
  const auto quadruped_world = [] {
    auto world = std::make_shared<CompiledWorld>();
    world->model = load_quadruped();
    RobotInstance robot = robot_instance(*world->model);
    robot.options.controller.type = "trot";
    world->robots.push_back(robot);
    return world;
  };
  const auto begin = [&] {
    auto sim = start(quadruped_world());
    EXPECT_TRUE(sim->post({.what = SetVelocityGoal{{0, 0}, 0.5, 0, 0.3}}).ok());
    EXPECT_TRUE(sim->step(733).ok());
    return sim;
  };
  auto plain = begin(), changed = begin();
  const auto again = quadruped_world();
  ASSERT_TRUE(changed->recompile(again, controllers_of(again)).ok());
  ASSERT_TRUE(plain->step(500).ok() && changed->step(500).ok());
  const Snapshot a = plain->latest(), b = changed->latest();
  EXPECT_TRUE(std::equal(a.state().begin(), a.state().end(), b.state().begin()));
}

TEST(Controllers, AreFoundByNameAndErrorsSayWhatToDo) {
  auto make = [](ControllerOptions options) {
    options.loc = {"scene.toml", 9};
    auto world = make_world(std::move(options));
    return make_controller(world, world->robots[0]);
  };
  auto none = make({.type = "none"});
  ASSERT_TRUE(none.ok());
  EXPECT_EQ(*none, nullptr);
  auto wrong = make({.type = "joint_positoin"});
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().to_string().find("'joint_position'"), std::string::npos);
  EXPECT_EQ(wrong.error().loc.line, 9);
  EXPECT_FALSE(make({.type = "joint_position", .target = {1}}).ok());
  EXPECT_FALSE(make({.type = "joint_position", .kp = -1}).ok());
  EXPECT_FALSE(make({.type = "torque", .target = {1, 2, 3}}).ok());
}

// A controller from outside of Gloam, with a setting of its own.
class ConstantControl final : public Controller {
 public:
  explicit ConstantControl(double value) : value_(value) {}
  void reset(const mjModel*, const mjData*) override {}
  void control(const ControlInputs& in) override { in.data->ctrl[0] = value_; }

 private:
  double value_;
};

Result<std::unique_ptr<Controller>> make_constant(const ControllerRequest& request) {
  GLOAM_TRY(const std::vector<double> value, controller_param(request.robot.controller, "value"));
  EXPECT_EQ(request.robot.controller.type, "constant");
  EXPECT_TRUE(request.world.compiled() != nullptr);
  return std::unique_ptr<Controller>(
      std::make_unique<ConstantControl>(value.empty() ? 0.25 : value[0]));
}

TEST(Controllers, OnesOfAProgramAreRegisteredOnce) {
  ASSERT_TRUE(register_controller("constant", make_constant).ok());
  EXPECT_FALSE(register_controller("constant", make_constant).ok());
  EXPECT_FALSE(register_controller("trot", make_constant).ok());
  EXPECT_FALSE(register_controller("no name", make_constant).ok());
  EXPECT_FALSE(register_controller("empty", {}).ok());
  const std::vector<std::string> types = controller_types();
  EXPECT_EQ(types.front(), "none");
  EXPECT_EQ(types.back(), "constant");
  const auto sim = start(make_world({.type = "constant", .params = {"{ value = -1.5 }"}}));
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), -1.5);
}

TEST(Controllers, ParamsAreNumbersOrNamedAsWrong) {
  const auto read = [](const char* text) { return controller_param({.params = {text}}, "value"); };
  EXPECT_TRUE(read("")->empty());
  EXPECT_TRUE(read("{ other = 1 }")->empty());
  EXPECT_EQ(*read("{ value = [1, 2.5] }"), (std::vector<double>{1, 2.5}));
  for (const char* bad : {"{ value = \"1\" }", "{ value = [1, true] }", "3", "{", "{} x = 1"})
    EXPECT_FALSE(read(bad).ok()) << bad;
}

}  // namespace
}  // namespace gloam
