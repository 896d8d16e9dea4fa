// Once warm, the sim thread neither allocates nor frees: commands, controllers, Snapshots and
// readers included. malloc itself is replaced in this program, to count what one thread asks for.

#include <atomic>
#include <cstdlib>
#include <thread>

#include "agent_rig.h"
#include "gas_rig.h"
#include "gas_room.h"
#include "test_world.h"

namespace {
thread_local bool counting = false;
std::atomic<int64_t> allocations{0}, frees{0};
}  // namespace

#ifndef GLOAM_SANITIZED
extern "C" {
void* __libc_malloc(size_t size);
void __libc_free(void* block);
void* malloc(size_t size) {
  if (counting) ++allocations;
  return __libc_malloc(size);
}
void free(void* block) {
  if (counting && block != nullptr) ++frees;
  __libc_free(block);
}
}
#endif

namespace gloam {
namespace {

TEST(StepLoop, AllocatesNothingOnceWarm) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  auto world = world_from_mjcf(kRichModel);
  const Body base{mj_name2id(world->model.get(), mjOBJ_BODY, "base")};
  auto sim = make_simulator(world);
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {500, 1}).ok());
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData* d) { counting = d->time > 0.1; }).ok());
  auto required = *sim->subscribe({.rate = {250, 1}, .required = true, .capacity = 4});
  auto slow = *sim->subscribe({.rate = {500, 1}, .capacity = 2});
  std::thread reader([required] {
    while (required->next()) {
    }
  });
  std::thread client([&sim, base] {
    for (int i = 0; i < 500; ++i) {
      static_cast<void>(sim->post({.what = SetControl{Actuator{i % 4}, 0.1}}).ok());
      static_cast<void>(sim->post({.what = SetWrench{base, {0, 0, 1}, {}}}).ok());
      static_cast<void>(sim->post({.what = DragBody{base, {}, {0, 0, .5}, i % 3 != 0}}).ok());
      static_cast<void>(sim->post({i * 10, AddVelocity{base, {0.01, 0, 0}}}).ok());
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  sim->start(4000);
  ASSERT_TRUE(sim->wait().ok());
  client.join();
  EXPECT_GT(slow->dropped(), 1000);
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
  // The hook does count what it should.
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData*) {
                   counting = true;
                   free(malloc(10));
                   counting = false;
                 })
                  .ok());
  sim->run_until(4001);
  ASSERT_TRUE(sim->wait().ok());
  EXPECT_GE(allocations.load(), 1);
  sim->stop();
  reader.join();
}

// They start, replace each other and stop, and the memory of the old ones is released elsewhere.
TEST(StepLoop, FollowsTrajectoriesOfAnyLengthWithoutAllocating) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  auto world = world_from_mjcf(kRichModel);
  auto sim = make_simulator(world);
  ASSERT_TRUE(sim->add_controller(0, std::make_unique<RandomController>(), {500, 1}).ok());
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData* d) { counting = d->time > 0.1; }).ok());
  auto queue = *sim->subscribe({.rate = {250, 1}, .required = true, .capacity = 4});
  std::thread reader([queue] {
    while (queue->next()) {
    }
  });
  const auto joint = [&](const char* name) {
    return Joint{mj_name2id(world->model.get(), mjOBJ_JOINT, name), 0};
  };
  FollowTrajectory both{{0, 0}, {joint("hip"), joint("knee")}, {}};
  for (int i = 1; i <= 20'000; ++i) both.trajectory.points.push_back({0.01 * i, {0.1, -0.2}});
  allocations = frees = 0;
  std::thread client([&] {
    for (int i = 0; i < 40; ++i) {
      FollowTrajectory one{{0, 0}, {both.joints[i % 2]}, {.points = {{1, {-0.1 * (i % 3)}, {0}}}}};
      EXPECT_TRUE(sim->post({.what = both}).ok());
      EXPECT_TRUE(sim->post({.what = std::move(one)}).ok());
      const Command stop{.what = StopTrajectory{{0, 0}}};
      EXPECT_TRUE(i % 4 != 0 || sim->post(stop).ok());
      static_cast<void>(sim->take_command_log());
    }
  });
  sim->start(100'000);
  client.join();
  sim->run_until(sim->latest().step() + 100);
  ASSERT_TRUE(sim->wait().ok());
  EXPECT_EQ(sim->counters().commands_applied, 90);
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData*) { counting = false; }).ok());
  sim->stop();
  reader.join();
}

// Nothing is allocated after `warm` [s] while a reader takes Snapshots of a queue of `capacity`.
void expect_no_allocation(std::shared_ptr<const CompiledWorld> world, double warm, int64_t steps,
                          int capacity) {
  auto sim = make_simulator(std::move(world));
  ASSERT_TRUE(
      sim->set_step_hook([warm](const mjModel*, mjData* d) { counting = d->time > warm; }).ok());
  auto queue = *sim->subscribe({.rate = {250, 1}, .required = true, .capacity = capacity});
  std::thread reader([queue] {
    while (queue->next()) {
    }
  });
  allocations = frees = 0;
  sim->start(steps);
  EXPECT_TRUE(sim->wait().ok());
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData*) { counting = false; }).ok());
  sim->stop();
  reader.join();
}

TEST(WaterLoop, AllocatesNothingOnceWarm) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.002"/><worldbody>
    <body pos="0 0 0.3"><freejoint/><geom type="box" size=".2 .2 .1" density="400"/></body>
    <body pos="1 0 0.3"><freejoint/><geom type="capsule" size=".1 .2" density="400"/></body>
    </worldbody></mujoco>)");
  Scene scene;
  WaterOptions& water = scene.waters.emplace_back();
  water.name = "pool";
  water.wave_height = 0.05;
  water.wave_period = 1;
  world->waters = *describe_waters(scene);
  world->wind.speed = 5;
  world->wind.gusts = 1;
  expect_no_allocation(world, 0.5, 2000, 4);
}

TEST(SoilLoop, AllocatesNothingOnceWarm) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.002"/><worldbody>
    <body pos="0 0 0.3"><freejoint/><geom type="box" size=".2 .2 .1" density="900"/></body>
    <body pos="-1 0 0.1"><freejoint/><geom type="cylinder" size=".1 .05" euler="90 0 0"/></body>
    <body pos="1 0 0.3"><freejoint/><geom type="capsule" size=".1 .2" density="900"/></body>
    </worldbody></mujoco>)");
  Scene scene;
  scene.soils.emplace_back().name = "bed";
  world->soils = *describe_soils(scene, *world->model);
  expect_no_allocation(world, 0.1, 1000, 1);
}

TEST(Agents, DecideAndWalkWithoutAllocating) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  AgentRig rig(agent_place("<geom type='box' size='0.1 3 1.2' pos='0 -3 1.2'/>"));
  for (int i = 0; i < 3; ++i) rig.add("a" + std::to_string(i), {-3.0 + 2 * i, 3, 0}, "wander");
  auto sim = make_simulator(rig.compile());
  allocations = frees = 0;
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData* d) { counting = d->time > 1; }).ok());
  sim->start(5000);
  ASSERT_TRUE(sim->wait().ok());
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
}

TEST(GasObstacles, AllocateNothingAfterTheFirstCall) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  GasRig rig(
      "<geom type='plane' size='1 1 1' pos='0 0 -.4'/><body pos='9 0 0'><freejoint/>"
      "<geom type='box' size='.5 .3 .01' pos='.2 0 0'/><geom type='sphere' size='.4'/></body>"
      "<body mocap='true' pos='5 0 0'><geom type='capsule' size='.1 .3'/></body>",
      cube_grid(20, .1f), .01);
  rig.solve();  // everything is out of the grid
  allocations = frees = 0;
  for (int step = 0; step < 20; ++step) {
    for (int i = 0; i < 7; ++i) rig.d->qpos[i] = random_control(step, i);
    rig.d->mocap_pos[0] = random_control(step, 8);
    const Snapshot s = rig.snapshot();
    counting = true;
    const bool ok = rig.obstacles->solve(s, &rig.walls).ok();
    counting = false;
    ASSERT_TRUE(ok && rig.obstacles->shape_changed());
  }
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
}

TEST(GasStep, AllocatesNothingOnceWarm) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  const GasGrid grid{32, 28, 24, 0.1f, {}};
  auto gas = make_gas(grid, closed_box());
  GasSource source = ball({1, 1, 0.5f}, 0.3f);
  source.fuel = 0.01f;
  for (int n = 0; n < 12; ++n) {
    GasWalls walls(grid);
    add_sheet(&walls, 20, [](int, int k) { return k < 5; });
    add_solid(&walls, {4 + n, 4, 4}, {9 + n, 12, 12}, {1, 0, 0});
    if (n == 4) allocations = frees = 0;
    counting = n >= 4;
    gas->set_walls(walls);
    gas->step(0.1f, std::span(&source, 1), {});
    counting = false;
  }
  EXPECT_EQ(allocations.load(), 0);
  EXPECT_EQ(frees.load(), 0);
}

}  // namespace
}  // namespace gloam
