// Commands take effect at their steps, and only what makes sense is taken.

#include <cmath>
#include <thread>

#include "sim/commands/live_fields.h"
#include "test_world.h"

namespace gloam {
namespace {

const char* const kCart = R"(<mujoco><option timestep="0.01" gravity="0 0 0"/><worldbody>
  <body name="cart"><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="2"/></body>
  <body name="float" pos="0 3 0"><freejoint name="free"/><geom name="g" size=".1" mass="4"/>
    <body name="tail" pos="0 0 .3"><joint type="hinge" axis="0 1 0"/><geom size=".1" mass="1"/></body></body>
  <body name="hand" mocap="true"><geom size=".1" contype="0" conaffinity="0"/></body>
  </worldbody><actuator><motor name="push" joint="x"/></actuator></mujoco>)";

class CommandTest : public testing::Test {
 protected:
  Body body(const char* name) const { return {mj_name2id(world->model.get(), mjOBJ_BODY, name)}; }
  double position() { return sim->latest()[Joint{0}].position(); }
  double velocity() { return sim->latest()[Joint{0}].velocity(); }

  std::shared_ptr<CompiledWorld> world = world_from_mjcf(kCart);
  std::unique_ptr<Simulator> sim = make_simulator(world, lockstep());
};

TEST_F(CommandTest, AppliesBeforeTheVeryStepItNames) {
  ASSERT_TRUE(sim->post({7, SetControl{Actuator{0}, 0}}).ok());  // not in order of step
  ASSERT_TRUE(sim->post({3, SetControl{Actuator{0}, 2}}).ok());
  sim->start();
  for (int n = 0; n < 12; ++n) {
    // 1 m/s² over the steps 3, 4, 5, 6.
    EXPECT_NEAR(velocity(), 0.01 * std::clamp(n - 3, 0, 4), 1e-14) << n;
    ASSERT_TRUE(sim->step().ok());
  }
  const std::vector<LoggedCommand> log = sim->take_command_log();
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].command.step, 3);
  EXPECT_EQ(log[1].command.step, 7);
}

TEST_F(CommandTest, OneThatIsLateAppliesAtTheNextStepAndTheLogSaysSo) {
  sim->start();
  ASSERT_TRUE(sim->step(10).ok());
  ASSERT_TRUE(sim->post({4, SetControl{Actuator{0}, 2}}).ok());
  ASSERT_TRUE(sim->post({.what = SetControl{Actuator{0}, 3}}).ok());
  ASSERT_TRUE(sim->step(5).ok());
  const std::vector<LoggedCommand> log = sim->take_command_log();
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].command.step, 10);
  EXPECT_EQ(log[1].command.step, 10);
  EXPECT_NEAR(velocity(), 5 * 0.01 * 1.5, 1e-14);  // the later one of a step has the last word
  EXPECT_EQ(sim->latest().control(Actuator{0}), 3);
}

TEST_F(CommandTest, WrenchStaysUntilItIsChanged) {
  ASSERT_TRUE(sim->post({2, SetWrench{body("cart"), {4, 0, 0}, {}}}).ok());
  ASSERT_TRUE(sim->post({6, SetWrench{body("cart"), {}, {}}}).ok());
  sim->start();
  ASSERT_TRUE(sim->step(20).ok());
  EXPECT_NEAR(velocity(), 4 * 0.01 * 2, 1e-14);
}

TEST_F(CommandTest, AddVelocityMovesTheWholeFloatingSubtree) {
  ASSERT_TRUE(sim->post({0, AddVelocity{body("tail"), {1, -2, .5}}}).ok());
  sim->start();
  ASSERT_TRUE(sim->step(100).ok());
  const JointState free = sim->latest()[Joint{1}];
  EXPECT_NEAR(free.qpos[0], 1, 1e-12);
  EXPECT_NEAR(free.qpos[1], 3 - 2, 1e-12);
  EXPECT_NEAR(free.qpos[2], .5, 1e-12);
  EXPECT_NEAR(sim->latest()[Joint{2}].velocity(), 0, 1e-12);
}

TEST_F(CommandTest, MocapPoseIsSetAndItsQuaternionMadeUnit) {
  ASSERT_TRUE(sim->post({.what = SetMocapPose{body("hand"), {{1, 2, 3}, {0, 0, 2, 0}}}}).ok());
  double seen[7] = {};
  ASSERT_TRUE(sim->set_step_hook([&seen](const mjModel*, mjData* d) {
                   mju_copy(seen, d->mocap_pos, 3);
                   mju_copy(seen + 3, d->mocap_quat, 4);
                 })
                  .ok());
  sim->start();
  ASSERT_TRUE(sim->step().ok());
  const double expected[7] = {1, 2, 3, 0, 0, 1, 0};
  for (int i = 0; i < 7; ++i) EXPECT_EQ(seen[i], expected[i]);
}

TEST_F(CommandTest, DragPullsAPointToItsTargetWithoutOvershootAndLetsGo) {
  ASSERT_TRUE(sim->post({.what = DragBody{body("cart"), {0, 0, 0}, {1, 0, 0}, true}}).ok());
  sim->start();
  double furthest = 0;
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(sim->step().ok());
    furthest = std::max(furthest, position());
  }
  EXPECT_NEAR(position(), 1, 1e-4);  // critically damped: ten time constants of 0.1 s … twice over
  EXPECT_LT(furthest, 1 + 1e-3);
  ASSERT_TRUE(sim->post({.what = DragBody{body("cart"), {}, {5, 0, 0}, false}}).ok());
  ASSERT_TRUE(sim->step(100).ok());
  EXPECT_NEAR(position(), 1, 1e-3);
}

TEST_F(CommandTest, DragOffCentreTurnsTheBody) {
  ASSERT_TRUE(sim->post({.what = DragBody{body("float"), {0, .1, 0}, {.2, 3.1, 0}, true}}).ok());
  sim->start();
  ASSERT_TRUE(sim->step(20).ok());
  EXPECT_GT(sim->latest()[Joint{1}].qvel[0], 0);
  EXPECT_LT(sim->latest()[Joint{1}].qvel[5], -1e-3);  // pulled along +x at +y: turns clockwise
}

TEST_F(CommandTest, TurnRotatesABodyToItsTargetAndLetsGo) {
  const double half = std::sqrt(0.5);
  ASSERT_TRUE(sim->post({.what = TurnBody{body("float"), {half, 0, 0, half}}}).ok());
  sim->start();
  ASSERT_TRUE(sim->step(300).ok());
  const Snapshot turned = sim->latest();
  EXPECT_NEAR(turned[Joint{1}].qpos[3], half, 1e-3);
  EXPECT_NEAR(turned[Joint{1}].qpos[6], half, 1e-3);
  EXPECT_NEAR(turned[Joint{1}].qpos[1], 3, 1e-2) << "it stays where it is";
  ASSERT_TRUE(sim->post({.what = TurnBody{body("float"), {1, 0, 0, 0}, false}}).ok());
  ASSERT_TRUE(sim->step(100).ok());
  EXPECT_NEAR(sim->latest()[Joint{1}].qpos[6], half, 1e-2) << "nothing turns it back";
}

TEST_F(CommandTest, TurnsThatDoNotFitAreRefused) {
  EXPECT_FALSE(sim->post({.what = TurnBody{body("float"), {0, 0, 0, 0}}}).ok());
  EXPECT_FALSE(sim->post({.what = TurnBody{body("float"), {NAN, 0, 0, 0}}}).ok());
  EXPECT_FALSE(sim->post({.what = TurnBody{body("hand"), {1, 0, 0, 0}}}).ok()) << "cannot move";
  EXPECT_FALSE(sim->post({.what = TurnBody{Body{99}, {1, 0, 0, 0}}}).ok());
  EXPECT_FALSE(sim->post({.what = SetEquality{Equality{0}, true}}).ok()) << "there is none";
}

TEST(Equality, IsSwitchedAndItsStateIsPartOfTheSnapshot) {
  const auto world = world_from_mjcf(R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <body><joint name="a" type="slide"/><geom size=".1"/></body>
    <body pos="1 0 0"><joint name="b" type="slide"/><geom size=".1"/></body></worldbody>
    <equality><joint name="together" joint1="a" joint2="b"/></equality></mujoco>)");
  const auto sim = make_simulator(world, lockstep());
  const Equality together = *World(world).find_equality("together");
  sim->start();
  const auto distance = [&] {
    return sim->latest()[Joint{0}].position() - sim->latest()[Joint{1}].position();
  };
  ASSERT_TRUE(sim->post({.what = SetEquality{together, false}}).ok());
  ASSERT_TRUE(sim->post({.what = SetJointState{Joint{0}, {0.5}, {}}}).ok());
  ASSERT_TRUE(sim->step(200).ok());
  EXPECT_NEAR(distance(), 0.5, 1e-9) << "it is off";
  Instant instant;
  ASSERT_TRUE(instant.solve(sim->latest()).ok());
  EXPECT_EQ(instant.value("eq_active")->at(0), 0);
  ASSERT_TRUE(sim->post({.what = SetEquality{together, true}}).ok());
  ASSERT_TRUE(sim->step(500).ok());
  EXPECT_NEAR(distance(), 0, 1e-3);
  EXPECT_FALSE(World(world).find_equality("apart").ok());
}

TEST_F(CommandTest, ASnapshotWithCommandsIsTheNextStepsBeginning) {
  sim->start();
  ASSERT_TRUE(sim->step(5).ok());
  const std::vector<Command> commands = {{.what = SetJointState{Joint{0}, {0.7}, {2}}},
                                         {.what = SetControl{Actuator{0}, 3}},
                                         {.what = SetWrench{body("cart"), {1, 0, 0}, {}}}};
  const Snapshot before = sim->latest();
  const Snapshot shown = *before.with(commands);
  EXPECT_EQ(shown[Joint{0}].position(), 0.7);
  EXPECT_EQ(shown[Joint{0}].velocity(), 2);
  EXPECT_EQ(shown.control(Actuator{0}), 3);
  EXPECT_EQ(shown.step(), 5);
  EXPECT_EQ(sim->latest()[Joint{0}].position(), before[Joint{0}].position())
      << "nothing has changed";
  EXPECT_EQ(sim->latest().hash(), before.hash());
  EXPECT_FALSE(before.with(std::vector<Command>{{.what = SetJointState{Joint{9}, {1}, {}}}}).ok());
}

TEST_F(CommandTest, GravityMassAndFrictionChangeWhileItRuns) {
  const mjModel& m = *world->model;
  ASSERT_TRUE(sim->post({5, SetLiveField{LiveFieldId::kGravity, 2, {-4}}}).ok());
  ASSERT_TRUE(sim->post({0, SetLiveField{LiveFieldId::kBodyMass, body("cart").id, {8}}}).ok());
  ASSERT_TRUE(sim->post({0, SetControl{Actuator{0}, 8}}).ok());
  double inertia = 0, m0 = 0, friction = 0;
  ASSERT_TRUE(sim->set_step_hook([&](const mjModel* model, mjData*) {
                   inertia = model->body_inertia[3], m0 = model->dof_M0[0],
                   friction = model->geom_friction[0];
                 })
                  .ok());
  sim->start();
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_NEAR(velocity(), 0.1, 1e-12);                                 // 8 N on 8 kg
  EXPECT_NEAR(sim->latest()[Joint{1}].qvel[2], -4 * 5 * 0.01, 1e-12);  // over the last five steps
  EXPECT_NEAR(inertia, 4 * m.body_inertia[3], 1e-12);
  EXPECT_NEAR(m0, 8, 1e-12);
  EXPECT_EQ(friction, m.geom_friction[0]);
  EXPECT_EQ(sim->latest().data().live->version, 2u);
  EXPECT_EQ(m.opt.gravity[2], 0);  // the World is as it was
}

TEST_F(CommandTest, LiveFieldsOfOneSimulationReachNoOtherOfItsWorld) {
  auto other = make_simulator(world, lockstep());  // made before, so that it could notice
  const std::vector<mjtNum> before(world->model->body_mass,
                                   world->model->body_mass + world->model->nbody);
  ASSERT_TRUE(sim->post({0, SetLiveField{LiveFieldId::kBodyMass, body("cart").id, {8}}}).ok());
  for (Simulator* each : {sim.get(), other.get()}) {
    ASSERT_TRUE(each->post({0, SetControl{Actuator{0}, 8}}).ok());
    each->start();
    ASSERT_TRUE(each->step(10).ok());
  }
  EXPECT_NEAR(velocity(), 8 / 8.0 * 0.1, 1e-12);
  EXPECT_NEAR(other->latest()[Joint{0}].velocity(), 8 / 2.0 * 0.1, 1e-12);
  for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(world->model->body_mass[i], before[i]);
  // A reset takes the change back, for good and in the one that made it only.
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->post({0, SetControl{Actuator{0}, 8}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_NEAR(velocity(), 8 / 2.0 * 0.1, 1e-12);
}

TEST_F(CommandTest, FieldsKeepTheirChangesInWhateverOrderTheyCome) {
  const mjModel& m = *world->model;
  const double friction_before = m.geom_friction[0];
  const int cart = body("cart").id;
  double friction = 0, mass = 0, m0 = 0;
  ASSERT_TRUE(sim->set_step_hook([&](const mjModel* model, mjData*) {
                   friction = model->geom_friction[0], mass = model->body_mass[cart],
                   m0 = model->dof_M0[0];
                 })
                  .ok());
  const auto set = [&](int64_t step, LiveFieldId field, int first, float value) {
    ASSERT_TRUE(sim->post({step, SetLiveField{field, first, {value}}}).ok());
  };
  const auto expect = [&](double f, double kilograms) {
    EXPECT_EQ(friction, f);
    EXPECT_EQ(mass, kilograms);
    EXPECT_NEAR(m0, kilograms, 1e-12);  // what MuJoCo derives from the mass
    EXPECT_EQ(m.geom_friction[0], friction_before) << "the World has changed";
    EXPECT_EQ(m.body_mass[cart], 2) << "the World has changed";
  };
  set(2, LiveFieldId::kGeomFriction, 0, 0.25f);
  set(4, LiveFieldId::kBodyMass, cart, 8);
  set(6, LiveFieldId::kGeomFriction, 0, 0.5f);
  sim->start();
  ASSERT_TRUE(sim->step(3).ok());
  expect(0.25, 2);
  ASSERT_TRUE(sim->step(2).ok());
  expect(0.25, 8);
  ASSERT_TRUE(sim->step(2).ok());
  expect(0.5, 8);
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(1).ok());
  expect(friction_before, 2);
  set(2, LiveFieldId::kBodyMass, cart, 4);
  set(3, LiveFieldId::kGeomFriction, 0, 0.75f);
  ASSERT_TRUE(sim->step(3).ok());
  expect(0.75, 4);
}

TEST_F(CommandTest, LiveFieldsAreInTheHash) {
  auto hash = [this](std::vector<Command> commands) {
    auto sim = make_simulator(world, lockstep());
    for (Command& c : commands) EXPECT_TRUE(sim->post(c).ok());
    sim->start();
    EXPECT_TRUE(sim->step(10).ok());
    return sim->latest().hash();
  };
  const uint64_t plain = hash({});
  // Friction does not matter to bodies that touch nothing: only the digest can tell.
  const Command same{4, SetLiveField{LiveFieldId::kGeomFriction, 0, {0.25f}}};
  const Command other{4, SetLiveField{LiveFieldId::kGeomFriction, 0, {0.5f}}};
  EXPECT_NE(hash({same}), plain);
  EXPECT_EQ(hash({same}), hash({same}));
  EXPECT_NE(hash({same}), hash({other}));
}

TEST_F(CommandTest, OneChangedValueLeavesTheOthersExact) {
  auto bare = world_from_mjcf(kRichModel);
  const mjModel& m = *bare->model;
  ModelPtr copy(mj_copyModel(nullptr, &m));
  DataPtr scratch(mj_makeData(copy.get()));
  for (const LiveFieldId field :
       {LiveFieldId::kBodyMass, LiveFieldId::kGravity, LiveFieldId::kGeomFriction}) {
    ASSERT_TRUE(write_live_field(m, field, read_live_field(m, field), *copy, scratch.get()).ok());
  }
  EXPECT_TRUE(std::equal(m.body_mass, m.body_mass + m.nbody, copy->body_mass));
  EXPECT_TRUE(std::equal(m.body_inertia, m.body_inertia + 3 * m.nbody, copy->body_inertia));
  EXPECT_TRUE(std::equal(m.geom_friction, m.geom_friction + 3 * m.ngeom, copy->geom_friction));
  EXPECT_TRUE(std::equal(m.opt.gravity, m.opt.gravity + 3, copy->opt.gravity));
  EXPECT_TRUE(std::equal(m.dof_invweight0, m.dof_invweight0 + m.nv, copy->dof_invweight0));
  EXPECT_TRUE(std::equal(m.actuator_acc0, m.actuator_acc0 + m.nu, copy->actuator_acc0));
}

TEST_F(CommandTest, ResetSimStartsOverAndThrowsAwayWhatWasPostedBeforeIt) {
  ASSERT_TRUE(sim->post({0, SetControl{Actuator{0}, 2}}).ok());
  ASSERT_TRUE(sim->post({50, SetControl{Actuator{0}, 9}}).ok());
  ASSERT_TRUE(sim->post({10, ResetSim{}}).ok());
  ASSERT_TRUE(sim->post({4, AddVelocity{body("float"), {1, 0, 0}}}).ok());
  sim->start();
  auto queue = *sim->subscribe({.rate = {100, 1}, .required = true, .capacity = 200});
  sim->run_until(60);
  ASSERT_TRUE(sim->wait().ok());
  for (int n = 0; n <= 10; ++n) EXPECT_EQ(queue->try_next().step(), n);
  for (int n = 0; n <= 60; ++n) EXPECT_EQ(queue->try_next().step(), n);
  EXPECT_EQ(velocity(), 0);
  EXPECT_EQ(sim->counters().resets, 1);
  EXPECT_EQ(sim->counters().commands_discarded, 1);
}

TEST_F(CommandTest, RefusesWhatMakesNoSense) {
  const double nan = std::nan("");
  auto refused = [this](Command c) { return !sim->post(std::move(c)).ok(); };
  EXPECT_TRUE(refused({.what = SetControl{Actuator{1}, 0}}));
  EXPECT_TRUE(refused({.what = SetControl{Actuator{-1}, 0}}));
  EXPECT_TRUE(refused({.what = SetControl{Actuator{0}, nan}}));
  EXPECT_TRUE(refused({-2, SetControl{Actuator{0}, 0}}));
  EXPECT_TRUE(refused({.what = SetMocapPose{body("cart"), {}}}));
  EXPECT_TRUE(refused({.what = SetMocapPose{body("hand"), {{}, {0, 0, 0, 0}}}}));
  EXPECT_TRUE(refused({.what = SetWrench{Body{0}, {}, {}}}));
  EXPECT_TRUE(refused({.what = SetWrench{Body{99}, {}, {}}}));
  EXPECT_TRUE(refused({.what = SetWrench{body("cart"), {nan, 0, 0}, {}}}));
  EXPECT_TRUE(refused({.what = AddVelocity{body("cart"), {1, 0, 0}}}));  // does not float
  EXPECT_TRUE(refused({.what = DragBody{body("hand"), {}, {}, true}}));
  EXPECT_TRUE(refused({.what = SetVelocityGoal{{1, 0}, 0, 0, 0}}));
  EXPECT_TRUE(refused({.what = SetVelocityGoal{{0, 0}, nan, 0, 0}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kGravity, 2, {1, 2}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kGravity, -1, {1}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kGravity, 0, {}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kBodyMass, 1, {-1}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kBodyMass, 1, {0}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{static_cast<LiveFieldId>(99), 0, {1}}}));
  EXPECT_TRUE(refused({.what = SetLiveField{LiveFieldId::kHeightField, 0, {0.5f}}}));  // has none
}

TEST_F(CommandTest, AFullQueueIsReportedToThePoster) {
  SimulatorOptions options = lockstep();
  options.command_capacity = 8;
  auto small = make_simulator(world, options);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(small->post({.what = SetControl{Actuator{0}, 1}}).ok());
  const Status full = small->post({.what = SetControl{Actuator{0}, 1}});
  ASSERT_FALSE(full.ok());
  EXPECT_NE(full.error().message.find("full"), std::string::npos);
  small->start();
  ASSERT_TRUE(small->step().ok());
  EXPECT_TRUE(small->post({.what = SetControl{Actuator{0}, 1}}).ok());
}

TEST_F(CommandTest, AFullLogCountsWhatItLost) {
  SimulatorOptions options = lockstep();
  options.log_capacity = 3;
  auto small = make_simulator(world, options);
  small->start();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(small->post({.what = SetControl{Actuator{0}, 1}}).ok());
    ASSERT_TRUE(small->step().ok());
  }
  EXPECT_EQ(small->counters().log_lost, 2);
  EXPECT_EQ(small->take_command_log().size(), 3u);
}

TEST_F(CommandTest, ManyThreadsMayPost) {
  sim->start();
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t) {
    threads.emplace_back([this] {
      for (int i = 0; i < 500; ++i) {
        ASSERT_TRUE(sim->post({i, SetControl{Actuator{0}, 0.01 * i}}).ok());
      }
    });
  }
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(sim->step(5).ok());
  for (std::thread& t : threads) t.join();
  sim->run_until(1000);
  ASSERT_TRUE(sim->wait().ok());
  const std::vector<LoggedCommand> log = sim->take_command_log();
  ASSERT_EQ(log.size(), 1500u);
  for (size_t i = 1; i < log.size(); ++i) EXPECT_GE(log[i].command.step, log[i - 1].command.step);
}

// Records the goal it is given at every call.
class GoalRecorder final : public Controller {
 public:
  explicit GoalRecorder(std::vector<std::pair<int64_t, double>>& goals) : goals_(goals) {}
  void reset(const mjModel*, const mjData*) override { goals_.clear(); }
  void control(const ControlInputs& in) override {
    EXPECT_EQ(in.period, 0.02);
    goals_.emplace_back(in.step, in.goal.vx);
  }
  std::vector<std::pair<int64_t, double>>& goals_;
};

TEST(SceneSchedule, GoalsAndPushesApplyAtTheirExactStepsInEveryRun) {
  auto world = world_from_mjcf(kCart);
  world->robots[0].options.controller.goals = {{.time = 0.1, .vx = 0.5}, {.time = 0.3, .vx = -1}};
  world->scene.pushes = {{.body = "float", .time = 0.25, .velocity = {0, 0, 1}}};
  auto sim = make_simulator(world, lockstep());
  std::vector<std::pair<int64_t, double>> goals;
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<GoalRecorder>(goals), {50, 1}).ok());
  sim->start();
  for (int run = 0; run < 2; ++run) {
    ASSERT_TRUE(sim->step(25).ok());
    EXPECT_EQ(sim->latest()[Joint{1}].qvel[2], 0);
    ASSERT_TRUE(sim->step(1).ok());
    EXPECT_EQ(sim->latest()[Joint{1}].qvel[2], 1);
    ASSERT_TRUE(sim->post({32, SetVelocityGoal{{0, 0}, 7, 0, 0}}).ok());
    ASSERT_TRUE(sim->step(14).ok());
    ASSERT_EQ(goals.size(), 20u);
    for (size_t i = 0; i < goals.size(); ++i) {
      const int64_t step = 2 * static_cast<int64_t>(i);
      EXPECT_EQ(goals[i].first, step);
      EXPECT_EQ(goals[i].second, step < 10 ? 0 : step < 30 ? 0.5 : step < 32 ? -1 : 7);
    }
    ASSERT_TRUE(sim->reset().ok());
  }
}

TEST(SceneSchedule, ErrorsNameTheLine) {
  auto world = world_from_mjcf(kCart);
  world->scene.pushes = {{.body = "floot", .time = 1, .loc = {"room.toml", 12}}};
  auto sim = Simulator::create(world);
  ASSERT_FALSE(sim.ok());
  EXPECT_EQ(sim.error().loc.line, 12);
  EXPECT_NE(sim.error().to_string().find("'float'"), std::string::npos) << sim.error().to_string();
  world->scene.pushes = {{.body = "cart", .time = 1, .loc = {"room.toml", 13}}};
  sim = Simulator::create(world);
  ASSERT_FALSE(sim.ok());
  EXPECT_EQ(sim.error().loc.line, 13);
  world->scene.pushes = {{.body = "float", .time = -1, .loc = {"room.toml", 14}}};
  EXPECT_FALSE(Simulator::create(world).ok());
}

TEST(AddController, RefusesRatesThatDoNotDivideTheStepRate) {
  auto sim = make_simulator(world_from_mjcf(kCart), lockstep());
  std::vector<std::pair<int64_t, double>> goals;
  EXPECT_FALSE(sim->add_controller(0, std::make_unique<GoalRecorder>(goals), {30, 1}).ok());
  EXPECT_FALSE(sim->add_controller(0, std::make_unique<GoalRecorder>(goals), {200, 1}).ok());
  EXPECT_FALSE(sim->add_controller(1, std::make_unique<GoalRecorder>(goals), {50, 1}).ok());
}

}  // namespace
}  // namespace gloam
