#pragma once
// PoseMotion: the motion of a logged run as its states tell, for a World that looks otherwise.
// Exact at the steps that were logged, interpolated between; any step at once, forwards or back.

#include <memory>
#include <optional>
#include <vector>

#include "mcap/mcap_reader.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/logged_runs.h"
#include "sim/loop/motion.h"
#include "sim/state/correspondence.h"

namespace gloam {

class PoseMotion final : public Motion {
 public:
  /// `run`: its World may have been compiled otherwise; `to`: whose bodies
  /// follow those of the same names. `log` outlives it. Errors: states of another size, a recompile
  /// on the way.
  static Result<std::unique_ptr<PoseMotion>> create(const McapReader& log,
                                                    const LoggedRuns::Run& run,
                                                    std::shared_ptr<const CompiledWorld> to);
  /// Before the first logged state bodies stand as in it.
  Status advance(int64_t step, mjData* data) override;
  bool moves_agents() const override { return !same_.before.agents.empty(); }

 private:
  struct FirstState {
    int64_t step = 0;
    uint64_t time = 0;  // log time [ns]
  };

  PoseMotion(const McapReader& log, const LoggedRuns::Run& run,
             std::shared_ptr<const CompiledWorld> to);
  Status begin_at(uint64_t time);
  Status look_at(int64_t step);
  Result<std::optional<gloam_msgs::State>> next();
  void interpolate(double share);

  McapMessages messages_;
  const int64_t run_;
  std::shared_ptr<const CompiledWorld> from_, to_;
  Correspondence same_;
  DataPtr data_, after_data_;                        // of from_
  std::optional<gloam_msgs::State> before_, after_;  // around the present step
  std::optional<FirstState> first_;
  uint64_t time_ = 0;             // log time of the last state that began a reading [ns]
  const double step_time_;        // [s]
  std::vector<double> velocity_;  // (nv)
};

}  // namespace gloam
