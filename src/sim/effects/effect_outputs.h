#pragma once
// Outputs of effects in Snapshots, by kind of output and not by effect.

#include <memory>
#include <vector>

#include "instant/contact_load.h"
#include "instant/medium_field.h"
#include "instant/surface_heights.h"

namespace gloam {

struct CompiledWorld;

struct EffectOutputs {
  std::vector<FieldWindow> media;      ///< by row of CompiledWorld::gases
  std::vector<HeightChange> surfaces;  ///< by row of world/effects/surface_layout.h
  std::vector<ContactLoad> loads;      ///< loads of the last step
  std::shared_ptr<const std::vector<float>> snow_left;  ///< as PoseFrame::snow_left; null = all
  /// Work that each body has done on soft ground since the beginning [J]; empty = no probe asks.
  std::vector<double> ground_work;

  /// Room for the outputs of a World.
  void fit(const CompiledWorld& world);
  /// Lets go of all that is shared.
  void clear();
};

}  // namespace gloam
