// gloam cache: lists or clears the cache on disk that makes later starts faster.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/program.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

using Json = nlohmann::ordered_json;
using Time = std::optional<std::chrono::system_clock::time_point>;

std::string mebibytes(uint64_t bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

std::string entries_of(const CacheKind& kind) {
  return fmt::format("{} {}", kind.entries, kind.entries == 1 ? "entry" : "entries");
}

std::string local_time(const Time& time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return fmt::format("{:%Y-%m-%d %H:%M}", local);
}

Json utc_time(const Time& time) {
  if (!time) return nullptr;
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc);
}

Json as_json(const CacheKind& kind) {
  return {{"name", kind.name},
          {"what", kind.what},
          {"folder", kind.folder.string()},
          {"entries", kind.entries},
          {"bytes", kind.bytes},
          {"oldest_use", utc_time(kind.oldest_use)},
          {"newest_use", utc_time(kind.newest_use)}};
}

int list(const Globals& globals) {
  const Result<CacheInfo> info = cache_info();
  if (!info.ok()) return fail(info.error());
  uint64_t bytes = 0;
  for (const CacheKind& kind : info->kinds) bytes += kind.bytes;
  if (globals.json) {
    Json json = {{"folder", info->folder.string()},
                 {"bytes", bytes},
                 {"limit_bytes", info->limit_bytes},
                 {"kinds", Json::array()}};
    for (const CacheKind& kind : info->kinds) json["kinds"].push_back(as_json(kind));
    put_json(json);
    return 0;
  }
  say("{}: {} of at most {}\n", info->folder.string(), mebibytes(bytes),
      mebibytes(info->limit_bytes));
  for (const CacheKind& kind : info->kinds) {
    say("\n{} in {}\n  {}\n  {}, {}", kind.name, kind.folder.string(), kind.what, entries_of(kind),
        mebibytes(kind.bytes));
    if (kind.oldest_use)
      say("; last used from {} to {}", local_time(kind.oldest_use), local_time(kind.newest_use));
    say("\n");
  }
  return 0;
}

int clear(const std::string& which, const Globals& globals) {
  const Result<std::vector<CacheKind>> removed = clear_cache(which);
  if (!removed.ok()) return fail(removed.error());
  Json json = {{"removed", Json::array()}};
  for (const CacheKind& kind : *removed) {
    json["removed"].push_back(as_json(kind));
    if (!globals.json)
      say("{}: {} removed, {}\n", kind.name, entries_of(kind), mebibytes(kind.bytes));
  }
  if (globals.json) put_json(json);
  return 0;
}

}  // namespace

void add_cache(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("cache", "List or clear the cache on disk that makes later starts faster");
  sub->require_subcommand(0, 1);
  sub->footer(
      "GLOAM_CACHE sets the folder (default: ~/.cache/gloam), GLOAM_CACHE_SIZE its maximum size "
      "(default: 10G);\nthe least recently used entries are removed first.\nExamples:\n  gloam "
      "cache\n  gloam cache clear visuals");
  CLI::App* clearing = sub->add_subcommand("clear", "Remove cached entries");
  auto kind = std::make_shared<std::string>();
  clearing->add_option("KIND", *kind,
                       "Kind of entries to remove, as listed by gloam cache; default: all");
  clearing->footer("Example:\n  gloam cache clear");
  sub->callback([&globals, &action, clearing, kind] {
    action = [&globals, is_clear = clearing->parsed(), kind] {
      return is_clear ? clear(*kind, globals) : list(globals);
    };
  });
}

}  // namespace gloam::cli
