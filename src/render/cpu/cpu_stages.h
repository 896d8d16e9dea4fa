#pragma once
// The path stage, the direct stage and the exact channels on the CPU: tiles of a picture, by all
// threads of parallel_for.

#include <cstdint>
#include <vector>

#include "render/cpu/path/adaptive_tile.h"
#include "render/cpu/path/tile.h"

namespace gloam {

class CpuStages {
 public:
  /// Fills a film of the right size. The tier is kPath or kDirect. What `job` refers to is read
  /// anew by each tile: RenderSlices change it in place.
  RenderStats render(Job& job);
  /// The exact channels alone, of any tier.
  void render_exact_channels(const Job& job);

 private:
  /// Makes the tiles of the film. Returns how many there are.
  int64_t begin(const Film& film);
  int x_of(int64_t tile) const { return static_cast<int>(tile % columns_) * kTile; }
  int y_of(int64_t tile) const { return static_cast<int>(tile / columns_) * kTile; }
  AdaptivePlan look(const Job& job);
  void render_tile(const Job& job, int64_t tile, const AdaptivePlan& plan);

  std::vector<RenderStats> tiles_;
  int columns_ = 0;  // of tiles
};

}  // namespace gloam
