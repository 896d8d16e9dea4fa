#pragma once
// The interactive tier: the state that a camera keeps between pictures, and the next picture.

#include <optional>

#include "render/cpu/interactive/filter.h"
#include "render/cpu/interactive/irradiance_cache.h"
#include "render/cpu/interactive/lamp_cache.h"
#include "render/cpu/path/tile.h"
#include "render/renderer.h"

namespace gloam {

/// Inputs of all rays of one picture.
struct InteractiveView {
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

class InteractiveHistory final : public ViewHistory {
 public:
  /// Renders into job.film->radiance.
  RenderStats render(const Job& job);

 private:
  void resize(int width, int height);
  /// One frame of the sequence, seen by `camera`, into the image; `pass` tells frames of one
  /// instant apart.
  void add_frame(const Job& job, const CameraView32& camera, uint32_t pass, RenderWatch* watch);
  /// Reads the light of the first image from disk. False: it is not there.
  bool load_first_light(uint64_t key);
  void keep_first_light(uint64_t key);
  /// Number of cells for an image of this size, of the one for an image of kBudgetPixels.
  size_t budget(size_t cells) const;
  void trace(const InteractiveView& view, uint32_t pass, RenderSlices* slices);
  /// Traces the tile from the pixel (x0, y0) on. Returns the number of rays.
  uint64_t trace_tile(const InteractiveView& view, uint32_t pass, int x0, int y0,
                      AskedOfTile* asked);
  /// Whether lamps have moved since the last picture; stores their places.
  bool find_moving_lamps(const SceneView& scene);
  void look_up(const IrradianceCacheView& cache);
  void compose();

  IrradianceCache cache_;
  LampCache lamp_cells_;
  InteractiveFrame now_, before_;  ///< of fewer pixels than the image
  ResolvedImage image_, past_image_;
  InteractiveFilter filter_;
  std::vector<LampPlace> lamps_;  ///< in the last picture
  bool lamps_move_ = false;
  std::vector<AskedOfTile> asked_;  ///< by tile
  std::vector<CacheRequest> requests_, lamp_requests_;
  Vec2f near_offset_;  ///< in [0, 1)², of the directions of InteractiveSampleOf::near
  uint64_t rays_ = 0;
  float coarse_ = 1;       ///< edges of the cache's cells, times those wanted
  uint32_t pictures_ = 0;  ///< taken, those of one instant too
};

}  // namespace gloam
