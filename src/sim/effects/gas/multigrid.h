#pragma once
// A geometric multigrid cycle as the preconditioner of the pressure's conjugate gradients (McAdams,
// Sifakis and Teran 2010). Cells of a level are joined by one to three along each axis, so that the
// walls of rooms, which lie in planes, stay between cells of the coarser levels instead of getting
// lost inside of them; weights of faces are those of finite volumes.

#include "sim/effects/gas/kernel/poisson.h"
#include "sim/effects/gas/rows.h"

namespace gloam::gas {

class Multigrid {
 public:
  /// Bytes for a grid of `cells`, about.
  static uint64_t bytes(uint64_t cells) { return cells * (4 * 8 + 1); }

  /// For a grid of this shape; all open until the next update().
  explicit Multigrid(const Shape& shape);
  /// The finest level's weights were changed: makes all else of them.
  void update();
  /// To be filled before update(): 1 = open, 0 = closed, sides of the box too.
  Faces<float> weights();
  PoissonView finest() const { return view(0); }
  /// Open faces of the finest level's cells: open_faces(), after update().
  const uint8_t* open_faces() const { return open_.data(); }
  /// x = about A⁻¹ b, by a symmetric linear map. `x`, `b`: with ghosts of 0.
  void precondition(const float* b, float* x);

  int levels() const { return int(levels_.size()); }
  PoissonView view(size_t level) const;
  /// Along an axis: the finer level's first cell of each of this level's, one more than cells.
  const std::vector<int>& start(size_t level, int axis) const { return levels_[level].start[axis]; }

 private:
  struct Cycle;
  struct FirstStep;
  struct Level {
    Shape shape;
    Field weight[3], inverse;
    Field x, b, scratch;
    /// Along each axis: widths of cells with a ghost at both ends, and start().
    std::vector<float> width[3];
    std::vector<int> start[3];
  };
  struct Plane {
    float count = 0, sum = 0, most = 0;
  };
  void find_lost(const Level& fine, int axis);
  void choose_cells(const Level& fine, int axis, std::vector<int>* start);
  void coarsen(const Level& fine, Level& coarse);
  void find_open_faces();
  void invert(Level& level);
  /// to = a damped Jacobi step from `from`.
  template <class From>
  void smooth(size_t level, const float* b, From from, float* to, float damping) const;
  void restrict_residual(size_t level, const float* b, const float* x);
  void prolong(size_t level, float* x);

  std::vector<Level> levels_;
  std::vector<uint8_t> open_;
  std::vector<Plane> planes_;       ///< scratch of find_lost()
  std::vector<float> lost_, cost_;  ///< scratch of choose_cells()
  std::vector<int> choice_;
};

}  // namespace gloam::gas
