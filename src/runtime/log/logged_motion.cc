#include "runtime/log/logged_motion.h"

#include <fmt/format.h>

#include "runtime/live_simulation.h"
#include "sim/state/state_transfer.h"

namespace gloam {

Result<std::unique_ptr<LoggedMotion>> LoggedMotion::create(
    const LoggedRuns::Run& run, const std::shared_ptr<const CompiledWorld>& world) {
  if (!run.has_beginning || run.record.chapters.size() != 1)
    return Error{
        ErrorKind::kUnsupported,
        "the run began from a checkpoint or was recompiled on its way: its motion cannot be "
        "followed in another World"};
  GLOAM_TRY(auto restepper, Restepper::create(run.record, make_controllers));
  const CompiledWorld& from = *run.record.chapters.front().world;
  return std::unique_ptr<LoggedMotion>(
      new LoggedMotion(std::move(restepper), from, world, run.last_step, run.record.hash));
}

Status LoggedMotion::advance(int64_t step, mjData* data) {
  if (step > last_step_)
    return Error{ErrorKind::kPartial, fmt::format("the log ends at step {}", last_step_)};
  GLOAM_TRY_STATUS(restepper_->run_until(step));
  Stepper& stepper = restepper_->loop().stepper();
  if (step == last_step_ && stepper.hash() != last_hash_)
    return Error{ErrorKind::kPartial,
                 "the run was not the logged one: its last state hash differs",
                 {},
                 "`gloam replay LOG --verify` tells where"};
  transfer_state(same_, stepper.data(), *data);
  return {};
}

}  // namespace gloam
