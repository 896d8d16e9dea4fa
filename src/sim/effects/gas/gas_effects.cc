#include "sim/effects/gas/gas_effects.h"

#include <algorithm>

#include "base/hash.h"
#include "sim/effects/gas/gas_effect.h"

namespace gloam {

Result<std::unique_ptr<Effect>> GasEffects::make(const EffectParts& parts) {
  std::unique_ptr<GasEffects> effects;
  for (size_t row = 0; row < parts.world->gases.gases.size(); ++row) {
    if (effects == nullptr) effects.reset(new GasEffects(*parts.world, parts.timestep));
    GLOAM_TRY(std::unique_ptr<GasEffect> gas, GasEffect::create(parts.world, row, parts.timestep));
    effects->gases_.push_back(std::move(gas));
  }
  return std::unique_ptr<Effect>(std::move(effects));
}

GasEffects::GasEffects(const CompiledWorld& world, Rational timestep) : forces_(world, timestep) {}
GasEffects::~GasEffects() = default;

void GasEffects::reset(const EffectContext&) {
  for (const auto& gas : gases_) gas->reset();
  forces_.reset();
}

void GasEffects::take_over(const EffectContext& at, Effect* before) {
  auto* other = static_cast<GasEffects*>(before);
  for (const auto& gas : gases_) {
    const std::unique_ptr<GasEffect>* same = nullptr;
    if (other != nullptr) {
      const auto found = std::find_if(other->gases_.begin(), other->gases_.end(),
                                      [&](const auto& one) { return gas->continues(*one); });
      if (found != other->gases_.end()) same = &*found;
    }
    if (same != nullptr) {
      gas->take_over(**same);
    } else {
      gas->begin_at(at.step);
    }
  }
}

int64_t GasEffects::next_tick() const {
  int64_t next = gases_.front()->next_tick();
  for (const auto& gas : gases_) next = std::min(next, gas->next_tick());
  return next;
}

void GasEffects::tick(const EffectContext& at) {
  for (const auto& gas : gases_) {
    if (gas->next_tick() != at.step) continue;
    const uint64_t digest = gas->tick();
    at.hash = hash_bytes(&digest, sizeof(digest), at.hash);
    ticked_.push_back(gas.get());
  }
}

void GasEffects::start(const Snapshot& now) {
  for (GasEffect* gas : ticked_) gas->start(now);
  ticked_.clear();
}

void GasEffects::apply_forces(const EffectContext& at) {
  forces_.begin_step(at.step, at.model, at.data,
                     [this](size_t row) -> const MediumField& { return gases_[row]->air(); });
}

void GasEffects::observe(const EffectContext& at) {
  for (const auto& gas : gases_) gas->observe(at.model, at.data, at.events);
}

void GasEffects::publish(int64_t step, EffectOutputs* out) {
  for (size_t i = 0; i < gases_.size(); ++i) out->media[i] = gases_[i]->window(step);
}

}  // namespace gloam
