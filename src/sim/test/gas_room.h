#pragma once
// Boxes of gas with walls in them, for tests.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sim/effects/gas/gas_solver.h"

namespace gloam {

inline GasProperties closed_box() {
  GasProperties p;
  for (bool& open : p.open) open = false;
  return p;
}

inline std::unique_ptr<GasSolver> make_gas(const GasGrid& grid, const GasProperties& properties) {
  auto solver = GasSolver::create(grid, properties);
  if (!solver.ok()) {
    ADD_FAILURE() << solver.error().to_string();
    std::abort();
  }
  return std::move(solver).value();
}

/// Cells [i0, i1) x [j0, j1) x [k0, k1) become solid and move at v.
inline void add_solid(GasWalls* walls, const int (&low)[3], const int (&high)[3], Vec3f v = {}) {
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) {
        walls->solid[walls->cell(i, j, k)] = 1;
        for (int a = 0; a < 3; ++a) {
          for (int side = 0; side < 2; ++side) {
            const size_t face = walls->face(a, i + (a == 0 ? side : 0), j + (a == 1 ? side : 0),
                                            k + (a == 2 ? side : 0));
            walls->closed[a][face] = 1;
            walls->velocity[a][face] = v[a];
          }
        }
      }
    }
  }
}

/// Closes the face x = i between all cells but those for which `hole(j, k)`.
inline void add_sheet(GasWalls* walls, int i, const std::function<bool(int j, int k)>& hole) {
  for (int k = 0; k < walls->grid.nz; ++k) {
    for (int j = 0; j < walls->grid.ny; ++j) {
      if (!hole(j, k)) walls->closed[0][walls->face(0, i, j, k)] = 1;
    }
  }
}

inline GasSource ball(Vec3f centre, float radius) {
  GasSource source;
  source.X_WS.p = centre;
  source.half_size = {radius, radius, radius};
  return source;
}

}  // namespace gloam
