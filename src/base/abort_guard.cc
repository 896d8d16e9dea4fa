#include "base/abort_guard.h"

#include <setjmp.h>
#include <signal.h>

#include <mutex>

namespace gloam {
namespace {

thread_local jmp_buf* abort_point = nullptr;
struct sigaction previous_action = {};

void on_abort(int signal) {
  if (abort_point != nullptr) _longjmp(*abort_point, 1);
  ::sigaction(signal, &previous_action, nullptr);  // abort() raises it again
  if (previous_action.sa_handler != SIG_DFL && previous_action.sa_handler != SIG_IGN)
    ::raise(signal);
}

void install() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action = {};
    action.sa_handler = on_abort;
    action.sa_flags = SA_NODEFER;  // the jump leaves the handler: the next abort must come through
    ::sigaction(SIGABRT, &action, &previous_action);
  });
}

}  // namespace

namespace detail {

[[gnu::noinline]] void call_as_outermost(void (*call)(void*), void* context) {
#if defined(__x86_64__)
  asm volatile(".cfi_undefined rip");
#elif defined(__aarch64__)
  asm volatile(".cfi_undefined x30");
#endif
  call(context);
  asm volatile("" ::: "memory");  // no tail call
}

// Locals that change after _setjmp would be indeterminate after a jump: there are none.
bool run_without_abort(void (*call)(void*), void* context) {
  install();
  jmp_buf here;
  jmp_buf* const outer = abort_point;
  abort_point = &here;
  if (_setjmp(here) != 0) {
    abort_point = outer;
    return false;
  }
  call_as_outermost(call, context);
  abort_point = outer;
  return true;
}

}  // namespace detail
}  // namespace gloam
