#include "world/sensors/authored_lidar.h"

#include <fmt/format.h>

#include "base/text.h"
#include "world/compile/level.h"
#include "world/sensors/hidden_bodies.h"
#include "world/sensors/mount.h"
#include "world/world.h"

namespace gloam {
namespace {

std::vector<std::string> mount_names(const mjModel* m) {
  std::vector<std::string> names = object_names(m, mjOBJ_BODY);
  for (std::string& site : object_names(m, mjOBJ_SITE)) names.push_back(std::move(site));
  return names;
}

}  // namespace

Result<std::vector<LidarDescription>> describe_lidars(const CompiledWorld& world) {
  std::vector<LidarDescription> lidars;
  const mjModel* m = world.model.get();
  for (const LidarOptions& options : world.scene.lidars) {
    const std::optional<ModelMount> mount = find_mount(*m, options.body);
    if (!mount) {
      return Error{
          ErrorKind::kInput,
          fmt::format("lidar '{}': there is no body or site '{}'", options.name, options.body),
          options.loc, suggest_name(options.body, mount_names(m))};
    }
    GLOAM_TRY(
        std::vector<uint8_t> hidden,
        hidden_bodies(*m, options.hide, fmt::format("lidar '{}'", options.name), options.loc));
    const Pose X_ML{options.position, options.orientation};
    const Pose X_BL = mount->X_BM == Pose{} ? X_ML : compose(mount->X_BM, X_ML);
    lidars.push_back({options, mount->body, X_BL, std::move(hidden)});
  }
  return lidars;
}

}  // namespace gloam
