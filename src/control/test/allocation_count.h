#pragma once
// Counts allocations, for tests that control() makes none.

namespace gloam {

/// Calls of malloc by this thread so far; operator new and Eigen end there. Never changes where
/// counts_allocations() is false.
long allocation_count();
/// glibc only, and not under sanitizers, which bring their own malloc.
bool counts_allocations();

}  // namespace gloam
