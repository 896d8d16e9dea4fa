#include "runtime/robot_metrics.h"

#include <algorithm>
#include <cmath>

#include "gloam/scene.h"
#include "sim/commands/command_check.h"

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

// Reach of the robot's colliders, sideways from its base [m].
double reach_of(const mjModel& m, const mjData& d, int root) {
  double reach = 0;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.body_rootid[m.geom_bodyid[g]] != root || !(m.geom_contype[g] | m.geom_conaffinity[g]))
      continue;
    const mjtNum *p = d.geom_xpos + 3 * g, *base = d.xpos + 3 * root;
    reach = std::max(reach, std::hypot(p[0] - base[0], p[1] - base[1]) + m.geom_rbound[g]);
  }
  return reach;
}

}  // namespace

RobotMetrics::RobotMetrics(const CompiledWorld& world, VisibilityProbe probe,
                           std::unique_ptr<LightProbe> light, int64_t light_every)
    : probe_(std::move(probe)), light_(std::move(light)), light_every_(light_every) {
  columns_.push_back("time_s");
  const mjModel& model = *world.model;
  const bool measures_around = probe_.has_media() || light_ != nullptr;
  const DataPtr data(measures_around ? mj_makeData(&model) : nullptr);
  if (data) mj_kinematics(&model, data.get());
  for (const RobotInstance& robot : world.robots) {
    const int joint = floating_joint(*world.model, robot.root_body);
    if (joint < 0) continue;
    Tracked tracked;
    tracked.name = robot.name;
    tracked.options = &robot.options;
    tracked.base = {joint};
    if (data) tracked.reach = reach_of(model, *data, robot.root_body);
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
    if (probe_.has_media()) columns_.push_back(prefix + "visibility_m");
    if (light_ != nullptr) columns_.push_back(prefix + "illuminance_lx");
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
  if (light_ != nullptr && samples_ % light_every_ == 0) measure_light(snapshot);
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
  const double up = 1 - 2 * (qx * qx + qy * qy);  // vertical fraction of the body's z axis

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
  if (probe_.has_media()) {
    const double visibility = this->visibility(robot, snapshot, x, y, z);
    robot.least_visibility = std::min(robot.least_visibility, visibility);
    robot.extinction += kKoschmieder / visibility;
    row_.push_back(visibility);
  }
  if (light_ != nullptr) row_.push_back(robot.illuminance);
}

void RobotMetrics::measure_light(const Snapshot& snapshot) {
  std::vector<Vec3> places;
  for (const Tracked& robot : robots_) {
    const JointState base = snapshot[robot.base];
    // Over all of it: it casts no shadow there.
    places.push_back({base.qpos[0], base.qpos[1], base.qpos[2] + robot.reach});
  }
  const std::vector<double> light = light_->illuminance(snapshot, places);
  for (size_t i = 0; i < robots_.size(); ++i) {
    Tracked& robot = robots_[i];
    robot.illuminance = light[i];
    robot.illuminances += light[i];
    robot.least_illuminance = lights_ == 0 ? light[i] : std::min(robot.least_illuminance, light[i]);
  }
  ++lights_;
}

double RobotMetrics::visibility(const Tracked& robot, const Snapshot& snapshot, double x, double y,
                                double z) const {
  constexpr int kPoints = 8;
  constexpr double kClear = 0.15;  // margin for voxels that it fills in part [m]
  double least = VisibilityProbe::kClear;
  for (int i = 0; i < kPoints; ++i) {
    const double a = 2 * M_PI * i / kPoints, r = robot.reach + kClear;
    const Vec3f p{float(x + r * std::cos(a)), float(y + r * std::sin(a)), float(z)};
    least = std::min(least, probe_.visibility(snapshot.data(), p));
  }
  return least;
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
    if (probe_.has_media() && samples_ > 0) {
      numbers.emplace_back(prefix + "visibility_min_m", robot.least_visibility);
      numbers.emplace_back(prefix + "visibility_mean_m",
                           kKoschmieder * static_cast<double>(samples_) / robot.extinction);
    }
    if (lights_ > 0) {
      numbers.emplace_back(prefix + "illuminance_min_lx", robot.least_illuminance);
      numbers.emplace_back(prefix + "illuminance_mean_lx",
                           robot.illuminances / static_cast<double>(lights_));
    }
  }
  return numbers;
}

}  // namespace gloam
