#pragma once
// All gases of a World, each solved for on a thread of its own at a rate of its own.
//
// At its tick k, at the step of t_k, a gas hands out the field of t_k, reads the poses of t_k and
// begins to solve for the field of t_{k+1}: Snapshots in between hold both, and whoever looks at
// one waits for the second if it is not there yet. The simulation itself waits at t_{k+1} alone.

#include <memory>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/effects/gas/gas_forces.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

class GasEffect;

class GasEffects final : public Effect {
 public:
  /// Errors: of memory, MuJoCo's, rates above the step rate.
  static Result<std::unique_ptr<Effect>> make(const EffectParts& parts);
  ~GasEffects() override;

  std::string_view kind() const override { return "gas"; }
  void reset(const EffectContext& at) override;
  /// Goes on with the air that gases of the same name and grid had; the others begin.
  void take_over(const EffectContext& at, Effect* before) override;
  bool acts_on_bodies() const override { return true; }
  void apply_forces(const EffectContext& at) override;
  void observe(const EffectContext& at) override;
  int64_t next_tick() const override;
  void tick(const EffectContext& at) override;
  void start(const Snapshot& now) override;
  void publish(int64_t step, EffectOutputs* out) override;

 private:
  GasEffects(const CompiledWorld& world, Rational timestep);

  std::vector<std::unique_ptr<GasEffect>> gases_;
  std::vector<GasEffect*> ticked_;  // not yet started
  GasForces forces_;
};

}  // namespace gloam
