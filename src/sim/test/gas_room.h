#pragma once
// Boxes of gas with walls in them, for tests.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

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

/// Box with a floor around the foot of a plume, `height` m high.
inline GasGrid plume_grid(float voxel, float height) {
  const auto cells = [voxel](float size) { return int(std::round(size / voxel)); };
  return {cells(3.2f), cells(3.2f), cells(height), voxel, {-1.6f, -1.6f, 0}};
}

/// Still air above a floor, which loses no heat.
inline std::unique_ptr<GasSolver> make_plume(const GasGrid& grid) {
  GasProperties p;
  p.open[4] = false;
  p.cooling = 0;
  return make_gas(grid, p);
}

/// Height of the front of a plume that starts [m]: up to where some cell is warmer by more than
/// `least_rise` of its height [m] [K].
inline double front_of(const GasSolver& gas, const std::function<double(double)>& least_rise) {
  const GasGrid& grid = gas.grid();
  std::vector<float> soot, kelvin;
  gas.read(&soot, &kelvin);
  const size_t plane = size_t(grid.nx) * size_t(grid.ny);
  for (size_t k = size_t(grid.nz); k-- > 0;) {
    const auto layer = kelvin.begin() + ptrdiff_t(k * plane);
    const double warmest = double(*std::max_element(layer, layer + ptrdiff_t(plane))) - 293;
    const double z = (double(k) + 0.5) * double(grid.voxel);
    if (warmest > least_rise(z)) return double(k + 1) * double(grid.voxel);
  }
  return 0;
}

}  // namespace gloam
