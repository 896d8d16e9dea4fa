// A simulation that goes on in another World keeps nothing of the one before but what compiles to
// it, from which a checkpoint can still step the run again.

#include "gloam/simulation.h"
#include "scene/test/temp_folder.h"
#include "test_world.h"

namespace gloam {
namespace {

TEST(ReleasedWorlds, AreFreedWithTheirLastSnapshot) {
  const auto sim = make_simulator(world_from_mjcf(kRichModel), lockstep());
  sim->start();
  std::weak_ptr<const CompiledWorld> before = sim->world();
  Snapshot last = sim->latest();
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(sim->recompile(world_from_mjcf(kRichModel), {}).ok());
    ASSERT_TRUE(sim->step().ok());
    EXPECT_FALSE(before.expired()) << "a Snapshot of it is held";
    last = sim->latest();
    EXPECT_TRUE(before.expired()) << "recompile " << i;
    before = sim->world();
  }
}

}  // namespace
}  // namespace gloam
