#include "control/controllers.h"

#include <fmt/format.h>

#include "base/text.h"
#include "control/joint_position.h"
#include "control/torque.h"
#include "control/trot.h"

namespace gloam {
namespace {

using Factory = Result<std::unique_ptr<Controller>> (*)(const CompiledWorld&, const RobotInstance&);

struct ControllerType {
  const char* name;
  Factory make;
};

Result<std::unique_ptr<Controller>> make_none(const CompiledWorld&, const RobotInstance&) {
  return std::unique_ptr<Controller>();
}

constexpr ControllerType kControllers[] = {
    {"none", make_none},
    {"torque", make_torque_controller},
    {"joint_position", make_joint_position_controller},
    {"trot", make_trot_controller},
};

}  // namespace

Result<std::unique_ptr<Controller>> make_controller(const CompiledWorld& world,
                                                    const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  std::vector<std::string> names;
  for (const ControllerType& type : kControllers) {
    if (options.type == type.name) return type.make(world, robot);
    names.emplace_back(type.name);
  }
  return Error{ErrorKind::kInput, fmt::format("unknown controller '{}'", options.type), options.loc,
               suggest_name(options.type, names)};
}

}  // namespace gloam
