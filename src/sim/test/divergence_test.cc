// A simulation that explodes stops, says what and where, and keeps its last good state.

#include <cmath>

#include "test_world.h"

namespace gloam {
namespace {

// A spring that pushes the wrong way: the angle grows without end.
const char* const kExplodes = R"(<mujoco><option timestep="0.01"/><worldbody>
  <body name="calm" pos="3 0 1"><joint name="still" axis="0 1 0"/><geom size=".1" pos="0 0 -.3"/></body>
  <body name="arm" pos="0 0 1"><joint name="wild" axis="0 1 0"/><geom size=".1" pos=".3 0 0" mass="1"/></body>
  </worldbody><actuator><general joint="wild" gainprm="0" biastype="affine" biasprm="0 1e5 0"/></actuator>
  <sensor><jointpos joint="wild"/></sensor></mujoco>)";

TEST(Divergence, StopsAtTheLastGoodStateAndNamesTheJoint) {
  auto world = world_from_mjcf(kExplodes);
  auto sim = make_simulator(world, lockstep());
  auto queue = *sim->subscribe({.rate = {100, 1}, .capacity = 100});
  sim->start();
  const Status status = sim->step(100000);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().kind, ErrorKind::kDiverged);
  EXPECT_EQ(status.error().exit_code(), 3);
  const Snapshot last = sim->latest();
  EXPECT_GT(last.step(), 2);
  EXPECT_LT(last.step(), 100000);
  EXPECT_EQ(last.step(), sim->step_count());
  const std::string message = status.error().message;
  EXPECT_NE(message.find("'wild'"), std::string::npos) << message;
  EXPECT_EQ(message.find("'still'"), std::string::npos) << message;
  EXPECT_NE(message.find("step " + std::to_string(last.step())), std::string::npos) << message;
  for (const double x : last.state()) EXPECT_TRUE(std::abs(x) <= 1e10);
  EXPECT_NEAR(last.time(), 0.01 * static_cast<double>(last.step()), 1e-9);
  // Sensors are those of the state itself.
  EXPECT_EQ(last[SensorHandle{0}].values[0], last[Joint{1}].position());
  EXPECT_EQ(last[SensorHandle{0}].stamp, last.time());
  const SimCounters counters = sim->counters();
  EXPECT_EQ(counters.steps, last.step());

  // It stays there …
  EXPECT_FALSE(sim->step(5).ok());
  EXPECT_EQ(sim->latest().step(), last.step());
  EXPECT_EQ(sim->latest().hash(), last.hash());
  EXPECT_EQ(queue->options().capacity, 100);
  // … until it is reset, and then does the same again.
  ASSERT_TRUE(sim->reset().ok());
  EXPECT_EQ(sim->latest().step(), 0);
  EXPECT_FALSE(sim->step(100000).ok());
  EXPECT_EQ(sim->latest().hash(), last.hash());
}

TEST(Divergence, NotANumberFromAHookIsCaught) {
  auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData* d) {
                   if (d->time > 0.0399) d->qvel[8] = std::nan("");
                 })
                  .ok());
  sim->start();
  const Status status = sim->step(100);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(sim->latest().step(), 20);
  EXPECT_EQ(sim->counters().warnings[mjWARN_BADQVEL], 1);
  EXPECT_NE(status.error().message.find("velocity"), std::string::npos) << status.error().message;
}

TEST(Divergence, BadControlsAreCountedAndPhysicsGoesOn) {
  auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
  ASSERT_TRUE(
      sim->set_step_hook([](const mjModel*, mjData* d) { d->ctrl[0] = std::nan(""); }).ok());
  sim->start();
  ASSERT_TRUE(sim->step(10).ok());
  EXPECT_EQ(sim->counters().warnings[mjWARN_BADCTRL], 10);
}

TEST(Divergence, ErrorsOfMuJoCoInsideAStepBecomeErrors) {
  auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
  sim->start();
  mjcb_control = [](const mjModel*, mjData* d) {
    if (d->time > 0.0499) mju_error("a plugin broke");
  };
  const Status status = sim->step(1000);
  mjcb_control = nullptr;
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("a plugin broke"), std::string::npos);
  EXPECT_NE(status.error().message.find("step 25"), std::string::npos) << status.error().message;
  EXPECT_EQ(sim->latest().step(), 25);
  // The mjData was made anew: after a reset it runs as if nothing had been.
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(100).ok());
  auto fresh = make_simulator(world_from_mjcf(kRichModel), lockstep());
  fresh->start();
  ASSERT_TRUE(fresh->step(100).ok());
  EXPECT_EQ(sim->latest().hash(), fresh->latest().hash());
}

TEST(Divergence, AutoResetIsOffOnThePrivateCopyOnly) {
  auto world = world_from_mjcf(kExplodes);
  auto sim = make_simulator(world, lockstep());
  int flags = 0;
  ASSERT_TRUE(
      sim->set_step_hook([&flags](const mjModel* m, mjData*) { flags = m->opt.disableflags; })
          .ok());
  sim->start();
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_NE(flags & mjDSBL_AUTORESET, 0);
  EXPECT_EQ(world->model->opt.disableflags & mjDSBL_AUTORESET, 0);
}

}  // namespace
}  // namespace gloam
