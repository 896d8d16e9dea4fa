// MuJoCo without memory: an error or an exception of ours, at every further call, too.
#include <sys/resource.h>

#include <fstream>

#include "places/writer/spec_edit.h"
#include "test_world.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

/// From now on this process gets `bytes` more and then no memory. For a child process: it ends with
/// the code that the checks give.
void leave_memory(rlim_t bytes) {
  std::ifstream in("/proc/self/statm");
  rlim_t pages = 0;
  in >> pages;
  const rlim_t limit = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
  const rlimit tight{limit, limit};
  setrlimit(RLIMIT_AS, &tight);
}

constexpr rlim_t kLittle = 32 << 20;

#ifndef GLOAM_SANITIZED  // whose malloc needs address space without bound

TEST(WantOfMemoryDeathTest, AnInstantThatCannotBeSolvedIsAnErrorEachTime) {
  const auto compiled = world_from_mjcf(R"(
    <mujoco><size memory="512M"/><worldbody><body><freejoint/><geom size=".1"/></body></worldbody></mujoco>)");
  const auto sim = make_simulator(compiled, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(1).ok());
  const Snapshot snapshot = sim->latest();
  EXPECT_EXIT(
      {
        leave_memory(kLittle);
        Instant instant;
        for (int i = 0; i < 3; ++i) {
          const Status status = instant.solve(snapshot);
          if (status.ok() || status.error().message.find("memory") == std::string::npos) _exit(1);
        }
        _exit(0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(WantOfMemoryDeathTest, AMeshThatASpecCannotHoldIsBadAlloc) {
  const std::vector<float> vertices(30'000'000);  // 120 MB
  EXPECT_EXIT(
      {
        const SpecPtr spec(mj_makeSpec());
        mjsMesh* mesh = edit(mjs_addMesh, spec.get(), nullptr);
        leave_memory(kLittle);
        for (int i = 0; i < 3; ++i) {
          try {
            edit(mjs_setFloat, mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
            _exit(1);
          } catch (const std::bad_alloc&) {
          }
        }
        _exit(0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(WantOfMemoryDeathTest, DataThatIsNotThereIsBadAlloc) {
  const auto compiled = world_from_mjcf(
      "<mujoco><size memory='512M'/><worldbody><geom size='.1'/></worldbody></mujoco>");
  EXPECT_EXIT(
      {
        leave_memory(kLittle);
        try {
          static_cast<void>(make_data(*compiled->model));
        } catch (const std::bad_alloc&) {
          _exit(0);
        }
        _exit(1);
      },
      testing::ExitedWithCode(0), "");
}

#endif

}  // namespace
}  // namespace gloam
