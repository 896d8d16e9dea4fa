#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <new>

namespace gloam {
namespace {
std::mutex limit_mutex;
std::unique_ptr<tbb::global_control> limit;  // TBB honours the smallest live limit
std::atomic<int> limit_count{0};

/// TBB puts the caller before the tasks and the tasks before its return. ThreadSanitizer does not
/// see into TBB; it sees `order`. Exceptions are carried here: TBB would allocate for one, which
/// fails where the exception tells of no memory.
struct Job {
  const std::function<void(int64_t, int64_t)>* f;
  std::atomic<int> order;
  std::atomic<bool> failed{false};
  std::exception_ptr first_error;  // once failed
};

void run_range(void* context, int64_t begin, int64_t end) {
  Job& job = *static_cast<Job*>(context);
  job.order.load(std::memory_order_acquire);
  try {
    if (!job.failed.load(std::memory_order_relaxed)) (*job.f)(begin, end);
  } catch (...) {
    if (!job.failed.exchange(true)) job.first_error = std::current_exception();
  }
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
  Job job{.f = &f, .order = 0, .failed = false, .first_error = nullptr};
  job.order.store(0, std::memory_order_release);
  try {
    run_in_tbb(n, grain, run_range, &job);
  } catch (const std::exception&) {  // of TBB's own: no memory for its tasks or threads
    if (!job.failed) throw std::bad_alloc();
  }
  job.order.load(std::memory_order_acquire);
  if (job.failed) std::rethrow_exception(job.first_error);
}

}  // namespace gloam
