#pragma once
// Cells that a source reaches.

#include "sim/effects/gas/gas_solver.h"
#include "sim/effects/gas/openings.h"

namespace gloam::gas {

/// Greatest speed at which a source drives air [m/s].
inline constexpr float kFastestSource = 50;

/// Calls f(c, share) for the open cells of the source, with fractions that add up to 1; counts
/// those that are solid.
template <class F>
bool for_cells_of(const GasSource& source, const GasGrid& grid, const Openings& openings,
                  int* blocked, F&& f) {
  const Shape& s = openings.shape;
  const Affine3f X_SW = inverse(source.X_WS);
  const Vec3f h = source.half_size;
  const auto inside = [&](Vec3f p_W) {
    const Vec3f p = transform_point(X_SW, p_W);
    const Vec3f q{p.x / h.x, p.y / h.y, p.z / h.z};
    return source.box ? std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) <= 1.0f
                      : dot(q, q) <= 1.0f;
  };
  // Half the size of the box around it, along the world's axes.
  const Affine3f& X = source.X_WS;
  const Vec3f half{std::abs(X.x.x) * h.x + std::abs(X.y.x) * h.y + std::abs(X.z.x) * h.z,
                   std::abs(X.x.y) * h.x + std::abs(X.y.y) * h.y + std::abs(X.z.y) * h.z,
                   std::abs(X.x.z) * h.x + std::abs(X.y.z) * h.y + std::abs(X.z.z) * h.z};
  const auto cell = [&](float p, float low) { return std::floor((p - low) / grid.voxel); };
  int from[3], to[3];
  for (int a = 0; a < 3; ++a) {
    const float n = float(s.n(a));
    from[a] = int(std::clamp(cell(X.p[a] - half[a], grid.low[a]), 0.0f, n));
    to[a] = int(std::clamp(cell(X.p[a] + half[a], grid.low[a]) + 1, 0.0f, n));
  }
  const auto centre = [&](int i, int j, int k) {
    return grid.low + Vec3f{float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f} * grid.voxel;
  };
  int cells = 0;
  const auto visit = [&](auto&& act) {
    for (int k = from[2]; k < to[2]; ++k) {
      for (int j = from[1]; j < to[1]; ++j) {
        for (int i = from[0]; i < to[0]; ++i) {
          if (inside(centre(i, j, k))) act(s.at(i, j, k));
        }
      }
    }
  };
  int solid = 0;
  visit([&](int c) { openings.solid[size_t(c)] ? ++solid : ++cells; });
  if (cells > 0) {
    *blocked += solid;
    const float share = 1.0f / float(cells);
    visit([&](int c) {
      if (!openings.solid[size_t(c)]) f(c, share);
    });
    return true;
  }
  // No centre of an open cell lies inside: the cell of its own centre.
  const float at[3] = {cell(X.p.x, grid.low.x), cell(X.p.y, grid.low.y), cell(X.p.z, grid.low.z)};
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] >= 0.0f) || !(at[a] < float(s.n(a)))) return false;
  }
  const int c = s.at(int(at[0]), int(at[1]), int(at[2]));
  *blocked += solid + (openings.solid[size_t(c)] && solid == 0);
  if (openings.solid[size_t(c)]) return false;
  f(c, 1.0f);
  return true;
}

}  // namespace gloam::gas
