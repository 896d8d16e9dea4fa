#include "world/sensors/hidden_bodies.h"

#include <fmt/format.h>

#include "base/text.h"
#include "world/compile/level.h"

namespace gloam {

Result<std::vector<uint8_t>> hidden_bodies(const mjModel& model,
                                           const std::vector<std::string>& patterns,
                                           const std::string& owner, const SourceLoc& loc) {
  if (patterns.empty()) return std::vector<uint8_t>();
  const int count = static_cast<int>(model.nbody);
  std::vector<uint8_t> bodies(static_cast<size_t>(count));
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (int b = 1; b < count; ++b) {
      const char* name = mj_id2name(&model, mjOBJ_BODY, b);
      if (name == nullptr || !fits_pattern(pattern, name)) continue;
      bodies[static_cast<size_t>(b)] = found = true;
    }
    if (!found)
      return Error{ErrorKind::kInput,
                   fmt::format("{} hides '{}', but there is no such body", owner, pattern), loc,
                   suggest_name(pattern, object_names(&model, mjOBJ_BODY))};
  }
  for (int b = 1; b < count; ++b)  // parents come first
    bodies[static_cast<size_t>(b)] |= bodies[static_cast<size_t>(model.body_parentid[b])];
  return bodies;
}

}  // namespace gloam
