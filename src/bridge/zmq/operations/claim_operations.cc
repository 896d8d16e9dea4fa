// Operations on the control of robots: claims.

#include <fmt/format.h>

#include <algorithm>

#include "bridge/zmq/operations/operation.h"
#include "gloam/program.h"

namespace gloam::bridge::zeromq {
namespace {

using enum OperationSpeed;

Status claim(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  GLOAM_TRY_STATUS(call.services.sessions.claim(call.from, robot.name));
  pack_nothing(out);
  return {};
}

Status release(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  GLOAM_TRY_STATUS(call.services.sessions.release(call.from.client, robot.name));
  pack_nothing(out);
  return {};
}

}  // namespace

Result<RobotInfo> robot_of(const Call& call, const World& world) {
  const std::vector<RobotInfo> robots = world.robots();
  std::vector<std::string> names;
  for (const RobotInfo& robot : robots) names.push_back(robot.name);
  const std::string name = call.arguments.text("robot");
  if (name.empty() && robots.size() == 1) return robots[0];
  if (name.empty())
    return Error{ErrorKind::kUsage,
                 fmt::format("there are {} robots, not one", robots.size()),
                 {},
                 "select one with 'robot'"};
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    return Error{ErrorKind::kInput,
                 fmt::format("there is no robot '{:.60}'", name),
                 {},
                 suggest_name(name.substr(0, 60), names)};
  return robots[static_cast<size_t>(found - names.begin())];
}

std::vector<Operation> claim_operations() {
  const Argument robot{"robot", ArgumentType::kText, false, "",
                       "name of the robot; optional if there is only one"};
  return {
      {"claim",
       "reserves a robot's controls and goals for this client until it releases the robot or "
       "disconnects",
       kAtOnce,
       {robot},
       claim},
      {"release", "releases a claimed robot", kAtOnce, {robot}, release},
  };
}

}  // namespace gloam::bridge::zeromq
