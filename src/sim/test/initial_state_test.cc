// Runs begin in the World's initial keyframe. How scenes make one of their robots' keyframes is
// tested in world/.

#include "test_world.h"

namespace gloam {
namespace {

const char* const kLeg =
    R"(<mujoco><worldbody><body name="base"><freejoint name="f"/><geom size=".1"/>
  <body name="leg" pos="0 0 -.2"><joint name="h" axis="0 1 0"/><geom size=".05"/></body></body></worldbody>
  <actuator><position name="h" joint="h" kp="5"/></actuator>
  <keyframe><key name="stand" qpos="0 0 .5 1 0 0 0 .7" qvel="1 0 0 0 0 0 0" ctrl=".7"/></keyframe></mujoco>)";

TEST(InitialState, TheInitialKeyframeIsTakenWhole) {
  auto world = world_from_mjcf(kLeg);
  world->initial_key = 0;
  auto sim = make_simulator(world, lockstep());
  DataPtr d(mj_makeData(world->model.get()));
  mj_resetDataKeyframe(world->model.get(), d.get(), 0);
  const Snapshot s = sim->latest();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(s.state()[static_cast<size_t>(1 + i)], d->qpos[i]);
  EXPECT_EQ(s.control(Actuator{0}), .7);
}

TEST(InitialState, WithoutOneItIsTheModelsDefault) {
  auto sim = make_simulator(world_from_mjcf(kLeg), lockstep());
  EXPECT_EQ(sim->latest()[Joint{0}].qpos[2], 0);
  EXPECT_EQ(sim->latest().control(Actuator{0}), 0);
}

}  // namespace
}  // namespace gloam
