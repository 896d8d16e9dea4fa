// Where memory ends: on parallel_for's threads, in libraries with a C++ runtime of their own, and
// at the borders where it becomes an error.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "base/abort_guard.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace gloam {
namespace {

TEST(ParallelFor, CarriesAnExceptionOfAnyThreadToTheCaller) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> thrown{0};
    EXPECT_THROW(parallel_for("test", 64,
                              [&](int64_t i) {
                                if (i % 7 != 3 && std::this_thread::get_id() == caller) return;
                                ++thrown;
                                throw std::bad_alloc();
                              }),
                 std::bad_alloc);
    EXPECT_GE(thrown, 1);
  }
}

TEST(ParallelFor, CarriesAnExceptionOutOfAnotherParallelFor) {
  EXPECT_THROW(parallel_for("outer", 16,
                            [&](int64_t i) {
                              parallel_for("inner", 16, [&](int64_t k) {
                                if (i == 5 && k == 11) throw std::bad_alloc();
                              });
                            }),
               std::bad_alloc);
  std::atomic<int> count{0};
  parallel_for("after", 100, [&](int64_t) { ++count; });
  EXPECT_EQ(count, 100) << "the next one is not disturbed";
}

TEST(AbortGuard, AnAbortBecomesAnExceptionAsOftenAsItComes) {
  for (int i = 0; i < 3; ++i) EXPECT_THROW(call_or_no_memory([] { std::abort(); }), std::bad_alloc);
  int calls = 0;
  call_or_no_memory([&] { ++calls; });
  EXPECT_EQ(calls, 1);
}

TEST(AbortGuard, GuardsNestAndBelongToOneThread) {
  call_or_no_memory([] {
    std::thread([] {
      EXPECT_THROW(call_or_no_memory([] { std::abort(); }), std::bad_alloc);
    }).join();
  });
}

TEST(AbortGuardDeathTest, OutsideOfAGuardAnAbortIsAnAbort) {
  EXPECT_EXIT(
      {
        try {
          call_or_no_memory([] { std::abort(); });
        } catch (const std::bad_alloc&) {
        }
        std::abort();
      },
      testing::KilledBySignal(SIGABRT), "");
}

TEST(OrNoMemory, TurnsWantOfMemoryIntoAnErrorThatNamesIt) {
  const auto run = [](auto&& f) { return or_no_memory("the picture", f); };
  EXPECT_TRUE(run([]() -> Status { return {}; }).ok());
  const Status none = run([]() -> Status { throw std::bad_alloc(); });
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().message, "out of memory for the picture");
  const std::error_code again = std::make_error_code(std::errc::resource_unavailable_try_again);
  EXPECT_FALSE(run([&]() -> Status { throw std::system_error(again); }).ok());
  const std::error_code other = std::make_error_code(std::errc::not_a_socket);
  EXPECT_THROW(static_cast<void>(run([&]() -> Status { throw std::system_error(other); })),
               std::system_error);
}

}  // namespace
}  // namespace gloam
