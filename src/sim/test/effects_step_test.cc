// How a step with effects is put together from MuJoCo's halves of one.

#include "sim/loop/stepper.h"
#include "test_world.h"

namespace gloam {
namespace {

// A change of inertia between the halves, M made anew, is the same as one before the whole step.
TEST(EffectsStep, HalvesWithNewInertiaAreAWholeStepBitForBit) {
  for (const mjtIntegrator integrator : {mjINT_EULER, mjINT_IMPLICITFAST, mjINT_IMPLICIT}) {
    for (const mjtSolver solver : {mjSOL_NEWTON, mjSOL_CG}) {
      auto whole = world_from_mjcf(kRichModel), halves = world_from_mjcf(kRichModel);
      DataPtr a(mj_makeData(whole->model.get())), b(mj_makeData(halves->model.get()));
      for (mjModel* m : {whole->model.get(), halves->model.get()})
        m->opt.integrator = integrator, m->opt.solver = solver;
      for (int step = 0; step < 300; ++step) {
        mjModel &ma = *whole->model, &mb = *halves->model;
        for (int i = 0; i < ma.nu; ++i) a->ctrl[i] = b->ctrl[i] = random_control(step, i);
        mj_step1(&mb, b.get());
        for (int dof = 0; dof < ma.nv; ++dof) {
          const double more = 0.01 * (1 + random_control(step, 100 + dof));
          ma.dof_armature[dof] += more, ma.dof_M0[dof] += more;
          mb.dof_armature[dof] += more, mb.dof_M0[dof] += more;
        }
        mj_makeM(&mb, b.get());
        mj_factorM(&mb, b.get());
        mj_step2(&mb, b.get());
        mj_step(&ma, a.get());
        for (int i = 0; i < ma.nq; ++i) ASSERT_EQ(a->qpos[i], b->qpos[i]) << step << " " << i;
        for (int i = 0; i < ma.nv; ++i) ASSERT_EQ(a->qvel[i], b->qvel[i]) << step << " " << i;
        for (int i = 0; i < ma.nsensordata; ++i) ASSERT_EQ(a->sensordata[i], b->sensordata[i]);
      }
    }
  }
}

/// A ball on sand and one in water, far apart.
std::shared_ptr<CompiledWorld> sand_and_water(const std::string& option) {
  auto world = world_from_mjcf("<mujoco><option timestep='0.002' " + option + R"(/><worldbody>
    <geom type="plane" size="9 9 .1" pos="0 0 -1"/>
    <body pos="0 0 .05"><freejoint/><geom size=".05" mass="2"/></body>
    <body pos="5 0 .05"><freejoint/><geom size=".1" density="400"/></body></worldbody></mujoco>)");
  Scene scene;
  SoilOptions bed;
  bed.name = "bed", bed.kind = "dry_sand", bed.depth = 0.5, bed.size = {1, 1};
  scene.soils = {bed};
  world->soils = *describe_soils(scene, *world->model);
  WaterOptions pool;
  pool.name = "pool", pool.position = {5, 0, 0}, pool.size = {2, 2}, pool.depth = 0.8;
  scene.waters = {pool};
  world->waters = *describe_waters(scene);
  return world;
}

// With solvers and integrators that need a whole step, too.
TEST(EffectsStep, ForcesOfOthersStayAsTheyAreAndBodiesComeToRestWhateverTheSolver) {
  for (const char* option :
       {"", "integrator='RK4'", "solver='PGS'", "integrator='implicit' noslip_iterations='3'"}) {
    auto stepper = Stepper::create(sand_and_water(option), 1, {});
    ASSERT_TRUE(stepper.ok());
    mjData& d = (*stepper)->data();
    d.qfrc_applied[2] = -0.125;
    d.xfrc_applied[8] = -0.25;
    for (int i = 0; i < 3000; ++i) ASSERT_TRUE((*stepper)->step());
    EXPECT_EQ(d.qfrc_applied[2], -0.125) << option;
    EXPECT_EQ(d.qfrc_applied[8], 0) << option;
    EXPECT_EQ(d.xfrc_applied[8], -0.25) << option;
    for (int dof = 0; dof < 12; ++dof)
      EXPECT_NEAR(d.qvel[dof], 0, dof < 6 ? 0.02 : 0.15) << option << " " << dof;
    EXPECT_LT(d.qpos[2], 0.05) << option << ": it sinks into sand";
    EXPECT_GT(d.qpos[2], 0) << option;
    EXPECT_NEAR(d.qpos[9], 0.0134, 0.005) << option << ": it floats";  // of a ball of 0.4
  }
}

}  // namespace
}  // namespace gloam
