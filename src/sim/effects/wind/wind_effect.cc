#include "sim/effects/wind/wind_effect.h"

#include "gloam/command.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

Result<std::unique_ptr<Effect>> WindEffect::make(const EffectParts& parts) {
  const CompiledWorld& world = *parts.world;
  if (!world.wind.blows()) return std::unique_ptr<Effect>();
  std::unique_ptr<WindEffect> wind(new WindEffect(world, parts.timestep));
  if (!has_own_drag(*world.model)) wind->drag_.emplace(parts.model);
  wind->follow_model(parts.model);
  return std::unique_ptr<Effect>(std::move(wind));
}

void WindEffect::follow_model(mjModel& model) {
  if (drag_)
    drag_->measure(model);
  else
    give_air(&model.opt);
}

void WindEffect::set_options(const EffectContext& at) {
  constexpr auto kWind = static_cast<size_t>(LiveFieldId::kWind);
  if (at.live != nullptr && !at.live->values[kWind].empty()) return;
  wind_.blow(at.step, at.data.qpos, &at.model.opt);
}

void WindEffect::apply_forces(const EffectContext& at) {
  if (drag_) drag_->push(at.model, at.data);
}

}  // namespace gloam
