#include "control/controllers.h"

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "base/text.h"
#include "control/joint_position.h"
#include "control/torque.h"
#include "control/trot.h"
#include "scene/options/controller_types.h"

namespace gloam {
namespace {

using OwnFactory = Result<std::unique_ptr<Controller>> (*)(const CompiledWorld&,
                                                           const RobotInstance&);

Result<std::unique_ptr<Controller>> make_none(const CompiledWorld&, const RobotInstance&) {
  return std::unique_ptr<Controller>();
}

// Gloam's own; names and options are in scene/options/controller_types.cc.
constexpr std::pair<std::string_view, OwnFactory> kControllers[] = {
    {"none", make_none},
    {"torque", make_torque_controller},
    {"joint_position", make_joint_position_controller},
    {"trot", make_trot_controller},
};

struct RegisteredControllers {
  std::mutex mutex;
  std::map<std::string, ControllerFactory> factories;
};

RegisteredControllers& registered() {
  static RegisteredControllers instance;
  return instance;
}

ControllerFactory find_registered(const std::string& type) {
  RegisteredControllers& all = registered();
  const std::lock_guard lock(all.mutex);
  const auto found = all.factories.find(type);
  return found != all.factories.end() ? found->second : ControllerFactory();
}

}  // namespace

Status register_controller(std::string type, ControllerFactory factory) {
  if (!factory) return Error{ErrorKind::kUsage, "a controller needs a factory"};
  GLOAM_TRY_STATUS(add_controller_type(type));
  RegisteredControllers& all = registered();
  const std::lock_guard lock(all.mutex);
  all.factories.emplace(std::move(type), std::move(factory));
  return {};
}

std::vector<std::string> controller_types() {
  const std::vector<std::string_view> names = controller_type_names();
  return {names.begin(), names.end()};
}

Result<std::unique_ptr<Controller>> make_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  for (const auto& [name, make] : kControllers)
    if (options.type == name) return make(*world, robot);
  if (const ControllerFactory make = find_registered(options.type))
    return make({World(world), robot.options});
  return Error{ErrorKind::kInput, fmt::format("unknown controller '{}'", options.type), options.loc,
               suggest_name(options.type, controller_types())};
}

}  // namespace gloam
