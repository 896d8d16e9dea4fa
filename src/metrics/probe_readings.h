#pragma once
// Probes that expressions of metrics name: each is read at its own rate, and its numbers hold until
// the next reading.

#include <memory>
#include <span>
#include <vector>

#include "sensors/probe/probe.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class ProbeReadings {
 public:
  explicit ProbeReadings(ProbeSources sources = {}) : sources_(std::move(sources)) {}

  /// Has it read; `row` of CompiledWorld::probes.
  void add(int row);
  /// Reads at an instant what is due. What cannot be read has no numbers, which is told once.
  void follow(const Snapshot& snapshot);
  /// Numbers of a probe that was added.
  std::span<const double> numbers(int row) const;

 private:
  struct Entry {
    int row = 0;
    ProbeReader read;  // empty until the first instant, and where it cannot be made
    StepSchedule schedule;
    int64_t next = 0;  // step
    std::vector<double> numbers;
  };
  void open(const Snapshot& snapshot);
  void tell(const Entry& entry, const Error& error);

  ProbeSources sources_;
  std::vector<Entry> entries_;
  std::unique_ptr<ProbeInstant> instant_;  // null until the first instant
  int64_t last_ = -1;                      // step
  bool has_told_ = false;
};

}  // namespace gloam
