#pragma once
// What the test program asks of the heap.

#include <atomic>
#include <cstddef>

namespace gloam {

/// The largest piece of memory that anyone has asked for by `new` since this was set to 0.
extern std::atomic<size_t> largest_request;

}  // namespace gloam
