#pragma once
// What an effect adds to the height of a surface: ripples on water. One version of it, which
// whoever has a Snapshot may hold.

#include <memory>
#include <vector>

namespace gloam {

struct SurfaceHeights {
  std::vector<float> height;  ///< [m], (ny x nx), at the middles of the grid's cells
  std::vector<float> rate;    ///< of its change [m/s], likewise
};

/// At an instant `since` after the field's: height + rate * since.
struct HeightChange {
  std::shared_ptr<const SurfaceHeights> field;  ///< null = none
  float since = 0;                              ///< [s]
};

}  // namespace gloam
