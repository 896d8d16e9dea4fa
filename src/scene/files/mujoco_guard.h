#pragma once
// MuJoCo reports fatal errors to a log handler that must not return. Ours is installed once for the
// process; it jumps back to the recovery point of the thread that called MuJoCo, so an error
// becomes a value. The mjData an error came out of is in an unknown state: throw it away.

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Installs the handler and turns MUJOCO_LOG.TXT off. Called by everything below; call it before
/// the first MuJoCo function that is not guarded. Thread-safe, cheap after the first time.
void install_mujoco_handler();

/// Message of the last guarded call of this thread that failed, until its next one.
const char* mujoco_error_message();

/// Message of MuJoCo as one line and without "XML Error: ".
std::string plain_message(std::string_view said);

/// Does MuJoCo say that it got no memory?
bool is_want_of_memory(std::string_view message);

/// Warnings that MuJoCo has logged in this process; mjData::warning counts them by type as well.
int64_t mujoco_warning_count();

/// Collects the warnings that MuJoCo logs on this thread, instead of printing them, while it lives.
/// Nested captures: the innermost gets them.
class MujocoWarningCapture {
 public:
  MujocoWarningCapture();
  ~MujocoWarningCapture();
  MujocoWarningCapture(const MujocoWarningCapture&) = delete;
  MujocoWarningCapture& operator=(const MujocoWarningCapture&) = delete;

  /// In order, at most 256.
  const std::vector<std::string>& messages() const { return messages_; }
  void add(const char* message);

 private:
  std::vector<std::string> messages_;
  MujocoWarningCapture* outer_;
};

namespace detail {
bool run_guarded(void (*call)(void*), void* context);
}

/// Calls f(). False when MuJoCo reported an error in it: see mujoco_error_message(). Allocates and
/// locks nothing, so it may stand in the step loop (a few nanoseconds). The error jumps over the
/// frames between here and MuJoCo: f may only call C functions, and must hold no object with a
/// destructor. No exception passes: one of MuJoCo's compiler, which is C++ inside and without
/// memory throws, ends the process with a message and exit code 1. Guarded calls nest. Only the
/// calling thread is covered, not MuJoCo's own pool.
template <class F>
bool try_mujoco(F&& f) {
  using Callable = std::remove_reference_t<F>;
  return detail::run_guarded([](void* context) { (*static_cast<Callable*>(context))(); },
                             const_cast<std::remove_const_t<Callable>*>(&f));
}

/// try_mujoco with MuJoCo's message as an Error of `kind`.
template <class F>
Status guarded(F&& f, ErrorKind kind = ErrorKind::kInput) {
  if (try_mujoco(f)) return {};
  return Error{kind, mujoco_error_message()};
}

}  // namespace gloam
