#pragma once
// The cells behind an IrradianceCacheView: which there are, and what light they hold.

#include <vector>

#include "render/cpu/embree_tracer.h"
#include "render/kernel/fast.h"

namespace gloam {

class IrradianceCache {
 public:
  /// Makes the requested cells, in order, where there are none yet, and forgets those that nobody
  /// has asked for in a while.
  void ask(const std::vector<CacheRequest>& requests);
  /// Traces rays from all cells that were asked for since the last update. `settle`: how many
  /// times; light is reflected once more each time. Returns the number of rays.
  uint64_t update(const SceneView& scene, const EmbreeTracer& tracer, Vec3f eye,
                  float edge_per_metre, uint64_t seed, uint32_t frame, int settle);

  IrradianceCacheView view(Vec3f eye, float edge_per_metre) const;
  size_t size() const { return cells_.size(); }

 private:
  struct Cell {
    uint64_t key = 0;
    uint32_t last_asked = 0, last_traced = 0;  ///< update
    int starts = 0;                            ///< places that asked since the last update
    int samples = 0;                           ///< rays that `light` is the mean of
  };
  static constexpr int kStarts = 4, kFurther = 4;

  uint32_t slot_of(uint64_t key) const;
  void rebuild(size_t slots);
  uint64_t trace(const SceneView& scene, const EmbreeTracer& tracer,
                 const IrradianceCacheView& cache, uint64_t seed, uint32_t frame, bool remembers);
  void forget();

  std::vector<uint64_t> keys_;
  std::vector<uint32_t> rows_;  ///< of each slot
  std::vector<Cell> cells_;
  std::vector<CacheRequest> starts_;  ///< (cells x kStarts)
  std::vector<Vec3f> light_, next_;
  std::vector<uint32_t> asked_;        ///< rows
  std::vector<CacheRequest> further_;  ///< of places that the last rays met: (asked x kFurther)
  uint32_t update_ = 0;
};

}  // namespace gloam
