#pragma once
// LoggedMotion: the motion of a logged run, stepped again to the bit, for a World that looks
// otherwise.

#include <memory>

#include "runtime/log/logged_runs.h"
#include "sim/loop/motion.h"
#include "sim/loop/restepper.h"
#include "sim/state/correspondence.h"

namespace gloam {

class LoggedMotion final : public Motion {
 public:
  /// `world`: whose bodies follow those of the same names in the run's World. Errors: the run began
  /// from a checkpoint, or was recompiled on its way.
  static Result<std::unique_ptr<LoggedMotion>> create(
      const LoggedRuns::Run& run, const std::shared_ptr<const CompiledWorld>& world);
  Status advance(int64_t step, mjData* data) override;
  bool moves_agents() const override { return !same_.before.agents.empty(); }
  void read_sensors(std::span<double> sensordata) const override;

 private:
  LoggedMotion(std::unique_ptr<Restepper> restepper, const CompiledWorld& from,
               std::shared_ptr<const CompiledWorld> to, int64_t last_step, uint64_t last_hash)
      : restepper_(std::move(restepper)),
        world_(std::move(to)),
        same_(from, *world_),
        last_step_(last_step),
        last_hash_(last_hash) {}

  std::unique_ptr<Restepper> restepper_;
  std::shared_ptr<const CompiledWorld> world_;
  Correspondence same_;
  int64_t last_step_;
  uint64_t last_hash_;
};

}  // namespace gloam
