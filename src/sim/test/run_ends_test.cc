// A time that goes on over resets: no instant of a run lies before the end of the run before.
#include "sim/loop/run_ends.h"

#include "test_world.h"

namespace gloam {
namespace {

TEST(RunEnds, ARunBeginsWhereTheOneBeforeEnded) {
  RunEnds ends;
  EXPECT_EQ(ends.start_of(0), 0);
  ends.end_run(1.5);
  ends.end_run(0);
  ends.end_run(2);
  EXPECT_EQ(ends.start_of(0), 0);
  EXPECT_EQ(ends.start_of(1), 1.5);
  EXPECT_EQ(ends.start_of(2), 1.5);
  EXPECT_EQ(ends.start_of(3), 3.5);
  EXPECT_EQ(ends.start_of(-1), 3.5);
}

// A log's threads ask while the last instants of a run still wait to be written.
TEST(RunEnds, ASimulatorTellsThemWhenItHasReset) {
  const auto world = world_from_mjcf(
      "<mujoco><option timestep=\"0.01\"/><worldbody><body><freejoint/><geom size=\".1\"/></body>"
      "</worldbody></mujoco>");
  const std::unique_ptr<Simulator> sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(12).ok());
  ASSERT_TRUE(sim->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(sim->step(5).ok());
  const int64_t run = sim->latest().data().run;
  EXPECT_EQ(run, 1);
  EXPECT_NEAR(sim->run_ends().start_of(run), 0.12, 1e-12);
  EXPECT_EQ(sim->run_ends().start_of(0), 0);
}

}  // namespace
}  // namespace gloam
