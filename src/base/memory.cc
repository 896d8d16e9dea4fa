#include "base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <sstream>

namespace gloam {
namespace fs = std::filesystem;
namespace {

uint64_t less(uint64_t a, uint64_t b) { return a > b ? a - b : 0; }

/// The number in a file of its own; false: none ("max", or no such file).
bool read_number(const fs::path& path, uint64_t* out) {
  std::ifstream in(path);
  return static_cast<bool>(in >> *out);
}

/// The number behind a name at the start of a line.
uint64_t number_of(const fs::path& path, const std::string& name, uint64_t otherwise) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    uint64_t value = 0;
    if (words >> first >> value && first == name) return value;
  }
  return otherwise;
}

void bound(uint64_t bytes, const char* limit, MemoryRoom* room) {
  if (bytes < room->bytes) *room = {bytes, limit};
}

/// Bounds by one group and all that it is in. Where the process sees a part of the tree only
/// (containers), its path may not exist there: then the part's root counts.
void bound_by_group(const fs::path& mount, const std::string& group, const char* limit_file,
                    const char* usage_file, const char* cache_name, MemoryRoom* room) {
  fs::path path = mount / fs::path(group).relative_path();
  for (;; path = path.parent_path()) {
    uint64_t limit = 0, usage = 0;
    if (read_number(path / limit_file, &limit) && read_number(path / usage_file, &usage)) {
      const uint64_t cache = number_of(path / "memory.stat", cache_name, 0);  // can be freed
      bound(less(limit, less(usage, cache)), "the memory limit of its control group", room);
    }
    if (path == mount || path == path.parent_path()) return;
  }
}

void bound_by_groups(const fs::path& root, MemoryRoom* room) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {  // "4:memory:/a/b", version 2: "0::/a/b"
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string kinds = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string group = line.substr(second + 1);
    if (kinds == ",,")
      bound_by_group(root / "sys/fs/cgroup", group, "memory.max", "memory.current", "inactive_file",
                     room);
    if (kinds.find(",memory,") != std::string::npos)
      bound_by_group(root / "sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                     "memory.usage_in_bytes", "total_inactive_file", room);
  }
}

void bound_by_own_limits(const fs::path& root, MemoryRoom* room) {
  const fs::path status = root / "proc/self/status";
  const auto bound_by = [&](auto resource, const char* used, const char* name) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    bound(less(limit.rlim_cur, 1024 * number_of(status, used, 0)), name, room);
  };
  bound_by(RLIMIT_AS, "VmSize:", "its address space limit (ulimit -v)");
  bound_by(RLIMIT_DATA, "VmData:", "its data limit (ulimit -d)");
}

}  // namespace

MemoryRoom memory_room(const fs::path& root) {
  MemoryRoom room;
  constexpr uint64_t kUnknown = UINT64_MAX / 1024;
  const uint64_t available = number_of(root / "proc/meminfo", "MemAvailable:", kUnknown);
  if (available != kUnknown) bound(1024 * available, "the machine's free memory", &room);
  bound_by_groups(root, &room);
  bound_by_own_limits(root, &room);
  return room;
}

void end_out_of_memory(const char* who) {
  const auto put = [](const char* text) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
  };
  put("gloam: error: out of memory");
  put(who);
  put(" (lower the resolution or the size of the scene)\n");
  ::_exit(1);
}

Error no_memory_for(const std::string& what) {
  return {ErrorKind::kInput,
          "out of memory for " + what,
          {},
          "give the process more memory, or lower the resolution or the size of the scene"};
}

// pthread_create reports EAGAIN.
bool is_want_of_memory(const std::system_error& error) {
  return error.code() == std::errc::resource_unavailable_try_again ||
         error.code() == std::errc::not_enough_memory;
}

Status check_memory(uint64_t bytes, const std::string& what, const std::string& hint) {
  constexpr uint64_t kUncheckedBytes = 16 << 20;  // not worth the look
  if (bytes <= kUncheckedBytes) return {};
  const MemoryRoom room = memory_room();
  if (bytes <= room.bytes) return {};
  const auto gib = [](uint64_t n) { return static_cast<double>(n) / (1 << 30); };
  return Error{
      ErrorKind::kInput,
      fmt::format(
          "{} needs about {:.1f} GiB of memory; the process can use {:.1f} GiB more within {}",
          what, gib(bytes), gib(room.bytes), room.limit),
      {},
      hint};
}

}  // namespace gloam
