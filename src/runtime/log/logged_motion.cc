#include "runtime/log/logged_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "control/controllers.h"
#include "runtime/live/live_simulation.h"
#include "sim/state/state_transfer.h"

namespace gloam {
namespace {

// Whether two sensors measure the same quantity in the same way.
bool is_same_sensor(const mjModel& a, int i, const mjModel& b, int k) {
  return a.sensor_type[i] == b.sensor_type[k] && a.sensor_dim[i] == b.sensor_dim[k] &&
         a.sensor_objtype[i] == b.sensor_objtype[k] && a.sensor_reftype[i] == b.sensor_reftype[k] &&
         a.sensor_cutoff[i] == b.sensor_cutoff[k];
}

}  // namespace

Result<std::unique_ptr<LoggedMotion>> LoggedMotion::create(
    const LoggedRuns::Run& run, const std::shared_ptr<const CompiledWorld>& world) {
  if (!run.has_beginning || run.record.chapters.size() != 1)
    return Error{ErrorKind::kUnsupported,
                 "the run started from a checkpoint or was recompiled: its motion cannot be "
                 "replayed in another World"};
  GLOAM_TRY(auto restepper,
            Restepper::create(run.record, run.has_history ? robot_makers() : replay_makers()));
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
                 "the replay does not match the logged run: the hash of its last state differs",
                 {},
                 "`gloam replay LOG --verify` reports where"};
  transfer_state(same_, stepper.data(), *data);
  return {};
}

// Readings depend on forces and on the order of a step, which poses do not tell: those of the
// logged run are the exact ones. A sensor that another scene has changed measures anew.
void LoggedMotion::read_sensors(std::span<double> sensordata) const {
  const mjModel &from = *same_.before.model, &to = *same_.after.model;
  const std::span<const double> logged = restepper_->loop().stepper().sensordata();
  for (size_t sensor = 0; sensor < same_.sensor.size(); ++sensor) {
    const int before = same_.sensor[sensor];
    if (before < 0 || !is_same_sensor(from, before, to, static_cast<int>(sensor))) continue;
    std::copy_n(logged.begin() + from.sensor_adr[before], from.sensor_dim[before],
                sensordata.begin() + to.sensor_adr[sensor]);
  }
}

}  // namespace gloam
