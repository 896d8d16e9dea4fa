#include "sim/loop/scene_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "sim/commands/command_check.h"
#include "sim/loop/step_schedule.h"

namespace gloam {
namespace {

Result<int64_t> step_of_time(double time, Rational timestep, const SourceLoc& loc) {
  if (!(time >= 0 && time < 1e9)) {
    return Error{ErrorKind::kInput, fmt::format("a time of {} s is not in [0, 1e9)", time), loc};
  }
  return step_at_or_after(exact_rational(time), timestep);
}

Result<Body> find_body(const mjModel& model, const PushOptions& push) {
  const int id = mj_name2id(&model, mjOBJ_BODY, push.body.c_str());
  if (id >= 0) return Body{id};
  std::vector<std::string> names;
  for (int body = 1; body < model.nbody; ++body) {
    const char* name = mj_id2name(&model, mjOBJ_BODY, body);
    if (name != nullptr) names.emplace_back(name);
  }
  return Error{ErrorKind::kInput, fmt::format("a push refers to an unknown body '{}'", push.body),
               push.loc, suggest_name(push.body, names)};
}

}  // namespace

Result<std::vector<Command>> scene_schedule(const CompiledWorld& world, Rational timestep) {
  std::vector<Command> schedule;
  const int robot_count = static_cast<int>(world.robots.size());
  auto add = [&](Command command, double time, const SourceLoc& loc) -> Status {
    GLOAM_TRY(command.step, step_of_time(time, timestep, loc));
    if (Status status = check_command(world, command); !status) {
      Error error = status.error();
      error.kind = ErrorKind::kInput;
      error.loc = loc;
      return error;
    }
    schedule.push_back(std::move(command));
    return {};
  };
  for (int robot = 0; robot < robot_count; ++robot) {
    for (const VelocityGoal& goal :
         world.robots[static_cast<size_t>(robot)].options.controller.goals) {
      GLOAM_TRY_STATUS(
          add({.what = SetVelocityGoal{{robot, 0}, goal.vx, goal.vy, goal.yaw_rate, goal.vz}},
              goal.time, goal.loc));
    }
  }
  for (const PushOptions& push : world.scene.pushes) {
    GLOAM_TRY(const Body body, find_body(*world.model, push));
    GLOAM_TRY_STATUS(add({.what = AddVelocity{body, push.velocity}}, push.time, push.loc));
  }
  std::stable_sort(schedule.begin(), schedule.end(),
                   [](const Command& a, const Command& b) { return a.step < b.step; });
  return schedule;
}

}  // namespace gloam
