#pragma once
// Walls of a gas, as the solver reads them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace gloam {

/// Cubic voxels, axes along the world's; the centre of cell (i, j, k) is low + voxel (i + ½, j + ½,
/// k + ½). x runs fastest everywhere.
struct GasGrid {
  int nx = 0, ny = 0, nz = 0;
  float voxel = 0.1f;  ///< edge [m]
  Vec3f low;           ///< corner [m], world

  size_t cells() const { return size_t(nx) * size_t(ny) * size_t(nz); }
  /// Faces across `axis`: one more than cells along it.
  size_t faces(int axis) const {
    return size_t(nx + (axis == 0)) * size_t(ny + (axis == 1)) * size_t(nz + (axis == 2));
  }
  friend bool operator==(const GasGrid& a, const GasGrid& b) {
    return a.nx == b.nx && a.ny == b.ny && a.nz == b.nz && a.voxel == b.voxel && a.low == b.low;
  }
};

/// Closed faces between cells. Face (i, j, k) across axis 0 lies between cells (i-1, j, k) and (i,
/// j, k); arrays are (nz, ny, nx+1), (nz, ny+1, nx), (nz+1, ny, nx).
struct GasWalls {
  GasGrid grid;
  /// 1 = closed. Thin things (a door leaf) close faces without filling a cell.
  std::vector<uint8_t> closed[3];
  /// Velocity of the wall that closes the face, along its axis [m/s]; 0 where open.
  std::vector<float> velocity[3];
  /// (nz, ny, nx); 1 = the cell's centre lies in something; all its faces are closed.
  std::vector<uint8_t> solid;

  GasWalls() = default;
  /// Nothing is closed.
  explicit GasWalls(const GasGrid& g) : grid(g), solid(g.cells(), 0) {
    for (int a = 0; a < 3; ++a) {
      closed[a].assign(g.faces(a), 0);
      velocity[a].assign(g.faces(a), 0.0f);
    }
  }
  size_t cell(int i, int j, int k) const {
    return (size_t(k) * size_t(grid.ny) + size_t(j)) * size_t(grid.nx) + size_t(i);
  }
  size_t face(int axis, int i, int j, int k) const {
    const size_t x = size_t(grid.nx + (axis == 0)), y = size_t(grid.ny + (axis == 1));
    return (size_t(k) * y + size_t(j)) * x + size_t(i);
  }
};

}  // namespace gloam
