#pragma once
// All waters of a World, on the sim thread: forces on bodies at every step, ripples at a rate of
// their own. Waves need no state: they are a function of time.

#include <memory>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/effects/water/water_forces.h"
#include "sim/effects/water/water_ripples.h"
#include "sim/loop/step_schedule.h"
#include "world/world.h"

namespace gloam {

class WaterEffect final : public Effect {
 public:
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);

  std::string_view kind() const override { return "water"; }
  void reset(const EffectContext& at) override;
  /// Goes on with the ripples of waters of the same name and grid.
  void take_over(const EffectContext& at, Effect* before) override;
  bool acts_on_bodies() const override { return true; }
  /// Ripples advance at their ticks, and the hash comes out with theirs. Masses of the water that
  /// bodies carry along are added to the model until end_step().
  void apply_forces(const EffectContext& at) override;
  void end_step(mjModel& model) override { forces_.end(model); }
  /// Ripples at a step that apply_forces() has not yet been called for.
  void publish(int64_t step, EffectOutputs* out) override;

 private:
  WaterEffect(std::shared_ptr<const CompiledWorld> world, Rational timestep, StepSchedule schedule);
  const std::vector<WaterDescription>& waters() const { return world_->waters; }
  void clear();
  void advance_ripples(const mjData& data);
  void look(int64_t step, std::span<HeightChange> changes) const;

  const std::shared_ptr<const CompiledWorld> world_;
  const StepSchedule schedule_;
  const double timestep_;  // [s]
  const std::vector<ImmersedShape> shapes_;
  WaterForces forces_;
  std::vector<std::unique_ptr<WaterRipples>> ripples_;  // ripples of each water, null = none
  std::vector<HeightChange> changes_;                   // scratch, of each water
  int64_t tick_ = -1;                                   // the last one
};

}  // namespace gloam
