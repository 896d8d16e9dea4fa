#pragma once
// Emission of volumes by cell and voxel, for GlowView.

#include <vector>

#include "render/kernel/media/medium_view.h"

namespace gloam {

class GlowTable {
 public:
  /// Builds the table of volume `row` of `media`, whose grids and bounds are set. Allocates only
  /// where more cells glow than ever did.
  void build(const MediaView& media, uint32_t row);
  bool is_dark() const { return cell_sums_.empty(); }
  /// Valid until the next build().
  GlowView view() const;

 private:
  GlowView view_;
  std::vector<uint32_t> cells_;  ///< that glow
  std::vector<double> power_;    ///< of each of them [cd]
  std::vector<float> cell_sums_, voxel_sums_;
  std::vector<int> rows_;
};

}  // namespace gloam
