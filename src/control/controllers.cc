#include "control/controllers.h"

#include <fmt/format.h>

#include "control/trot.h"

namespace gloam {

Result<std::unique_ptr<Controller>> make_controller(const CompiledWorld& world, const RobotInstance& robot) {
  if (robot.options.controller.type == "trot") return make_trot_controller(world, robot);
  return Error{ErrorKind::kInput, fmt::format("there is no controller '{}'", robot.options.controller.type)};
}

}  // namespace gloam
