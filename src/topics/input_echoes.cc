#include "topics/input_echoes.h"

#include <algorithm>
#include <cmath>

#include "ros/messages/sensor_msgs.h"
#include "topics/ros_values.h"

namespace gloam {
namespace {

/// The last Command of type T for which `fits` is true; null if there is none.
template <class T>
const T* last_of(const AppliedCommands& applied, const auto& fits) {
  const T* last = nullptr;
  for (const Command& command : applied.commands)
    if (const T* what = std::get_if<T>(&command.what); what != nullptr && fits(*what)) last = what;
  return last;
}

// Targets that Commands gave the joints `ids` of a robot, which are all its hinges and slides.
std::vector<JointTarget> targets_of(std::span<const Command> commands, int robot,
                                    const std::vector<int>& ids) {
  std::vector<JointTarget> targets(ids.size());
  const auto find = [&](int joint) -> JointTarget* {
    const auto found = std::ranges::find(ids, joint);
    return found == ids.end() ? nullptr : &targets[static_cast<size_t>(found - ids.begin())];
  };
  const auto set = [&](const SetJointCommand& c, const std::vector<double>& values,
                       double JointTarget::* field) {
    for (size_t i = 0; i < values.size(); ++i) {
      JointTarget* const target = find(c.joints.empty() ? ids[i] : c.joints[i].id);
      if (target != nullptr) target->*field = values[i];
    }
  };
  for (const Command& command : commands) {
    if (const auto* goal = std::get_if<SetJointGoal>(&command.what)) {
      if (JointTarget* const target = find(goal->joint.id)) target->position = goal->position;
    } else if (const auto* given = std::get_if<SetJointCommand>(&command.what);
               given != nullptr && given->robot.id == robot) {
      set(*given, given->position, &JointTarget::position);
      set(*given, given->velocity, &JointTarget::velocity);
      set(*given, given->effort, &JointTarget::effort);
    }
  }
  return targets;
}

}  // namespace

InputEcho velocity_echo(int robot) {
  return [robot](const AppliedCommands& applied, MessageBytes* out) {
    const auto* goal = last_of<SetVelocityGoal>(
        applied, [robot](const SetVelocityGoal& c) { return c.robot.id == robot; });
    if (goal == nullptr) return false;
    encode(geometry_msgs::Twist{{goal->vx, goal->vy, goal->vz}, {0, 0, goal->yaw_rate}}, out);
    return true;
  };
}

InputEcho joint_command_echo(int robot, std::vector<int> ids, std::vector<std::string> names) {
  return [robot, ids = std::move(ids), names = std::move(names)](const AppliedCommands& applied,
                                                                 MessageBytes* out) {
    const std::vector<JointTarget> targets = targets_of(applied.commands, robot, ids);
    sensor_msgs::JointState message;
    message.header = ros_header(applied.time, "");
    const auto is_set = [&](double JointTarget::* field) {
      return std::ranges::any_of(targets, [&](const auto& t) { return std::isfinite(t.*field); });
    };
    const auto add = [&](double JointTarget::* field, size_t i, std::vector<double>* to) {
      if (is_set(field)) to->push_back(targets[i].*field);
    };
    for (size_t i = 0; i < ids.size(); ++i) {
      const JointTarget& t = targets[i];
      if (!std::isfinite(t.position) && !std::isfinite(t.velocity) && !std::isfinite(t.effort))
        continue;
      message.name.push_back(names[i]);
      add(&JointTarget::position, i, &message.position);
      add(&JointTarget::velocity, i, &message.velocity);
      add(&JointTarget::effort, i, &message.effort);
    }
    if (message.name.empty()) return false;
    encode(message, out);
    return true;
  };
}

InputEcho pose_goal_echo(int robot) {
  return [robot](const AppliedCommands& applied, MessageBytes* out) {
    const auto* goal = last_of<SetPoseGoal>(
        applied, [robot](const SetPoseGoal& c) { return c.robot.id == robot; });
    if (goal == nullptr) return false;
    encode(
        geometry_msgs::PoseStamped{ros_header(applied.time, kWorldFrameId), ros_pose(goal->X_WF)},
        out);
    return true;
  };
}

InputEcho controls_echo(std::vector<int> places) {
  return [places = std::move(places)](const AppliedCommands& applied, MessageBytes* out) {
    const auto is_set = [&](int i) { return applied.is_set[static_cast<size_t>(i)] != 0; };
    if (std::ranges::none_of(places, is_set)) return false;
    std_msgs::Float64MultiArray message;
    for (const int i : places) message.data.push_back(applied.controls[static_cast<size_t>(i)]);
    encode(message, out);
    return true;
  };
}

InputEcho initial_pose_echo(int joint) {
  return [joint](const AppliedCommands& applied, MessageBytes* out) {
    const auto* put = last_of<SetJointState>(applied, [joint](const SetJointState& c) {
      return c.joint.id == joint && c.qpos.size() == 7;
    });
    if (put == nullptr) return false;
    const std::vector<double>& q = put->qpos;
    geometry_msgs::PoseWithCovarianceStamped message;
    message.header = ros_header(applied.time, kWorldFrameId);
    message.pose.pose = ros_pose({{q[0], q[1], q[2]}, {q[3], q[4], q[5], q[6]}});
    encode(message, out);
    return true;
  };
}

InputEcho wrench_echo(int body) {
  return [body](const AppliedCommands& applied, MessageBytes* out) {
    const auto* wrench =
        last_of<SetWrench>(applied, [body](const SetWrench& c) { return c.body.id == body; });
    if (wrench == nullptr) return false;
    encode(geometry_msgs::WrenchStamped{ros_header(applied.time, kWorldFrameId),
                                        {ros_vector(wrench->force), ros_vector(wrench->torque)}},
           out);
    return true;
  };
}

InputEcho mocap_pose_echo(int body) {
  return [body](const AppliedCommands& applied, MessageBytes* out) {
    const auto* pose =
        last_of<SetMocapPose>(applied, [body](const SetMocapPose& c) { return c.body.id == body; });
    if (pose == nullptr) return false;
    encode(
        geometry_msgs::PoseStamped{ros_header(applied.time, kWorldFrameId), ros_pose(pose->X_WB)},
        out);
    return true;
  };
}

InputEcho reset_echo() {
  return [](const AppliedCommands& applied, MessageBytes* out) {
    if (last_of<ResetSim>(applied, [](const ResetSim&) { return true; }) == nullptr) return false;
    encode(std_msgs::Empty{}, out);
    return true;
  };
}

}  // namespace gloam
