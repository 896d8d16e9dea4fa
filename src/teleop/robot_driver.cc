#include "teleop/robot_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gloam/program.h"
#include "teleop/velocity_mapping.h"

namespace gloam::teleop {
namespace {

constexpr std::chrono::seconds kLeaseTime{1};
constexpr double kLongestStick = 0.1;  // [s] of a stick's step: after a pause it does not leap

const char* const kRemedy =
    "select a controller with velocity goals (diff_drive, quadrotor, trot, policy) or pose goals "
    "(ik, osc) in [robot.controller]";

bool can_be_driven(const RobotGoals& goals) { return goals.velocity || goals.frame; }

std::string controller_of(const World& world, const std::string& robot) {
  for (const RobotOptions& options : world.scene().robots)
    if (options.name == robot) return options.controller.type;
  return "none";
}

// The first robot that can be driven.
Result<std::string> choose_robot(const World& world) {
  std::string reasons;
  for (const RobotInfo& robot : world.robots()) {
    GLOAM_TRY(const RobotGoals goals, robot_goals(world, robot.robot));
    if (can_be_driven(goals)) return robot.name;
    reasons += fmt::format("{}'{}' has controller '{}'", reasons.empty() ? ": " : ", ", robot.name,
                           controller_of(world, robot.name));
  }
  return Error{
      ErrorKind::kInput, "no robot of the scene can be driven by hand" + reasons, {}, kRemedy};
}

}  // namespace

RobotDriver::RobotDriver(Simulation& simulation, std::string name)
    : simulation_(simulation), name_(std::move(name)) {}

Result<std::unique_ptr<RobotDriver>> RobotDriver::create(Simulation& simulation,
                                                         const std::string& robot) {
  std::string name = robot;
  if (name.empty()) {
    GLOAM_TRY(name, choose_robot(simulation.world()));
  }
  std::unique_ptr<RobotDriver> driver(new RobotDriver(simulation, name));
  GLOAM_TRY_STATUS(driver->look_up());
  driver->moves_frame_ = !driver->goals_.velocity;
  if (driver->goals_.gripper) driver->is_open_ = driver->goals_.gripper->opening >= 0.5;
  return driver;
}

Status RobotDriver::look_up() {
  const World world = simulation_.world();
  if (world.compiled() == world_) return {};
  GLOAM_TRY(robot_, world.find_robot(name_));
  GLOAM_TRY(goals_, robot_goals(world, robot_));
  if (!can_be_driven(goals_))
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' cannot be driven by hand: its controller '{}' accepts "
                             "neither velocity nor pose goals",
                             name_, controller_of(world, name_)),
                 {},
                 kRemedy};
  if (moves_frame_ ? !goals_.frame : !goals_.velocity) moves_frame_ = goals_.frame.has_value();
  for (const RobotInfo& info : world.robots())
    if (info.name == name_) root_ = info.root;
  world_ = world.compiled();
  return {};
}

void RobotDriver::set_speed(int speed) { speed_ = std::clamp(speed, kSlowest, kFastest); }

Status RobotDriver::post(const Command& command, Time now) {
  if (lease_ == nullptr) {
    auto lease = simulation_.claim(robot_);
    if (!lease.ok())
      return Error{ErrorKind::kUsage, fmt::format("another client controls robot '{}'", name_)};
    lease_ = std::move(*lease);
  }
  last_post_ = now;
  return lease_->post(command);
}

Status RobotDriver::post_velocity(const SetVelocityGoal& goal, Time now) {
  GLOAM_TRY_STATUS(post({.what = goal}, now));
  velocity_ = goal;
  return {};
}

Status RobotDriver::steer(const Deflection& move, Time now) {
  const double seconds = std::chrono::duration<double>(now - last_steer_).count();
  last_steer_ = now;
  GLOAM_TRY_STATUS(look_up());
  const int64_t step = simulation_.latest().step();
  if (step < last_step_) {  // a reset: the goals are the scene's again
    velocity_ = {};
    X_WG_.reset();
  }
  last_step_ = step;
  if (moves_frame_) {
    if (move.is_zero()) return {};
    return move_goal(move, stick_step(speed_, std::min(seconds, kLongestStick)), now);
  }
  const SetVelocityGoal goal = velocity_goal(robot_, *goals_.velocity, move, speed_);
  return is_same(goal, velocity_) ? Status() : post_velocity(goal, now);
}

Status RobotDriver::jog(const Deflection& move, Time now) {
  GLOAM_TRY_STATUS(look_up());
  return moves_frame_ ? move_goal(move, key_step(speed_), now) : Status();
}

Status RobotDriver::move_goal(const Deflection& move, const JogStep& step, Time now) {
  GLOAM_TRY_STATUS(instant_.solve(simulation_.latest()));
  GLOAM_TRY(const Pose X_WF, frame_pose(instant_, *goals_.frame));
  GLOAM_TRY(const BodyState root, instant_.body(root_));
  const Pose X_WG = jogged(X_WG_.value_or(X_WF), X_WF, heading(root.X_WB), move, step);
  GLOAM_TRY_STATUS(post({.what = SetPoseGoal{robot_, X_WG}}, now));
  X_WG_ = X_WG;
  return {};
}

Status RobotDriver::stop(Time now) {
  GLOAM_TRY_STATUS(look_up());
  if (!moves_frame_) return post_velocity({.robot = robot_}, now);
  X_WG_.reset();
  return move_goal({}, {}, now);
}

bool RobotDriver::switch_goal(Time now) {
  if (!goals_.velocity || !goals_.frame) return false;
  static_cast<void>(steer({}, now).ok());
  moves_frame_ = !moves_frame_;
  return true;
}

Status RobotDriver::set_gripper(bool open, Time now) {
  GLOAM_TRY_STATUS(look_up());
  if (!goals_.gripper)
    return Error{ErrorKind::kUsage,
                 fmt::format("robot '{}' has no gripper", name_),
                 {},
                 "give a [[robot.part]] the controller \"gripper\""};
  const FingerGoal& finger = *goals_.gripper;
  GLOAM_TRY_STATUS(
      post({.what = SetJointGoal{finger.joint, open ? finger.open : finger.closed}}, now));
  is_open_ = open;
  return {};
}

void RobotDriver::release_idle(Time now) {
  const bool is_moving = !moves_frame_ && !is_standing(velocity_);
  if (!is_moving && now - last_post_ > kLeaseTime) lease_.reset();
}

std::string RobotDriver::goal_text() const {
  const std::string gripper =
      !goals_.gripper ? "" : (is_open_ ? "  gripper open" : "  gripper closed");
  if (moves_frame_) {
    const std::string goal =
        X_WG_ ? fmt::format("goal {:+.3f} {:+.3f} {:+.3f} m", X_WG_->p.x, X_WG_->p.y, X_WG_->p.z)
              : "goal unchanged";
    return goal + gripper;
  }
  const VelocityRanges& ranges = *goals_.velocity;
  std::string text = fmt::format("vx {:+.2f}", velocity_.vx);
  if (!ranges.vy.is_zero()) text += fmt::format("  vy {:+.2f}", velocity_.vy);
  if (!ranges.vz.is_zero()) text += fmt::format("  vz {:+.2f}", velocity_.vz);
  return text + fmt::format(" m/s  turn {:+.2f} rad/s", velocity_.yaw_rate) + gripper;
}

}  // namespace gloam::teleop
