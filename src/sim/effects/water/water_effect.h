#pragma once
// All waters of a World, on the sim thread: forces on bodies at every step, ripples at a rate of
// their own. Waves need no state: they are a function of time.

#include <memory>
#include <vector>

#include "sim/effects/water/water_forces.h"
#include "sim/effects/water/water_ripples.h"
#include "sim/loop/step_schedule.h"
#include "world/world.h"

namespace gloam {

class WaterEffect {
 public:
  /// The World has waters.
  static std::unique_ptr<WaterEffect> create(std::shared_ptr<const CompiledWorld> world,
                                             Rational timestep);

  void reset();
  /// Goes on at `step` with the ripples of waters of the same name and grid in `before`, null =
  /// none.
  void take_over(int64_t step, const WaterEffect* before);

  /// Adds the forces of step `step` to data.qfrc_applied, and added masses to `model` until
  /// end_step(): true = there are some. Poses and velocities in `data` are of its state. Ripples
  /// advance at their ticks, and the hash comes out with theirs.
  bool begin_step(int64_t step, mjModel& model, mjData& data, uint64_t* hash);
  /// Where a step that has been begun has its inertias already: adds those masses to them.
  void add_masses(const mjModel& model, mjData& data) const { forces_.add_masses(model, data); }
  /// After it, whether it went well or not.
  void end_step(mjModel& model) { forces_.end(model); }

  /// Ripples at a step that begin_step() has not yet been called for.
  void fill(int64_t step, std::vector<HeightChange>* heights) const;

 private:
  WaterEffect(std::shared_ptr<const CompiledWorld> world, Rational timestep, StepSchedule schedule);
  const std::vector<WaterDescription>& waters() const { return world_->waters; }
  void tick(const mjData& data);
  void look(int64_t step, std::span<HeightChange> changes) const;

  const std::shared_ptr<const CompiledWorld> world_;
  const StepSchedule schedule_;
  const double timestep_;  // [s]
  const std::vector<WaterShape> shapes_;
  WaterForces forces_;
  std::vector<std::unique_ptr<WaterRipples>> ripples_;  // of each water, null = none
  std::vector<HeightChange> changes_;                   // room, of each water
  int64_t tick_ = -1;                                   // the last one
};

}  // namespace gloam
