// TBB's task tree lies in its headers and orders itself by what ThreadSanitizer does not see in
// libtbb: this file alone is not built with it (CMakeLists.txt).

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>

namespace gloam {

void run_in_tbb(int64_t n, int64_t grain, void (*run)(void* job, int64_t begin, int64_t end),
                void* job) {
  tbb::parallel_for(
      tbb::blocked_range<int64_t>(0, n, static_cast<size_t>(grain)),
      [=](const tbb::blocked_range<int64_t>& range) { run(job, range.begin(), range.end()); });
}

}  // namespace gloam
