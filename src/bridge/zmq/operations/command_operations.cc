// Operations that become Commands: controls, goals, poses, forces, fields, and messages to topics.

#include <algorithm>

#include "bridge/zmq/operations/operation.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

const Argument kRobotArgument{"robot", kText, false, "",
                              "name of the robot; optional if there is only one"};
const Argument kStepArgument{"at_step", kInteger, false, "steps since reset",
                             "the step before which it applies; default: the next step"};

Vec3 vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

int64_t step_of(const Call& call) { return call.arguments.integer("at_step", Command::kNextStep); }

// Robot that has a joint or actuator; empty = none.
template <class Handle>
std::string owner_of(const std::vector<RobotInfo>& robots, Handle handle,
                     std::vector<Handle> RobotInfo::* members) {
  for (const RobotInfo& robot : robots)
    if (std::ranges::count(robot.*members, handle.id, &Handle::id) != 0) return robot.name;
  return {};
}

// All of one robot's at once; each robot's are checked before any is posted.
Status post_by_robot(const Call& call, const std::map<std::string, std::vector<Command>>& commands,
                     Packer& out) {
  if (commands.empty()) return Error{ErrorKind::kUsage, "nothing to set"};
  for (const auto& [robot, all] : commands)
    GLOAM_TRY_STATUS(call.services.sessions.post(call.from.client, robot, all));
  pack_nothing(out);
  return {};
}

Status post_one(const Call& call, const Command& command, Packer& out) {
  GLOAM_TRY_STATUS(call.services.simulation().post(command));
  pack_nothing(out);
  return {};
}

Status controls(const Call& call, Packer& out) {
  const World world = call.services.simulation().world();
  const std::vector<RobotInfo> robots = world.robots();
  std::map<std::string, std::vector<Command>> commands;
  if (call.arguments.has("values")) {
    GLOAM_TRY(const RobotInfo robot, robot_of(call, world));
    commands[robot.name].push_back(
        {step_of(call), SetControls{robot.robot, call.arguments.numbers("values")}});
  }
  for (const auto& [name, value] : call.arguments.number_map("actuators")) {
    GLOAM_TRY(const Actuator actuator, world.find_actuator(name));
    const std::string robot = owner_of(robots, actuator, &RobotInfo::actuators);
    commands[robot].push_back({step_of(call), SetControl{actuator, value}});
  }
  return post_by_robot(call, commands, out);
}

Status joint_goals(const Call& call, Packer& out) {
  const World world = call.services.simulation().world();
  const std::vector<RobotInfo> robots = world.robots();
  std::map<std::string, std::vector<Command>> commands;
  for (const auto& [name, position] : call.arguments.number_map("joints")) {
    GLOAM_TRY(const Joint joint, world.find_joint(name));
    const std::string robot = owner_of(robots, joint, &RobotInfo::joints);
    commands[robot].push_back({step_of(call), SetJointGoal{joint, position}});
  }
  return post_by_robot(call, commands, out);
}

Status velocity_goal(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  const Command command{
      step_of(call),
      SetVelocityGoal{robot.robot, call.arguments.number("vx"), call.arguments.number("vy"),
                      call.arguments.number("yaw_rate"), call.arguments.number("vz")}};
  return post_by_robot(call, {{robot.name, {command}}}, out);
}

// Position and orientation of a call; without an orientation, the identity.
Pose pose_of(const Call& call) {
  Pose X{vector_of(call.arguments.numbers("position")), {}};
  if (const auto q = call.arguments.numbers("orientation"); !q.empty())
    X.q = {q[0], q[1], q[2], q[3]};
  return X;
}

Status pose_goal(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  const Command command{step_of(call), SetPoseGoal{robot.robot, pose_of(call)}};
  return post_by_robot(call, {{robot.name, {command}}}, out);
}

Status joint_states(const Call& call, Packer& out) {
  const World world = call.services.simulation().world();
  const auto positions = call.arguments.numbers_map("positions");
  const auto velocities = call.arguments.numbers_map("velocities");
  std::map<std::string, SetJointState> states;
  for (const auto& [name, values] : positions) states[name].qpos = values;
  for (const auto& [name, values] : velocities) states[name].qvel = values;
  if (states.empty()) return Error{ErrorKind::kUsage, "nothing to set"};
  std::vector<Command> commands;
  for (auto& [name, state] : states) {
    GLOAM_TRY(state.joint, world.find_joint(name));
    commands.push_back({step_of(call), std::move(state)});
  }
  GLOAM_TRY_STATUS(call.services.simulation().post(commands));
  pack_nothing(out);
  return {};
}

Status mocap_pose(const Call& call, Packer& out) {
  GLOAM_TRY(const Body body,
            call.services.simulation().world().find_body(call.arguments.text("body")));
  return post_one(call, {step_of(call), SetMocapPose{body, pose_of(call)}}, out);
}

Status wrench(const Call& call, Packer& out) {
  GLOAM_TRY(const Body body,
            call.services.simulation().world().find_body(call.arguments.text("body")));
  SetWrench wrench{body, {}, {}};
  if (call.arguments.has("force")) wrench.force = vector_of(call.arguments.numbers("force"));
  if (call.arguments.has("torque")) wrench.torque = vector_of(call.arguments.numbers("torque"));
  return post_one(call, {step_of(call), wrench}, out);
}

Status add_velocity(const Call& call, Packer& out) {
  GLOAM_TRY(const Body body,
            call.services.simulation().world().find_body(call.arguments.text("body")));
  const AddVelocity push{body, vector_of(call.arguments.numbers("velocity"))};
  return post_one(call, {step_of(call), push}, out);
}

Status live_field(const Call& call, Packer& out) {
  const int64_t first = call.arguments.integer("first");
  if (first < 0 || first > INT32_MAX) return Error{ErrorKind::kInput, "'first' is out of range"};
  GLOAM_TRY_STATUS(call.services.operations().set_live_field(
      call.arguments.text("field"), static_cast<int>(first), call.arguments.numbers("values")));
  pack_nothing(out);
  return {};
}

Status publish(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.simulation().publish(call.arguments.text("topic"),
                                                      call.arguments.bytes("data")));
  pack_nothing(out);
  return {};
}

}  // namespace

std::vector<Operation> command_operations() {
  const Argument body{"body", kText, true, "", "full name of a body"};
  return {
      {"controls",
       "sets all controls of a robot, or some of them by name",
       kAtOnce,
       {kRobotArgument,
        {"values", kNumbers, false, "unit of each actuator, (actuators)",
         "in the order of the robot's actuators"},
        {"actuators", kNumberMap, false, "unit of each actuator", "by full name"},
        kStepArgument},
       controls},
      {"joint_goals",
       "sets goal positions of joints for a robot's controller",
       kAtOnce,
       {{"joints", kNumberMap, true, "rad or m", "by full name; hinges and slides"}, kStepArgument},
       joint_goals},
      {"velocity_goal",
       "sets the goal velocity of a robot's controller, in the heading frame",
       kAtOnce,
       {kRobotArgument,
        {"vx", kNumber, false, "m/s", "forward"},
        {"vy", kNumber, false, "m/s", "left"},
        {"yaw_rate", kNumber, false, "rad/s", "counterclockwise"},
        {"vz", kNumber, false, "m/s", "up, of a flying robot"},
        kStepArgument},
       velocity_goal},
      {"pose_goal",
       "sets the goal pose of the frame that a robot's controller controls, in the world",
       kAtOnce,
       {kRobotArgument,
        {"position", kNumbers, true, "m, (3)", "x y z", 3},
        {"orientation", kNumbers, false, "(4)", "unit quaternion w x y z; default: 1 0 0 0", 4},
        kStepArgument},
       pose_goal},
      {"joint_states",
       "sets positions and velocities of joints",
       kAtOnce,
       {{"positions", kNumbersMap, false, "rad or m; ball wxyz (4), free xyz wxyz (7)", "by name"},
        {"velocities", kNumbersMap, false, "rad/s or m/s; (1), (3) or (6)", "by name"},
        kStepArgument},
       joint_states},
      {"mocap_pose",
       "sets the pose of a mocap body in the world",
       kAtOnce,
       {body,
        {"position", kNumbers, true, "m, (3)", "x y z", 3},
        {"orientation", kNumbers, false, "(4)", "unit quaternion w x y z; default: 1 0 0 0", 4},
        kStepArgument},
       mocap_pose},
      {"wrench",
       "applies a force and torque at the centre of mass of a body, in world axes, until changed",
       kAtOnce,
       {body,
        {"force", kNumbers, false, "N, (3)", "default: 0", 3},
        {"torque", kNumbers, false, "N m, (3)", "default: 0", 3},
        kStepArgument},
       wrench},
      {"add_velocity",
       "adds to the linear velocity of a floating body",
       kAtOnce,
       {body, {"velocity", kNumbers, true, "m/s, (3)", "world axes", 3}, kStepArgument},
       add_velocity},
      {"live_field",
       "changes values of the model during the run: gravity, wind, masses, friction, gains, "
       "lights, colours",
       kAtOnce,
       {{"field", kText, true, "", "one of the live_fields listed by hello"},
        {"values", kNumbers, true, "unit of the field", "elements from 'first' on"},
        {"first", kInteger, false, "", "index of the first element; default: 0"}},
       live_field},
      {"publish",
       "publishes a message to an input topic",
       kAtOnce,
       {{"topic", kText, true, "", "an input topic listed by hello"},
        {"data", kBytes, true, "", "the message in CDR, with its header of four bytes"}},
       publish},
  };
}

}  // namespace gloam::bridge::zeromq
