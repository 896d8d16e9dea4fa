#pragma once
// All beds of soil of a World, on the sim thread: what sinks in, at every step.

#include <memory>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/effects/soil/soil_bed.h"
#include "world/world.h"

namespace gloam {

class SoilEffect final : public Effect {
 public:
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);

  std::string_view kind() const override { return "soil"; }
  void reset(const EffectContext& at) override;
  /// Goes on with the tracks of soils of the same name and grid.
  void take_over(const EffectContext& at, Effect* before) override;
  bool acts_on_bodies() const override { return true; }
  /// The hash comes out with what the ground has been through; loads are by beds and geoms.
  void apply_loads(const EffectContext& at) override;
  /// Touch sensors sum the loads whose middle lies in their site, as MuJoCo sums contacts. Not
  /// those with a delay, an interval or a history.
  void update_sensors(const EffectContext& at) override;
  void publish(int64_t step, EffectOutputs* out) override;

  const SoilBed& bed(size_t row) const { return *beds_[row]; }

 private:
  SoilEffect(std::shared_ptr<const CompiledWorld> world, const mjModel& model);
  void take_over_work(const SoilEffect& before);

  const std::shared_ptr<const CompiledWorld> world_;
  std::vector<ColliderBottom> colliders_;
  std::vector<const ColliderBottom*> near_;  // scratch
  std::vector<std::unique_ptr<SoilBed>> beds_;
  ResponseSolver solver_;
  std::vector<int> touch_sensors_;
  std::vector<double> work_;  // as EffectOutputs::ground_work
};

}  // namespace gloam
