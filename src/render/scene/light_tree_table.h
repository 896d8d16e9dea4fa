#pragma once
// Builds the tree over many lights (render/kernel/light/light_tree.h).

#include <vector>

#include "render/kernel/scene_view.h"

namespace gloam {

class LightTreeTable {
 public:
  /// Builds the tree over all of `lights`, a function of them alone; `headlights`: rows of those at
  /// the camera, in order. Positions and strengths must be finite. Takes about 1 µs of CPU and 125
  /// bytes a light, and 60 more while it lasts.
  void build(const std::vector<LightView>& lights, const std::vector<uint32_t>& headlights);
  /// Follows headlights that have moved; `lights` otherwise as they were built from.
  void move_headlights(const std::vector<LightView>& lights,
                       const std::vector<uint32_t>& headlights);
  LightTreeView view() const;

 private:
  std::vector<LightNode> nodes_;
  std::vector<uint32_t> leaf_of_;
  float scale_ = 0;             ///< turns strengths into fractions of their sum
  uint32_t first_carried_ = 0;  ///< row of nodes_: the headlights' are from here on
};

}  // namespace gloam
