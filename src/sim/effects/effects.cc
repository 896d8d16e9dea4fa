#include "sim/effects/effects.h"

#include <algorithm>

#include "base/hash.h"
#include "sim/effects/gas/gas_effect.h"

namespace gloam {

Result<std::unique_ptr<Effects>> Effects::create(std::shared_ptr<const CompiledWorld> world,
                                                 Rational timestep) {
  std::unique_ptr<Effects> effects;
  for (size_t row = 0; row < world->gases.gases.size(); ++row) {
    if (effects == nullptr) effects.reset(new Effects(*world, timestep));
    GLOAM_TRY(std::unique_ptr<GasEffect> gas, GasEffect::create(world, row, timestep));
    effects->gases_.push_back(std::move(gas));
  }
  return effects;
}

Effects::Effects(const CompiledWorld& world, Rational timestep) : forces_(world, timestep) {}
Effects::~Effects() = default;

void Effects::reset() {
  for (const auto& gas : gases_) gas->reset();
  forces_.reset();
}

void Effects::take_over(int64_t step, Effects* before) {
  for (const auto& gas : gases_) {
    const std::unique_ptr<GasEffect>* same = nullptr;
    if (before != nullptr) {
      const auto found = std::find_if(before->gases_.begin(), before->gases_.end(),
                                      [&](const auto& other) { return gas->continues(*other); });
      if (found != before->gases_.end()) same = &*found;
    }
    if (same != nullptr) {
      gas->take_over(**same);
    } else {
      gas->begin_at(step);
    }
  }
}

int64_t Effects::next_tick() const {
  int64_t next = gases_.front()->next_tick();
  for (const auto& gas : gases_) next = std::min(next, gas->next_tick());
  return next;
}

uint64_t Effects::tick(int64_t step, uint64_t hash) {
  for (const auto& gas : gases_) {
    if (gas->next_tick() != step) continue;
    const uint64_t digest = gas->tick();
    hash = hash_bytes(&digest, sizeof(digest), hash);
    ticked_.push_back(gas.get());
  }
  return hash;
}

void Effects::start(const Snapshot& now) {
  for (GasEffect* gas : ticked_) gas->start(now);
  ticked_.clear();
}

void Effects::begin_step(int64_t step, const mjModel& model, mjData& data) {
  forces_.begin_step(step, model, data,
                     [this](size_t row) -> const MediumField& { return gases_[row]->air(); });
}

void Effects::gather(const mjModel& model, const mjData& data, std::span<const SoilReaction> soil,
                     const Agents* agents) {
  for (const auto& gas : gases_) gas->gather(model, data, soil, agents);
}

void Effects::fill(int64_t step, std::vector<FieldWindow>* fields) const {
  for (size_t i = 0; i < gases_.size(); ++i) (*fields)[i] = gases_[i]->window(step);
}

}  // namespace gloam
