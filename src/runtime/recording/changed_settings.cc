#include "runtime/recording/changed_settings.h"

#include <algorithm>
#include <map>

#include "gloam/options.h"

namespace gloam {
namespace {

constexpr const char* kReportedElsewhere[] = {"sim.seed",         "render.tier",    "render.spp",
                                              "render.max_depth", "render.denoise", "render.error"};

bool is_told_elsewhere(const std::string& path) {
  return path.starts_with("record.") || path.ends_with(".outputs") ||
         std::ranges::find(kReportedElsewhere, path) != std::end(kReportedElsewhere);
}

}  // namespace

std::vector<NamedText> changed_settings(const CompiledWorld& world) {
  const Scene& given = world.written;
  if (given.file.empty() || !given.bare_model.empty()) return {};
  Result<Scene> file = load_scene(given.file, given.access);
  if (!file.ok()) return {};
  std::map<std::string, std::string> before;
  for (OptionInfo& option : list_options(*file)) before[option.path] = std::move(option.value);
  std::vector<NamedText> changed;
  for (const OptionInfo& option : list_options(given)) {
    const auto known = before.find(option.path);
    if (is_told_elsewhere(option.path) || (known != before.end() && known->second == option.value))
      continue;
    if (known == before.end()) {
      // A table that the file has not: its defaults are no changes, and are there once it is.
      const Result<std::string> now = get_option(*file, option.path);
      if (option.value.empty() || (now.ok() && *now == option.value)) continue;
      if (!set_option(*file, option.path, option.value).ok()) continue;
    }
    changed.emplace_back(option.path, option.value.empty() ? "not given" : option.value);
  }
  return changed;
}

}  // namespace gloam
