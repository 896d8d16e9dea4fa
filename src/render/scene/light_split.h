#pragma once
// Split of a set of lights in two, so that each half is close together and shines one way.

#include <span>

#include "base/vec.h"

namespace gloam {

/// One light while the tree over it is built.
struct LightItem {
  Vec3f center, half;  ///< of its box [m]; of far lights: its axis, zero
  Vec3f axis;          ///< the way it shines, unit; zero: all ways
  float power = 0;
  uint32_t light = 0;
};

/// Reorders `items`, two at least, and returns how many of the first belong together; at least one
/// and not all. `evenly`: halves them, however unlike they are. A function of the items and their
/// order.
size_t split_lights(std::span<LightItem> items, bool evenly);

}  // namespace gloam
