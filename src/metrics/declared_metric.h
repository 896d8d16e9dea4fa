#pragma once
// A [[metric]] of one robot, or of the scene.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "metrics/quantities.h"
#include "metrics/reduction.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class DeclaredMetric {
 public:
  /// `robot`: row of CompiledWorld::robots; -1 = the scene's. Error: of the expression, with the
  /// line of the [[metric]].
  static Result<DeclaredMetric> make(const MetricOptions& options, const CompiledWorld& world,
                                     const std::vector<BuiltinColumn>& builtin, int robot);

  const MetricOptions& options() const { return options_; }
  int robot() const { return robot_; }
  std::span<const QuantityReader> readers() const { return readers_; }
  /// Name before the unit: "ada.clearance".
  const std::string& name() const { return name_; }
  std::string column() const;

  void begin_episode();
  /// Value at an instant; NaN between the samples of a rate of its own, and where it has none.
  double sample(const MetricInstant& instant);
  void summarize(std::vector<MetricNumber>* numbers) const;
  /// Samples without a value so far, of all episodes.
  int64_t missing() const { return missing_; }

 private:
  MetricOptions options_;
  int robot_ = -1;
  std::string name_;
  Expression expression_;
  std::vector<QuantityReader> readers_;
  std::vector<double> inputs_;
  Reduction reduction_;
  StepSchedule schedule_;
  bool has_schedule_ = false;
  int64_t next_ = 0;  // number of the next sample of its schedule
  int64_t missing_ = 0;
};

}  // namespace gloam
