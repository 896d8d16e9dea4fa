#pragma once
// Numbers that a run is judged by: [[metric]] and [[goal]] (docs/metrics.md). Part of
// gloam/scene.h.

#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[metric]]: an expression over each instant of a run: a column of metrics.csv, and numbers of
/// the summary.
struct MetricOptions {
  std::string name = {};    ///< column, behind the robot's name and before the unit
  std::string value = {};   ///< expression: 'norm(body("ada/trunk").velocity)'
  std::string unit = {};    ///< unit of its value, joins the column's name: "m/s" as "mps"
  std::string robots = {};  ///< robots that have it, * stands for any text; empty = the scene's own
  /// Numbers of the summary: last | mean | min | max | rms | sum | integral | first_time_true |
  /// fraction_true
  std::vector<std::string> reduce = {"mean"};
  /// Evaluations per second of simulation time [Hz], at most record.metrics_rate; empty = as often.
  std::optional<Rational> rate = {};
  SourceLoc loc = {};
};

/// [[goal]]: a place that a robot has to reach. Several goals of a robot are reached in the order
/// in which they are written.
struct GoalOptions {
  std::string robot = {};  ///< robot that has to reach it; * stands for any text
  Vec3 position = {};      ///< place in the world [m]; distances to it are horizontal
  double radius = 0.5;     ///< distance of the robot's root body at which it is reached [m]
  double time_limit = 0;   ///< time by which it has to be reached, from the start [s]; 0 = any
  /// Length of the shortest way here from the last goal, or from the start, for SPL [m]; empty = a
  /// straight line.
  std::optional<double> shortest_path = {};
  /// Speed that the robot could have on that way, for the success weighted by completion time
  /// [m/s]; 0 = it is not told.
  double top_speed = 0;
  SourceLoc loc = {};
};

}  // namespace gloam
