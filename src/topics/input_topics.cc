// Input topics: goals, controls, poses, forces, resets.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "gloam/controller.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/trajectory_msgs.h"
#include "ros/trajectory_check.h"
#include "topics/input_echoes.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/agents/agent_bodies.h"
#include "world/model_names.h"
#include "world/world.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

using InputBytes = std::span<const uint8_t>;
using Commands = Result<std::vector<Command>>;

/// Joints of one robot that have one number, by their local names.
struct JointsByName {
  std::string robot;
  Robot handle;
  std::vector<std::string> names;
  std::vector<int> ids;

  Joint joint(size_t i) const { return {ids[i], handle.world}; }
  Result<std::vector<Joint>> find(const std::vector<std::string>& wanted) const {
    std::vector<Joint> joints;
    for (const std::string& name : wanted) {
      GLOAM_TRY(const Joint joint, find(name));
      joints.push_back(joint);
    }
    return joints;
  }
  Result<Joint> find(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return joint(static_cast<size_t>(found - names.begin()));
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' has no hinge or slide joint '{}'", robot, name),
                 {},
                 suggest_name(name, names)};
  }
};

JointsByName joints_by_name(const CompiledWorld& world, Robot handle) {
  const RobotInstance& robot = world.robots[static_cast<size_t>(handle.id)];
  JointsByName joints{robot.name, handle, {}, {}};
  const mjModel& m = *world.model;
  for (const int id : robot_joints(m, robot)) {
    if (m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE) continue;
    joints.names.push_back(joint_label(m, id, robot.prefix));
    joints.ids.push_back(id);
  }
  return joints;
}

Command now(auto what) { return Command{.what = std::move(what)}; }

InputDecoder velocity(Robot robot) {
  return [robot](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto twist, decode<geometry_msgs::Twist>(bytes));
    return std::vector{now(
        SetVelocityGoal{robot, twist.linear.x, twist.linear.y, twist.angular.z, twist.linear.z})};
  };
}

InputDecoder stamped_velocity(Robot robot) {
  return [robot](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto message, decode<geometry_msgs::TwistStamped>(bytes));
    const geometry_msgs::Twist& twist = message.twist;
    return std::vector{now(
        SetVelocityGoal{robot, twist.linear.x, twist.linear.y, twist.angular.z, twist.linear.z})};
  };
}

Status check_lengths(const std::string& what, size_t names, size_t values) {
  if (names == values) return {};
  return Error{ErrorKind::kInput, fmt::format("{}: {} names, but {} numbers", what, names, values)};
}

Status check_finite(const std::string& what, std::span<const double> values) {
  if (std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) return {};
  return Error{ErrorKind::kInput, fmt::format("{}: a number is not finite", what)};
}

// Positions, velocities and efforts, of which a message may leave out two.
InputDecoder joint_command(JointsByName joints) {
  return [joints = std::move(joints)](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(auto state, decode<sensor_msgs::JointState>(bytes));
    const bool is_empty = state.velocity.empty() && state.effort.empty();
    if (is_empty && state.name.empty() && state.position.empty()) return std::vector<Command>();
    GLOAM_TRY_STATUS(check_joint_names(state.name));
    if (is_empty || !state.position.empty())
      GLOAM_TRY_STATUS(check_lengths("joint_command", state.name.size(), state.position.size()));
    for (const auto* values : {&state.position, &state.velocity, &state.effort})
      GLOAM_TRY_STATUS(check_finite("joint_command", *values));
    GLOAM_TRY(auto named, joints.find(state.name));
    return std::vector{
        now(SetJointCommand{joints.handle, std::move(named), std::move(state.position),
                            std::move(state.velocity), std::move(state.effort)})};
  };
}

// Goals of all joints, in their order.
InputDecoder position_commands(JointsByName joints) {
  return [joints = std::move(joints)](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(auto message, decode<std_msgs::Float64MultiArray>(bytes));
    GLOAM_TRY_STATUS(check_lengths("position_commands", joints.names.size(), message.data.size()));
    GLOAM_TRY_STATUS(check_finite("position_commands", message.data));
    return std::vector{now(SetJointCommand{joints.handle, {}, std::move(message.data)})};
  };
}

// A trajectory; without points, the named joints stop at once, or all if none is named.
InputDecoder joint_trajectory(JointsByName joints) {
  return [joints = std::move(joints)](InputBytes bytes, const Snapshot& now,
                                      double timestep) -> Commands {
    GLOAM_TRY(const auto message, decode<trajectory_msgs::JointTrajectory>(bytes));
    const bool is_stop = message.points.empty();
    if (!is_stop || !message.joint_names.empty())
      GLOAM_TRY_STATUS(check_joint_names(message.joint_names));
    GLOAM_TRY(auto named, joints.find(message.joint_names));
    if (is_stop)
      return std::vector{Command{.what = StopTrajectory{joints.handle, std::move(named)}}};
    GLOAM_TRY(const int64_t start, start_step(message, now.time(), timestep));
    GLOAM_TRY(auto trajectory, joint_trajectory_of(message));
    return std::vector{
        Command{start, FollowTrajectory{joints.handle, std::move(named), std::move(trajectory)}}};
  };
}

InputDecoder set_controller(Robot robot) {
  return [robot](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto message, decode<std_msgs::String>(bytes));
    GLOAM_TRY(auto options, parse_controller(message.data));
    return std::vector{now(SetController{robot, std::move(options)})};
  };
}

InputDecoder controls(Robot robot) {
  return [robot](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(auto message, decode<std_msgs::Float64MultiArray>(bytes));
    return std::vector{now(SetControls{robot, std::move(message.data)})};
  };
}

Status check_frame(const std_msgs::Header& header) {
  if (header.frame_id.empty() || header.frame_id == kWorldFrameId) return {};
  return Error{ErrorKind::kInput,
               fmt::format("frame '{}' is not supported", header.frame_id),
               {},
               "use frame 'world'"};
}

InputDecoder mocap_pose(Body body) {
  return [body](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto pose, decode<geometry_msgs::PoseStamped>(bytes));
    GLOAM_TRY_STATUS(check_frame(pose.header));
    return std::vector{now(SetMocapPose{body, from_ros(pose.pose)})};
  };
}

InputDecoder pose_goal(Robot robot) {
  return [robot](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto goal, decode<geometry_msgs::PoseStamped>(bytes));
    GLOAM_TRY_STATUS(check_frame(goal.header));
    return std::vector{now(SetPoseGoal{robot, from_ros(goal.pose)})};
  };
}

InputDecoder wrench(Body body) {
  return [body](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto message, decode<geometry_msgs::WrenchStamped>(bytes));
    GLOAM_TRY_STATUS(check_frame(message.header));
    return std::vector{
        now(SetWrench{body, from_ros(message.wrench.force), from_ros(message.wrench.torque)})};
  };
}

// Puts a floating robot elsewhere, at rest.
InputDecoder initial_pose(Joint root) {
  return [root](InputBytes bytes, const Snapshot&, double) -> Commands {
    GLOAM_TRY(const auto message, decode<geometry_msgs::PoseWithCovarianceStamped>(bytes));
    GLOAM_TRY_STATUS(check_frame(message.header));
    const Pose X_WB = from_ros(message.pose.pose);
    const double norm =
        X_WB.q.w * X_WB.q.w + X_WB.q.x * X_WB.q.x + X_WB.q.y * X_WB.q.y + X_WB.q.z * X_WB.q.z;
    if (!(norm > 0.5 && norm < 2))
      return Error{ErrorKind::kInput, "initialpose: the orientation is not a unit quaternion"};
    return std::vector{
        now(SetJointState{root,
                          {X_WB.p.x, X_WB.p.y, X_WB.p.z, X_WB.q.w, X_WB.q.x, X_WB.q.y, X_WB.q.z},
                          {0, 0, 0, 0, 0, 0}})};
  };
}

Commands reset(InputBytes bytes, const Snapshot&, double) {
  GLOAM_TRY_STATUS(decode<std_msgs::Empty>(bytes));
  return std::vector{now(ResetSim{})};
}

// Places of actuators' controls in mjData::ctrl.
std::vector<int> control_places(const mjModel& m, const std::vector<int>& actuators) {
  std::vector<int> places;
  for (const int actuator : actuators)
    for (int i = 0; i < m.actuator_ctrlnum[actuator]; ++i)
      places.push_back(m.actuator_ctrladr[actuator] + i);
  return places;
}

void add_input(std::string name, std::string type, TopicSource source, InputDecoder decoder,
               InputEcho echo, TopicTable* table) {
  Topic& topic = table->emplace_back();
  topic.info = {.name = std::move(name),
                .type = std::move(type),
                .is_input = true,
                .source = std::move(source)};
  topic.code = std::move(decoder);
  topic.echo = std::move(echo);
}

}  // namespace

void add_input_topics(const TopicWorld& world, TopicTable* table) {
  const mjModel& m = *world->model;
  for (size_t i = 0; i < world->robots.size(); ++i) {
    const RobotInstance& robot = world->robots[i];
    const Robot handle{static_cast<int>(i), world->serial};
    const std::string space = "/" + topic_token(robot.name);
    const TopicSource source = {TopicSource::Kind::kRobot, robot.name};
    const std::string& controller = robot.options.controller.type;
    if (controller != "none") {
      add_input(space + "/cmd_vel", type_name<geometry_msgs::Twist>(), source, velocity(handle),
                velocity_echo(handle.id), table);
      add_input(space + "/cmd_vel_stamped", type_name<geometry_msgs::TwistStamped>(), source,
                stamped_velocity(handle), {}, table);
      const JointsByName joints = joints_by_name(*world, handle);
      add_input(space + "/joint_command", type_name<sensor_msgs::JointState>(), source,
                joint_command(joints), joint_command_echo(handle.id, joints.ids, joints.names),
                table);
      add_input(space + "/joint_trajectory", type_name<trajectory_msgs::JointTrajectory>(), source,
                joint_trajectory(joints), {}, table);
      add_input(space + "/position_commands", type_name<std_msgs::Float64MultiArray>(), source,
                position_commands(joints), {}, table);
      add_input(space + "/pose_goal", type_name<geometry_msgs::PoseStamped>(), source,
                pose_goal(handle), pose_goal_echo(handle.id), table);
      add_input(space + "/set_controller", type_name<std_msgs::String>(), source,
                set_controller(handle), {}, table);
    }
    if (const std::vector<int> actuators = robot_actuators(m, robot); !actuators.empty())
      add_input(space + "/controls", type_name<std_msgs::Float64MultiArray>(), source,
                controls(handle), controls_echo(control_places(m, actuators)), table);
    const int root = robot.root_body > 0 ? m.body_jntadr[robot.root_body] : -1;
    if (root >= 0 && m.jnt_type[root] == mjJNT_FREE)
      add_input(space + "/initialpose", type_name<geometry_msgs::PoseWithCovarianceStamped>(),
                source, initial_pose({root, world->serial}), initial_pose_echo(root), table);
    if (robot.root_body > 0)
      add_input(space + "/wrench_command", type_name<geometry_msgs::WrenchStamped>(), source,
                wrench({robot.root_body, world->serial}), wrench_echo(robot.root_body), table);
  }
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (m.body_mocapid[body] < 0 || find_agent(*world, body) != nullptr) continue;
    const std::string name = body_frame(m, body);
    add_input("/" + topic_token(name) + "/pose", type_name<geometry_msgs::PoseStamped>(),
              {TopicSource::Kind::kBody, name}, mocap_pose({body, world->serial}),
              mocap_pose_echo(body), table);
  }
  add_input("/reset", type_name<std_msgs::Empty>(), {.name = "simulation"}, reset, reset_echo(),
            table);
}

}  // namespace gloam
