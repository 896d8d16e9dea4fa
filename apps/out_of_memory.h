#pragma once
// Want of memory, wherever it shows.

#include <system_error>

namespace gloam::cli {

/// From now on an exception for want of memory that nobody catches, on whichever thread or out of
/// a library's callback, ends the process with a message and exit code 1.
void end_when_out_of_memory();

[[noreturn]] void end_out_of_memory();

/// Is it a thread that found no room for its stack?
bool is_want_of_memory(const std::system_error& error);

}  // namespace gloam::cli
