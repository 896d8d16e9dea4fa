#pragma once
// All beds of soil of a World, on the sim thread: what sinks in, at every step.

#include <memory>
#include <vector>

#include "sim/effects/soil/soil_bed.h"
#include "world/world.h"

namespace gloam {

class SoilEffect {
 public:
  /// The World has soils.
  static std::unique_ptr<SoilEffect> create(std::shared_ptr<const CompiledWorld> world,
                                            const mjModel& model);

  void reset();
  /// Goes on with the tracks of soils of the same name and grid in `before`, null = none.
  void take_over(const SoilEffect* before);

  /// Adds the forces of step `step` to data.qfrc_applied; poses, velocities and qLD in `data` are
  /// of its state. The hash goes in and comes out with what the ground has been through.
  uint64_t begin_step(int64_t step, const mjModel& model, mjData& data, uint64_t hash);

  /// After the physics of that step: touch sensors sum the loads whose middle lies in their site,
  /// as MuJoCo sums contacts. Not those with a delay, an interval or a history.
  void feel(const mjModel& model, mjData& data) const;

  /// Of the last step, by beds and geoms.
  std::span<const SoilReaction> reactions() const { return reactions_; }

  /// Tracks as they are now.
  void fill(std::vector<HeightChange>* tracks);

  const SoilBed& bed(size_t row) const { return *beds_[row]; }

 private:
  SoilEffect(std::shared_ptr<const CompiledWorld> world, const mjModel& model);

  const std::shared_ptr<const CompiledWorld> world_;
  std::vector<ColliderBottom> colliders_;
  std::vector<const ColliderBottom*> near_;  // room
  std::vector<std::unique_ptr<SoilBed>> beds_;
  ResponseSolver solver_;
  std::vector<SoilReaction> reactions_;
  std::vector<int> touch_sensors_;
};

}  // namespace gloam
