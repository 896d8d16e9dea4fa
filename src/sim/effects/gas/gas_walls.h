#pragma once
// What a gas meets: faces between cells that something closes.
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace gloam {
/// Cubic voxels, axes along the world's; cell (i,j,k) centre = low + voxel*(i+.5, j+.5, k+.5). x
/// fastest everywhere.
struct GasGrid {
  int nx = 0, ny = 0, nz = 0;
  float voxel = 0.1f;  ///< [m]
  Vec3f low;           ///< [m], world
};
/// Face (i,j,k) across axis 0 lies between cells (i-1,j,k) and (i,j,k); arrays of (nx+1)*ny*nz,
/// nx*(ny+1)*nz, nx*ny*(nz+1).
struct GasWalls {
  GasGrid grid;
  /// 1 = closed. Thin things (a door leaf) close faces without filling a cell.
  std::vector<uint8_t> closed[3];
  std::vector<float> velocity[3];  ///< of what closes the face, along the axis [m/s]; 0 where open
  /// (nz x ny x nx) 1 = the cell's centre lies in something; all its faces are closed
  std::vector<uint8_t> solid;
};
}  // namespace gloam
