#include "scene/validate/validate_effect.h"

#include <fmt/format.h>

#include "places/generators.h"

namespace gloam {
namespace {

template <class Source>
Status check_times(const Source& source, const char* kind) {
  if (!source.stop || *source.stop > source.start) return {};
  return Error{ErrorKind::kInput,
               fmt::format("{} '{}' stops at {} s, but starts at {} s", kind, source.name,
                           *source.stop, source.start),
               source.loc, "'stop' must be later than 'start'"};
}

/// A box has a centre and edges, or is left to us.
template <class Options>
Status check_box(const Options& options, const char* kind, const char* without) {
  if (options.position.has_value() == options.size.has_value()) return {};
  return Error{ErrorKind::kInput,
               fmt::format("{} '{}' has a {} but no {}", kind, options.name,
                           options.size ? "size" : "position", options.size ? "position" : "size"),
               options.loc, fmt::format("specify both, or neither for {}", without)};
}

Status check_rotor(const RotorOptions& rotor) {
  if (rotor.actuator.empty() == rotor.site.empty()) {
    return Error{
        ErrorKind::kInput,
        fmt::format("rotor '{}' has {} an actuator {} a site", rotor.name,
                    rotor.site.empty() ? "neither" : "both", rotor.site.empty() ? "nor" : "and"),
        rotor.loc, "specify exactly one of them"};
  }
  if (rotor.thrust.has_value() == rotor.site.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("rotor '{}' has {}", rotor.name,
                             rotor.thrust ? "a thrust in addition to its actuator's force"
                                          : "a site but no thrust"),
                 rotor.loc, "specify 'thrust' together with 'site'"};
  }
  return {};
}

}  // namespace

Status validate_effects(const Scene& scene) {
  for (const GasOptions& gas : scene.gases) {
    GLOAM_TRY_STATUS(check_box(gas, "gas", "a box that fits the scene"));
  }
  for (const FireOptions& fire : scene.fires) GLOAM_TRY_STATUS(check_times(fire, "fire"));
  for (const SmokeOptions& smoke : scene.smokes) GLOAM_TRY_STATUS(check_times(smoke, "smoke"));
  for (const RotorOptions& rotor : scene.rotors) GLOAM_TRY_STATUS(check_rotor(rotor));
  for (const DustOptions& dust : scene.dusts)
    GLOAM_TRY_STATUS(check_box(dust, "dust", "all ground in the gas"));
  if (scene.weather && scene.weather->where == "rooms" && !has_rooms(scene.environment)) {
    return Error{ErrorKind::kInput, "where = \"rooms\" of [weather] needs a generated building",
                 scene.weather->loc, "use a [[volume]] to fill a box anywhere with a medium"};
  }
  return {};
}

}  // namespace gloam
