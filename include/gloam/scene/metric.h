#pragma once
// Evaluation of runs: [[metric]] and [[goal]] (docs/metrics.md). Part of gloam/scene.h.

#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[metric]]: an expression that is evaluated at each instant of a run, for a column of
/// metrics.csv and values of the summary.
struct MetricOptions {
  std::string name = {};    ///< name of the column, between the robot's name and the unit
  std::string value = {};   ///< expression: 'norm(body("ada/trunk").velocity)'
  std::string unit = {};    ///< unit of its value, appended to the column's name: "m/s" as "mps"
  std::string robots = {};  ///< robots to which it applies, * matches any text; empty = the scene
  /// Values of the summary: last | mean | min | max | rms | sum | integral | first_time_true |
  /// fraction_true
  std::vector<std::string> reduce = {"mean"};
  /// Evaluations per second of simulation time [Hz], at most record.metrics_rate, the default if
  /// empty.
  std::optional<Rational> rate = {};
  SourceLoc loc = {};
};

/// [[goal]]: a place that a robot has to reach. Several goals of a robot have to be reached in the
/// order of the tables.
struct GoalOptions {
  std::string robot = {};  ///< robot that has to reach it; * matches any text
  Vec3 position = {};      ///< place in the world [m]; distances to it are horizontal
  double radius = 0.5;     ///< distance of the robot's root body at which it is reached [m]
  double time_limit = 0;   ///< time by which it has to be reached, from the start [s]; 0 = any
  /// Length of the shortest path here from the previous goal, or from the start, for SPL [m]; empty
  /// = a straight line.
  std::optional<double> shortest_path = {};
  /// Speed that the robot can reach on that path, for success weighted by completion time [m/s]; 0
  /// = unknown.
  double top_speed = 0;
  SourceLoc loc = {};
};

}  // namespace gloam
