#include "world/sensors/authored_lidar.h"

#include <fmt/format.h>

#include "base/text.h"
#include "world/compile/level.h"
#include "world/sensors/hidden_bodies.h"
#include "world/world.h"

namespace gloam {

Result<std::vector<LidarDescription>> describe_lidars(const CompiledWorld& world) {
  std::vector<LidarDescription> lidars;
  const mjModel* m = world.model.get();
  for (const LidarOptions& options : world.scene.lidars) {
    const int body = options.body.empty() ? 0 : mj_name2id(m, mjOBJ_BODY, options.body.c_str());
    if (body < 0) {
      return Error{
          ErrorKind::kInput,
          fmt::format("lidar '{}': there is no body '{}'", options.name, options.body), options.loc,
          suggest_name(options.body, object_names(m, mjOBJ_BODY, static_cast<int>(m->nbody)))};
    }
    GLOAM_TRY(
        std::vector<uint8_t> hidden,
        hidden_bodies(*m, options.hide, fmt::format("lidar '{}'", options.name), options.loc));
    lidars.push_back({options, body, {options.position, options.orientation}, std::move(hidden)});
  }
  return lidars;
}

}  // namespace gloam
