#pragma once
// The program itself: version, location of its files, logging, threads and cache.

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
/// Compiler, instruction set, build type and the versions of MuJoCo and Embree: results are
/// deterministic for one such configuration.
std::string configuration();
/// The folder that contains `assets/`: $GLOAM_HOME or, if that is not set, the source tree or the
/// share/gloam/ of an installation, found upwards from the running program or its library.
Result<std::filesystem::path> gloam_home();

enum class LogLevel { kDebug, kInfo, kWarning, kError, kOff };
/// Lowest level that is printed to stderr; default kInfo.
void set_log_level(LogLevel level);

/// Returns "did you mean 'x'?" with the candidate nearest to `word` or, if none is close and the
/// list is short, "one of: a, b, c"; may be empty.
std::string suggest_name(std::string_view word, std::span<const std::string> candidates);

/// One kind of data cached on disk to make later starts faster.
struct CacheKind {
  std::string name;  ///< "models", "visuals"
  std::string what;  ///< description for display
  std::filesystem::path folder;
  int64_t entries = 0;
  uint64_t bytes = 0;  ///< including entries that are being written
  /// Times at which entries were used.
  std::optional<std::chrono::system_clock::time_point> oldest_use, newest_use;
};
struct CacheInfo {
  std::filesystem::path folder;  ///< $GLOAM_CACHE, else $XDG_CACHE_HOME/gloam, else ~/.cache/gloam
  uint64_t limit_bytes = 0;      ///< limit for all kinds together: $GLOAM_CACHE_SIZE, else 10 GiB
  std::vector<CacheKind> kinds;
};
/// Limit for all entries together, in bytes: $GLOAM_CACHE_SIZE, such as 500M or 20G (powers of
/// 1024; 0 = no cache), 10 GiB by default. Errors: the variable is not a valid size.
Result<uint64_t> cache_limit();
/// Errors: a folder that cannot be read; as for cache_limit().
Result<CacheInfo> cache_info();
/// Removes all entries, or all of one kind, and returns the removed ones by kind. Files that are
/// not entries stay. Errors: no such kind, a folder or entry that cannot be changed.
Result<std::vector<CacheKind>> clear_cache(std::string_view kind = {});

/// Sets the number of threads for rendering and loading; 0 = all processors. Results do not depend
/// on it.
void set_thread_count(int n);

}  // namespace gloam
