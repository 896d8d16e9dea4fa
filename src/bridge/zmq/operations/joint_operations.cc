// Operations for the joints of robots: targets, controllers, trajectories.

#include <fmt/format.h>

#include "bridge/zmq/operations/operation.h"
#include "gloam/controller.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

Status post_to(const Call& call, const RobotInfo& robot, decltype(Command::what) what,
               Packer& out) {
  const Command command{call.arguments.integer("at_step", Command::kNextStep), std::move(what)};
  GLOAM_TRY_STATUS(call.services.sessions.post(call.from.client, robot.name, {&command, 1}));
  pack_nothing(out);
  return {};
}

// Joints by their full names or their names in the robot's model; none = all hinges and slides.
Result<std::vector<Joint>> named_joints(const Call& call, const World& world,
                                        const RobotInfo& robot) {
  std::vector<Joint> joints;
  for (const std::string& name : call.arguments.texts("joints")) {
    Result<Joint> joint = world.find_joint(robot.name + "/" + name);
    if (!joint.ok()) joint = world.find_joint(name);
    if (!joint.ok()) return joint.error();
    joints.push_back(*joint);
  }
  return joints;
}

Status command_joints(const Call& call, Packer& out) {
  const World world = call.services.simulation().world();
  GLOAM_TRY(const RobotInfo robot, robot_of(call, world));
  GLOAM_TRY(auto joints, named_joints(call, world, robot));
  const auto numbers = [&](const char* name) { return call.arguments.numbers(name); };
  const SetJointCommand command{robot.robot,         std::move(joints), numbers("position"),
                                numbers("velocity"), numbers("effort"), numbers("kp"),
                                numbers("kd")};
  return post_to(call, robot, command, out);
}

Status set_controller(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  GLOAM_TRY(auto options, parse_controller(call.arguments.text("options")));
  return post_to(call, robot, SetController{robot.robot, std::move(options)}, out);
}

// Row `point` of an array with one row a point; nothing if the array is not given.
Result<std::vector<double>> row_of(const std::vector<double>& values, std::string_view name,
                                   size_t point, size_t points) {
  if (values.empty()) return std::vector<double>();
  if (values.size() % points != 0)
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' has {} numbers, which is not a multiple of {} points", name,
                             values.size(), points)};
  const auto width = static_cast<std::ptrdiff_t>(values.size() / points);
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(point) * width;
  return std::vector<double>(first, first + width);
}

Result<JointTrajectory> trajectory_of(const Arguments& arguments) {
  JointTrajectory trajectory;
  GLOAM_TRY(trajectory.profile, profile_named(arguments.text("profile", "spline")));
  trajectory.max_velocity = arguments.numbers("max_velocity");
  trajectory.max_acceleration = arguments.numbers("max_acceleration");
  const std::vector<double> times = arguments.numbers("times");
  const bool has_times = trajectory.profile == TrajectoryProfile::kSpline;
  const int64_t given = arguments.integer("points", 1);
  if (!has_times && (given < 1 || given > 100'000))
    return Error{ErrorKind::kInput, "'points' is out of range"};
  const size_t points = has_times ? times.size() : static_cast<size_t>(given);
  for (size_t i = 0; i < points; ++i) {
    TrajectoryPoint& point = trajectory.points.emplace_back();
    if (has_times) point.time = times[i];
    const auto row = [&](const char* name) {
      return row_of(arguments.numbers(name), name, i, points);
    };
    GLOAM_TRY(point.positions, row("positions"));
    GLOAM_TRY(point.velocities, row("velocities"));
    GLOAM_TRY(point.accelerations, row("accelerations"));
  }
  return trajectory;
}

Status follow_trajectory(const Call& call, Packer& out) {
  const World world = call.services.simulation().world();
  GLOAM_TRY(const RobotInfo robot, robot_of(call, world));
  GLOAM_TRY(auto joints, named_joints(call, world, robot));
  GLOAM_TRY(auto trajectory, trajectory_of(call.arguments));
  return post_to(call, robot,
                 FollowTrajectory{robot.robot, std::move(joints), std::move(trajectory)}, out);
}

Status stop_trajectory(const Call& call, Packer& out) {
  GLOAM_TRY(const RobotInfo robot, robot_of(call, call.services.simulation().world()));
  return post_to(call, robot, StopTrajectory{robot.robot}, out);
}

}  // namespace

std::vector<Operation> joint_operations() {
  const Argument robot{"robot", kText, false, "", "name; optional if there is only one"};
  const Argument step{"at_step", kInteger, false, "steps since reset",
                      "the step before which it applies; default: the next step"};
  const Argument joints{"joints", kTexts, false, "", "default: all hinges and slides of the robot"};
  return {
      {"joint_command",
       "sets targets of joints for a robot's controller; targets that are not given stay",
       kAtOnce,
       {robot,
        joints,
        {"position", kNumbers, false, "rad or m, (joints)", "target positions"},
        {"velocity", kNumbers, false, "rad/s or m/s, (joints)", "target velocities"},
        {"effort", kNumbers, false, "N m or N, (joints)", "feed-forward"},
        {"kp", kNumbers, false, "N m/rad or N/m, (joints)", "stiffness"},
        {"kd", kNumbers, false, "N m s/rad or N s/m, (joints)", "damping"},
        step},
       command_joints},
      {"set_controller",
       "replaces the controller of a robot until the next reset",
       kAtOnce,
       {robot,
        {"options", kText, true, "", "as in [robot.controller]: \"type = 'joint_effort'\""},
        step},
       set_controller},
      {"follow_trajectory",
       "makes a robot's joints follow a trajectory, which replaces the trajectories of the same "
       "joints",
       kAtOnce,
       {robot,
        joints,
        {"positions", kNumbers, true, "rad or m, (points x joints)", "row by row"},
        {"velocities", kNumbers, false, "rad/s or m/s, (points x joints)", "profile spline"},
        {"accelerations", kNumbers, false, "per s^2, (points x joints)", "profile spline"},
        {"times", kNumbers, false, "s after the start, (points)", "profile spline"},
        {"points", kInteger, false, "", "number of points without times; default: 1"},
        {"profile", kText, false, "", "spline (default), trapezoidal or quintic"},
        {"max_velocity", kNumbers, false, "rad/s or m/s, (1) or (joints)", "not for spline"},
        {"max_acceleration", kNumbers, false, "per s^2, (1) or (joints)", "not for spline"},
        step},
       follow_trajectory},
      {"stop_trajectory",
       "ends a robot's trajectory; its joints hold their positions",
       kAtOnce,
       {robot, step},
       stop_trajectory},
  };
}

}  // namespace gloam::bridge::zeromq
