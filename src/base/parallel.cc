#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <memory>
#include <mutex>

namespace gloam {
namespace {
std::mutex limit_mutex;
std::unique_ptr<tbb::global_control> limit;  // TBB honours the smallest live limit
std::atomic<int> limit_count{0};
}  // namespace

void set_thread_count(int n) {
  const std::lock_guard lock(limit_mutex);
  limit.reset();
  limit_count = n > 0 ? n : 0;
  if (n > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<size_t>(n));
  }
}

int thread_count() {
  const int n = limit_count;
  return n > 0 ? n : tbb::info::default_concurrency();
}

void parallel_for_range(const char* /*name*/, int64_t n, int64_t grain,
                        const std::function<void(int64_t, int64_t)>& f) {
  if (n <= 0) return;
  if (n <= grain || thread_count() == 1) {
    f(0, n);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<int64_t>(0, n, static_cast<size_t>(grain)),
      [&f](const tbb::blocked_range<int64_t>& range) { f(range.begin(), range.end()); });
}

}  // namespace gloam
