// gloam::Simulation as its users call it.

#include <mujoco/mujoco.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "scenes.h"

namespace gloam {
namespace {

TEST(LiveSimulation, StandsWhereItWasToldTo) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  EXPECT_TRUE(simulation->paused());
  EXPECT_EQ(simulation->latest().step(), 0);
  EXPECT_EQ(simulation->step_rate(), (Rational{500, 1}));
  ASSERT_TRUE(simulation->step(3).ok());
  EXPECT_EQ(simulation->latest().step(), 3);
  ASSERT_TRUE(simulation->run_until(50).ok());
  EXPECT_EQ(simulation->latest().step(), 50);
  EXPECT_TRUE(simulation->paused());
  ASSERT_TRUE(simulation->run_until(20).ok()) << "the past needs no steps";
  EXPECT_EQ(simulation->latest().step(), 50);
  simulation->resume();
  EXPECT_FALSE(simulation->paused());
  while (simulation->latest().step() < 100) std::this_thread::yield();
  simulation->pause();
  const int64_t step = simulation->latest().step();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(simulation->latest().step(), step);
  const auto stats = simulation->stats();
  EXPECT_EQ(stats.step, step);
  EXPECT_EQ(stats.hash, simulation->latest().hash());
  EXPECT_NEAR(stats.time, static_cast<double>(step) * 0.002, 1e-9);
}

TEST(LiveSimulation, AResetWaitsAtStepZeroWithTheSameHash) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  const uint64_t first = simulation->latest().hash();
  ASSERT_TRUE(simulation->run_until(40).ok());
  const uint64_t at_40 = simulation->latest().hash();
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(simulation->latest().step(), 0) << "it set out again by itself";
  EXPECT_EQ(simulation->latest().hash(), first);
  ASSERT_TRUE(simulation->run_until(40).ok());
  EXPECT_EQ(simulation->latest().hash(), at_40);
}

TEST(LiveSimulation, ResetsWithoutEndAreOneAndLeaveASaneSpeed) {
  const TempFolder folder;
  auto made = Simulation::create(flight(folder), {.pace = Pace::kRealTime});
  ASSERT_TRUE(made.ok());
  Simulation& simulation = **made;
  simulation.resume();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  std::atomic<bool> ends{false};
  std::vector<std::thread> clients;
  for (int i = 0; i < 2; ++i)
    clients.emplace_back([&] {
      while (!ends) EXPECT_TRUE(simulation.post({.what = ResetSim{}}).ok());
    });
  for (int i = 0; i < 50; ++i) {
    const double factor = simulation.stats().realtime_factor;
    EXPECT_TRUE(factor >= 0 && factor < 2) << factor;
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  ends = true;
  for (std::thread& client : clients) client.join();
  EXPECT_LT(simulation.stats().commands_applied, 100) << "a reset every 10 ms at most";
  simulation.pause();  // at rest each one counts
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(simulation.step(2).ok());
    ASSERT_TRUE(simulation.post({.what = ResetSim{}}).ok());
    EXPECT_EQ(simulation.latest().step(), 0);
  }
}

TEST(LiveSimulation, AStopFromOutsideEndsAnEndlessRun) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  std::thread user([&] {
    while (simulation->latest().step() < 10) std::this_thread::yield();
    simulation->request_stop();
  });
  const Status status = simulation->run_until(int64_t{1} << 50);
  user.join();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().exit_code(), 130);
  EXPECT_TRUE(simulation->status().ok()) << "physics is well";
  EXPECT_TRUE(simulation->step(1).ok()) << "and can go on";
}

TEST(LiveSimulation, CommandsApplyAtTheirStepAndAreCounted) {
  const TempFolder folder;
  const World world = flight(folder);
  auto simulation = simulate(world);
  const auto ball = world.find_body("a/ball");
  ASSERT_TRUE(ball.ok());
  ASSERT_TRUE(simulation->post({100, AddVelocity{*ball, {0, 0, 2}}}).ok());
  ASSERT_TRUE(simulation->run_until(100).ok());
  EXPECT_NEAR(simulation->body_pose(*ball)->p.z, 0, 1e-9);
  EXPECT_EQ(simulation->stats().commands_applied, 0);
  ASSERT_TRUE(simulation->run_until(200).ok());
  EXPECT_NEAR(simulation->body_pose(*ball)->p.z, 0.4, 1e-9) << "2 m/s for 0.2 s";
  EXPECT_NEAR(simulation->body_pose(*ball)->p.x, 0.4, 1e-9);
  EXPECT_EQ(simulation->stats().commands_applied, 1);
  // Not of this World, not finite: refused at once, and nothing changes.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(simulation->post({.what = AddVelocity{{99}, {0, 0, 1}}}).ok());
  EXPECT_FALSE(simulation->post({.what = AddVelocity{*ball, {nan, 0, 0}}}).ok());
  EXPECT_FALSE(simulation->post({.what = SetControl{{0}, 1}}).ok()) << "there are no actuators";
  EXPECT_FALSE(simulation->body_pose({-1}).ok());
  EXPECT_FALSE(simulation->body_pose({99}).ok());
  EXPECT_EQ(simulation->stats().commands_applied, 1);
}

TEST(LiveSimulation, TheStepHookSeesTheStateBeforeEveryStep) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  std::vector<double> times;
  ASSERT_TRUE(
      simulation->set_step_hook([&](const mjModel*, mjData* d) { times.push_back(d->time); }).ok());
  ASSERT_TRUE(simulation->step(3).ok());
  ASSERT_EQ(times.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(times[i], 0.002 * static_cast<double>(i), 1e-12);
}

TEST(LiveSimulation, PhysicsStepsInTheMemoryThatItTells) {
  const TempFolder folder;
  const World world = flight(folder);
  auto simulation = simulate(world);
  const PhysicsMemory memory = simulation->memory();
  ASSERT_TRUE(simulation->step(3).ok());
  EXPECT_NEAR(memory.data->time, 0.006, 1e-12);
  EXPECT_EQ(memory.data->qpos[0], simulation->latest().state()[1]);
  ASSERT_TRUE(simulation->recompile(world).ok());
  ASSERT_TRUE(simulation->step(1).ok());
  EXPECT_NEAR(memory.data->time, 0.006, 1e-12) << "kept, and no longer stepped";
  EXPECT_NEAR(simulation->memory().data->time, 0.008, 1e-12);
}

TEST(LiveSimulation, PhysicsStepsInMemoryThatIsGivenToTheSameHash) {
  const TempFolder folder;
  const World world = flight(folder);
  auto bare = simulate(world);
  ASSERT_TRUE(bare->step(40).ok());
  std::vector<std::shared_ptr<mjData>> made;
  const auto make = [&](const std::shared_ptr<mjModel>& model) {
    made.emplace_back(mj_makeData(model.get()), [model](mjData* d) { mj_deleteData(d); });
    return made.back();
  };
  auto given = Simulation::create(world, {.make_data = make});
  ASSERT_TRUE(given.ok()) << given.error().to_string();
  Simulation& simulation = **given;
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(simulation.memory().data, made[0]);
  ASSERT_TRUE(simulation.step(40).ok());
  EXPECT_EQ(simulation.latest().hash(), bare->latest().hash());
  // Live fields change the copy of the model, and a reset takes them back.
  ASSERT_TRUE(simulation.post({.what = SetLiveField{LiveFieldId::kBodyMass, 1, {5}}}).ok());
  ASSERT_TRUE(simulation.step(1).ok());
  EXPECT_EQ(simulation.memory().model->body_mass[1], 5);
  EXPECT_NE(bare->memory().model->body_mass[1], 5) << "the World's own";
  ASSERT_TRUE(simulation.post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation.run_until(40).ok());
  EXPECT_EQ(simulation.latest().hash(), bare->latest().hash());
  EXPECT_NE(simulation.memory().model->body_mass[1], 5);
  EXPECT_EQ(simulation.memory().data, made[0]);
  // Physics that fails stays in it; another World has its own.
  ASSERT_TRUE(simulation.set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] = NAN; }).ok());
  EXPECT_FALSE(simulation.step(1).ok());
  EXPECT_EQ(simulation.memory().data, made[0]);
  ASSERT_TRUE(simulation.set_step_hook({}).ok());
  ASSERT_TRUE(simulation.post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation.run_until(1).ok());
  ASSERT_TRUE(simulation.recompile(world).ok());
  ASSERT_EQ(made.size(), 2u);
  EXPECT_EQ(simulation.memory().data, made[1]);
  EXPECT_FALSE(Simulation::create(
                   world, {.make_data = [](const auto&) { return std::shared_ptr<mjData>(); }})
                   .ok());
}

TEST(LiveSimulation, AStreamTellsWhenItsNextMessageIsWhole) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  std::atomic<int> messages{0};
  auto stream = simulation->open_snapshots({.rate = {100, 1}, .required = true},
                                           [&](const Snapshot&) { ++messages; });
  ASSERT_TRUE(stream.ok());
  EXPECT_EQ((*stream)->complete_at(0), 0);
  EXPECT_EQ((*stream)->complete_at(1), 5) << "100 Hz of 500";
  EXPECT_EQ((*stream)->complete_at(6), 10);
  for (int i = 1; i <= 50; ++i) {
    ASSERT_TRUE(simulation->run_until((*stream)->complete_at(5 * i - 4)).ok());
    (*stream)->flush();
    EXPECT_EQ(messages, i + 1) << "that of step 0 is the first";
  }
}

TEST(LiveSimulation, APixelLeadsToTheBodyBehindIt) {
  const TempFolder folder;
  const World world = flight(folder);
  auto simulation = simulate(world);
  ASSERT_TRUE(simulation->run_until(50).ok());  // the ball's centre at x = 0.1
  CameraFrame frame;
  frame.intrinsics = {64, 48, 50, 50, 32, 24};
  frame.X_WC = {{0.1, -2, 0}, {std::sqrt(0.5), std::sqrt(0.5), 0, 0}};
  const auto hit = simulation->pick(frame, 32, 24);
  ASSERT_TRUE(hit.ok()) << hit.error().to_string();
  EXPECT_EQ(hit->body.id, world.find_body("a/ball")->id);
  EXPECT_NEAR(hit->point_W.x, 0.1, 1e-4);
  EXPECT_NEAR(hit->point_W.y, -0.2, 1e-4);
  EXPECT_NEAR(hit->point_B.x, 0, 1e-4);
  EXPECT_NEAR(hit->point_B.y, -0.2, 1e-4);
  frame.X_WC.q = {1, 0, 0, 0};  // straight down: nothing there
  EXPECT_FALSE(simulation->pick(frame, 32, 24).ok());
}

TEST(LiveSimulation, APixelOfAFisheyeLeadsToTheBodyInItsDirection) {
  const TempFolder folder;
  auto simulation = simulate(flight(folder));
  CameraFrame frame;
  frame.intrinsics = {128, 48, 50, 50, 32, 24};
  frame.intrinsics.lens = LensModel::kEquidistant;
  // Turned to the left by 60 degrees: the ball, straight along +Y, is 60 degrees to the right.
  const double s = std::sqrt(0.5), c30 = std::cos(M_PI / 6), s30 = std::sin(M_PI / 6);
  frame.X_WC = {{0, -2, 0}, {c30 * s, c30 * s, s30 * s, s30 * s}};
  const auto hit = simulation->pick(frame, 32 + 50 * M_PI / 3, 24);
  ASSERT_TRUE(hit.ok()) << hit.error().to_string();
  EXPECT_EQ(hit->name, "a/ball");
  EXPECT_NEAR(hit->point_W.x, 0, 1e-4);
  EXPECT_NEAR(hit->point_W.y, -0.2, 1e-4);
}

TEST(LiveSimulation, OptionsOutOfRangeAreRefused) {
  const TempFolder folder;
  const World world = flight(folder);
  for (const double timestep : {-0.001, std::nan(""), 1e9, 1e-300}) {
    const auto simulation = Simulation::create(world, {.timestep = timestep});
    ASSERT_FALSE(simulation.ok()) << timestep;
    EXPECT_NE(simulation.error().to_string().find("timestep"), std::string::npos);
  }
  for (const double speed : {0.0, -1.0, std::nan("")}) {
    const auto simulation = Simulation::create(world, {.pace = Pace::kRealTime, .speed = speed});
    EXPECT_FALSE(simulation.ok()) << speed;
  }
}

}  // namespace
}  // namespace gloam
