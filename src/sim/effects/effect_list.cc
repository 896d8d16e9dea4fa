#include "sim/agents/agents.h"
#include "sim/effects/gas/gas_effects.h"
#include "sim/effects/snow/snow_shedding.h"
#include "sim/effects/soil/soil_effect.h"
#include "sim/effects/water/water_effect.h"
#include "sim/effects/wind/wind_effect.h"

namespace gloam {

Result<EffectList> make_effects(const EffectParts& parts) {
  // A new effect is a line here. Forces act in this order; agents come last, for what they write
  // into a state is what the other effects find at the next step.
  static constexpr EffectMaker kMakers[] = {
      WindEffect::make, GasEffects::make,   WaterEffect::make,
      SoilEffect::make, SnowShedding::make, Agents::make,
  };
  EffectList effects;
  for (const EffectMaker make : kMakers) {
    GLOAM_TRY(std::unique_ptr<Effect> effect, make(parts));
    if (effect != nullptr) effects.push_back(std::move(effect));
  }
  return effects;
}

}  // namespace gloam
