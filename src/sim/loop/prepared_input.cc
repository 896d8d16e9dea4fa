#include "sim/loop/prepared_input.h"

#include <utility>

#include "sim/joints/joint_inputs.h"

namespace gloam {
namespace {

Status prepare(const std::shared_ptr<const CompiledWorld>& world, const SetController& command,
               Rational timestep, const ControllerMaker& make, PreparedInput* out) {
  if (!make)
    return Error{ErrorKind::kUnsupported,
                 "this simulation cannot make controllers",
                 {},
                 "create it with Simulation::create"};
  const ControllerOptions& options = command.controller;
  GLOAM_TRY(auto controller, make(world, command.robot.id, options));
  GLOAM_TRY(out->controller,
            ControllerSlot::make(*world, {command.robot.id, std::move(controller), options.rate},
                                 timestep));
  out->controller.options = std::make_shared<const ControllerOptions>(options);
  return {};
}

Status prepare(const CompiledWorld& world, const FollowTrajectory& command, PreparedInput* out) {
  std::vector<Joint> joints = joints_of_command(world, command.robot, command.joints);
  GLOAM_TRY(JointPath path, JointPath::make(command.trajectory, joints.size()));
  for (Joint& joint : joints) joint.world = world.serial;
  out->trajectory.replaced.resize(joints.size());
  out->trajectory.trajectory = std::make_shared<ActiveTrajectory>(
      ActiveTrajectory{std::move(joints), std::move(path), command.tag});
  return {};
}

}  // namespace

Result<std::unique_ptr<PreparedInput>> prepare_input(
    const std::shared_ptr<const CompiledWorld>& world, const Command& command, Rational timestep,
    const ControllerMaker& make) {
  auto prepared = std::make_unique<PreparedInput>();
  if (const auto* change = std::get_if<SetController>(&command.what)) {
    GLOAM_TRY_STATUS(prepare(world, *change, timestep, make, prepared.get()));
  } else if (const auto* follow = std::get_if<FollowTrajectory>(&command.what)) {
    GLOAM_TRY_STATUS(prepare(*world, *follow, prepared.get()));
  } else {
    prepared.reset();
  }
  return prepared;
}

}  // namespace gloam
