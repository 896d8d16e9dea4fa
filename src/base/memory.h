#pragma once
// Memory that is still available. Linux promises memory that it has not, and ends the process that
// then uses it: a user's demand is compared with this before it is taken.

#include <cstdint>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "gloam/result.h"

namespace gloam {

struct MemoryRoom {
  uint64_t bytes = UINT64_MAX;  ///< that this process may still take
  std::string limit;            ///< the limit that sets that bound, after "within"; empty: unknown
};

/// The least of: memory of the machine that is free or can be freed, what is left of the limits of
/// the process's control groups (version 1 and 2), and of its own limits (ulimit -v, ulimit -d).
/// `root`: where proc/ and sys/ are.
MemoryRoom memory_room(const std::filesystem::path& root = "/");

/// Ends the process: "out of memory" on stderr, exit code 1, for where no value can tell of it.
/// `who`: "" or ", in MuJoCo". Takes none itself; may be called in a signal's handler.
[[noreturn]] void end_out_of_memory(const char* who);

/// Error (kInput): no memory for `what`.
Error no_memory_for(const std::string& what);

/// Is it a thread that found no room for its stack?
bool is_want_of_memory(const std::system_error& error);

/// Calls f(), which returns a Result or Status; want of memory in it becomes no_memory_for(what).
template <class F>
auto or_no_memory(const char* what, F&& f) -> decltype(f()) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
  } catch (const std::system_error& error) {
    if (!is_want_of_memory(error)) throw;
  }
  return no_memory_for(what);
}

/// Error (kInput) naming the need and the room if `bytes` are more than there is room for. `what`
/// needs them; `hint`: how to need less.
Status check_memory(uint64_t bytes, const std::string& what, const std::string& hint);

}  // namespace gloam
