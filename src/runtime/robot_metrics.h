#pragma once
// Metrics of robots: error against their velocity goals, and the visibility around them. One row of
// metrics.csv per sample, and the numbers of the summary.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gloam/snapshot.h"
#include "record/recorder.h"
#include "runtime/light_probe.h"
#include "runtime/visibility_probe.h"
#include "world/world.h"

namespace gloam {

class RobotMetrics {
 public:
  /// Robots with a floating base are measured; others give no columns. Visibility is measured where
  /// the scene has media: the least at eight points around the robot at the height of its base.
  /// With a light probe the illuminance over the robot, of a level surface, once in `light_every`
  /// samples.
  explicit RobotMetrics(const CompiledWorld& world, VisibilityProbe probe = {},
                        std::unique_ptr<LightProbe> light = nullptr, int64_t light_every = 1);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Plots for the contact sheet: measured and commanded velocity of the first robot with goals.
  std::vector<MetricPlot> plots() const;
  /// The row of one instant; also feeds the summary.
  const std::vector<double>& sample(const Snapshot& snapshot);
  /// "NAME.vx_error_rms_percent" … over all samples so far, "NAME.falls", and in media
  /// "NAME.visibility_min_m", "NAME.visibility_mean_m": of the mean extinction; with a light probe
  /// "NAME.illuminance_min_lx", "NAME.illuminance_mean_lx".
  std::vector<NamedNumber> summary() const;

 private:
  struct Tracked {
    std::string name;
    const RobotOptions* options = nullptr;
    Joint base;               // its free joint
    double start_height = 0;  // [m]
    double reach = 0;         // reach of its colliders, sideways from its base, at qpos0 [m]
    bool has_start = false, fallen = false;
    int64_t falls = 0;
    double error_squared[3] = {}, goal_squared[3] = {};
    double path_length = 0, last_x = 0, last_y = 0;                     // [m]
    double least_visibility = VisibilityProbe::kClear, extinction = 0;  // [m]; sum of samples [1/m]
    double illuminance = 0, least_illuminance = 0, illuminances = 0;    // [lx]; the last, …, sum
  };
  void measure(Tracked& robot, const Snapshot& snapshot);
  void measure_light(const Snapshot& snapshot);
  // Around it, since its own body keeps smoke out.
  double visibility(const Tracked& robot, const Snapshot& snapshot, double x, double y,
                    double z) const;

  VisibilityProbe probe_;
  std::unique_ptr<LightProbe> light_;
  int64_t light_every_;
  int64_t lights_ = 0;  // samples of it
  std::vector<Tracked> robots_;
  std::vector<std::string> columns_;
  std::vector<double> row_;
  int64_t samples_ = 0;
};

}  // namespace gloam
