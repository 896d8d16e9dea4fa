#include "sim/effects/wind/wind_effect.h"

#include "gloam/command.h"
#include "sim/loop/step_halves.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

Result<std::unique_ptr<Effect>> WindEffect::make(const EffectParts& parts) {
  const CompiledWorld& world = *parts.world;
  if (!world.wind.blows()) return std::unique_ptr<Effect>();
  std::unique_ptr<WindEffect> wind(new WindEffect(world, parts.timestep));
  wind->follow_model(parts.model);
  const mjOption& own = world.model->opt;
  if (own.density == 0 && own.viscosity == 0 && has_halves(parts.model) &&
      AirDrag::can_be(parts.model))
    wind->drag_.emplace(parts.model);
  return std::unique_ptr<Effect>(std::move(wind));
}

void WindEffect::follow_model(mjModel& model) {
  give_air(&model.opt);
  if (drag_) drag_->measure(model);
}

void WindEffect::set_options(const EffectContext& at) {
  constexpr auto kWind = static_cast<size_t>(LiveFieldId::kWind);
  if (at.live != nullptr && !at.live->values[kWind].empty()) return;
  wind_.blow(at.step, at.data.qpos, &at.model.opt);
}

// Without density and viscosity MuJoCo computes no drag in its first half.
void WindEffect::prepare_step(const EffectContext& at) {
  if (drag_) at.model.opt.density = at.model.opt.viscosity = 0;
}

void WindEffect::apply_forces(const EffectContext& at) {
  if (!drag_) return;
  give_air(&at.model.opt);
  drag_->push(at.model, at.data);
}

void WindEffect::end_step(mjModel& model) {
  if (drag_) give_air(&model.opt);
}

}  // namespace gloam
