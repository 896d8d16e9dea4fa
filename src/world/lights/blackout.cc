#include "world/lights/blackout.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/text.h"

namespace gloam {
namespace {

bool is_named(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return fits_pattern(pattern, name); });
}

/// Calls f(name, schedule) of all that shines.
template <class F>
void each_lamp(RenderDescription* out, const F& f) {
  for (LightDescription& light : out->lights) {
    if (!light.of_sky) f(light.name, &light.schedule);
  }
  for (MaterialDescription& material : out->materials)
    if (luminance(material.emission) > 0) f(material.name, &material.schedule);
}

}  // namespace

Status author_blackout(const BlackoutOptions& options, RenderDescription* out) {
  std::vector<std::string> names;
  each_lamp(out, [&](const std::string& name, int*) { names.push_back(name); });
  for (const auto* patterns : {&options.except, &options.emergency}) {
    for (const std::string& pattern : *patterns) {
      if (pattern.find('*') != std::string::npos) continue;
      if (std::find(names.begin(), names.end(), pattern) != names.end()) continue;
      return Error{ErrorKind::kInput,
                   fmt::format("[blackout]: no lamp or glowing material is named '{}'", pattern),
                   options.loc, suggest_name(pattern, names)};
    }
  }
  PowerCut cut;
  cut.at = options.at;
  cut.until = options.until.value_or(std::numeric_limits<double>::infinity());
  cut.starter = options.starter;
  const auto cut_off = [&](const std::string& name, int* schedule) {
    if (is_named(options.except, name)) return;
    LightSchedule parts;
    if (*schedule >= 0) parts = out->schedules[static_cast<size_t>(*schedule)];
    cut.emergency = is_named(options.emergency, name);
    parts.parts.push_back(cut);
    *schedule = static_cast<int>(out->schedules.size());
    out->schedules.push_back(std::move(parts));
  };
  each_lamp(out, cut_off);
  cut_off("headlight", &out->sky.schedule);
  return {};
}

}  // namespace gloam
