#pragma once
// Restepper: makes a recorded run again, step by step, on the calling thread: for checkpoints and
// for the verification of logs.

#include <memory>
#include <vector>

#include "sim/loop/run_record.h"
#include "sim/loop/sim_loop.h"

namespace gloam {

class Restepper {
 public:
  /// Stands at step 0 of the record's first World.
  static Result<std::unique_ptr<Restepper>> create(RunRecord record, RobotMakers makers,
                                                   DataMaker make_data = {});

  /// Goes on to `step`, and stands there as before a recompile at it. Errors: physics fails, a
  /// World of the record cannot go on from the one before it.
  Status run_until(int64_t step);
  /// Goes on in another World where the record does so at the present step.
  Status begin_chapters();
  bool has_chapter_here() const;

  SimLoop& loop() { return *loop_; }
  const RunRecord& record() const { return record_; }

 private:
  Restepper(RunRecord record, RobotMakers makers, DataMaker make_data)
      : record_(std::move(record)), makers_(std::move(makers)), make_data_(std::move(make_data)) {}
  Status begin_chapter(const RunRecord::Chapter& chapter);
  void repeat_inputs();

  RunRecord record_;
  RobotMakers makers_;
  DataMaker make_data_;
  CommandQueue queue_{2, 0};
  std::unique_ptr<SimLoop> loop_;
  size_t next_chapter_ = 1, next_input_ = 0;
  std::vector<double> state_;  // of apply_input
};

}  // namespace gloam
