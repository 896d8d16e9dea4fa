#pragma once
// Metrics of a run: built in for each robot, and those that the scene declares. They are functions
// of Snapshots alone, and change nothing.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gloam/stream_info.h"
#include "metrics/builtin/robot_metric.h"
#include "metrics/declared_metric.h"
#include "metrics/probe_readings.h"

namespace gloam {

class Metrics {
 public:
  /// Curve of the contact sheet: columns; `commanded` may be "".
  struct Plot {
    std::string title, unit, measured, commanded;
  };
  /// From the start, or a reset, to the next or the end.
  struct Episode {
    int64_t steps = 0;
    double duration = 0;  ///< [s]
    uint64_t hash = 0;    ///< state hash at its end
    std::vector<MetricNumber> results;
  };

  /// Errors: an expression that does not parse, a quantity that there is not, a pattern that fits
  /// no robot, two columns of one name.
  static Result<std::unique_ptr<Metrics>> make(const CompiledWorld& world,
                                               MetricProbes probes = {});

  /// "time_s", then what metrics() tells of.
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<MetricInfo>& infos() const { return infos_; }
  /// Measured and commanded velocity of the first robot with velocity goals.
  std::vector<Plot> plots() const;

  /// Row of an instant of the World that the metrics are of; NaN = no value. A Snapshot of another
  /// run (after a reset) begins an episode.
  const std::vector<double>& sample(const Snapshot& snapshot);
  /// Numbers of the episode so far: "NAME.path_length_m", "NAME.falls" …
  std::vector<MetricNumber> summary() const;
  /// All episodes so far, the last one among them.
  std::vector<Episode> episodes() const;
  /// Columns with samples without a value, and how many.
  std::vector<std::pair<std::string, int64_t>> missing() const;

 private:
  struct Family {
    std::unique_ptr<RobotMetric> metric;
    std::string prefix;           ///< "ada."
    size_t first = 0, count = 0;  ///< columns
  };
  Metrics() = default;
  void add_robot(const CompiledWorld& world, int index, std::vector<BuiltinColumn>* builtin);
  Status add_declared(const CompiledWorld& world, const std::vector<BuiltinColumn>& builtin);
  Status add_declared_of(const MetricOptions& options, const CompiledWorld& world,
                         const std::vector<BuiltinColumn>& builtin, int robot);
  void begin_episode();
  void measure_light(const Snapshot& snapshot);
  Episode present_episode() const;

  MetricProbes probes_;
  ProbeReadings readings_;
  std::vector<MetricRobot> robots_;
  std::vector<Family> families_;
  std::vector<DeclaredMetric> declared_;
  std::vector<std::string> columns_;
  std::vector<MetricInfo> infos_;
  Instant instant_;
  std::vector<ContactState> contacts_;
  std::vector<double> row_, light_;
  Episode present_;      // without results
  int64_t run_ = 0;      // SnapshotData::run of it
  int64_t samples_ = 0;  // of this episode
  bool told_failure_ = false;
  std::vector<Episode> ended_;
};

/// Does an expression of the scene hold that word? What is measured on demand alone.
bool metrics_name(const Scene& scene, std::string_view word);

}  // namespace gloam
