#pragma once
// The program itself: version, where its files are, its logging, threads and cache.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// One kind of what is kept on disk so that a second start is faster.
struct CacheKind {
  std::string name;  ///< "models", "visuals"
  std::string what;  ///< for people
  std::filesystem::path folder;
  int64_t entries = 0;
  uint64_t bytes = 0;  ///< with what is being written
  /// Time of use of an entry.
  std::optional<std::chrono::system_clock::time_point> oldest_use, newest_use;
};
struct CacheInfo {
  std::filesystem::path folder;  ///< $GLOAM_CACHE, else $XDG_CACHE_HOME/gloam, else ~/.cache/gloam
  uint64_t limit_bytes = 0;      ///< limit for all kinds together: $GLOAM_CACHE_SIZE, else 10 GiB
  std::vector<CacheKind> kinds;
};
/// Bytes that all entries together may have: $GLOAM_CACHE_SIZE, as 500M or 20G (powers of 1024), 0
/// for none, else 10 GiB. Errors: it is set to what is no size.
Result<uint64_t> cache_limit();
/// Errors: a folder that cannot be read, those of cache_limit().
Result<CacheInfo> cache_info();
/// Removes all entries, or those of one kind, and says what they were; files that are no entries
/// stay. Errors: there is no such kind, a folder or an entry that may not be changed.
Result<std::vector<CacheKind>> clear_cache(std::string_view kind = {});

/// Threads for rendering and loading; 0 = all processors. Results do not depend on it.
void set_thread_count(int n);

}  // namespace gloam
