#pragma once
// A World's walls of gas at any state, and where air gets through them.

#include <array>
#include <vector>

#include "scene/files/mujoco_guard.h"
#include "sim/effects/gas/gas_obstacles.h"
#include "test_world.h"

namespace gloam {

inline GasGrid cube_grid(int n, float voxel) {
  const float low = -0.5f * voxel * static_cast<float>(n);
  return {n, n, n, voxel, {low, low, low}};
}

/// Where in the arrays of GasWalls a face is; axis 3: a cell.
size_t gas_index(const GasGrid& grid, int axis, int i, int j, int k);
/// The centre of a face, or of a cell (axis 3) [m].
std::array<double, 3> gas_centre(const GasGrid& grid, int axis, int i, int j, int k);

/// Calls f(axis, i, j, k, index) for all faces.
template <class F>
void for_faces(const GasGrid& g, F&& f) {
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < g.nz + (axis == 2); ++k)
      for (int j = 0; j < g.ny + (axis == 1); ++j)
        for (int i = 0; i < g.nx + (axis == 0); ++i) f(axis, i, j, k, gas_index(g, axis, i, j, k));
}
/// Calls f(i, j, k, index) for all cells.
template <class F>
void for_cells(const GasGrid& g, F&& f) {
  for (int k = 0; k < g.nz; ++k)
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) f(i, j, k, gas_index(g, 3, i, j, k));
}

/// Adds all cells that air of the `reached` ones gets to, from cell to cell through open faces.
void flood(const GasWalls& walls, std::vector<uint8_t>* reached);

/// What must hold of any walls: sizes, closed faces of solid cells, no velocity where open.
void expect_consistent(const GasWalls& walls);
void expect_equal(const GasWalls& a, const GasWalls& b);

int count(const std::vector<uint8_t>& flags);

struct GasRig {
  std::shared_ptr<CompiledWorld> world;
  DataPtr d;  // the state that solve() is asked about
  std::unique_ptr<GasObstacles> obstacles;
  GasWalls walls;
  double gap;

  GasRig(std::shared_ptr<CompiledWorld> world, const GasGrid& grid, double sealed_gap = 0);
  GasRig(const std::string& bodies, const GasGrid& grid, double sealed_gap = 0);
  Snapshot snapshot() const;
  void solve();
  /// The walls of obstacles that have seen nothing before.
  GasWalls fresh() const;
};

}  // namespace gloam
