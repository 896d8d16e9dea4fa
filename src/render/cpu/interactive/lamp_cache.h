#pragma once
// The cells behind a LampCellsView, and the lamps that each cell sees.

#include <vector>

#include "render/cpu/interactive/cell_index.h"
#include "render/cpu/path/watch.h"
#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/interactive/cached_light.h"
#include "render/kernel/interactive/lamp_cells.h"

namespace gloam {

/// Lists of the lamps that each cell sees past all static geometry. Shadow rays account for moving
/// objects.
class LampCache {
 public:
  /// Scenes with more lights have no lists.
  static constexpr uint32_t kMostLights = 1024;

  /// Follows the scene's lights. Lights that move from picture to picture are in no list; when
  /// lights appear, disappear or become brighter, the cache drops all cells.
  void follow(const SceneView& scene);
  /// Makes the requested cells, in order, where there are none yet.
  void ask(const std::vector<CacheRequest>& requests);
  /// Traces rays from new cells to all lamps that may matter, and from the `most_old` other cells
  /// that have waited longest; forgets cells that nothing has asked for in a while. Returns the
  /// number of rays. Of no use any more once `watch` has stopped it.
  uint64_t update(const SceneView& scene, const CpuTracer& tracer, uint64_t seed, size_t most_old,
                  RenderWatch* watch);

  LampCellsView view(Vec3f eye, float edge_per_metre) const;
  /// Writes or reads the cells; the lights must be those of the scene in which they were made.
  template <class Archive>
  void visit(Archive& archive) {
    archive(cells_), archive(lists_), archive(update_);
    starts_.resize(cells_.size() * kStarts);
    index_.assign(cells_);
  }
  size_t size() const { return cells_.size(); }

 private:
  static constexpr int kStarts = 3;
  struct Cell {
    uint64_t key = 0;
    uint32_t last_asked = 0, last_traced = 0;  ///< update
    uint32_t rounds = 0;                       ///< of rays; 0: it is new
    int starts = 0;                            ///< places that asked since the last update
  };

  uint64_t trace_cell(const SceneView& scene, const CpuTracer& fixed, uint64_t seed, uint32_t row);
  void forget_old();

  CellIndex index_;
  std::vector<Cell> cells_;
  std::vector<LampCell> lists_;
  std::vector<CacheRequest> starts_;  ///< (cells x kStarts)
  std::vector<LightView> lights_;     ///< of the last picture
  std::vector<float> strengths_;      ///< of each light, that lists were made with
  std::vector<bool> moves_;           ///< by light, from its first move on
  std::vector<uint16_t> movable_;     ///< rows of those
  uint32_t update_ = 0;
};

}  // namespace gloam
