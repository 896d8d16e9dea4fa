#pragma once
// Builds the tree over many lights (render/kernel/light_tree.h).

#include <vector>

#include "render/kernel/scene_view.h"

namespace gloam {

class LightTree {
 public:
  /// Over all of `lights`, a function of them alone; `headlights`: rows of those at the camera.
  /// Positions and strengths must be finite. About 0.3 µs a light and thread, 170 bytes a light,
  /// 100 of them while it lasts.
  void build(const std::vector<LightView>& lights, const std::vector<uint32_t>& headlights);
  /// Follows headlights that have moved; `lights` otherwise as they were built from.
  void move_headlights(const std::vector<LightView>& lights,
                       const std::vector<uint32_t>& headlights);
  LightTreeView view() const;

 private:
  std::vector<LightNode> nodes_;
  std::vector<uint32_t> leaf_of_;
  float scale_ = 0;             ///< makes shares of strengths
  uint32_t first_carried_ = 0;  ///< row of nodes_: the headlights' are from here on
};

}  // namespace gloam
