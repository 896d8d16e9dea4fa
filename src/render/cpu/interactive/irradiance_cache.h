#pragma once
// The cells behind an IrradianceCacheView: which there are, and what light they hold.

#include <span>
#include <utility>
#include <vector>

#include "render/cpu/interactive/cell_index.h"
#include "render/cpu/interactive/excess_regions.h"
#include "render/cpu/path/watch.h"
#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/interactive/cached_light.h"

namespace gloam {

/// Inputs of the rays of cells.
struct CellRays {
  const SceneView& scene;
  const CpuTracer& tracer;
  Vec3f eye;             ///< of the camera
  float edge_per_metre;  ///< of a cell, by its distance from the eye
  uint64_t seed;
};

/// Cells that an update traces at most: of those whose light rests, and of all.
struct CellBudget {
  size_t settled, most;
};

class IrradianceCache {
 public:
  /// Makes the requested cells, in order, where there are none yet, but not more than `most` cells
  /// in all.
  void ask(const std::vector<CacheRequest>& requests, size_t most = SIZE_MAX);
  /// Traces rays from all cells that were asked for since the last update, and forgets those that
  /// nobody has asked for in a while. `settles`: again and again, at most kFirstRounds times, until
  /// light has come round; if not, once, and only those that have waited longest, as many as
  /// `budget` allows. Returns the number of rays. Of no use any more once `watch` has stopped it.
  uint64_t update(const CellRays& rays, bool settles, CellBudget budget, RenderWatch* watch);
  static constexpr int kFirstRounds = 16;

  IrradianceCacheView view(Vec3f eye, float edge_per_metre) const;
  /// Writes or reads all that lasts between updates.
  template <class Archive>
  void visit(Archive& archive) {
    archive(cells_), archive(light_), archive(homes_), archive(mean_);
    archive(last_change_), archive(last_quotient_), archive(terms_);
    archive(light_changes_), archive(update_), archive(random_state_), archive(further_);
    excess_.visit(archive);
    starts_.resize(cells_.size() * kStarts);
    index_.assign(cells_);
  }
  size_t size() const { return cells_.size(); }

 private:
  struct Cell {
    uint64_t key = 0;
    uint32_t last_asked = 0, last_traced = 0;  ///< update
    uint32_t rounds = 0;                       ///< of rays, since it was made
    int starts = 0;                            ///< places that asked since the last update
    float variance = 0;                        ///< of the luminance of a round's mean
    float stir = 0;   ///< fraction of directions in which things moved lately
    int samples = 0;  ///< rays that `light` is the mean of
  };
  /// Light that a cell's rays of one round brought.
  struct Traced {
    CellLight light;
    Vec3f excess;                    ///< of rays that bring more than is likely: what is above that
    float variance = 0, before = 0;  ///< of its luminance; luminance before the round
    float usual = 0;                 ///< luminance that rays are judged by
    float stir = 0;                  ///< fraction of the rays that met what has moved
    bool is_new = false, changed = false;  ///< it had no light yet; it is not what it was
    uint64_t rays = 0;
  };
  /// Change of several cells: their luminance before, how much more the last rays brought, and the
  /// variance of that.
  struct LightChange {
    float light = 0, change = 0, variance = 0;
  };
  static constexpr int kStarts = 8, kFurther = 8;

  /// Next random number, of the same sequence each time.
  uint32_t next_random();
  /// Mean luminance of the cells beside that of a key, or of all cells if there are none.
  float luminance_beside(uint64_t key) const;
  /// Home of a new cell of air; places that are hidden from there start no rays.
  void find_home(const CpuTracer& tracer, uint32_t row);
  /// Cell k of asked_ into traced_.
  void trace_cell(const SceneView& scene, const CpuTracer& tracer, IrradianceCacheView cache,
                  uint64_t seed, int rays, size_t k);
  LightChange change_of(std::span<const KeyGroups::Member> group) const;
  void find_changes();
  uint64_t trace(const CellRays& rays, bool remembers, RenderWatch* watch);
  /// Extrapolates, after each round, to the light after many more. Returns the fraction by which it
  /// has changed.
  double extrapolate(int round, bool remembers);
  void forget();

  CellIndex index_;
  std::vector<Cell> cells_;
  std::vector<CacheRequest> starts_;  ///< (cells x kStarts)
  std::vector<CellLight> light_;
  std::vector<AirHome> homes_;
  double last_change_ = 0;       ///< of a cell's light in a round [cd/m²]
  double last_quotient_ = 0;     ///< of that and the round's before
  int terms_ = 0;                ///< rounds since the last extrapolation
  std::vector<uint32_t> asked_;  ///< rows
  std::vector<Traced> traced_;   ///< of asked_
  KeyGroups groups_;
  std::vector<CacheRequest> further_;  ///< of places that the last rays met: (asked x kFurther)
  Vec3f mean_;
  ExcessRegions excess_;
  std::vector<ExcessRegions::OfCell> of_cells_;  ///< of traced_
  std::vector<Vec3f> spread_;                    ///< what they get
  bool light_changes_ = false;                   ///< in many of the cells that were traced last
  uint32_t update_ = 0;
  uint64_t random_state_ = 1;
};

}  // namespace gloam
