#include "sim/loop/actuator_layer.h"

#include <algorithm>
#include <cmath>

#include "sim/loop/step_schedule.h"

namespace gloam {
namespace {

// MuJoCo sets all controls to zero and warns when one is not a number that it can use.
bool has_bad_control(const mjModel& model, const mjData& data) {
  return std::any_of(data.ctrl, data.ctrl + model.nu,
                     [](double control) { return !(std::abs(control) <= mjMAXVAL); });
}

}  // namespace

ActuatorLayers::ActuatorLayers(const ActuatorLayers& other)
    : commanded_(other.commanded_), flags_(other.flags_), error_(other.error_) {
  for (const Entry& entry : other.robots_) robots_.push_back({entry.robot, entry.layer->clone()});
}

ActuatorLayers& ActuatorLayers::operator=(const ActuatorLayers& other) {
  if (this != &other) *this = ActuatorLayers(other);
  return *this;
}

Status ActuatorLayers::add(int robot, std::unique_ptr<ActuatorLayer> layer, const mjModel& model,
                           const mjData& data) {
  GLOAM_TRY_STATUS(layer->begin(model, exact_rational(double{model.opt.timestep})));
  layer->reset(model, data);
  commanded_.resize(static_cast<size_t>(model.nu));
  robots_.push_back({robot, std::move(layer)});
  return {};
}

void ActuatorLayers::reset(const mjModel& model, const mjData& data) {
  for (const Entry& entry : robots_) entry.layer->reset(model, data);
}

void ActuatorLayers::take_over(const ActuatorLayers& before, const Correspondence& same,
                               const mjModel& model, const mjData& data) {
  for (const Entry& entry : robots_) {
    const int old = same.robot[static_cast<size_t>(entry.robot)];
    const auto from = std::ranges::find(before.robots_, old, &Entry::robot);
    if (old < 0 || from == before.robots_.end())
      entry.layer->reset(model, data);
    else
      entry.layer->take_over(model, data, *from->layer);
  }
}

bool ActuatorLayers::apply(mjModel* model, mjData* data) {
  if (robots_.empty() || has_bad_control(*model, *data)) return true;
  applied_ = true;
  std::copy_n(data->ctrl, commanded_.size(), commanded_.begin());
  flags_ = model->opt.disableflags;
  take_over_control_limits(model, data);
  for (const Entry& entry : robots_) {
    if (entry.layer->apply(*model, *data)) continue;
    error_ = entry.layer->error();
    return false;
  }
  return true;
}

void ActuatorLayers::release(mjModel* model, mjData* data) {
  if (!applied_) return;
  applied_ = false;
  for (const Entry& entry : robots_) entry.layer->observe(*model, *data);
  std::ranges::copy(commanded_, data->ctrl);
  model->opt.disableflags = flags_;
}

uint64_t ActuatorLayers::hash(uint64_t before) const {
  for (const Entry& entry : robots_) before = entry.layer->hash(before);
  return before;
}

void ActuatorLayers::publish(std::vector<ActuatorOutputs>* out) const {
  out->resize(robots_.size());
  for (size_t i = 0; i < robots_.size(); ++i) {
    (*out)[i].robot = robots_[i].robot;
    robots_[i].layer->publish(&(*out)[i]);
  }
}

}  // namespace gloam
