#include <fmt/format.h>

#include <algorithm>

#include "control/controllers.h"
#include "control/guess/guess_text.h"
#include "control/robot_joints.h"
#include "control/trot_legs.h"
#include "gloam/controller.h"

namespace gloam {
namespace {

bool is_known(const std::string& type) { return std::ranges::count(controller_types(), type) > 0; }

std::vector<std::string> joint_names(const CompiledWorld& world, const Limb& limb) {
  std::vector<std::string> names;
  for (const int joint : limb.joints) names.push_back(own_name(world, mjOBJ_JOINT, joint));
  return names;
}

/// The legs' joints and feet; empty lists where a part has no name.
RobotJoints leg_names(const CompiledWorld& world, const RobotTree& tree, const RobotShape& shape,
                      const Quadruped& quadruped) {
  RobotJoints joints;
  std::vector<std::string>* const legs[] = {&joints.front_left, &joints.front_right,
                                            &joints.rear_left, &joints.rear_right};
  for (size_t i = 0; i < 4; ++i) {
    *legs[i] = joint_names(world, tree.limbs[static_cast<size_t>(shape.legs[i])]);
    joints.feet.push_back(own_name(world, mjOBJ_GEOM, quadruped.legs[i].foot_geom));
  }
  const auto lacks_name = [](const std::vector<std::string>& names) {
    return std::ranges::count(names, "") > 0;
  };
  if (lacks_name(joints.feet)) joints.feet.clear();
  if (std::ranges::any_of(legs, [&](const auto* leg) { return lacks_name(*leg); }))
    for (auto* leg : legs) leg->clear();
  return joints;
}

/// Whether the robot can have a controller of this type, with its present options.
Status accepts(const CompiledWorld& world, const std::string& type, const RobotJoints& joints) {
  RobotInstance robot = world.robots.at(0);
  robot.options.controller = {};
  robot.options.controller.type = type;
  robot.options.joints = joints;
  const std::shared_ptr<const CompiledWorld> shared(&world, [](const CompiledWorld*) {});
  const auto controller = make_controller(shared, robot);
  return controller.ok() ? Status() : Status(controller.error());
}

}  // namespace

std::string own_name(const CompiledWorld& world, mjtObj type, int id) {
  const char* name = mj_id2name(world.model.get(), type, id);
  const std::string& prefix = world.robots.at(0).prefix;
  const std::string full = name == nullptr ? "" : name;
  return full.starts_with(prefix) ? full.substr(prefix.size()) : std::string();
}

GuessedController guess_controller(const CompiledWorld& world, const RobotTree& tree,
                                   const RobotShape& shape) {
  GuessedController out;
  const auto try_type = [&](const std::string& type) {
    if (out.type != "none" || !is_known(type)) return;
    const Status status = accepts(world, type, out.joints);
    if (status.ok())
      out.type = type;
    else
      out.reasons.push_back(fmt::format("not {}: {}", type, status.error().message));
  };
  if (shape.plan == BodyPlan::kQuadruped) {
    if (const auto quadruped = find_quadruped(*world.model, world.robots.at(0)); quadruped.ok())
      out.joints = leg_names(world, tree, shape, *quadruped);
    try_type("trot");
  }
  if (shape.plan == BodyPlan::kQuadrotor) try_type("quadrotor");
  if (shape.plan == BodyPlan::kDiffDrive) try_type("diff_drive");
  const bool drives_joints = !driven_joints(*world.model, world.robots.at(0)).empty();
  if (drives_joints) try_type("joint_position");
  if (out.type == "joint_position")
    out.reasons.emplace_back(
        "joint_position holds the keyframe; kp and kd fit motors of this size?");
  if (out.type == "none" && !drives_joints)
    out.reasons.push_back(
        world.model->nactuator == 0
            ? "no controller: the model has no actuators; a controller needs a <motor> or "
              "<position> for each joint, which URDF cannot express"
            : "no controller: no actuator is a motor or a position servo of one joint");
  if (shape.plan == BodyPlan::kHumanoid || shape.plan == BodyPlan::kQuadruped)
    out.reasons.emplace_back("trained networks walk it as well: docs/policies.md");
  return out;
}

}  // namespace gloam
