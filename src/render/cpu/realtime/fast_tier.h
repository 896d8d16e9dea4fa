#pragma once
// The fast tier: what a camera remembers from picture to picture, and one picture more.

#include <optional>

#include "render/cpu/path/tile.h"
#include "render/cpu/realtime/fast_filter.h"
#include "render/cpu/realtime/irradiance_cache.h"
#include "render/cpu/realtime/lamp_cache.h"
#include "render/renderer.h"

namespace gloam {

/// Inputs that all rays of one picture share.
struct FastView {
  const SceneView& scene;
  const CpuTracer& tracer;
  const CpuTracer& movers;  ///< of only the instances that may move
  const CameraView32& camera;
  IrradianceCacheView cache;
  std::optional<LampCellsView> lamps;
  uint64_t seed;
};

/// Requests of one tile: for surfaces in view, for what mirrors show, and for lists of lamps.
struct AskedOfTile {
  std::vector<CacheRequest> seen, mirrored, lamps;
};

/// Position and direction of a lamp.
struct LampPlace {
  Vec3f p_W, direction;
};

class FastHistory final : public ViewHistory {
 public:
  /// Renders into job.film->radiance.
  RenderStats render(const Job& job);

 private:
  /// One picture of the sequence; `pass` tells those of one instant apart.
  void add_picture(const Job& job, uint32_t pass, RenderWatch* watch);
  void trace(const FastView& view, uint32_t pass, RenderSlices* slices);
  /// Traces the tile from the pixel (x0, y0) on. Returns the number of rays.
  uint64_t trace_tile(const FastView& view, uint32_t pass, int x0, int y0, AskedOfTile* asked);
  /// Whether lamps have moved since the last picture; stores their places.
  bool find_moving_lamps(const SceneView& scene);
  void look_up(const IrradianceCacheView& cache);
  void compose();

  IrradianceCache cache_;
  LampCache lamp_cells_;
  FastFrame now_, before_;
  FastFilter filter_;
  std::vector<LampPlace> lamps_;  ///< in the last picture
  bool lamps_move_ = false;
  std::vector<AskedOfTile> asked_;  ///< by tile
  std::vector<CacheRequest> requests_, lamp_requests_;
  Vec2f near_offset_;  ///< in [0, 1)², of the directions of FastSampleOf::near
  uint64_t rays_ = 0;
  float coarse_ = 1;       ///< edges of the cache's cells, times those wanted
  uint32_t pictures_ = 0;  ///< taken, those of one instant too
};

}  // namespace gloam
