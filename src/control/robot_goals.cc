#include "gloam/drive/robot_goals.h"

#include <fmt/format.h>

#include "control/gripper.h"
#include "control/parted_controller.h"
#include "control/task_frame.h"
#include "policy/policy_controller.h"
#include "scene/options/controller_types.h"

namespace gloam {
namespace {

// The trotting controller has no limits of its own; its tests walk as fast as this.
constexpr VelocityRanges kTrotRanges = {{-1, 1}, {-0.25, 0.25}, {-0.8, 0.8}};

VelocityRange within(double most) { return {-most, most}; }

// Empty: the controller takes no velocity.
Result<std::optional<VelocityRanges>> velocity_ranges(const CompiledWorld& world,
                                                      const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  const FlightOptions& flight = options.flight;
  std::optional<VelocityRanges> ranges;
  if (!has_controller_option(options.type, "goals")) return ranges;
  ranges.emplace();
  if (options.type == "trot") ranges = kTrotRanges;
  if (options.type == "diff_drive")
    ranges = {within(options.drive.max_speed), within(0), within(options.drive.max_yaw_rate),
              within(0)};
  if (options.type == "quadrotor")
    ranges = {within(flight.max_speed), within(flight.max_speed), within(flight.max_yaw_rate),
              within(flight.max_climb)};
  if (options.type == "policy") {
    GLOAM_TRY(const auto limits, policy_command_ranges(world, robot));
    ranges = {
        {limits[0][0], limits[0][1]}, {limits[1][0], limits[1][1]}, {limits[2][0], limits[2][1]}};
  }
  return ranges;
}

bool is_task_controller(const ControllerOptions& options) {
  return options.type == "ik" || options.type == "osc";
}

}  // namespace

Result<RobotGoals> robot_goals(const World& world, Robot robot) {
  const CompiledWorld& compiled = *world.compiled();
  if (robot.id < 0 || static_cast<size_t>(robot.id) >= compiled.robots.size())
    return Error{ErrorKind::kUsage, fmt::format("there is no robot number {}", robot.id)};
  const RobotInstance& whole = compiled.robots[static_cast<size_t>(robot.id)];
  RobotGoals goals;
  GLOAM_TRY(const auto parts, robot_parts(*compiled.model, whole));
  for (const ControlledPart& part : parts) {
    const ControllerOptions& options = part.robot.options.controller;
    if (!goals.velocity) {
      GLOAM_TRY(goals.velocity, velocity_ranges(compiled, part.robot));
    }
    if (is_task_controller(options) && !goals.frame) {
      GLOAM_TRY(const TaskFrame task, find_task_frame(*compiled.model, part.robot));
      goals.frame = task.name;
    }
    if (options.type == "gripper" && !goals.gripper)
      goals.gripper = finger_goal(*compiled.model, part.robot);
  }
  if (goals.gripper) goals.gripper->joint.world = robot.world;
  return goals;
}

Result<Pose> frame_pose(const Instant& instant, const ik::FrameName& frame) {
  GLOAM_TRY(const ik::FrameId id, ik::find_frame(*instant.model(), frame));
  return to_pose(ik::pose_of(*instant.data(), id));
}

}  // namespace gloam
