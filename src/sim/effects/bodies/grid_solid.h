#pragma once
// Intervals in which the lines through the centres of a grid's cells are inside a convex solid:
// closed forms. All lengths are in voxels from the grid's low corner: the centre of cell i is at i
// + 1/2.

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

#include "sim/effects/gas/gas_walls.h"

namespace gloam {

/// Solids are taken larger by this [m], so that nothing leaks between two that touch.
inline constexpr double kWallTolerance = 1e-6;

/// n·x <= offset is inside; n a unit vector. As a face of a collider: in its own frame [m].
struct SolidPlane {
  double n[3], offset;
};

/// One convex solid. Made anew for every pose, in the same memory.
class GridSolid {
 public:
  /// Sets grid and pose of the solids made after it: p [m], R row by row (mjData's xpos and xmat).
  void set_pose(const GasGrid& grid, const double* p, const double* R);
  /// Sphere, ellipsoid, capsule, cylinder, box or plane by MuJoCo's geom_size [m]. False: another.
  bool make_primitive(int type, const double* size);
  /// Makes the intersection of the half-spaces below all `planes` with the box at `centre` of half
  /// sides `half` [m].
  void make_polyhedron(std::span<const SolidPlane> planes, const double* centre,
                       const double* half);

  /// Bounds, where all surfaces are moved out by `grow`.
  double low(int axis, double grow) const { return low_[axis] - kDiagonal * grow; }
  double high(int axis, double grow) const { return high_[axis] + kDiagonal * grow; }

  /// The lines along `axis` through the cells (b0 + i, c) of the other two axes, in order of axes,
  /// for i < n: inside where lo[i] <= x <= hi[i]. All surfaces are moved out by `grow`.
  void inside(int axis, int b0, int c, int n, double grow, double* lo, double* hi) const;

 private:
  // Diagonal of a cube over its edge: reach of a grown box
  static constexpr double kDiagonal = 1.7320508;
  enum class Kind : uint8_t { kPlanes, kEllipsoid, kCylinder, kCapsule };
  void add_plane(const SolidPlane& plane);
  void bound(const double* centre, const double* half);
  void inside_planes(int axis, int b0, int c, int n, double grow, double* lo, double* hi) const;

  Kind kind_ = Kind::kPlanes;
  double voxel_ = 1;  // [m]
  double p_[3] = {}, R_[9] = {};
  double size_[3] = {};  // half axes; or radius and half length
  double low_[3] = {}, high_[3] = {};
  std::vector<SolidPlane> planes_;
};

}  // namespace gloam
