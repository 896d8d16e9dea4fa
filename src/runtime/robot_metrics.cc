#include "runtime/robot_metrics.h"

#include <cmath>

#include "gloam/scene.h"
#include "sim/command_check.h"

namespace gloam {
namespace {

constexpr const char* kAxes[] = {"vx", "vy", "yaw_rate"};
constexpr const char* kUnits[] = {"mps", "mps", "radps"};

// The goal that the scene's schedule has put in force at `time`.
VelocityGoal goal_at(const RobotOptions& robot, double time) {
  VelocityGoal current;
  for (const VelocityGoal& goal : robot.controller.goals) {
    if (goal.time <= time) current = goal;
  }
  return current;
}

}  // namespace

RobotMetrics::RobotMetrics(const CompiledWorld& world) {
  columns_.push_back("time_s");
  for (const RobotInstance& robot : world.robots) {
    const int joint = floating_joint(*world.model, robot.root_body);
    if (joint < 0) continue;
    Tracked tracked;
    tracked.name = robot.name;
    tracked.options = &robot.options;
    tracked.base = {joint};
    robots_.push_back(tracked);
    const std::string prefix = robot.name.empty() ? "" : robot.name + ".";
    for (const char* column : {"x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad"}) {
      columns_.push_back(prefix + column);
    }
    for (int axis = 0; axis < 3; ++axis)
      columns_.push_back(prefix + kAxes[axis] + "_" + kUnits[axis]);
    for (int axis = 0; axis < 3; ++axis)
      columns_.push_back(prefix + kAxes[axis] + "_goal_" + kUnits[axis]);
    columns_.push_back(prefix + "fallen");
  }
}

std::vector<MetricPlot> RobotMetrics::plots() const {
  for (const Tracked& robot : robots_) {
    if (robot.options->controller.goals.empty()) continue;
    const std::string prefix = robot.name.empty() ? "" : robot.name + ".";
    const auto plot = [&](const char* title, const char* unit, int axis) {
      const std::string name = prefix + kAxes[axis];
      return MetricPlot{title, unit, name + "_" + kUnits[axis], name + "_goal_" + kUnits[axis]};
    };
    return {plot("forward speed", "m/s", 0), plot("sideways speed", "m/s", 1),
            plot("turn rate", "rad/s", 2)};
  }
  return {};
}

const std::vector<double>& RobotMetrics::sample(const Snapshot& snapshot) {
  row_.assign(1, snapshot.time());
  for (Tracked& robot : robots_) measure(robot, snapshot);
  ++samples_;
  return row_;
}

void RobotMetrics::measure(Tracked& robot, const Snapshot& snapshot) {
  const JointState base = snapshot[robot.base];
  const double x = base.qpos[0], y = base.qpos[1], z = base.qpos[2];
  const double qw = base.qpos[3], qx = base.qpos[4], qy = base.qpos[5], qz = base.qpos[6];
  const double yaw = std::atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz));
  const double pitch = std::asin(std::fmin(1.0, std::fmax(-1.0, 2 * (qw * qy - qz * qx))));
  const double roll = std::atan2(2 * (qw * qx + qy * qz), 1 - 2 * (qx * qx + qy * qy));
  const double up = 1 - 2 * (qx * qx + qy * qy);  // vertical share of the body's z axis

  // A free joint's linear velocity is in world axes, its angular velocity in the body's.
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double wx = base.qvel[3], wy = base.qvel[4], wz = base.qvel[5];
  const double measured[3] = {
      c * base.qvel[0] + s * base.qvel[1], -s * base.qvel[0] + c * base.qvel[1],
      2 * (qx * qz - qw * qy) * wx + 2 * (qy * qz + qw * qx) * wy + up * wz};
  const VelocityGoal goal = goal_at(*robot.options, snapshot.time());
  const double wanted[3] = {goal.vx, goal.vy, goal.yaw_rate};
  for (int axis = 0; axis < 3; ++axis) {
    robot.error_squared[axis] += (measured[axis] - wanted[axis]) * (measured[axis] - wanted[axis]);
    robot.goal_squared[axis] += wanted[axis] * wanted[axis];
  }

  if (!robot.has_start) {
    robot.has_start = true;
    robot.start_height = z;
  } else {
    robot.path_length += std::hypot(x - robot.last_x, y - robot.last_y);
  }
  robot.last_x = x;
  robot.last_y = y;
  // Fallen: tipped by more than 60 degrees, or the base at half its first height.
  const bool fallen = up < 0.5 || z < 0.5 * robot.start_height;
  if (fallen && !robot.fallen) ++robot.falls;
  robot.fallen = fallen;

  row_.insert(row_.end(), {x, y, z, roll, pitch, yaw});
  row_.insert(row_.end(), measured, measured + 3);
  row_.insert(row_.end(), wanted, wanted + 3);
  row_.push_back(fallen ? 1 : 0);
}

std::vector<NamedNumber> RobotMetrics::summary() const {
  std::vector<NamedNumber> numbers;
  for (const Tracked& robot : robots_) {
    const std::string prefix = robot.name.empty() ? "" : robot.name + ".";
    for (int axis = 0; axis < 3; ++axis) {
      if (robot.goal_squared[axis] <= 0) continue;
      numbers.emplace_back(prefix + kAxes[axis] + "_error_rms_percent",
                           100 * std::sqrt(robot.error_squared[axis] / robot.goal_squared[axis]));
    }
    numbers.emplace_back(prefix + "falls", static_cast<double>(robot.falls));
    numbers.emplace_back(prefix + "path_length_m", robot.path_length);
  }
  return numbers;
}

}  // namespace gloam
