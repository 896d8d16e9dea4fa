#include "sim/effects/water/water_effect.h"

#include "base/hash.h"
#include "sim/effects/water/water_surface.h"
#include "world/effects/surface_layout.h"

namespace gloam {

Result<std::unique_ptr<Effect>> WaterEffect::make(const EffectParts& parts) {
  if (parts.world->waters.empty()) return std::unique_ptr<Effect>();
  // All waters have one rate.
  const auto schedule =
      StepSchedule::at_most(parts.world->waters.front().ripple_rate, parts.timestep);
  return std::unique_ptr<Effect>(new WaterEffect(parts.world, parts.timestep, schedule));
}

WaterEffect::WaterEffect(std::shared_ptr<const CompiledWorld> world, Rational timestep,
                         StepSchedule schedule)
    : world_(std::move(world)),
      schedule_(schedule),
      timestep_(timestep.value()),
      shapes_(immersed_shapes(*world_->model)),
      forces_(*world_->model, waters(), shapes_),
      changes_(waters().size()) {
  // Ticks fall on whole steps, so that one may be a step longer than the rate says.
  const double longest = 1 / waters().front().ripple_rate.value() + timestep_;
  for (const WaterDescription& water : waters()) {
    ripples_.push_back(water.ripples.nx > 0 ? std::make_unique<WaterRipples>(water, longest)
                                            : nullptr);
  }
}

void WaterEffect::reset(const EffectContext&) { clear(); }

void WaterEffect::clear() {
  for (const auto& ripples : ripples_)
    if (ripples != nullptr) ripples->reset();
  tick_ = -1;
}

void WaterEffect::take_over(const EffectContext& at, Effect* before) {
  clear();
  tick_ = schedule_.first_at_or_after(at.step) - 1;
  const auto* other = static_cast<const WaterEffect*>(before);
  for (size_t i = 0; other != nullptr && i < ripples_.size(); ++i) {
    for (size_t k = 0; k < other->ripples_.size(); ++k) {
      const WaterDescription &a = waters()[i], &b = other->waters()[k];
      if (ripples_[i] != nullptr && other->ripples_[k] != nullptr && a.name == b.name &&
          a.ripples == b.ripples)
        ripples_[i]->take_over(*other->ripples_[k]);
    }
  }
}

void WaterEffect::apply_forces(const EffectContext& at) {
  if (at.step == schedule_.step_of(tick_ + 1)) {
    advance_ripples(at.data);
    for (const auto& ripples : ripples_) {
      const uint64_t digest = ripples != nullptr ? ripples->digest() : 0;
      if (digest != 0) at.hash = hash_bytes(&digest, sizeof(digest), at.hash);
    }
  }
  look(at.step, changes_);
  const bool has_masses = forces_.begin(at.model, at.data, changes_);
  if (has_masses && at.is_halved) forces_.add_masses(at.model, at.data);
}

void WaterEffect::advance_ripples(const mjData& data) {
  const int64_t from = tick_ >= 0 ? schedule_.step_of(tick_) : 0;
  const double interval = static_cast<double>(schedule_.step_of(++tick_) - from) * timestep_;
  for (size_t i = 0; i < ripples_.size(); ++i) {
    if (ripples_[i] == nullptr) continue;
    const WaterDescription& water = waters()[i];
    for (const ImmersedShape& shape : shapes_) {
      if (!forces_.is_near(i, shape, data)) continue;
      const double* p = data.geom_xpos + 3 * shape.geom;
      const double surface = water.level + wave_height(water, p[0], p[1], data.time);
      ripples_[i]->displace(shape, p, data.geom_xmat + 9 * shape.geom, surface);
    }
    ripples_[i]->advance(interval);
  }
}

void WaterEffect::look(int64_t step, std::span<HeightChange> changes) const {
  const int64_t from = tick_ >= 0 ? schedule_.step_of(tick_) : 0;
  const auto since = static_cast<float>(static_cast<double>(step - from) * timestep_);
  for (size_t i = 0; i < ripples_.size(); ++i) {
    if (ripples_[i] != nullptr) changes[i] = {ripples_[i]->field(), since};
  }
}

void WaterEffect::publish(int64_t step, EffectOutputs* out) {
  look(step, std::span(out->surfaces).subspan(water_surface(*world_, 0), ripples_.size()));
}

}  // namespace gloam
