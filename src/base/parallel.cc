#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <atomic>
#include <memory>
#include <mutex>

namespace gloam {
namespace {
std::mutex limit_mutex;
std::unique_ptr<tbb::global_control> limit;  // TBB honours the smallest live limit
std::atomic<int> limit_count{0};

/// TBB puts the caller before the tasks and the tasks before its return. ThreadSanitizer does not
/// see into TBB; it sees `order`.
struct Job {
  const std::function<void(int64_t, int64_t)>* f;
  std::atomic<int> order;
};

void run_range(void* context, int64_t begin, int64_t end) {
  Job& job = *static_cast<Job*>(context);
  job.order.load(std::memory_order_acquire);
  (*job.f)(begin, end);
  job.order.fetch_add(1, std::memory_order_release);
}
}  // namespace

// parallel_tbb.cc
void run_in_tbb(int64_t n, int64_t grain, void (*run)(void* job, int64_t begin, int64_t end),
                void* job);

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
  Job job{&f};
  job.order.store(0, std::memory_order_release);
  run_in_tbb(n, grain, run_range, &job);
  job.order.load(std::memory_order_acquire);
}

}  // namespace gloam
