// control() must not allocate. Counts every malloc of this program's threads (operator new and
// Eigen end there); glibc only, and not under sanitizers, which bring their own malloc.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "control/trot.h"
#include "control/trot_options.h"
#include "trot_robots.h"

#if defined(__GLIBC__) && !defined(GLOAM_SANITIZED)

namespace {
thread_local long g_allocations = 0;
}
extern "C" void* __libc_malloc(size_t size);  // NOLINT: glibc's own name
extern "C" void* malloc(size_t size) {
  ++g_allocations;
  return __libc_malloc(size);
}

namespace gloam {
namespace {

TEST(TrotAllocation, ControlNeverAllocates) {
  const ModelPtr model = load_quadruped();
  auto trot = make_trot_controller(*model, robot_instance(*model), TrotOptions{});
  ASSERT_TRUE(trot.ok());
  TestData data(mj_makeData(model.get()));
  mj_resetDataKeyframe(model.get(), data.get(), 0);
  mj_forward(model.get(), data.get());
  (*trot)->reset(model.get(), data.get());
  long inside = 0;
  for (int step = 0; step < 1500; ++step) {
    const long before = g_allocations;
    (*trot)->control({model.get(), data.get(), {}, step, 0.002, {step < 1000 ? 0.5 : 0.0, 0, 0.3}});
    inside += g_allocations - before;
    mj_step(model.get(), data.get());
  }
  EXPECT_EQ(inside, 0);
  const long before = g_allocations;
  delete new int(1);
  Eigen::MatrixXd heap(8, 8);
  EXPECT_GE(g_allocations - before, 1) << "the counter does not count";
}

}  // namespace
}  // namespace gloam

#endif
