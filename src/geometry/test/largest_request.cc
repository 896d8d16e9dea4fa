// Replaces the program's operator new; in a file of its own, so that none of it is inlined.

#include "geometry/test/largest_request.h"

#include <cstdlib>
#include <new>

namespace gloam {
std::atomic<size_t> largest_request{0};
}

void* operator new(size_t size) {
  size_t known = gloam::largest_request.load();
  while (size > known && !gloam::largest_request.compare_exchange_weak(known, size)) {
  }
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
// std::stable_sort and its like ask this one, and give back to the one below.
void* operator new(size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
