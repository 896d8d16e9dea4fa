#pragma once
// The only way to use many threads. The name documents the call; nothing reads it at run time.

#include <cstdint>
#include <functional>

#include "gloam/program.h"

namespace gloam {

/// Calls f(begin, end) over disjoint ranges that cover [0, n), on several threads; returns when all
/// are done. `grain` = smallest range worth a task. f must not depend on how the range is split.
/// The first exception that leaves f is thrown to the caller; ranges not begun by then are left
/// out.
void parallel_for_range(const char* name, int64_t n, int64_t grain,
                        const std::function<void(int64_t begin, int64_t end)>& f);

/// Calls f(i) for every i in [0, n) on several threads.
template <class F>
void parallel_for(const char* name, int64_t n, F&& f) {
  parallel_for_range(name, n, 1, [&f](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) f(i);
  });
}

/// Number of threads parallel_for may use; default: the machine's processors. 0 restores the
/// default.
void set_thread_count(int n);
int thread_count();

}  // namespace gloam
