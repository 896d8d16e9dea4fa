#include "base/cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/text.h"
#include "gloam/program.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr std::array kFormats = {kModelCache, kVisualCache, kBvhCache,  kPatternCache,
                                 kLightCache, kHullCache,   kSceneCache};
constexpr size_t kHeadSize = 2 * sizeof(uint64_t);  // the format's number, the hash of the rest
constexpr size_t kHashedPiece = size_t{16} << 20;
constexpr uint64_t kDefaultSizeLimit = uint64_t{10} << 30;
// Older than that, what a writer has left aside is of one that died.
constexpr std::chrono::hours kLongestWrite{1};

struct Entry {
  fs::path path;
  std::chrono::system_clock::time_point used;
  uint64_t bytes;
  bool is_whole;  // else a writer's, before it is renamed
};

bool is_hex(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

// "0123456789abcdef.world", or while it is written "0123456789abcdef.world.89ab.tmp".
bool is_entry_name(const CacheFormat& format, std::string_view name, bool* is_whole) {
  constexpr size_t kDigits = 16;
  if (name.size() < kDigits || !is_hex(name.substr(0, kDigits))) return false;
  name.remove_prefix(kDigits);
  if (!name.starts_with(format.ending)) return false;
  name.remove_prefix(format.ending.size());
  *is_whole = name.empty();
  return name.empty() || (name.starts_with('.') && name.ends_with(kTemporaryEnding) &&
                          is_hex(name.substr(1, name.size() - 1 - kTemporaryEnding.size())));
}

// A regular file, not a link to one, that has our first bytes or no bytes.
bool read_entry(const CacheFormat& format, const fs::path& path, Entry* out) {
  if (!is_entry_name(format, path.filename().native(), &out->is_whole)) return false;
  const int fd = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return false;
  struct stat status{};
  char head[kCacheMagic.size()];
  const bool is_file = ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  const ssize_t n = is_file ? ::read(fd, head, sizeof(head)) : -1;
  ::close(fd);
  if (n != 0 && (n != sizeof(head) || std::memcmp(head, kCacheMagic.data(), sizeof(head)) != 0))
    return false;
  out->path = path;
  out->bytes = static_cast<uint64_t>(status.st_size);
  out->used = std::chrono::system_clock::from_time_t(status.st_mtim.tv_sec) +
              std::chrono::duration_cast<std::chrono::system_clock::duration>(
                  std::chrono::nanoseconds(status.st_mtim.tv_nsec));
  return true;
}

Result<std::vector<Entry>> list_entries(const CacheFormat& format) {
  std::vector<Entry> entries;
  const fs::path folder = cache_folder(format);
  std::error_code code;
  fs::directory_iterator it(folder, code);
  for (const fs::directory_iterator end; !code && it != end; it.increment(code)) {
    Entry entry;
    if (read_entry(format, it->path(), &entry)) entries.push_back(std::move(entry));
  }
  if (code && code != std::errc::no_such_file_or_directory)
    return Error{ErrorKind::kIo,
                 fmt::format("cannot read the cache: {}", code.message()),
                 {folder.string(), 0, 0},
                 "set GLOAM_CACHE to a folder that you can access"};
  return entries;
}

CacheKind describe(const CacheFormat& format, const std::vector<Entry>& entries) {
  CacheKind kind;
  kind.name = format.kind;
  kind.what = format.what;
  kind.folder = cache_folder(format);
  for (const Entry& entry : entries) {
    kind.bytes += entry.bytes;
    if (!entry.is_whole) continue;
    ++kind.entries;
    kind.oldest_use = std::min(kind.oldest_use.value_or(entry.used), entry.used);
    kind.newest_use = std::max(kind.newest_use.value_or(entry.used), entry.used);
  }
  return kind;
}

}  // namespace

fs::path cache_folder() {
  if (const char* cache = std::getenv("GLOAM_CACHE"); cache != nullptr && *cache != 0) return cache;
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != 0)
    return fs::path(xdg) / "gloam";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
    return fs::path(home) / ".cache" / "gloam";
  return fs::temp_directory_path() / "gloam-cache";
}

fs::path cache_folder(const CacheFormat& format) { return cache_folder() / format.kind; }

std::string cache_entry_name(const CacheFormat& format, uint64_t key) {
  return hash_to_hex(key) + std::string(format.ending);
}

void begin_cache_entry(std::vector<uint8_t>* entry) { entry->assign(kHeadSize, 0); }

void seal_cache_entry(uint64_t magic, std::vector<uint8_t>* entry) {
  const uint64_t head[] = {magic, hash_large(std::as_bytes(std::span(*entry).subspan(kHeadSize)))};
  std::memcpy(entry->data(), head, kHeadSize);
}

std::span<const uint8_t> unseal_cache_entry(uint64_t magic, std::span<const uint8_t> entry) {
  uint64_t head[2];
  static_assert(sizeof(head) == kHeadSize);
  if (entry.size() < kHeadSize) return {};
  std::memcpy(head, entry.data(), kHeadSize);
  const std::span<const uint8_t> rest = entry.subspan(kHeadSize);
  const bool is_whole = head[0] == magic && head[1] == hash_large(std::as_bytes(rest));
  return is_whole ? rest : std::span<const uint8_t>();
}

uint64_t hash_large(std::span<const std::byte> bytes) {
  std::vector<uint64_t> hashes(bytes.size() / kHashedPiece + 1);
  parallel_for("hash", static_cast<int64_t>(hashes.size()), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kHashedPiece;
    hashes[static_cast<size_t>(i)] =
        hash_bytes(bytes.data() + begin, std::min(kHashedPiece, bytes.size() - begin));
  });
  return hash_span(std::span<const uint64_t>(hashes), bytes.size());
}

Result<uint64_t> cache_limit() {
  const char* text = std::getenv("GLOAM_CACHE_SIZE");
  if (text == nullptr || *text == 0) return kDefaultSizeLimit;
  const char* const end = text + std::strlen(text);
  uint64_t value = 0;
  const auto [after, error] = std::from_chars(text, end, value);
  constexpr std::string_view kUnits = "KMGT";
  size_t power = 0;
  if (after + 1 == end) power = kUnits.find(*after) + 1;  // npos + 1 = 0
  const int shift = 10 * static_cast<int>(power);
  if (error != std::errc() || after + (power > 0 ? 1 : 0) != end || value > (UINT64_MAX >> shift))
    return Error{ErrorKind::kInput,
                 fmt::format("GLOAM_CACHE_SIZE is '{:.60}', which is not a size", text),
                 {},
                 "give it in bytes, or as 500M or 20G"};
  return value << shift;
}

void keep_in_cache(const fs::path& entry, std::span<const uint8_t> bytes) {
  const Result<uint64_t> set = cache_limit();
  if (!set.ok()) log_warning("{}; using the default of 10G", set.error().to_string());
  const uint64_t limit = set.ok() ? *set : kDefaultSizeLimit;
  if (bytes.size() > limit) return;
  Status status = make_folder(entry.parent_path());
  if (status.ok()) status = write_file_atomic(entry, bytes);
  if (!status.ok()) return log_debug("cache not written: {}", status.error().to_string());
  trim_cache(limit);
}

void mark_cache_use(const fs::path& entry) {
  std::error_code ignored;  // of a cache that may only be read
  fs::last_write_time(entry, fs::file_time_type::clock::now(), ignored);
}

void trim_cache(uint64_t limit) {
  std::vector<Entry> entries;
  uint64_t total = 0;
  const auto now = std::chrono::system_clock::now();
  for (const CacheFormat& format : kFormats) {
    const Result<std::vector<Entry>> listed = list_entries(format);
    if (!listed.ok()) continue;
    for (const Entry& entry : *listed) {
      if (!entry.is_whole && now - entry.used < kLongestWrite) continue;
      total += entry.bytes;
      entries.push_back(entry);
    }
  }
  // Leftovers of dead writers go first.
  std::ranges::sort(entries, {}, [](const Entry& e) { return std::pair(e.is_whole, e.used); });
  for (const Entry& entry : entries) {
    if (total <= limit && entry.is_whole) break;
    std::error_code code;
    fs::remove(entry.path, code);
    if (!code) total -= entry.bytes;  // also where another process was faster
  }
}

Result<CacheInfo> cache_info() {
  CacheInfo info;
  info.folder = cache_folder();
  GLOAM_TRY(info.limit_bytes, cache_limit());
  for (const CacheFormat& format : kFormats) {
    GLOAM_TRY(const std::vector<Entry> entries, list_entries(format));
    info.kinds.push_back(describe(format, entries));
  }
  return info;
}

Result<std::vector<CacheKind>> clear_cache(std::string_view kind) {
  std::vector<std::string> kinds;
  for (const CacheFormat& format : kFormats) kinds.emplace_back(format.kind);
  if (!kind.empty() && std::ranges::find(kinds, kind) == kinds.end())
    return Error{ErrorKind::kUsage,
                 fmt::format("there is no cache '{:.60}'", kind),
                 {},
                 suggest_name(kind, kinds)};
  std::vector<CacheKind> removed;
  for (const CacheFormat& format : kFormats) {
    if (!kind.empty() && kind != format.kind) continue;
    GLOAM_TRY(const std::vector<Entry> entries, list_entries(format));
    for (const Entry& entry : entries) {
      std::error_code code;
      fs::remove(entry.path, code);
      if (code)
        return Error{ErrorKind::kIo,
                     fmt::format("cannot remove: {}", code.message()),
                     {entry.path.string(), 0, 0},
                     "check the folder's permissions"};
    }
    removed.push_back(describe(format, entries));
  }
  return removed;
}

}  // namespace gloam
