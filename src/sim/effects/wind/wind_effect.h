#pragma once
// The wind of a World on its bodies: sets MuJoCo's wind for each step, and adds the drag of air to
// a model that has no fluid of its own. One that has is left to MuJoCo.

#include <optional>

#include "sim/effects/effect.h"
#include "sim/effects/wind/air_drag.h"
#include "sim/effects/wind/wind.h"

namespace gloam {

class WindEffect final : public Effect {
 public:
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);

  std::string_view kind() const override { return "wind"; }
  void reset(const EffectContext&) override {}
  void take_over(const EffectContext&, Effect*) override {}
  void follow_model(mjModel& model) override;
  bool acts_on_bodies() const override { return drag_.has_value(); }
  /// A Command that sets the wind takes the weather's place until the next reset.
  void set_options(const EffectContext& at) override;
  void apply_forces(const EffectContext& at) override;

 private:
  WindEffect(const CompiledWorld& world, Rational timestep) : wind_(world, timestep) {}

  WindOnBodies wind_;
  std::optional<AirDrag> drag_;  // none: MuJoCo's own
};

}  // namespace gloam
