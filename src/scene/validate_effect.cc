#include "scene/validate_effect.h"

#include <fmt/format.h>

namespace gloam {
namespace {

template <class Source>
Status check_times(const Source& source, const char* kind) {
  if (!source.stop || *source.stop > source.start) return {};
  return Error{ErrorKind::kInput,
               fmt::format("{} '{}' stops at {} s and starts at {} s", kind, source.name,
                           *source.stop, source.start),
               source.loc, "'stop' comes after 'start'"};
}

}  // namespace

Status validate_effects(const Scene& scene) {
  for (const GasOptions& gas : scene.gases) {
    if (gas.position.has_value() != gas.size.has_value()) {
      return Error{ErrorKind::kInput,
                   fmt::format("gas '{}' has a {} but no {}", gas.name,
                               gas.size ? "size" : "position", gas.size ? "position" : "size"),
                   gas.loc, "give both, or neither for the box that fits the scene"};
    }
  }
  for (const FireOptions& fire : scene.fires) GLOAM_TRY_STATUS(check_times(fire, "fire"));
  for (const SmokeOptions& smoke : scene.smokes) GLOAM_TRY_STATUS(check_times(smoke, "smoke"));
  return {};
}

}  // namespace gloam
