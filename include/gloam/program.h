#pragma once
// The program itself: version, where its files are, its logging and threads.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

/// "0.1.0"
const char* version();
/// Compiler, instruction set, build type and the versions of MuJoCo and Embree: what determinism is
/// relative to.
std::string configuration();
/// The folder that holds `assets/`: $GLOAM_HOME, else found upwards from the running program or
/// from the library that it uses, as the source tree or as share/gloam/ of an installation.
Result<std::filesystem::path> gloam_home();

enum class LogLevel { kDebug, kInfo, kWarning, kError, kOff };
/// Lowest level that is printed to stderr; default kInfo.
void set_log_level(LogLevel level);

/// "did you mean 'x'?", the candidate nearest to `word`; or, when nothing is close and the list is
/// short, "one of: a, b, c"; may be empty.
std::string suggest_name(std::string_view word, std::span<const std::string> candidates);

/// Threads for rendering and loading; 0 = all processors. Results do not depend on it.
void set_thread_count(int n);

}  // namespace gloam
