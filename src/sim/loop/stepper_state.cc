// Copies of a Stepper's instant and back.

#include <algorithm>

#include "scene/files/mujoco_guard.h"
#include "sim/commands/live_fields.h"
#include "sim/loop/checkpoint.h"
#include "sim/loop/stepper.h"

namespace gloam {

std::unique_ptr<StepperState> Stepper::save() const {
  if (!effects_.empty() || failed_) return nullptr;
  mjData* copy = nullptr;
  const mjModel* model = &model_;
  const mjData* data = data_.get();
  if (!try_mujoco([&] { copy = mj_copyData(nullptr, model, data); }) || copy == nullptr)
    return nullptr;
  return std::make_unique<StepperState>(StepperState{DataPtr(copy), *inputs_, actuators_, live_,
                                                     since_, step_, hash_, state_, sensors_,
                                                     own_sensors_, sensor_stamp_, warnings_seen_});
}

// The model's fields as they are in `live`.
bool Stepper::set_live(const std::shared_ptr<const LiveFields>& live) {
  if (live == live_) return true;
  live_.reset();
  if (!take_back_model()) return false;
  if (live == nullptr) return true;
  std::vector<LiveFieldId> changed;
  for (int f = 0; f < kLiveFieldCount; ++f)
    if (!live->values[static_cast<size_t>(f)].empty())
      changed.push_back(static_cast<LiveFieldId>(f));
  // Masses and armatures first: they bring a whole model, in which nothing else is changed yet.
  std::ranges::stable_partition(changed, derives_constants);
  if (!changed.empty() && derives_constants(changed[0]) && scratch_ == nullptr) {
    mjData* scratch = nullptr;
    const mjModel* model = &model_;
    if (!try_mujoco([&] { scratch = mj_makeData(model); }))
      return fail({ErrorKind::kInput, mujoco_error_message()});
    scratch_.reset(scratch);
  }
  for (const LiveFieldId field : changed) {
    const std::vector<double>& values = live->values[static_cast<size_t>(field)];
    if (!own_the_field(field)) return false;
    const Status written = write_live_field(*world_->model, field, values, model_, scratch_.get());
    if (!written.ok()) return fail(written.error());
  }
  live_ = live;
  return true;
}

bool Stepper::restore(const StepperState& saved) {
  failed_ = false;
  snapshot_ = {};
  if (!set_live(saved.live)) return false;
  const mjModel* model = &model_;
  mjData* data = data_.get();
  if (!try_mujoco([&] { mj_copyData(data, model, saved.data.get()); }))
    return fail({ErrorKind::kInput, mujoco_error_message()});
  *inputs_ = saved.inputs;
  actuators_ = saved.actuators;
  since_ = saved.since;
  step_ = saved.step;
  hash_ = saved.hash;
  state_ = saved.state;
  sensors_ = saved.sensors;
  own_sensors_ = saved.own_sensors;
  sensor_stamp_ = saved.sensor_stamp;
  warnings_seen_ = saved.warnings_seen;
  reader_ = StateReader(model_, *data_);
  return true;
}

void Stepper::set_run(int64_t run) {
  run_ = run;
  snapshot_ = {};
}

}  // namespace gloam
