#pragma once
// Points on what is drawn, for views and light that are fitted to it.

#include <span>
#include <vector>

#include "world/render_description.h"

namespace gloam {

/// One drawn thing at an instant.
struct DrawnPart {
  size_t instance = 0;        ///< row of RenderDescription::instances
  std::vector<Vec3f> points;  ///< on its surface, world [m], at most some 2000
  Vec3f low, high;            ///< their bounding box
};

/// All instances that are shown and finite, with bodies at X_WB (nbody).
std::vector<DrawnPart> drawn_parts(const RenderDescription& scene, std::span<const Affine3f> X_WB);

/// The parts that a picture of the model is about: the tree of bodies with the most parts, and
/// what stands beside it and is not much larger. The world's own geoms count where nothing else is
/// drawn; floors, walls and props that are far off or many times larger do not. `root_of`: the root
/// body of each body (nbody).
std::vector<DrawnPart> subject_of(std::vector<DrawnPart> parts, const RenderDescription& scene,
                                  std::span<const int> root_of);

}  // namespace gloam
