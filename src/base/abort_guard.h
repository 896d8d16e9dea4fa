#pragma once
// Calls into a C++ library that has a runtime of its own (MuJoCo's spec functions): an exception
// that the library does not catch, which is want of memory, ends in its std::terminate() and so in
// abort(), since its unwinder cannot pass our frames. Here that becomes std::bad_alloc of our own.

#include <new>
#include <type_traits>

namespace gloam {
namespace detail {
/// Calls call(context) with no caller known above it, so that an unwinder ends its search there.
void call_as_outermost(void (*call)(void*), void* context);
/// False: abort() was called on this thread, in call(context).
bool run_without_abort(void (*call)(void*), void* context);
}  // namespace detail

/// Calls f(); throws std::bad_alloc if the library calls abort() on this thread meanwhile. The
/// abort jumps over the frames between here and the library: f may only call C functions, and must
/// hold no object with a destructor, no lock and no thread. What f was changing is in an unknown
/// state: throw it away. Costs nanoseconds.
template <class F>
void call_or_no_memory(F&& f) {
  using Callable = std::remove_reference_t<F>;
  if (!detail::run_without_abort([](void* context) { (*static_cast<Callable*>(context))(); },
                                 const_cast<std::remove_const_t<Callable>*>(&f)))
    throw std::bad_alloc();
}

}  // namespace gloam
