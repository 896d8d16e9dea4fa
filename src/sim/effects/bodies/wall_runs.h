#pragma once
// From a solid to the faces and cells of a grid that it closes, by way of runs along grid lines.

#include <cstdint>
#include <span>
#include <vector>

#include "sim/effects/bodies/grid_solid.h"

namespace gloam {

/// A stretch of a grid line that is inside a solid. A face is closed when the segment between the
/// centres of its two cells meets the solid: then no way from cell to cell leads through a sheet,
/// however thin.
struct WallRun {
  int axis;  ///< the line's direction
  int b, c;  ///< its cell in the other two axes, in order
  int first_face, last_face;
  int first_cell, last_cell;  ///< cells whose centres are inside; none where first > last
  bool operator==(const WallRun&) const = default;
};

/// Velocities of a rigid body's points: v + w x (world position - the grid's low corner).
struct RigidMotion {
  double v[3] = {}, w[3] = {};  ///< [m/s], [rad/s], world
  bool operator==(const RigidMotion&) const = default;
};

class WallRuns {
 public:
  /// Gaps narrower than `sealed_gap` [m] between two solids are closed.
  WallRuns(const GasGrid& grid, double sealed_gap);

  /// Appends what of the solid is in the grid.
  void append(const GridSolid& solid, std::vector<WallRun>* runs);
  /// No solid within a sphere of this radius [m] makes more runs than this.
  size_t most_runs(double radius) const;

  /// Closes what runs of things that stand still close.
  void close(std::span<const WallRun> runs, GasWalls* walls) const;
  /// The same for what moves. What is closed in `still`, which has no velocities, stands still.
  void close(std::span<const WallRun> runs, const RigidMotion& motion, const GasWalls& still,
             GasWalls* walls) const;
  /// Makes everything that runs touch as it is in `still`.
  void restore(std::span<const WallRun> runs, const GasWalls& still, GasWalls* walls) const;

 private:
  template <class OnFace, class OnCell>
  void visit(const WallRun& run, OnFace&& on_face, OnCell&& on_cell) const;

  GasGrid grid_;
  int n_[3];
  double grow_;                  // growth of all surfaces, for faces [voxels]
  std::vector<double> lo_, hi_;  // ends of a row of lines
};

}  // namespace gloam
