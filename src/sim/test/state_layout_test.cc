// Our order of the state is MuJoCo's.

#include "sim/state/state_layout.h"

#include "test_world.h"

namespace gloam {
namespace {

// Every component but plugins: activation, history, mocap, user data, equalities, plastic springs.
const char* const kAllParts = R"(<mujoco><size nuserdata="3"/><worldbody>
  <body pos="0 0 1"><freejoint/><geom size=".1"/></body>
  <body name="h" mocap="true" pos="1 2 3"><geom size=".1" contype="0" conaffinity="0"/></body>
  <body><joint name="j" axis="0 1 0" stiffness="3" springyield=".1"/><geom size=".1" pos=".2 0 0"/></body>
  <body pos="0 1 0"><joint name="k" axis="0 1 0"/><geom size=".1" pos=".2 0 0"/></body></worldbody>
  <equality><joint joint1="j" joint2="k"/><joint joint1="k" active="false"/></equality>
  <actuator><general joint="j" dyntype="filter" dynprm=".1"/><motor joint="k" delay=".004" nsample="3"/></actuator>
  <sensor><jointpos joint="j" delay=".004" nsample="2"/></sensor></mujoco>)";

TEST(StateReader, ReadsWhatMjGetStateReads) {
  for (const char* xml : {kAllParts, kRichModel}) {
    auto world = world_from_mjcf(xml);
    const mjModel& m = *world->model;
    DataPtr d(mj_makeData(&m));
    if (xml == kAllParts) {
      for (int bit = 0; bit < mjNSTATE; ++bit) {
        if ((1 << bit) == mjSTATE_PLUGIN) continue;
        EXPECT_GT(mj_stateSize(&m, 1 << bit), 0) << bit;
      }
    }
    for (int i = 0; i < m.nuserdata; ++i) d->userdata[i] = 7 + i;
    for (int i = 0; i < 6 * m.nbody; ++i) d->xfrc_applied[i] = 1e-3 * i;
    for (int i = 0; i < m.nv; ++i) d->qfrc_applied[i] = 1e-2 * i;
    for (int n = 0; n < 20; ++n) {
      for (int i = 0; i < m.nu; ++i) d->ctrl[i] = random_control(n, i);
      mj_step(&m, d.get());
    }
    std::vector<double> expected(static_cast<size_t>(state_size(m))), got(expected.size(), -1);
    mj_getState(&m, d.get(), expected.data(), mjSTATE_INTEGRATION);
    StateReader(m, *d).read(got.data());
    EXPECT_EQ(got, expected);
    const auto warm = state_part(m, expected, mjSTATE_WARMSTART);
    EXPECT_TRUE(std::equal(warm.begin(), warm.end(), d->qacc_warmstart));
    const auto xfrc = state_part(m, expected, mjSTATE_XFRC_APPLIED);
    EXPECT_TRUE(std::equal(xfrc.begin(), xfrc.end(), d->xfrc_applied));
  }
}

}  // namespace
}  // namespace gloam
