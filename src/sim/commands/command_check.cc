#include "sim/commands/command_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <span>

#include "sim/commands/live_fields.h"
#include "sim/joints/joint_inputs.h"
#include "sim/state/state_layout.h"
#include "world/agents/agent_bodies.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

Error refuse(std::string message, std::string hint = {}) {
  return Error{ErrorKind::kUsage, std::move(message), {}, std::move(hint)};
}

bool finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}
bool finite(std::initializer_list<double> values) {
  return finite(std::span(values.begin(), values.size()));
}
bool finite(Vec3 v) { return finite({v.x, v.y, v.z}); }

std::string body_label(const mjModel& model, int body) {
  const char* name = mj_id2name(&model, mjOBJ_BODY, body);
  return name != nullptr && *name != 0 ? fmt::format("body '{}'", name)
                                       : fmt::format("body {}", body);
}

// Has degrees of freedom above it; a mocap body has none.
bool can_move(const mjModel& model, int body) {
  while (body > 0 && model.body_dofnum[body] == 0) body = model.body_parentid[body];
  return body > 0;
}

class Check {
 public:
  explicit Check(const CompiledWorld& world)
      : world_(world),
        serial_(world.serial),
        model_(*world.model),
        robot_count_(static_cast<int>(world.robots.size())) {}

  Status operator()(const SetControl& c) const {
    GLOAM_TRY_STATUS(check_handle(c.actuator, "actuator", 0, model_.nactuator));
    if (model_.actuator_ctrlnum[c.actuator.id] != 1) {
      return refuse(fmt::format("actuator {} has {} controls, not one", c.actuator.id,
                                model_.actuator_ctrlnum[c.actuator.id]),
                    "set its controls in a step hook or a controller");
    }
    if (!finite({c.value})) return refuse("a control is not a finite number");
    return {};
  }
  Status operator()(const SetJointState& c) const {
    GLOAM_TRY_STATUS(check_handle(c.joint, "joint", 0, model_.njnt));
    const JointWidth width = joint_width(model_.jnt_type[c.joint.id]);
    const auto fits = [](const std::vector<double>& values, int count) {
      return values.empty() || values.size() == static_cast<size_t>(count);
    };
    if (!fits(c.qpos, width.qpos) || !fits(c.qvel, width.qvel)) {
      return refuse(fmt::format("joint {} has {} positions and {} velocities, not {} and {}",
                                c.joint.id, width.qpos, width.qvel, c.qpos.size(), c.qvel.size()),
                    "set all of them, or none to keep the current values");
    }
    if (!finite(c.qpos) || !finite(c.qvel)) return refuse("the state of a joint is not finite");
    if (c.qpos.size() >= 4 && mju_norm(c.qpos.data() + c.qpos.size() - 4, 4) < 1e-6)
      return refuse("the quaternion of a joint is zero");
    return {};
  }
  Status operator()(const SetControls& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    const RobotInstance& robot = world_.robots[static_cast<size_t>(c.robot.id)];
    const std::vector<int> actuators = robot_actuators(model_, robot);
    if (c.values.size() != actuators.size())
      return refuse(fmt::format("robot '{}' has {} actuators, not {}", robot.name, actuators.size(),
                                c.values.size()),
                    "pass one value per entry of RobotInfo::actuators");
    for (const int actuator : actuators)
      if (model_.actuator_ctrlnum[actuator] != 1)
        return refuse(fmt::format("actuator {} has more than one control", actuator),
                      "set its controls in a step hook or a controller");
    if (!finite(c.values)) return refuse("a control is not a finite number");
    return {};
  }
  Status operator()(const SetVelocityGoal& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    if (!finite({c.vx, c.vy, c.yaw_rate, c.vz})) return refuse("a velocity goal is not finite");
    return {};
  }
  Status operator()(const SetJointGoal& c) const {
    GLOAM_TRY_STATUS(check_handle(c.joint, "joint", 0, model_.njnt));
    if (joint_width(model_.jnt_type[c.joint.id]).qpos != 1)
      return refuse(fmt::format("joint {} is neither a hinge nor a slide", c.joint.id),
                    "its position has more than one coordinate");
    if (!finite({c.position})) return refuse("the goal of a joint is not finite");
    return {};
  }
  Status operator()(const SetJointCommand& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    GLOAM_TRY_STATUS(check_joints(c.robot, c.joints));
    const size_t joints = joints_of_command(world_, c.robot, c.joints).size();
    const auto check = [&](const std::vector<double>& values, const char* name, double least) {
      if (!values.empty() && values.size() != joints)
        return Status(
            refuse(fmt::format("'{}' has {} values for {} joints", name, values.size(), joints),
                   "set one value per joint, or none to keep the current ones"));
      for (const double v : values)
        if (std::isinf(v) || v < least)
          return Status(refuse(fmt::format("'{}' of a joint cannot be {}", name, v)));
      return Status();
    };
    constexpr double kAny = -std::numeric_limits<double>::max();
    GLOAM_TRY_STATUS(check(c.position, "position", kAny));
    GLOAM_TRY_STATUS(check(c.velocity, "velocity", kAny));
    GLOAM_TRY_STATUS(check(c.effort, "effort", kAny));
    GLOAM_TRY_STATUS(check(c.kp, "kp", 0));
    return check(c.kd, "kd", 0);
  }
  Status operator()(const SetController& c) const {
    return check_handle(c.robot, "robot", 0, robot_count_);
  }
  Status operator()(const FollowTrajectory& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    GLOAM_TRY_STATUS(check_joints(c.robot, c.joints));
    const std::vector<Joint> joints = joints_of_command(world_, c.robot, c.joints);
    for (size_t k = 0; k < c.trajectory.points.size(); ++k) {
      const std::vector<double>& positions = c.trajectory.points[k].positions;
      for (size_t i = 0; i < std::min(joints.size(), positions.size()); ++i)
        GLOAM_TRY_STATUS(check_range(joints[i].id, k, positions[i]));
    }
    return {};
  }
  Status operator()(const StopTrajectory& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    return c.joints.empty() ? Status() : check_joints(c.robot, c.joints);
  }
  Status operator()(const SetPoseGoal& c) const {
    GLOAM_TRY_STATUS(check_handle(c.robot, "robot", 0, robot_count_));
    const Quat& q = c.X_WF.q;
    const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (!finite(c.X_WF.p) || !std::isfinite(norm)) return refuse("a pose goal is not finite");
    if (norm < 1e-12) return refuse("the quaternion of a pose goal is zero");
    return {};
  }
  Status operator()(const SetMocapPose& c) const {
    if (Status status = check_body(c.body); !status) return status;
    if (model_.body_mocapid[c.body.id] < 0) {
      return refuse(fmt::format("{} is not a mocap body", body_label(model_, c.body.id)),
                    "set mocap=\"true\" in the model");
    }
    if (const AgentDescription* agent = find_agent(world_, c.body.id); agent != nullptr)
      return refuse(fmt::format("{} is agent '{}', which moves by itself",
                                body_label(model_, c.body.id), agent->name));
    const Quat& q = c.X_WB.q;
    if (!finite(c.X_WB.p) || !finite({q.w, q.x, q.y, q.z}) ||
        q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 1e-12) {
      return refuse("a mocap pose is not finite, or its quaternion is zero");
    }
    return {};
  }
  Status operator()(const SetWrench& c) const {
    if (Status status = check_body(c.body); !status) return status;
    if (!finite(c.force) || !finite(c.torque)) return refuse("a wrench is not finite");
    return {};
  }
  Status operator()(const AddVelocity& c) const {
    if (Status status = check_body(c.body); !status) return status;
    if (!finite(c.velocity)) return refuse("a velocity is not finite");
    if (floating_joint(model_, c.body.id) < 0) {
      return refuse(
          fmt::format("{} is not free-floating: neither it nor an ancestor has a free joint",
                      body_label(model_, c.body.id)),
          "apply a wrench instead");
    }
    return {};
  }
  Status operator()(const DragBody& c) const {
    if (Status status = check_body(c.body); !status) return status;
    if (!finite(c.point_B) || !finite(c.target_W)) return refuse("a drag point is not finite");
    if (c.active && !can_move(model_, c.body.id)) {
      return refuse(fmt::format("{} cannot move", body_label(model_, c.body.id)));
    }
    return {};
  }
  Status operator()(const TurnBody& c) const {
    if (Status status = check_body(c.body); !status) return status;
    const Quat& q = c.target_WB;
    const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (!std::isfinite(norm) || norm < 1e-12)
      return refuse("the orientation to turn to is not finite, or its quaternion is zero");
    if (c.active && !can_move(model_, c.body.id))
      return refuse(fmt::format("{} cannot move", body_label(model_, c.body.id)));
    return {};
  }
  Status operator()(const SetEquality& c) const {
    return check_handle(c.equality, "equality constraint", 0, model_.neq);
  }
  Status operator()(const ResetSim&) const { return {}; }
  Status operator()(const SetLiveField& c) const { return check_live_field(model_, c); }

 private:
  template <class Kind>
  Status check_handle(Handle<Kind> handle, const char* kind, int first, mjtSize end) const {
    if (handle.world != 0 && handle.world != serial_) {
      return refuse(
          fmt::format("the handle of a {} belongs to another World, not to the running one", kind),
          "look it up again in Simulation::world(): a recompile creates a new World");
    }
    if (handle.id < first || handle.id >= end)
      return refuse(fmt::format("there is no {} number {}", kind, handle.id));
    return {};
  }
  std::string joint_name(int joint) const {
    const char* name = mj_id2name(&model_, mjOBJ_JOINT, joint);
    return name != nullptr ? fmt::format("joint '{}'", name) : fmt::format("joint {}", joint);
  }
  // Hinges and slides of the robot, each once.
  Status check_joints(Robot robot, const std::vector<Joint>& joints) const {
    const RobotInstance& instance = world_.robots[static_cast<size_t>(robot.id)];
    const std::vector<Joint> own = joints_of_command(world_, robot, {});
    if (own.empty())
      return refuse(fmt::format("robot '{}' has no hinge or slide joints", instance.name));
    std::set<int> seen;
    for (const Joint joint : joints) {
      GLOAM_TRY_STATUS(check_handle(joint, "joint", 0, model_.njnt));
      if (std::ranges::find(own, joint.id, &Joint::id) == own.end())
        return refuse(fmt::format("{} is not a hinge or slide of robot '{}'", joint_name(joint.id),
                                  instance.name));
      if (!seen.insert(joint.id).second)
        return refuse(fmt::format("{} is listed twice", joint_name(joint.id)),
                      "list each joint once");
    }
    return {};
  }
  // Joints stop softly: a goal at the very end of the range may round beyond it.
  Status check_range(int joint, size_t point, double position) const {
    if (!model_.jnt_limited[joint]) return {};
    const double low = model_.jnt_range[2 * joint], high = model_.jnt_range[2 * joint + 1];
    const double slack = 1e-3 * (high - low);
    if (!(position < low - slack || position > high + slack)) return {};
    return refuse(fmt::format("position {:g} of {} in point {} is outside its range, {:g} to {:g}",
                              position, joint_name(joint), point, low, high));
  }
  Status check_body(Body body) const { return check_handle(body, "movable body", 1, model_.nbody); }

  const CompiledWorld& world_;
  uint64_t serial_;
  const mjModel& model_;
  int robot_count_;
};

}  // namespace

Status check_command(const CompiledWorld& world, const Command& command) {
  if (command.step < Command::kNextStep) {
    return refuse(fmt::format("a command cannot apply at step {}", command.step));
  }
  return std::visit(Check(world), command.what);
}

}  // namespace gloam
