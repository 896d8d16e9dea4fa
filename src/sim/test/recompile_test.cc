// A recompile in the middle of a run: what remains goes on, bit for bit where nothing new touches
// it; what is new begins; what cannot be done leaves the old World running.

#include <algorithm>
#include <thread>

#include "sim/state/state_layout.h"
#include "test_world.h"

namespace gloam {
namespace {

std::string with(std::string xml, const std::string& before, const std::string& more) {
  const size_t place = xml.find(before);
  EXPECT_NE(place, std::string::npos) << before;
  return xml.insert(place, more);
}

std::string replaced(std::string xml, const std::string& from, const std::string& to) {
  const size_t place = xml.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return xml.replace(place, from.size(), to);
}

int id_of(const CompiledWorld& world, mjtObj type, const char* name) {
  return mj_name2id(world.model.get(), type, name);
}

Joint joint(const CompiledWorld& world, const char* name) {
  return {id_of(world, mjOBJ_JOINT, name), world.serial};
}
Body body(const CompiledWorld& world, const char* name) {
  return {id_of(world, mjOBJ_BODY, name), world.serial};
}

std::vector<RobotController> random_controllers() {
  std::vector<RobotController> controllers;
  controllers.push_back({0, std::make_unique<RandomController>(), {250, 1}});
  return controllers;
}

std::unique_ptr<Simulator> driven(std::shared_ptr<const CompiledWorld> world,
                                  SimulatorOptions options = lockstep()) {
  auto sim = make_simulator(std::move(world), std::move(options));
  EXPECT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {250, 1}).ok());
  sim->start();
  return sim;
}

std::vector<double> state(Simulator& sim) {
  const Snapshot s = sim.latest();
  return {s.state().begin(), s.state().end()};
}

TEST(Recompile, ToTheSameSceneChangesNoBitOfTheRun) {
  const auto world = world_from_mjcf(kRichModel), again = world_from_mjcf(kRichModel);
  auto plain = driven(world), changed = driven(world);
  for (Simulator* sim : {plain.get(), changed.get()}) {
    ASSERT_TRUE(sim->post({.what = SetWrench{body(*world, "ball"), {0.1, 0, 1}, {}}}).ok());
    ASSERT_TRUE(sim->post({30, DragBody{body(*world, "base"), {0, 0, .05}, {.2, 0, 1}}}).ok());
    ASSERT_TRUE(sim->post({200, SetMocapPose{body(*world, "hand"), {{-1, 0.1, 1}, {}}}}).ok());
    ASSERT_TRUE(
        sim->post(
               {20, SetLiveField{LiveFieldId::kBodyMass, id_of(*world, mjOBJ_BODY, "base"), {6}}})
            .ok());
    ASSERT_TRUE(sim->step(101).ok());
  }
  const int64_t step = changed->step_count();
  const uint64_t before = changed->latest().hash();
  ASSERT_TRUE(changed->recompile(again, random_controllers()).ok());
  EXPECT_EQ(changed->step_count(), step);
  EXPECT_EQ(changed->latest().time(), plain->latest().time());
  EXPECT_NE(changed->latest().hash(), before) << "the chain tells of it";
  EXPECT_EQ(state(*changed), state(*plain));
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(plain->step(1).ok() && changed->step(1).ok());
    ASSERT_EQ(state(*changed), state(*plain)) << "step " << changed->step_count();
  }
  EXPECT_EQ(changed->counters().commands_discarded, 0) << "a command for step 200 went along";
  EXPECT_GT(changed->counters().log_lost, 0) << "a replay would not be exact";
}

// An arm on a post, one that swings free: what is added elsewhere does not touch it.
const char* const kArm = R"(
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <body name="upper" pos="0 0 1">
      <joint name="shoulder" type="ball"/><geom type="capsule" fromto="0 0 0 .3 0 0" size=".03"/>
      <body name="lower" pos=".3 0 0">
        <joint name="elbow" axis="0 1 0" damping=".01"/><geom type="capsule" fromto="0 0 0 .3 0 0" size=".03"/>
      </body>
    </body>
    <body name="box" pos="2 0 1"><freejoint/><geom name="box" size=".1"/></body>
  </worldbody>
  <actuator><general name="elbow" joint="elbow" dyntype="filter" dynprm=".05"/></actuator>
</mujoco>)";

TEST(Recompile, AddingAndRemovingLeavesTheRestItsBits) {
  const auto first = world_from_mjcf(kArm);
  // One body before all others, so that every id and address moves; and the old box gone.
  const auto second = world_from_mjcf(replaced(
      with(kArm, "<body name=\"upper\"",
           "<body name=\"new\" pos=\"9 0 3\"><freejoint/><geom size=\".2\"/></body>"),
      "<body name=\"box\" pos=\"2 0 1\"><freejoint/><geom name=\"box\" size=\".1\"/></body>", ""));
  auto plain = make_simulator(first, lockstep()), changed = make_simulator(first, lockstep());
  for (Simulator* sim : {plain.get(), changed.get()}) {
    ASSERT_TRUE(sim->post({.what = SetControl{Actuator{0}, 0.3}}).ok());
    ASSERT_TRUE(sim->post({.what = SetJointState{joint(*first, "elbow"), {0.4}, {-2}}}).ok());
    sim->start();
    ASSERT_TRUE(sim->step(100).ok());
  }
  ASSERT_TRUE(changed->post({150, SetControl{Actuator{0}, -0.2}}).ok());
  ASSERT_TRUE(changed->post({150, AddVelocity{body(*first, "box"), {1, 0, 0}}}).ok());
  ASSERT_TRUE(plain->post({150, SetControl{Actuator{0}, -0.2}}).ok());
  ASSERT_TRUE(changed->recompile(second, {}).ok());
  EXPECT_EQ(changed->counters().commands_discarded, 1) << "there is no box to push any more";
  const Snapshot now = changed->latest();
  EXPECT_EQ(now.world().compiled(), second);
  const Joint fresh{second->model->body_jntadr[id_of(*second, mjOBJ_BODY, "new")], second->serial};
  EXPECT_EQ(now[fresh].qpos[2], 3) << "begins where its scene says";
  EXPECT_EQ(now[fresh].qvel[2], 0);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(plain->step(1).ok() && changed->step(1).ok());
    const Snapshot a = plain->latest(), b = changed->latest();
    for (const char* name : {"shoulder", "elbow"}) {
      const JointState x = a[joint(*first, name)], y = b[joint(*second, name)];
      ASSERT_TRUE(std::equal(x.qpos.begin(), x.qpos.end(), y.qpos.begin())) << name << " " << i;
      ASSERT_TRUE(std::equal(x.qvel.begin(), x.qvel.end(), y.qvel.begin())) << name << " " << i;
    }
  }
}

TEST(Recompile, AChangedMassCountsAndAChangedJointBeginsAnew) {
  const auto first = world_from_mjcf(kArm);
  const auto second = world_from_mjcf(
      replaced(replaced(kArm, "<joint name=\"elbow\" axis=\"0 1 0\" damping=\".01\"/>",
                        "<joint name=\"elbow\" type=\"ball\"/>"),
               "dyntype", "gear=\"1 0 0\" dyntype"));
  auto sim = make_simulator(first, lockstep());
  ASSERT_TRUE(sim->post({.what = SetWrench{body(*first, "box"), {7, 0, 0}, {}}}).ok());
  sim->start();
  ASSERT_TRUE(sim->step(50).ok());
  const Joint box{first->model->body_jntadr[id_of(*first, mjOBJ_BODY, "box")]};
  const double v0 = sim->latest()[box].qvel[0];
  const auto third = world_from_mjcf(
      replaced(kArm, "name=\"box\" size=\".1\"", "name=\"box\" size=\".1\" mass=\"7\""));
  ASSERT_TRUE(sim->recompile(third, {}).ok());
  ASSERT_TRUE(sim->step(50).ok());
  const Joint box_now{third->model->body_jntadr[id_of(*third, mjOBJ_BODY, "box")]};
  EXPECT_NEAR(sim->latest()[box_now].qvel[0] - v0, 7.0 / 7.0 * 50 * 0.002, 1e-9);
  ASSERT_TRUE(sim->recompile(second, {}).ok());
  const JointState elbow = sim->latest()[joint(*second, "elbow")];
  EXPECT_EQ(elbow.qpos[0], 1) << "the unit quaternion it begins with";
  EXPECT_EQ(elbow.qvel[0], 0);
}

TEST(Recompile, LiveFieldsThatWereChangedGoAlongByName) {
  const auto first = world_from_mjcf(kArm);
  const auto second = world_from_mjcf(
      replaced(with(kArm, "<body name=\"upper\"", "<geom name=\"post\" size=\".2\"/>"),
               "name=\"box\" size=\".1\"", "name=\"box\" size=\".1\" rgba=\"0 1 0 1\""));
  auto sim = make_simulator(first, lockstep());
  sim->start();
  const int elbow_geom = first->model->body_geomadr[id_of(*first, mjOBJ_BODY, "lower")];
  ASSERT_TRUE(
      sim->post({.what = SetLiveField{LiveFieldId::kGeomColor, 4 * elbow_geom, {1, 0, 0, 1}}})
          .ok());
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kGravity, 0, {0, 0, -1}}}).ok());
  ASSERT_TRUE(sim->step(10).ok());
  ASSERT_TRUE(sim->recompile(second, {}).ok());
  const Snapshot s = sim->latest();
  ASSERT_NE(s.data().live, nullptr);
  const auto& colors = s.data().live->values[static_cast<size_t>(LiveFieldId::kGeomColor)];
  const auto color = [&](int geom) {
    return std::vector<float>(colors.begin() + 4 * geom, colors.begin() + 4 * geom + 4);
  };
  EXPECT_EQ(color(second->model->body_geomadr[id_of(*second, mjOBJ_BODY, "lower")]),
            (std::vector<float>{1, 0, 0, 1}));
  EXPECT_EQ(color(id_of(*second, mjOBJ_GEOM, "box")), (std::vector<float>{0, 1, 0, 1}))
      << "not changed by Command: as the new scene says";
  EXPECT_EQ(s.data().live->values[static_cast<size_t>(LiveFieldId::kGravity)][2], -1);
  ASSERT_TRUE(sim->reset().ok());
  EXPECT_EQ(sim->latest().data().live, nullptr);
  EXPECT_EQ(sim->latest().hash(), make_simulator(second, lockstep())->latest().hash());
}

TEST(Recompile, WhatCannotBeDoneLeavesTheOldWorldRunning) {
  const auto world = world_from_mjcf(kArm);
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(10).ok());
  const Snapshot before = sim->latest();
  const auto other_step = world_from_mjcf(replaced(kArm, "0.002", "0.001"));
  const Status refused = sim->recompile(other_step, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().to_string().find("timestep"), std::string::npos);
  std::vector<RobotController> uneven;
  uneven.push_back({0, std::make_unique<RandomController>(), {333, 1}});
  EXPECT_FALSE(sim->recompile(world_from_mjcf(kArm), std::move(uneven)).ok());
  EXPECT_EQ(sim->world(), world);
  EXPECT_EQ(sim->latest().hash(), before.hash());
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->latest().step(), 20);
}

TEST(Recompile, HandlesOfTheOldWorldAreRefused) {
  const auto first = world_from_mjcf(kArm), second = world_from_mjcf(kArm);
  auto sim = make_simulator(first, lockstep());
  const Body old = body(*first, "box");
  ASSERT_TRUE(sim->post({.what = AddVelocity{old, {1, 0, 0}}}).ok());
  sim->start();
  ASSERT_TRUE(sim->recompile(second, {}).ok());
  const Status status = sim->post({.what = AddVelocity{old, {1, 0, 0}}});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().to_string().find("another World"), std::string::npos);
  EXPECT_TRUE(sim->post({.what = AddVelocity{body(*second, "box"), {1, 0, 0}}}).ok());
  const Snapshot now = sim->latest();
  sim->stop();  // a death test forks, without the other threads
  EXPECT_DEATH((void)now[joint(*first, "elbow")], "another World");
}

// Subscriptions go on: every step once, and each Snapshot says of which World it is.
TEST(Recompile, SubscriptionsGoOn) {
  const auto first = world_from_mjcf(kArm), second = world_from_mjcf(kArm);
  auto sim = make_simulator(first, lockstep());
  auto every = *sim->subscribe({.rate = {500, 1}, .required = true, .capacity = 64});
  auto windows =
      *sim->subscribe({.rate = {50, 1}, .required = true, .capacity = 64, .window = {1, 100}});
  sim->start();
  ASSERT_TRUE(sim->step(13).ok());
  ASSERT_TRUE(sim->recompile(second, {}).ok());
  ASSERT_TRUE(sim->step(20).ok());
  sim->stop();
  for (int64_t step = 0; step <= 33; ++step) {
    const Snapshot s = every->next();
    ASSERT_EQ(s.step(), step);
    EXPECT_EQ(s.world().compiled(), step <= 13 ? first : second);
  }
  std::vector<int64_t> begun;
  while (const SnapshotWindow window = windows->next_window()) {
    begun.push_back(window.keys[0].step());
    for (const Snapshot& key : window.all())
      EXPECT_EQ(key.world().compiled(), window.keys[0].world().compiled());
  }
  EXPECT_EQ(begun, (std::vector<int64_t>{0, 20})) << "that of step 10 had begun and is lost";
  EXPECT_EQ(windows->dropped(), 1);
}

// The same recompiles at the same steps: the same hashes, whoever watches.
TEST(Recompile, IsDeterministic) {
  const auto first = world_from_mjcf(kRichModel);
  const auto second = world_from_mjcf(
      with(kRichModel, "<body name=\"ball\"",
           "<body name=\"more\" pos=\"0 0 2\"><freejoint/><geom size=\".1\"/></body>"));
  const auto run = [&](bool watched) {
    auto sim = driven(first);
    std::thread reader;
    if (watched) {
      auto queue = *sim->subscribe({.rate = {100, 1}, .capacity = 1});
      reader = std::thread([queue] {
        while (queue->next()) {
        }
      });
    }
    std::vector<uint64_t> hashes;
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(sim->step(37).ok());
      EXPECT_TRUE(sim->recompile(i % 2 == 0 ? second : first, random_controllers()).ok());
      hashes.push_back(sim->latest().hash());
    }
    sim->stop();
    if (reader.joinable()) reader.join();
    return hashes;
  };
  const auto reference = run(false);
  EXPECT_EQ(run(false), reference);
  EXPECT_EQ(run(true), reference);
}

}  // namespace
}  // namespace gloam
