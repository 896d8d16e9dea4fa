#pragma once
// A family of built-in metrics of one robot. A family is a file in this folder and a row of
// kFamilies in robot_metric.cc.

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/handle.h"
#include "metrics/metric_instant.h"
#include "world/world.h"

namespace gloam {

struct MetricColumn {
  std::string name;  ///< without robot and unit: "path_length"
  std::string unit;  ///< "m", "m/s" …; "" = none
};
/// Number of the summary, without the robot's name: "path_length_m".
using MetricNumber = std::pair<std::string, double>;

/// A robot as families know it.
struct MetricRobot {
  const CompiledWorld* world = nullptr;
  const RobotInstance* instance = nullptr;
  int index = 0;                 ///< row of MetricInstant::light
  int base = -1;                 ///< its free joint; -1 = it has none
  bool moves_about = false;      ///< has a free joint, or its root body slides
  std::vector<int> actuators;    ///< ids
  std::vector<char> own_bodies;  ///< by body: is it the robot's?
  double mass = 0;               ///< [kg]
  double reach = 0;              ///< of its colliders, sideways from its base, at qpos0 [m]
  std::vector<GoalOptions> goals;
  const MetricProbes* probes = nullptr;

  int root() const { return instance->root_body; }
};

class RobotMetric {
 public:
  virtual ~RobotMetric() = default;
  virtual std::vector<MetricColumn> columns() const = 0;
  /// Forgets all of the episode before.
  virtual void begin_episode() = 0;
  /// Fills one number per column.
  virtual void sample(const MetricInstant& instant, std::span<double> out) = 0;
  /// Numbers of the episode so far, all of them finite.
  virtual void summarize(std::vector<MetricNumber>* numbers) const = 0;
};

/// Null where the family says nothing of this robot.
using RobotMetricFactory = std::unique_ptr<RobotMetric> (*)(const MetricRobot& robot);

std::unique_ptr<RobotMetric> make_pose_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_velocity_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_fall_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_visibility_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_illuminance_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_path_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_energy_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_electricity_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_collision_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_slip_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_servo_metric(const MetricRobot& robot);
std::unique_ptr<RobotMetric> make_goal_metric(const MetricRobot& robot);

/// All families, in the order of their columns.
std::span<const RobotMetricFactory> robot_metrics();

/// The robot in that row of CompiledWorld::robots.
MetricRobot describe_robot(const CompiledWorld& world, int index, const MetricProbes& probes);

/// Velocity of a point of a body, world axes [m/s].
Vec3 velocity_of_point(const MetricInstant& instant, int body, const Vec3& p_W);

/// A unit as a part of a name: "m/s" -> "mps", "rad" -> "rad"; "" stays.
std::string unit_word(std::string_view unit);
/// "path_length", "m" -> "path_length_m".
std::string with_unit(const std::string& name, std::string_view unit);

}  // namespace gloam
