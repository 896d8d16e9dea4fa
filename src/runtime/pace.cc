// Names of the paces.

#include <fmt/format.h>

#include <array>

#include "base/text.h"
#include "gloam/simulation_options.h"

namespace gloam {
namespace {

constexpr std::array kPaces = {Pace::kFast, Pace::kLockstep, Pace::kRealTime, Pace::kSensors};

}  // namespace

const char* to_string(Pace pace) {
  switch (pace) {
    case Pace::kFast:
      return "fast";
    case Pace::kLockstep:
      return "lockstep";
    case Pace::kRealTime:
      return "realtime";
    case Pace::kSensors:
      return "sensors";
  }
  return "";
}

Result<Pace> pace_named(std::string_view name) {
  std::vector<std::string> names;
  for (const Pace pace : kPaces) {
    if (name == to_string(pace)) return pace;
    names.emplace_back(to_string(pace));
  }
  return Error{ErrorKind::kUsage,
               fmt::format("there is no pace '{}'", name),
               {},
               suggest_name(std::string(name), names)};
}

}  // namespace gloam
