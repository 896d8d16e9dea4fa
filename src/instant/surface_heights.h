#pragma once
// Heights that an effect adds to a surface: ripples on water. One immutable version, which holders
// of Snapshots share.

#include <memory>
#include <vector>

namespace gloam {

struct SurfaceHeights {
  std::vector<float> height;  ///< [m], (ny x nx), at the middles of the grid's cells
  std::vector<float> rate;    ///< rate of its change [m/s], likewise
};

/// At an instant `since` after the field's: height + rate * since.
struct HeightChange {
  std::shared_ptr<const SurfaceHeights> field;  ///< null = none
  float since = 0;                              ///< [s]
};

}  // namespace gloam
