#include "scene/validate/validate_planner.h"

#include <fmt/format.h>

#include <algorithm>

namespace gloam {

Status validate_planner(const PlannerOptions& planner, const std::vector<RobotOptions>& robots) {
  const auto error = [&](std::string message, std::string hint) {
    return Error{ErrorKind::kInput, "[planner] " + message, planner.loc, std::move(hint)};
  };
  const auto has_name = [&](const RobotOptions& robot) { return robot.name == planner.robot; };
  if (planner.robot.empty() && robots.size() != 1) {
    return error(fmt::format("needs a 'robot': the scene has {}", robots.size()),
                 "set robot to the name of a [[robot]]");
  }
  if (!planner.robot.empty() && std::ranges::none_of(robots, has_name))
    return error(fmt::format("robot '{}' does not exist", planner.robot), "add a [[robot]]");
  const bool is_external = planner.type == "external";
  if (!is_external && (!planner.command.empty() || !planner.address.empty()))
    return error("has a 'command' or an 'address'", "these belong to type = \"external\"");
  if (is_external && planner.address.empty())
    return error("needs an 'address'", "for example address = \"tcp://127.0.0.1:7801\"");
  const bool is_library = planner.type == "library";
  if (!is_library && !planner.library.empty())
    return error("has a 'library'", "this belongs to type = \"library\"");
  if (is_library && planner.library.empty())
    return error("needs a 'library'", "for example library = \"planner.so\"");
  if (planner.latency < 0 && planner.latency != -1)
    return error("has a negative 'latency'", "remove it for the planner's own latency");
  return {};
}

}  // namespace gloam
