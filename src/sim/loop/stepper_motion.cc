// Steps of a Stepper that follows a motion: its effects look on and act on nothing.

#include <algorithm>

#include "base/hash.h"
#include "scene/files/mujoco_guard.h"
#include "sim/loop/motion.h"
#include "sim/loop/stepper.h"

namespace gloam {

bool Stepper::follow(std::unique_ptr<Motion> motion) {
  motion_ = std::move(motion);
  // An effect that moves people would undo a motion that has their poses already.
  if (motion_->moves_agents())
    std::erase_if(effects_, [](const auto& effect) { return effect->moves_bodies(); });
  if (const Status moved = motion_->advance(0, data_.get()); !moved.ok())
    return fail(moved.error());
  return begin_where_moved() || fail({ErrorKind::kInput, mujoco_error_message()});
}

bool Stepper::jump(int64_t step) {
  if (!reset()) return false;
  const int64_t to = effects_.empty() ? step : 0;
  if (const Status moved = motion_->advance(to, data_.get()); !moved.ok())
    return fail(moved.error());
  if (!begin_where_moved()) return fail({ErrorKind::kInput, mujoco_error_message()});
  step_ = to;
  hash_ = hash_span<double>(state_, hash_);
  return true;
}

// The first instant: its sensors are of its own state.
bool Stepper::begin_where_moved() {
  const bool ok = stand_where_moved();
  std::copy_n(data_->sensordata, sensors_.size(), sensors_.begin());
  sensor_stamp_ = state_[0];
  motion_->read_sensors(sensors_);
  return ok;
}

// Poses, contacts and sensors of the state that is in mjData.
bool Stepper::stand_where_moved() {
  const mjModel* model = &model_;
  mjData* data = data_.get();
  const bool ok = try_mujoco([=] { mj_forward(model, data); });
  mj_getState(model, data, state_.data(), mjSTATE_INTEGRATION);
  own_sensors_ = true;
  snapshot_ = {};
  return ok;
}

bool Stepper::step_along() {
  mjData* data = data_.get();
  events_.loads.clear();
  events_.footfalls.clear();
  if (acts_on_bodies_) {  // ripples and tracks come of forces, which nothing feels here
    std::copy_n(data->qfrc_applied, model_.nv, applied_.begin());
    for (const auto& effect : effects_) effect->apply_forces(context(step_));
    for (const auto& effect : effects_) effect->apply_loads(context(step_));
    for (const auto& effect : effects_) effect->end_step(model_);
    std::copy(applied_.begin(), applied_.end(), data->qfrc_applied);
  }
  // A step of physics measures the state that it starts from, and so does this one.
  std::copy_n(data->sensordata, sensors_.size(), sensors_.begin());
  sensor_stamp_ = state_[0];
  if (const Status moved = motion_->advance(step_ + 1, data); !moved.ok())
    return fail(moved.error());
  if (!stand_where_moved()) return fail({ErrorKind::kInput, mujoco_error_message()});
  motion_->read_sensors(sensors_);
  for (const auto& effect : effects_) effect->advance(context(step_ + 1));
  for (const auto& effect : effects_) effect->observe(context(step_ + 1));
  ++step_;
  hash_ = hash_span<double>(state_, hash_);
  if (step_ == next_tick()) tick_effects();
  return true;
}

}  // namespace gloam
