#include "allocation_count.h"

#include <features.h>
#include <cstddef>

namespace {
thread_local long g_allocations = 0;
}

#if defined(__GLIBC__) && !defined(GLOAM_SANITIZED)
extern "C" void* __libc_malloc(size_t size);  // NOLINT: glibc's own name
extern "C" void* malloc(size_t size) {
  ++g_allocations;
  return __libc_malloc(size);
}
#endif

namespace gloam {

long allocation_count() { return g_allocations; }

bool counts_allocations() {
#if defined(__GLIBC__) && !defined(GLOAM_SANITIZED)
  return true;
#else
  return false;
#endif
}

}  // namespace gloam
