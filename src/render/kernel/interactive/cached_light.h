#pragma once
// Requests of the interactive stage to the irradiance cache, and lookups in it. Device-safe.

#include "render/kernel/interactive/irradiance_cache_view.h"
#include "render/kernel/interactive/lamp_cells.h"
#include "render/kernel/surface/surface_point.h"

namespace gloam {

/// A cell that a surface needs.
struct CacheRequest {
  uint64_t key = 0;  ///< 0 = none
  Vec3f p, n;        ///< where rays for it may start
  float g = 0;       ///< of their lobe about n, in the air
};

/// Scene, tracer and cache that all rays of a picture see. Long functions that take it are not
/// inlined: each is called from several places, and the instruction cache is small.
template <class Tracer>
struct InteractiveWorld {
  const SceneView& scene;
  const Tracer& tracer;
  const IrradianceCacheView& cache;
  const LampCellsView* lamps = nullptr;  ///< null: lamps are searched for at each surface
  const Tracer* movers = nullptr;        ///< with `lamps`: of only the instances that may move
};

namespace interactive {

/// Places that ask the cache: surfaces, or air that a ray crosses.
template <class F>
struct CachePlaceOf {
  Vec3Of<F> p, n;
  UintOf<F> side;
  Vec3Of<F> start;  ///< of rays
  F g = 0.0f;       ///< mean cosine of what media there scatter
};
template <class F>
GLOAM_HD CachePlaceOf<F> place_of(const SurfaceOf<F>& v) {
  return {v.p, v.normal, select(v.outside, UintOf<F>(kOutsideCell), UintOf<F>(kInsideCell)),
          leave_surface(v.p, v.geometric, v.geometric, v.t)};
}

/// The cells of places; asks for them.
template <class F>
GLOAM_HD CacheCellOf<F> ask_cells(const CellGrid& grid, const CachePlaceOf<F>& at, MaskOf<F> active,
                                  Vec3Of<F> jitter, uint32_t coarser, CacheRequest* requests) {
  const CacheCellOf<F> cells = cache_cell<F>(grid, at.p, at.n, at.side, jitter, coarser);
  each_lane(active, [&](int i) {
    requests[i] = {cache_key(cells, i), lane(at.start, i), lane(at.n, i), lane(at.g, i)};
  });
  return cells;
}

/// Light that the cache holds for the cells. Until a cell is there, the one about the point itself
/// or a larger one stands for it, or `otherwise`.
template <class F>
GLOAM_HD Vec3Of<F> cached_light(const IrradianceCacheView& cache, const CachePlaceOf<F>& at,
                                const CacheCellOf<F>& cells, MaskOf<F> active, uint32_t coarser,
                                Vec3f otherwise) {
  Vec3Of<F> light;
  int cell[Lanes<F>::kCount];  // all before the first is read: the memory is waited for once
  each_lane(active, [&](int i) { cell[i] = find_known_cell(cache, cache_key(cells, i)); });
  each_lane(active, [&](int i) {
    for (uint32_t more = 0; cell[i] < 0 && more < 3; ++more) {
      cell[i] =
          find_known_cell(cache, cache_key(cache, lane(at.p, i), lane(at.n, i), lane(at.side, i),
                                           {0.5f, 0.5f, 0.0f}, coarser + more));
    }
    const bool known = cell[i] >= 0;
    set_lane(&light, i, known ? cache.light[static_cast<uint32_t>(cell[i])].all : otherwise);
  });
  return light;
}

}  // namespace interactive
}  // namespace gloam
